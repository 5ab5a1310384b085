"""Chapter 10: the way to rest that the hand does not notice, and the nod of the neck."""

import numpy as np

from ikteach.body import forward, jacobian, locate
from ikteach.course.checking import Answer, exercise, expect
from ikteach.motion.reach.packages import ReachingFigure

LOW, HIGH = np.radians([-30.0, 60.0])


def poses() -> list[tuple[ReachingFigure, np.ndarray, np.ndarray, np.ndarray]]:
    """The simulator's body, degrees of motion q (16,), J (3, 16) of a hand, a wish (16,)."""
    body, rng, made = ReachingFigure(), np.random.default_rng(10), []
    low, high = body.tree.lower[body.rows], body.tree.upper[body.rows]
    for _ in range(6):
        q = rng.uniform(low, high)
        frames = forward(body.tree, body.C @ q)
        wish = np.clip(body.tree.rest[body.rows] - q, -np.radians(1), np.radians(1))
        made.append((body, q, jacobian(body.tree, frames, body.hands["r"]) @ body.C, wish))
    return made


@exercise(
    "10.null",
    returns=lambda J, wish: np.shape(wish),
    hints=[
        "J⁺J wish is the part of the wish that the hand would notice: take it away.",
        "(I − J⁺J) wish, where `np.linalg.pinv(J)` is J⁺.",
    ],
)
def null(answer: Answer) -> None:
    """to_rest(J (3, d), wish (d,)) -> (d,) is what of the wish leaves the hand where it is."""
    for body, q, J, wish in poses():
        found = answer(J, wish)
        expect(
            not np.allclose(found, wish),
            f"That is the whole wish, and it moves the hand: J wish is {1000 * (J @ wish).round(4)}"
            " mm long.",
        )
        s, moved = (
            locate(forward(body.tree, body.C @ (q + h * found)), body.hands["r"])[0]
            for h in (0, 0.01)
        )
        expect(
            np.allclose(J @ found, 0, atol=1e-9),
            f"The hand notices: a hundredth of your step moves it by "
            f"{1e6 * np.linalg.norm(moved - s):.3g} µm, and to first order it should stay.",
        )
        best = wish - np.linalg.pinv(J) @ J @ wish
        expect(
            found.any() or not best.any(),
            "The hand stays because nothing moves at all; some of the wish can be granted.",
        )
        expect(
            np.allclose(found, best, atol=1e-9),
            "The hand stays, but more of the wish could be granted: yours lies "
            f"{np.linalg.norm(found - wish):.4f} rad from it, {np.linalg.norm(best - wish):.4f} "
            "is possible.",
        )


@exercise(
    "10.nod",
    returns=(),
    hints=[
        "With eyes = 0 it is −arctan2(y, z). The eyes sit higher: what angle is missing?",
        "The line of sight passes the neck at distance `eyes`: add arcsin(eyes / √(y² + z²)); "
        "then `np.clip` to −30° and 60°, in radians.",
    ],
)
def nod(answer: Answer) -> None:
    """nod(y, z, eyes) -> angle [rad] that makes the line of sight meet the cursor, clipped."""
    rng = np.random.default_rng(11)
    places = [(0.0, 0.6), *rng.uniform([-0.8, 0.3], [0.6, 1.0], (12, 2))]
    for y, z in places:
        for eyes in (0.15, 0.08):
            angle = float(answer(y, z, eyes))
            expect(
                LOW - 1e-9 <= angle <= HIGH + 1e-9,
                f"The neck goes from −30° to 60°; you have it nod by {np.degrees(angle):.0f}°.",
            )
            wanted = np.arcsin(eyes / np.hypot(y, z)) - np.arctan2(y, z)
            over = y * np.cos(angle) + z * np.sin(angle) - eyes
            outside = not LOW <= wanted <= HIGH
            beyond = f"The cursor is out of the neck's range: it stands at its limit, not at \
{np.degrees(angle):.0f}°."
            expect(not outside or np.isclose(angle, np.clip(wanted, LOW, HIGH)), beyond)
            where = "over" if over > 0 else "under"
            expect(
                outside or abs(over) < 1e-6,
                f"With the cursor at y {y:.2f} and z {z:.2f} m, nodding by "
                f"{np.degrees(angle):.1f}° has the cursor {100 * abs(over):.1f} cm {where} the "
                "line of sight.",
            )
