"""Chapter 10: the way to rest that the hand does not notice, and the nod of the neck."""

from collections.abc import Iterator

import numpy as np

from ikteach.arrays import Array
from ikteach.body import forward, jacobian
from ikteach.course.checking import Answer, exercise, expect
from ikteach.course.forms import agree
from ikteach.motion.reach.packages import ReachingFigure

LOW, HIGH = np.radians([-30.0, 60.0])


def wishes() -> Iterator[tuple[Array, Array]]:
    """J (3, n) of a hand of the simulator and a wish (n,); and others, some without full rank."""
    body, rng = ReachingFigure(), np.random.default_rng(10)
    low, high = body.tree.lower[body.rows], body.tree.upper[body.rows]
    for side in "rlrlr":
        q = rng.uniform(low, high)
        frames = forward(body.tree, body.C @ q)
        wish = np.clip(body.tree.rest[body.rows] - q, -np.radians(1), np.radians(1))
        yield jacobian(body.tree, frames, body.hands[side]) @ body.C, wish
    flat = rng.normal(size=(3, 6)) * np.array([[1.0], [1.0], [0.0]])
    for J in (rng.normal(size=(3, 5)), 1e-3 * rng.normal(size=(3, 7)), flat):
        yield J, rng.normal(size=len(J.T))


@exercise(
    "10.null",
    returns=lambda J, wish: np.shape(wish),
    hints=[
        "Which part of the wish moves the hand, and what is left when that is taken away?",
        "J⁺J wish is the part that the hand would notice: (I − J⁺J) wish is the rest.",
        "`return wish - np.linalg.pinv(J) @ J @ wish`",
    ],
)
def null(answer: Answer) -> None:
    """to_rest(J (3, n), wish (n,)) -> (n,) is what of the wish leaves the hand where it is."""
    for J, wish in wishes():
        found = answer(J, wish)
        best = wish - np.linalg.pinv(J) @ J @ wish
        length, moved, whole = (float(np.linalg.norm(x)) for x in (wish, J @ found, J @ wish))
        about = f"For a J of 3 × {J.shape[1]} and a wish {length:.3g} rad long"
        expect(
            not np.allclose(found, wish, rtol=1e-6, atol=0),
            f"{about} yours is the whole wish, and it moves the hand by {1000 * whole:.3g} mm.",
        )
        expect(
            moved <= 1e-4 * whole,
            f"{about} the hand notices: your step moves it by "
            f"{1000 * moved:.3g} mm (the whole wish "
            f"by {1000 * whole:.3g} mm), and to first order it should stay.",
        )
        granted, possible = float(np.linalg.norm(found)), float(np.linalg.norm(best))
        expect(
            granted > 1e-6 * possible,
            f"{about} the hand stays because nothing moves at all; {possible:.3g} rad of the wish "
            "can be granted.",
        )
        agree(
            found,
            best,
            f"{about} the hand stays, but more of the wish could be granted: yours is {{found}}, "
            "where {wanted} rad is possible.",
            size=length,
        )


def cursors() -> Iterator[tuple[float, float, float]]:
    """y, z and eyes: before and behind, above and below, and about both limits of the neck."""
    rng = np.random.default_rng(11)
    yield 0.0, 0.6, 0.15
    for eyes in (0.15, 0.08, 0.0):
        for y, z in rng.uniform([-0.8, 0.3], [0.6, 1.0], (8, 2)):
            yield float(y), float(z), eyes
        for nod in (-50, -31, -29, -5, 0, 30, 59, 61, 80):
            far, angle = rng.uniform(0.3, 1.0), np.radians(nod)
            ahead = np.sqrt(far**2 - eyes**2)  # along the line of sight
            y = eyes * np.cos(angle) - ahead * np.sin(angle)
            yield float(y), float(eyes * np.sin(angle) + ahead * np.cos(angle)), eyes
        for y, z in ((0.5, -0.5), (-0.5, -0.5), (0.3, -0.1), (-0.4, -0.1)):
            yield y, z, eyes  # behind the head


@exercise(
    "10.nod",
    returns=(),
    hints=[
        "In which direction is the cursor seen from the neck? And where is it seen from the eyes?",
        "With eyes = 0 it is −arctan2(y, z). The line of sight passes the neck at the distance "
        "`eyes`: add arcsin(eyes / √(y² + z²)), then clip to −30° and 60°.",
        "`np.clip(np.arcsin(eyes / np.hypot(y, z)) - np.arctan2(y, z), *np.radians([-30, 60]))`",
    ],
)
def nod(answer: Answer) -> None:
    """nod(y, z, eyes) -> angle [rad] that makes the line of sight meet the cursor, clipped."""
    for y, z, eyes in cursors():
        angle = float(answer(y, z, eyes))
        wanted = float(np.arcsin(eyes / np.hypot(y, z)) - np.arctan2(y, z))
        where = f"With the cursor at y {y:.3f} and z {z:.3f} m and eyes {eyes:g} m above the neck"
        degrees = np.degrees(angle) + 0.0  # no −0
        expect(
            LOW - 1e-4 <= angle <= HIGH + 1e-4,
            f"The neck goes from −30° to 60°. {where} you have it nod by {degrees:.5g}°.",
        )
        if not LOW <= wanted <= HIGH:
            agree(
                degrees,
                np.degrees(np.clip(wanted, LOW, HIGH)),
                f"{where} it is out of the neck's range: the neck stands at "
                f"its limit, {{wanted}}°, "
                "not at {found}°.",
                size=60,
            )
        over = y * np.cos(angle) + z * np.sin(angle) - eyes
        agree(
            degrees,
            np.degrees(np.clip(wanted, LOW, HIGH)),
            f"{where}, nodding by {{found}}° has the cursor {100 * abs(over):.2g} cm "
            f"{'over' if over > 0 else 'under'} the line of sight; {{wanted}}° meets it.",
            size=60,
        )
