"""Chapter 5. Damped least squares: nearness to the target against length of the step."""

import numpy as np

from ikteach.arrays import Array, ArrayLike

ROUNDING = 1e-13  # of the trace of JJᵀ: damping below it is lost in the rounding of JJᵀ
TINY = 1e-200  # keeps JJᵀ + λ²I invertible where J is all zero


def dls(J: Array, e: Array, *, damping: ArrayLike = 0.1) -> Array:
    """Δθ = Jᵀ (JJᵀ + λ²I)⁻¹ e, the least of ‖e − JΔθ‖² + λ²‖Δθ‖².

    J        (..., m, n)  Jacobian [m/rad]
    e        (..., m)     error [m]
    damping  λ, a number or (...) [m/rad]. It has the unit of J's singular values: metres made
             centimetres need a λ 100 times as large. ‖Δθ‖ is at most ‖e‖ / 2λ.
    Returns (..., n) [rad]. λ = 0 is taken as the smallest that rounding lets us see.
    ValueError if λ is negative or not a number. Source: thesis 4.4.3; Buss 2004, eq. 11.
    """
    damping = np.asarray(damping, dtype=float)
    if not (damping >= 0).all():
        raise ValueError(f"damping must be 0 or more, not {damping}")
    JJT = J @ J.mT
    least = ROUNDING * np.trace(JJT, axis1=-2, axis2=-1) + TINY
    lambda2 = np.maximum(damping * damping, least)[..., None, None]
    y = np.linalg.solve(JJT + lambda2 * np.eye(J.shape[-2]), e[..., None])[..., 0]
    return np.vecmat(y, J)


def dls_following(J: Array, e: Array, *, share: float = 0.5, least: float = 1e-3) -> Array:
    """`dls` with a damping that follows the error: λ² = (share ‖e‖)² + least².

    Far from the target the step is short and safe, near it the damping goes and convergence is
    fast. Recommended for bodies of human size in metres; the bench `tests/bench/damping.py`
    measures it against fixed dampings. Nonlinear least squares knows it as Levenberg–Marquardt
    with a damping in proportion to the residual (Sugihara 2011, IEEE Trans. Robotics 27:984).
    """
    return dls(J, e, damping=np.sqrt((share * share) * np.vecdot(e, e) + least * least))
