"""Chapter 0: forward kinematics of an arm, and what it can reach."""

import numpy as np

from ikteach.arrays import Array
from ikteach.body import figures, forward, locate
from ikteach.course.checking import Answer, exercise, expect
from ikteach.course.forms import TRUTH, agree, numbers_apart

LENGTHS = np.array([1.0, 0.7, 0.4])  # [m]
REACH = LENGTHS.sum()


def hand_of(theta: Array, lengths: Array) -> Array:
    """Where `forward` puts the hand, (2,) [m]."""
    tree, effectors = figures.planar_arm(lengths.tolist())
    return locate(forward(tree, theta), effectors)[0, :2]


@exercise(
    "00.hand",
    returns=(2,),
    hints=[
        "Which way does the second link point once the first has turned?",
        "Link i points along θ₁ + … + θᵢ: x is the sum of lengthᵢ · "
        "cos(θ₁ + … + θᵢ), y that of sin.",
        "`along = np.cumsum(theta)`; then x is `lengths @ np.cos(along)`.",
    ],
)
def hand(answer: Answer) -> None:
    """hand(theta (3,), lengths (3,)) -> (2,) is where `forward` puts it."""
    agree(
        answer(np.zeros(3), LENGTHS),
        [REACH, 0],
        "With all angles 0 the arm lies along x and the hand is at {wanted} m, not at {found}.",
    )
    agree(
        answer(np.array([np.pi / 2, 0, 0]), LENGTHS),
        [0, REACH],
        "With θ₁ = π/2 alone the whole arm points up: the hand is at {wanted} m, not at {found}.",
    )
    rng = np.random.default_rng(0)
    for _ in range(12):
        theta, lengths = rng.uniform(-7, 7, 3).round(2), rng.uniform(0.2, 4, 3).round(2)
        agree(
            answer(theta, lengths),
            hand_of(theta, lengths),
            f"For θ = {theta} and links of {lengths} m the hand is at {{wanted}} m, not at "
            "{found}.",
            size=lengths.sum(),
        )


def places() -> list[tuple[float, float, float, float]]:
    """(x, y, a, b) in all quadrants, near both ends of the reach, and just on them.

    Those on an end have lengths that no rounding touches: whatever formula is used, it meets them.
    """
    rng, cases = np.random.default_rng(0), []
    links = rng.uniform(0.2, 2.0, (40, 2)).round(2)
    links[::8, 1] = links[::8, 0]  # no hole
    for a, b in links:
        for end in (abs(a - b), a + b):
            for share in rng.permutation([0.5, 0.98, 0.999, 1.001, 1.02, 1.5])[:3]:
                x, y = (
                    share * end * np.array([np.cos(way := rng.uniform(0, 2 * np.pi)), np.sin(way)])
                )
                cases.append((float(x), float(y), float(a), float(b)))
    on = [(1.5, 0.0, 1.0, 0.5), (0.0, -1.5, 1.0, 0.5), (0.0, 0.5, 1.0, 0.5), (-0.5, 0.0, 0.5, 1.0)]
    just = [(0.0, share * (a + b), a, b) for a, b in links[:4] for share in (0.99999, 1.00001)]
    middle = [
        (0.0, 0.0, 0.5, 0.5),
        (0.0, 0.0, 1.0, 0.5),
        (0.0, 0.05, 0.8, 0.8),
        (0.5, 0.5, 1.0, 0.6),
    ]
    return [*middle, *on, *just, *cases]


@exercise(
    "00.reach",
    returns=TRUTH,
    hints=[
        "Stretched, the arm reaches a + b. What is the nearest to its shoulder that it can come?",
        "Folded, its hand is at the distance |a − b|: with unequal links there is a hole. "
        "So |a − b| ≤ √(x² + y²) ≤ a + b.",
        "`return abs(a - b) <= np.hypot(x, y) <= a + b`",
    ],
    seconds=20,
)
def reach(answer: Answer) -> None:
    """can_reach(x, y, a, b) -> bool for an arm of two links a and b [m]."""
    for x, y, a, b in places():
        near, far, d = abs(a - b), a + b, float(np.hypot(x, y))
        can = bool(near <= d <= far)
        away, low, high = numbers_apart(d, near, far)
        why = (
            "within its reach"
            if near < d < far
            else "on the edge of its reach"
            if can
            else "further than both links together"
            if d > far
            else "in the hole that unequal links leave"
        )
        expect(
            answer(x, y, a, b) == can,
            f"Links of {a:g} m and {b:g} m {'can' if can else 'cannot'} reach ({x:.4g}, {y:.4g}): "
            f"it is {away} m away, {why}; they reach from {low} m to {high} m.",
        )
