"""Chapter 3. The transpose: the best α, a step that is safe at zero, and how far is too far."""

import numpy as np

from ikteach.arrays import Array
from ikteach.body import figures, forward, jacobian
from ikteach.course.checking import Answer, exercise, expect
from ikteach.solvers import transpose


def problems() -> list[tuple[Array, Array]]:
    """Some (J, e), in metres, in millimetres and tiny."""
    rng = np.random.default_rng(3)
    shapes = [(3, 3), (3, 5), (6, 4), (12, 20)]
    plain = [(rng.normal(size=s), rng.normal(size=s[0])) for s in shapes]
    J, e = plain[1]
    return [*plain, (1000 * J, 1000 * e), (J, 1e-6 * e)]


@exercise(
    "03.alpha",
    returns=(),
    hints=[
        "Write g = JJᵀe. Then ‖e − αg‖² is a parabola in α: ⟨e,e⟩ − 2α⟨e,g⟩ + α²⟨g,g⟩.",
        "A parabola is lowest where its derivative is zero: α = ⟨e,g⟩ / ⟨g,g⟩.",
    ],
)
def alpha(answer: Answer) -> None:
    for J, e in problems():
        g = J @ (J.T @ e)
        a = float(answer(J, e))

        def left(share: float, a: float = a, e: Array = e, g: Array = g) -> float:
            return float(np.linalg.norm(e - share * a * g))

        expect(a > 0, f"`{answer.call}` is {a:.3g}: the best α goes downhill, it is above 0.")
        expect(
            left(1) <= left(0),
            "With your α the linear model leaves more error than no step at all: it is too large.",
        )
        better = min((0.5, 0.9, 0.999, 1.001, 1.1, 2.0), key=left)
        expect(
            left(1) <= left(better) * (1 + 1e-12),
            f"Your α is not the best: {better:g} times as much leaves less of ‖e − αJJᵀe‖.",
        )


@exercise(
    "03.safe",
    returns=lambda J, e: J.shape[1:],
    hints=[
        "What is divided by what when Jᵀe is zero?",
        "Ask whether JJᵀe is zero before you divide, not whether e is: a straight arm has Jᵀe = 0 "
        "for an e that is not. And add nothing to the denominator: it changes every other step.",
    ],
)
def safe(answer: Answer) -> None:
    for J, e in problems():
        wanted = transpose(J, e)
        expect(
            np.allclose(answer(J, e), wanted, rtol=1e-9, atol=0),
            "Where Jᵀe is not zero, your step is not α Jᵀe with the best α (e may be tiny).",
        )
    tree, effectors = figures.planar_arm(3)
    straight = jacobian(tree, forward(tree, tree.rest), effectors)
    inward = np.array([-1.0, 0.0, 0.0])
    for J, e, where in (
        (straight, np.zeros(3), "there is no error"),
        (straight, inward, "the arm is straight and its target straight inward"),
        (np.zeros((3, 4)), inward, "no joint can move the hand"),
    ):
        expect(not answer(J, e).any(), f"Where {where}, Jᵀe is zero, and so should the step be.")


@exercise(
    "03.gain",
    value=True,
    returns=(),
    hints=[
        "Read it off the parabola: where is it as high as at gain 0?",
        "A parabola is symmetric about its lowest point, which is at gain 1.",
    ],
)
def gain(value: Array) -> None:
    expect(value > 0, "The gain is above 0: else nothing moves, or uphill.")

    def left(share: float) -> float:
        """The largest share of ‖e‖ that the linear model leaves."""
        return max(
            float(np.linalg.norm(e - share * (J @ transpose(J, e))) / np.linalg.norm(e))
            for J, e in problems()
        )

    expect(left(0.999 * float(value)) < 1, "A little below your gain the error grows already.")
    expect(left(1.001 * float(value)) > 1, "A little above your gain the error still falls.")
