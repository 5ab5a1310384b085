"""Chapter 3. The Jacobian transpose: downhill on ½‖e‖², as far as the linear model says."""

from ikteach.arrays import Array
from ikteach.checks import number
from ikteach.solvers.door import solver
from ikteach.solvers.stacked import matvec, ratio, unit, vecmat


@solver(gain=number)
def transpose(J: Array, e: Array, *, gain: float = 1.0) -> Array:
    """Step Δθ = gain · α Jᵀe, with α = ⟨e, JJᵀe⟩ / ⟨JJᵀe, JJᵀe⟩.

    J     (..., m, n)  Jacobian [m/rad]
    e     (..., m)     error [m]
    gain  share of the step that brings the linear model nearest to the target. The thesis prints
          half of α: that is gain = ½.
    Returns (..., n) [rad]; zero where Jᵀe is, that is where no joint helps.
    ValueError if shapes do not fit or a number is none. Source: thesis 4.4.1; Buss 2004, eq. 10.
    """
    JTe = vecmat(e, J)
    g = unit(JTe)  # α is the same for any length of Jᵀe
    alpha = ratio(g, matvec(J, g))  # ⟨e, JJᵀe⟩ = ⟨Jᵀe, Jᵀe⟩
    return gain * alpha * JTe


def transpose_response(sigma: Array, alpha: Array, *, gain: float) -> Array:
    """Answer u_iᵀe = alpha (r,) by f_i = gain · α σ_i: the strong directions first."""
    g = unit(sigma * alpha)
    return gain * ratio(g, sigma * g) * sigma
