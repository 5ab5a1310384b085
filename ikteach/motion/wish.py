"""A pose that is wished for beside the targets: motion in the null space of J."""

import numpy as np

from ikteach.arrays import Array

CUT = 1e-6  # λ² of the projection, as a share of the mean σ²


def beside(J: Array, gap: Array) -> Array:
    """Project a turn `gap` (..., n) to where J (..., m, n) hardly feels it.

    N gap with N = I − Jᵀ(JJᵀ + λ²I)⁻¹J, which is I − J⁺J but where a singular value is below λ:
    there J is not trusted, and the wish is. Source: Liégeois 1977, IEEE Trans. Systems, Man, and
    Cybernetics 7:868; damped.
    """
    JJT = J @ J.mT
    m = JJT.shape[-1]
    squares = np.trace(JJT, axis1=-2, axis2=-1)[..., None, None] / m  # the mean σ²
    damped = JJT + (CUT * squares + np.finfo(float).tiny) * np.eye(m)
    return gap - np.vecmat(np.linalg.solve(damped, np.matvec(J, gap)[..., None])[..., 0], J)
