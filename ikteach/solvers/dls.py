"""Chapter 5. Damped least squares: nearness to the target against length of the step."""

import numpy as np

from ikteach.arrays import Array, ArrayLike

ROUNDING = 1e-13  # of the diagonal of JJᵀ: damping below it is lost in the rounding of JJᵀ
HUGE = 1e150  # its square is still finite
TINY = 1e-200  # keeps JJᵀ + λ²I invertible where J is all zero


def dls(J: Array, e: Array, *, damping: ArrayLike = 0.1) -> Array:
    """Δθ = Jᵀ (JJᵀ + λ²I)⁻¹ e, the least of ‖e − JΔθ‖² + λ²‖Δθ‖².

    J        (..., m, n)  Jacobian [m/rad]
    e        (..., m)     error [m]
    damping  λ, a number or (...) [m/rad]. It has the unit of J's singular values: metres made
             centimetres need a λ 100 times as large. ‖Δθ‖ is at most ‖e‖ / 2λ.
    Returns (..., n) [rad]. λ = 0 is taken as the smallest that rounding lets us see.
    ValueError if λ is negative or not finite. Source: thesis 4.4.3; Buss 2004, eq. 11.
    """
    if isinstance(damping, float):  # the common case: an array of one number costs as JJᵀ does
        fits, lambda2 = 0 <= damping < HUGE, damping * damping + TINY
    else:
        damping = np.asarray(damping, dtype=float)
        fits = bool(((damping >= 0) & (damping < HUGE)).all())
        lambda2 = (damping * damping + TINY)[..., None]
        J = np.broadcast_to(J, np.broadcast_shapes(J.shape, (*damping.shape, 1, 1)))
    if not fits:  # NaN fits nowhere
        raise ValueError(f"damping must be 0 or more, and finite, not {damping}")
    A, m = J @ J.mT, J.shape[-2]
    diagonal = A.reshape(*A.shape[:-2], m * m)[..., :: m + 1]  # a view of A
    diagonal += np.maximum(lambda2, ROUNDING * diagonal)  # A = JJᵀ + λ²I
    return np.vecmat(np.linalg.solve(A, e[..., None])[..., 0], J)


def dls_following(J: Array, e: Array, *, share: float = 0.5, least: float = 1e-3) -> Array:
    """`dls` with a damping that follows the error: λ² = (share ‖e‖)² + least².

    Far from the target the step is short and safe, near it the damping goes and convergence is
    fast. Recommended for bodies of human size in metres. Measured by `tests/bench/damping.py` on
    300 far poses of the human: all within 1 mm after 5 steps (median; 99 %: 7), where λ = 0.1
    takes 8 (30) and λ = 0.3 takes 34 (242); out of reach it trembles about as λ = 0.1 does.
    Nonlinear least squares knows it as Levenberg–Marquardt with a damping in proportion to the
    residual (Sugihara 2011, IEEE Trans. Robotics 27:984).
    """
    return dls(J, e, damping=np.sqrt((share * share) * np.vecdot(e, e) + least * least))
