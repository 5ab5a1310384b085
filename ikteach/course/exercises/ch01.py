"""Chapter 1: a column of the Jacobian, and the inverse of three by three."""

import numpy as np

from ikteach.course.checking import Answer, exercise, expect, of_form

H = 1e-6  # [rad]


@exercise(
    "01.column",
    returns=(3,),
    hints=[
        "A point at r from the axis moves at right angles to both: a cross product.",
        "r goes from the joint to the effector, s − p, and the axis comes first: v × (s − p).",
    ],
)
def column(answer: Answer) -> None:
    """column(v, p, s) -> (3,) is the central difference of turning s about the axis v at p."""
    rng = np.random.default_rng(1)
    for _ in range(8):
        v, p, s = rng.normal(size=(3, 3))
        v /= np.linalg.norm(v)
        found = answer(v, p, s)
        moved = (turned(s, v, p, H) - turned(s, v, p, -H)) / (2 * H)
        expect(
            abs(v @ found) < 1e-6,
            f"No point moves along the axis that it turns about, but your column has a part of "
            f"{v @ found:.2f} along v.",
        )
        expect(
            not np.allclose(found, -moved, atol=1e-6),
            "Your column is the right one the other way round: which factor comes first?",
        )
        expect(
            np.allclose(found, moved, atol=1e-6),
            f"For a turn of {H:g} rad the effector moves by {moved.round(2)} per radian, and your "
            f"column says {found.round(2)}.",
        )


def turned(s: np.ndarray, v: np.ndarray, p: np.ndarray, angle: float) -> np.ndarray:
    """s turned about the axis v through p (Rodrigues)."""
    r = s - p
    across = np.cross(v, r)
    return p + np.cos(angle) * r + np.sin(angle) * across + (1 - np.cos(angle)) * (v @ r) * v


@exercise(
    "01.cramer",
    hints=[
        "Cramer: x₁ is det(J with r in place of its first column) / det(J).",
        "The determinant comes first: where it is 0, `raise ValueError(...)` and do not divide.",
    ],
)
def cramer(answer: Answer) -> None:
    """cramer3(J (3, 3), r (3,)) -> (3,) solves J x = r, or raises ValueError where det = 0."""
    rng = np.random.default_rng(2)
    for _ in range(8):
        J, r = rng.normal(size=(3, 3)), rng.normal(size=3)
        x = of_form(answer(J, r), (3,), f"`{answer.call}` returned")
        expect(
            not np.allclose(x, J @ r),
            "That is J r. The text of 1998 writes so too, and means J⁻¹ r: what turn gives r?",
        )
        expect(
            np.allclose(J @ x, r),
            f"J times your step must be r = {r.round(2)}, and it is {(J @ x).round(2)}.",
        )
    singular = np.array([[1.0, 2.0, 3.0], [2.0, 4.0, 6.0], [0.0, 1.0, 1.0]])
    error = answer.error(singular, np.ones(3))
    expect(
        isinstance(error, ValueError),
        "Where det J = 0 there is no inverse: the answer is `raise ValueError(...)`, "
        + ("and yours returns something." if error is None else f"not {type(error).__name__}."),
    )
