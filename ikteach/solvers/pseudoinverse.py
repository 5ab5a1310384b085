"""Chapter 4. The pseudoinverse: of all steps that bring e nearest to zero, the shortest."""

import numpy as np

from ikteach.arrays import Array
from ikteach.checks import number
from ikteach.solvers.door import solver
from ikteach.solvers.stacked import EPS, strong, vecmat


@solver(cutoff=number)
def pseudoinverse(J: Array, e: Array, *, cutoff: float = 0.01) -> Array:
    """Step Δθ = Σ v_i (u_iᵀe) / σ_i over the singular directions with σ_i > cutoff · σ_max.

    J       (..., m, n)  Jacobian [m/rad]
    e       (..., m)     error [m]
    cutoff  directions weaker than this share of the strongest are left out. Buss uses 0.01;
            0 leaves out none that rounding lets us see.
    Returns (..., n) [rad]. Where J has full row rank and nothing is cut this is Jᵀ(JJᵀ)⁻¹e, as the
    thesis prints it. ValueError if shapes do not fit or a number is none.
    Source: thesis 4.4.2; Buss 2004, section 5.
    """
    U, sigma, Vt = np.linalg.svd(J, full_matrices=False)
    sigma = strong(sigma, max(cutoff, EPS))  # ∞ where a direction is left out
    return vecmat(vecmat(e, U) / sigma, Vt)


def pseudoinverse_response(sigma: Array, *, cutoff: float) -> Array:
    """Answer by f_i = 1/σ_i, and 0 for directions weaker than cutoff · σ_max, σ (r,)."""
    return 1 / strong(sigma, max(cutoff, EPS))
