"""Small helpers for whoever draws: rigid motions in the forms that screens want."""

import numpy as np

from ikteach.arrays import TINY, Array

EY = np.array([0.0, 1, 0])


def transforms(orientations: Array, positions: Array) -> Array:
    """Join R (..., 3, 3) and p (..., 3) into [R | p], (..., 3, 4)."""
    return np.concatenate([orientations, positions[..., None]], axis=-1)


def sticks(start: Array, end: Array) -> Array:
    """Return [R | p] (..., 3, 4) that lays (0, 0, 0) to (0, 1, 0) along start → end.

    The second column of R is end − start, so that R also stretches; the others have length 1.
    They are those of the mirror that takes e = (0, 1, 0) to ∓y, y being the segment's direction:
    I − 2wwᵀ / wᵀw with w = y ± e, by the sign of y_2. Where that is −, the first of them is turned
    round, so that R is no mirror.
    """
    along = end - start
    length = np.sqrt(np.vecdot(along, along))[..., None]
    y = along / np.maximum(length, TINY)
    sign = np.copysign(1, y[..., 1:2])
    w = y + sign * EY  # wᵀw = 2 (1 + |y_2|)
    M = np.empty((*y.shape, 4))
    M[..., :3] = np.eye(3) - w[..., None] * (w / (1 + abs(y[..., 1:2])))[..., None, :]
    M[..., 0] *= sign
    M[..., 1], M[..., 3] = along, start
    return M
