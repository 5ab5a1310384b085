"""Chapter 5. Damped least squares: its SVD form, its bound, its unit."""

import numpy as np

from ikteach.arrays import Array
from ikteach.course.checking import Answer, exercise, expect
from ikteach.course.forms import agree, numbers_apart
from ikteach.solvers import dls


def problems() -> list[tuple[Array, Array]]:
    """Some (J, e), wide and tall, one J without full rank, in metres and in other units."""
    rng = np.random.default_rng(5)
    lost = rng.normal(size=(6, 2)) @ rng.normal(size=(2, 8))
    full = [rng.normal(size=shape) for shape in ((3, 3), (3, 6), (6, 4), (12, 20))]
    made = [(J, rng.normal(size=len(J))) for J in (*full, lost, np.zeros((3, 4)))]
    J, e = made[1]
    return [*made, (100 * J, 100 * e), (1e-3 * J, 1e-3 * e)]


@exercise(
    "05.svd",
    returns=lambda J, e, damping: J.shape[1:],
    hints=[
        "Along v_i the pseudoinverse answers with 1/σ_i. What does damping make of that?",
        "Δθ = Σ f_i v_i (u_iᵀe), with f_i = σ_i / (σ_i² + λ²).",
        "`U, sigma, Vt = np.linalg.svd(J, full_matrices=False)`; then `Vt.T @ (f * (U.T @ e))`",
    ],
)
def svd(answer: Answer) -> None:
    for J, e in problems():
        for damping in (3.0, 0.5, 0.05):
            dtheta, wanted = answer(J, e, damping), dls(J, e, damping=damping)
            longest = float(np.linalg.norm(e)) / (2 * damping)
            length = float(np.linalg.norm(dtheta))
            about = f"For a J of {J.shape[0]} × {J.shape[1]} and λ = {damping:g}"
            expect(
                length <= longest * (1 + 1e-6),
                f"{about} your step is {length:.5g} rad long, longer than "
                f"‖e‖ / 2λ = {longest:.5g}, "
                "which damping never allows.",
            )
            agree(
                dtheta,
                wanted,
                f"{about} your step does not make ‖e − JΔθ‖² + λ²‖Δθ‖² least: it is "
                "{found}, where {wanted} is wanted.",
                size=1e-3 * longest,
            )


@exercise(
    "05.bound",
    returns=(),
    hints=[
        "For which σ is σ / (σ² + λ²) largest, and how large is it there?",
        "At σ = λ it is 1 / 2λ. So ‖Δθ‖ ≤ ‖e‖ / 2λ: solve for λ.",
        "`return np.linalg.norm(e) / (2 * longest)`",
    ],
)
def bound(answer: Answer) -> None:
    rng = np.random.default_rng(55)
    for size, longest in ((0.3, 0.1), (2.0, 0.5), *10.0 ** rng.uniform(-2, 1, (6, 2))):
        e = rng.normal(size=rng.choice([1, 3, 12]))
        e *= size / np.linalg.norm(e)
        damping = float(answer(e, float(longest)))
        about = f"For ‖e‖ = {size:.4g} and longest = {longest:.4g} your λ is {damping:.4g}"
        expect(damping > 0, f"{about}; it is above 0.")
        J = damping * np.eye(len(e))  # the worst J: all its σ are λ
        step = float(np.linalg.norm(dls(J, e, damping=damping)))
        texts = numbers_apart(step, longest)
        expect(
            step <= longest * (1 + 1e-4),
            f"{about}. With a J whose σ are all λ, the step is {step / longest:.4g} times the "
            f"longest: {texts[0]}, not {texts[1]} rad.",
        )
        expect(
            step >= longest * (1 - 1e-4),
            f"{about}. It is safe, but a smaller one is too: with no J is a step longer than "
            f"{texts[0]}, and {texts[1]} rad is allowed.",
        )


@exercise(
    "05.unit",
    returns=(),
    hints=[
        "In centimetres J and e are 100 times as large. And in degrees, by how much is J smaller?",
        "λ stands beside σ in σ² + λ², so it has the unit of σ: a length per angle.",
        "`return damping * per_metre / per_radian`",
    ],
)
def unit(answer: Answer) -> None:
    """damping_in(damping, per_metre, per_radian): λ in other units of length and of angle."""
    rng = np.random.default_rng(56)
    units = [
        (0.1, 100.0, 1.0),
        (0.5, 1.0, 180 / np.pi),
        (0.3, 1.0, 1.0),
        *10.0 ** rng.uniform(-1, 1, (8, 3)),
    ]
    for J, e in problems():
        if not J.any():
            continue
        for damping, per_metre, per_radian in units:
            other = float(answer(float(damping), float(per_metre), float(per_radian)))
            about = (
                f"With {per_metre:.4g} units to the metre and "
                f"{per_radian:.4g} to the radian your λ "
                f"is {other:.4g} for {damping:.4g}"
            )
            expect(other >= 0, f"{about}: it is not negative.")
            there = dls(J * per_metre / per_radian, e * per_metre, damping=other) / per_radian
            agree(
                there,
                dls(J, e, damping=damping),
                f"{about}: the same pose and target get another Δθ, {{found}} where {{wanted}} rad "
                "is wanted.",
            )
