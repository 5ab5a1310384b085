"""Chapter 0: forward kinematics of an arm, and what it can reach."""

import numpy as np

from ikteach.body import figures, forward, locate
from ikteach.course.checking import Answer, exercise, expect

LENGTHS = np.array([1.0, 0.7, 0.4])  # [m]


@exercise(
    "00.hand",
    returns=(2,),
    hints=[
        "The second link turns with the first: it points along θ₁ + θ₂.",
        "x is the sum of lengthᵢ · cos(θ₁ + … + θᵢ), y the same with sin. `np.cumsum` adds up.",
    ],
)
def hand(answer: Answer) -> None:
    """hand(theta (3,), lengths (3,)) -> (2,) is where `forward` puts it."""
    straight = answer(np.zeros(3), LENGTHS)
    expect(
        np.allclose(straight, [LENGTHS.sum(), 0]),
        f"With all angles 0 the arm lies along x and the hand is at x = {LENGTHS.sum():.1f} m, "
        f"y = 0, not at {_at(straight)}.",
    )
    raised = answer(np.array([np.pi / 2, 0, 0]), LENGTHS)
    expect(
        np.allclose(raised, [0, LENGTHS.sum()]),
        "With θ₁ = π/2 alone the whole arm points up: the hand must be at x = 0, "
        f"y = {LENGTHS.sum():.1f} m, not at {_at(raised)}.",
    )
    rng = np.random.default_rng(0)
    for _ in range(8):
        theta, lengths = rng.uniform(-3, 3, 3), rng.uniform(0.2, 1.5, 3)
        tree, effectors = figures.planar_arm(lengths.tolist())
        there = locate(forward(tree, theta), effectors)[0, :2]
        found = answer(theta, lengths)
        expect(
            np.allclose(found, there),
            f"For θ = {theta.round(2)} the hand is at {_at(there)}, not at {_at(found)}.",
        )


@exercise(
    "00.reach",
    returns=bool,
    hints=[
        "Stretched, the arm reaches a + b. What is the nearest to its shoulder that it can come?",
        "Folded, its hand is at the distance |a − b|: with unequal links there is a hole.",
    ],
)
def reach(answer: Answer) -> None:
    """can_reach(x, y, a, b) -> bool for an arm of two links a and b [m]."""
    cases = [
        (1.0, 0.5, 1.0, 0.6, True, "is within the ring"),
        (1.2, 1.2, 1.0, 0.6, False, "is further than both links together"),
        (0.1, 0.0, 1.0, 0.6, False, "is in the hole that unequal links leave"),
        (0.0, -0.2, 0.6, 1.0, False, "is in the hole, also when the second link is the longer"),
        (0.0, 0.05, 0.8, 0.8, True, "has no hole around it: the links are equal"),
        (-0.9, -0.9, 1.0, 0.6, True, "is within the ring: 1.27 m away, to the lower left"),
        (1.6, 0.0, 1.0, 0.6, True, "is reached by the stretched arm, just so"),
        (0.0, 0.5, 1.0, 0.5, True, "is reached by the folded arm, just so"),
    ]
    for x, y, a, b, can, why in cases:
        found = answer(x, y, a, b)
        said = "can" if can else "cannot"
        where = f"({x}, {y}) {why}"
        expect(found == can, f"Links of {a} m and {b} m {said} reach that: {where}.")


def _at(point: np.ndarray) -> str:
    return f"({point[0]:.2f}, {point[1]:.2f})"
