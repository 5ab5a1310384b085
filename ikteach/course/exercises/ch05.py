"""Chapter 5. Damped least squares: its SVD form, its bound, its unit."""

import numpy as np

from ikteach.arrays import Array
from ikteach.course.checking import Answer, exercise, expect
from ikteach.solvers import dls


def problems() -> list[tuple[Array, Array]]:
    """Some (J, e), one J without full rank."""
    rng = np.random.default_rng(5)
    lost = rng.normal(size=(6, 2)) @ rng.normal(size=(2, 8))
    full = [rng.normal(size=shape) for shape in ((3, 3), (3, 6), (6, 4))]
    return [(J, rng.normal(size=len(J))) for J in (*full, lost)]


@exercise(
    "05.svd",
    returns=lambda J, e, damping: J.shape[1:],
    hints=[
        "Δθ = Σ f_i v_i (u_iᵀe), with f_i = σ_i / (σ_i² + λ²) and `U, sigma, Vt` from the SVD.",
        "`np.linalg.svd(J, full_matrices=False)` gives u_i in the columns of U and v_i in the rows "
        "of Vt: `Vt.T @ (f * (U.T @ e))`.",
    ],
)
def svd(answer: Answer) -> None:
    for J, e in problems():
        for damping in (3.0, 0.5, 0.05):
            dtheta = answer(J, e, damping)
            longest = np.linalg.norm(e) / (2 * damping)
            expect(
                np.linalg.norm(dtheta) <= longest * (1 + 1e-9),
                f"A step is longer than ‖e‖ / 2λ = {longest:.3g}, which damping never allows.",
            )
            slope = J.T @ (J @ dtheta - e) + damping**2 * dtheta
            expect(
                np.linalg.norm(slope) <= 1e-8 * (1 + np.linalg.norm(J.T @ e)),
                "Your step is not the least of ‖e − JΔθ‖² + λ²‖Δθ‖²: its slope there is not zero.",
            )
            expect(
                np.allclose(dtheta, dls(J, e, damping=damping), rtol=1e-7, atol=1e-10),
                "Your step is not that of `dls`.",
            )


@exercise(
    "05.bound",
    returns=(),
    hints=[
        "The largest that σ / (σ² + λ²) can be, for any σ, is 1 / 2λ. So how long can Δθ be?",
        "‖Δθ‖ ≤ ‖e‖ / 2λ. Solve for λ.",
    ],
)
def bound(answer: Answer) -> None:
    for size, longest in ((0.3, 0.1), (2.0, 0.5), (0.05, 1.0)):
        for way in np.eye(3), np.full((1, 3), 1 / np.sqrt(3)):
            e = size * way[0]
            damping = float(answer(e, longest))
            expect(damping > 0, "λ is above 0.")
            J = damping * np.eye(3)  # the worst J: all its σ are λ
            step = float(np.linalg.norm(dls(J, e, damping=damping)))
            expect(
                step <= longest * (1 + 1e-9),
                f"With your λ and a J whose σ are all λ, the step is {step / longest:.2f} times "
                "the longest.",
            )
            expect(
                step >= longest * (1 - 1e-9),
                "Your λ is safe, but a smaller one is too: no J makes the step as long as allowed.",
            )


@exercise(
    "05.unit",
    returns=(),
    hints=[
        "In centimetres J and e are 100 times as large. Which λ leaves Δθ, an angle, as it was?",
        "In JJᵀ + λ²I both terms must grow alike; and λ has the unit of σ, length per radian.",
    ],
)
def unit(answer: Answer) -> None:
    for J, e in problems():
        for damping, per_metre in ((0.1, 100.0), (0.5, 1000.0), (0.3, 1.0), (0.2, 3.28)):
            other = float(answer(damping, per_metre))
            expect(other >= 0, "λ is not negative.")
            expect(
                np.allclose(
                    dls(J * per_metre, e * per_metre, damping=other),
                    dls(J, e, damping=damping),
                    rtol=1e-7,
                    atol=1e-12,
                ),
                f"With {per_metre:g} units to the metre and your λ = {other:.4g} the same pose and "
                "target get another Δθ.",
            )
