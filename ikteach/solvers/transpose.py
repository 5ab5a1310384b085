"""Chapter 3. The Jacobian transpose: downhill on ½‖e‖², as far as the linear model says."""

import numpy as np

from ikteach.arrays import Array, ArrayLike
from ikteach.checks import number, system

TINY = 1e-300  # below it a squared length is rounding, and nothing may be divided by it


def transpose(J: ArrayLike, e: ArrayLike, *, gain: float = 1.0) -> Array:
    """Δθ = gain · α Jᵀe, with α = ⟨e, JJᵀe⟩ / ⟨JJᵀe, JJᵀe⟩.

    J     (..., m, n)  Jacobian [m/rad]
    e     (..., m)     error [m]
    gain  share of the step that brings the linear model nearest to the target. The thesis prints
          half of α: that is gain = ½.
    Returns (..., n) [rad]; zero where Jᵀe is, that is where no joint helps.
    ValueError if shapes do not fit or a number is none. Source: thesis 4.4.1; Buss 2004, eq. 10.
    """
    (J, e), gain = system(J, e), number("gain", gain)
    JTe = np.vecmat(e, J)
    size = np.maximum.reduce(abs(JTe), axis=-1, keepdims=True, initial=TINY)
    g = JTe / size  # α is the same for any length
    Jg = np.matvec(J, g)
    gg, JgJg = np.vecdot(g, g)[..., None], np.vecdot(Jg, Jg)[..., None]
    alpha = np.divide(gg, JgJg, out=np.zeros_like(gg), where=JgJg > TINY)
    return gain * alpha * JTe
