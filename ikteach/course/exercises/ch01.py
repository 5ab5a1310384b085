"""Chapter 1: a column of the Jacobian, and the inverse of three by three."""

import numpy as np

from ikteach.arrays import Array
from ikteach.course.checking import Answer, exercise, expect
from ikteach.course.forms import agree, of_form

H = 1e-6  # [rad]
COARSE = 2e-3  # what central differences with a coarse h may be wrong by, of the arrow's length


@exercise(
    "01.column",
    returns=(3,),
    hints=[
        "A point turns about an axis. At right angles to which two directions does it move?",
        "It moves along v × (s − p): the axis first, then the arrow "
        "from the joint to the effector.",
        "`return np.cross(v, s - p)`",
    ],
)
def column(answer: Answer) -> None:
    """column(v, p, s) -> (3,) is the central difference of turning s about the axis v at p."""
    rng = np.random.default_rng(1)
    for _ in range(8):
        v, p, s = rng.normal(size=(3, 3)).round(2)
        v /= np.linalg.norm(v)
        found = answer(v, p, s)
        moved = (turned(s, v, p, H) - turned(s, v, p, -H)) / (2 * H)
        size = float(np.linalg.norm(s - p))
        where = f"For the axis {v.round(2)} at {p} and the effector at {s}"
        expect(
            abs(v @ found) < COARSE * size,
            f"{where} your column has a part of {v @ found:.3g} along the axis, and no point moves "
            "along the axis that it turns about.",
        )
        expect(
            abs(found + moved).max() > COARSE * size or abs(moved).max() < COARSE * size,
            f"{where} your column is the right one the other way round: {found.round(3)}, where "
            f"{moved.round(3)} is wanted. Which factor comes first?",
        )
        agree(
            found,
            moved,
            f"{where} it moves by {{wanted}} m per radian, and your column says {{found}}.",
            near=COARSE,
            size=size,
        )


def turned(s: Array, v: Array, p: Array, angle: float) -> Array:
    """s turned about the axis v through p (Rodrigues)."""
    r = s - p
    across = np.cross(v, r)
    return p + np.cos(angle) * r + np.sin(angle) * across + (1 - np.cos(angle)) * (v @ r) * v


def regular() -> list[Array]:
    """J (3, 3) that have an inverse, also very small ones and some that are nearly singular."""
    rng = np.random.default_rng(2)
    plain = [rng.normal(size=(3, 3)) for _ in range(6)]
    near = [
        J @ np.diag([1, 1, thin]) @ np.linalg.inv(J) for J in plain[:3] for thin in (1e-3, 1e-6)
    ]
    scaled = [size * J for size in (1e-9, 1e-6, 1e-3, 1e3) for J in plain[:2]]
    return [*plain, *near, *scaled, 1e-5 * np.eye(3), np.diag([1e-3, 1.0, 1e3])]


def singular() -> list[Array]:
    """J (3, 3) whose columns lie in a plane: exactly, or but for rounding."""
    rng = np.random.default_rng(3)
    exact = np.array([[1.0, 2.0, 3.0], [2.0, 4.0, 6.0], [0.0, 1.0, 1.0]])
    rounded = [rng.normal(size=(3, 2)) @ rng.normal(size=(2, 3)) for _ in range(20)]
    return [exact, np.zeros((3, 3)), 1e-6 * exact, *rounded, *(1e9 * J for J in rounded[:4])]


@exercise(
    "01.cramer",
    hints=[
        "Which number do you divide by, and what is it small against when J has no inverse?",
        "xᵢ = det(J with r in place of column i) / det J. And |det "
        "J| is at most the product of the "
        "lengths of the columns: where it is a billionth of that, `raise ValueError(...)`.",
        "`if abs(det) <= 1e-12 * np.prod(np.linalg.norm(J, axis=0)): raise ValueError(...)`",
    ],
)
def cramer(answer: Answer) -> None:
    """cramer3(J (3, 3), r (3,)) -> (3,) solves J x = r, or raises ValueError where it cannot."""
    rng = np.random.default_rng(4)
    for J in regular():
        r = rng.normal(size=3).round(2)
        wanted = np.linalg.solve(J, r)
        sigma = np.linalg.svdvals(J)
        about = f"For a J whose σ are from {sigma[-1]:.3g} to {sigma[0]:.3g} and r = {r}"
        error = answer.error(J, r)
        expect(
            not isinstance(error, ValueError),
            f"{about} you raise {type(error).__name__}, but it has an "
            f"inverse: x is {wanted.round(3)}.",
        )
        x = of_form(answer(J, r), (3,), f"`{answer.call}` returned")
        expect(
            np.allclose(J @ r, wanted, rtol=1e-3) or not np.allclose(x, J @ r, rtol=1e-6, atol=0),
            "That is J r. The text of 1998 writes so too, and means J⁻¹ r: what turn gives r? "
            f"{about} it is {wanted.round(3)}, not {x.round(3)}.",
        )
        agree(
            J @ x, r, f"{about} J times your x must be {{wanted}}, and it is {{found}}.", near=1e-3
        )
    for J in singular():
        error = answer.error(J, np.ones(3))
        sizes = float(np.prod(np.linalg.norm(J, axis=0)))
        expect(
            isinstance(error, ValueError),
            "Where the columns lie in a plane there is no inverse: det J is "
            f"{np.linalg.det(J):.2g} there, and the lengths of the "
            f"columns multiply to {sizes:.2g}. "
            "The answer is `raise ValueError(...)`, "
            + ("and yours returns something." if error is None else f"not {type(error).__name__}."),
        )
