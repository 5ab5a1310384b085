"""Chapter 4. The pseudoinverse: what the null space is, and a cap that spares the feet."""

from dataclasses import replace

import numpy as np

from ikteach.arrays import Array
from ikteach.body import figures
from ikteach.course.checking import Answer, exercise, expect
from ikteach.motion import gait, track


@exercise(
    "04.projector",
    returns=lambda J: (J.shape[1], J.shape[1]),
    hints=[
        "J⁺J keeps the part of Δθ that moves the effectors. What keeps the rest?",
        "P = I − J⁺J, with `np.linalg.pinv(J)` for J⁺: JJᵀ has no inverse where J lost a rank.",
    ],
)
def projector(answer: Answer) -> None:
    rng = np.random.default_rng(4)
    wide, tall = rng.normal(size=(3, 7)), rng.normal(size=(6, 4))
    lost = rng.normal(size=(6, 2)) @ rng.normal(size=(2, 9))
    for J, rank in ((wide, 3), (tall, 4), (lost, 2), (np.zeros((3, 4)), 0)):
        P = answer(J)
        n = J.shape[1]
        expect(
            np.allclose(J @ P, 0, atol=1e-8), "JP is not zero: what P lets through moves effectors."
        )
        expect(
            np.allclose(P @ P, P, atol=1e-8), "P² is not P: to project twice must change nothing."
        )
        expect(
            np.allclose(P, P.T, atol=1e-8),
            "P is not symmetric: it does not project at right angles.",
        )
        expect(
            abs(np.trace(P) - (n - rank)) < 1e-6,
            f"The trace of P is {np.trace(P):.2f}; it counts the free directions, and J of rank "
            f"{rank} leaves {n - rank} of {n}.",
        )


@exercise(
    "04.cap",
    returns=lambda dtheta, max_step, chains: dtheta.shape,
    hints=[
        "For each number in `np.unique(chains)`: which joints have it, and what is the largest |Δθ|?",
        "Multiply the joints of one chain by min(1, max_step / their largest |Δθ|).",
    ],
    seconds=20,
)
def cap(answer: Answer) -> None:
    rng = np.random.default_rng(5)
    chains = np.array([2, 2, 0, 0, 0, 1, 1])
    bound = 0.1
    for size in ([5, 5, 0.01, 0.01, 0.01, 3, 3], [0.01] * 7, [1] * 7):
        dtheta = rng.uniform(0.2, 1, 7) * rng.choice([-1, 1], 7) * size
        dtheta[0] = -abs(dtheta[0])
        done = answer(dtheta, bound, chains)
        for chain in range(3):
            before, after = dtheta[chains == chain], done[chains == chain]
            peak = abs(before).max()
            expect(abs(after).max() <= bound * (1 + 1e-9), "A joint turns further than max_step.")
            expect(
                np.allclose(after * peak, before * abs(after).max(), atol=1e-12),
                "The joints of a chain must shrink by the same share, or the hand goes elsewhere.",
            )
            wanted = min(peak, bound)
            expect(
                abs(abs(after).max() - wanted) < 1e-9,
                "A chain that keeps within max_step, or can just meet it, is shortened too much "
                "or made longer.",
            )
    expect(answer(np.zeros(7), bound, chains).max() == 0, "A step of zero must stay zero.")
    expect(
        feet(answer).max() < 1e-3,
        "With both hands out of reach the feet stay more than 1 mm from targets they can reach.",
    )


def feet(cap: Answer) -> Array:
    """Distance of each foot [m] after 2 s of standing, with both hands out of reach."""
    tree, effectors = figures.human()
    targets = np.tile(replace(gait.walking, x_hand=1.2).at(0.3), (60, 1, 1))
    run = track(tree, effectors, targets, "pseudoinverse", max_step=np.radians(5), cap=cap)
    return run.error[-1, :2]
