"""Chapter 4. The pseudoinverse: of all steps that bring e nearest to zero, the shortest."""

import numpy as np

from ikteach.arrays import Array, ArrayLike
from ikteach.checks import number, system

EPS = float(np.finfo(float).eps)
TINY = 1e-150  # [m/rad]; a motion this small is none


def pseudoinverse(J: ArrayLike, e: ArrayLike, *, cutoff: float = 0.01) -> Array:
    """Δθ = Σ v_i (u_iᵀe) / σ_i over the singular directions with σ_i > cutoff · σ_max.

    J       (..., m, n)  Jacobian [m/rad]
    e       (..., m)     error [m]
    cutoff  directions weaker than this share of the strongest are left out. Buss uses 0.01;
            0 leaves out none that rounding lets us see.
    Returns (..., n) [rad]. Where J has full row rank and nothing is cut this is Jᵀ(JJᵀ)⁻¹e, as the
    thesis prints it. ValueError if shapes do not fit or a number is none.
    Source: thesis 4.4.2; Buss 2004, section 5.
    """
    (J, e), cutoff = system(J, e), number("cutoff", cutoff)
    U, sigma, Vt = np.linalg.svd(J, full_matrices=False)
    strongest = sigma[..., :1]
    kept = sigma > np.maximum(TINY, strongest * max(cutoff, EPS))
    alpha = np.vecmat(e, U)
    return np.vecmat(np.where(kept, alpha / np.where(kept, sigma, 1), 0), Vt)
