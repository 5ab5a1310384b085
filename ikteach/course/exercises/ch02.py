"""Chapter 2: which errors a pose can mend, and where an arm moves best."""

import numpy as np

from ikteach.body import figures, forward, jacobian
from ikteach.course.checking import Answer, WrongError, exercise, expect
from ikteach.solvers import manipulability

WORDS = ("free", "near", "lost")


def arm(bend: float) -> np.ndarray:
    """J (2, 2) of a two-link arm along x whose elbow is bent by so many degrees."""
    tree, effectors = figures.planar_arm(2)
    return jacobian(tree, forward(tree, [0, np.radians(bend)]), effectors)[:2]


@exercise(
    "02.classify",
    returns=str,
    hints=[
        "The error counts too: a singular pose can still mend errors in other directions.",
        "First `lost`: Jᵀe is zero (compare ‖Jᵀe‖ with ‖e‖). Then the length of `pinv(J) @ e`.",
    ],
)
def classify(answer: Answer) -> None:
    """classify(J, e) -> "free", "near" or "lost"."""
    inward, across = np.array([-0.1, 0.0]), np.array([0.0, 0.1])
    cases = [
        (arm(90), inward, "free", "bent by 90°, any error"),
        (arm(0), inward, "lost", "straight, the error straight inward: Jᵀe = 0"),
        (arm(0), across, "free", "straight, the error across the arm: both joints help"),
        (arm(1), inward, "near", "bent by 1°, the error inward: a large turn for a small gain"),
        (arm(1), across, "free", "bent by 1°, but the error is across the arm"),
    ]
    rng = np.random.default_rng(3)
    turn = np.linalg.qr(rng.normal(size=(2, 2)))[0]
    for J, e, right, when in cases:
        found = answer(J, e)
        if found not in WORDS:
            raise WrongError(f"`{answer.name}` must say 'free', 'near' or 'lost', not {found!r}.")
        expect(found == right, f"It is '{right}' and not '{found}' with the arm {when}.")
        for scale in (1e-4, 10.0):
            expect(
                answer(J, scale * e) == right,
                f"The class is of the direction of e: {scale:g} e must be '{right}' as e is.",
            )
        expect(
            answer(turn @ J, turn @ e) == right,
            "Nothing changes when J and e are seen from other axes, and your answer does.",
        )


@exercise(
    "02.bend",
    returns=(),
    value=True,
    hints=[
        "√det(JJᵀ) of two links of 1 m is |sin| of the bend.",
        "Give the bend in degrees, between 0 (straight) and 180 (folded).",
    ],
)
def bend(value: np.ndarray) -> None:
    """best_bend: the elbow's bend in degrees where the manipulability is greatest."""
    degrees = float(value)
    expect(0 <= degrees <= 180, "Between 0 (straight) and 180 (folded), in degrees.")
    here = float(manipulability(arm(degrees)))
    others = range(0, 181, 5)
    there = np.array([float(manipulability(arm(other))) for other in others])
    best = others[there.argmax()]
    expect(
        here >= there.max() - 1e-3,
        f"At {degrees:g}° the manipulability is {here:.2f}, and it is greater elsewhere: "
        f"try {'more' if best > degrees else 'less'}.",
    )
