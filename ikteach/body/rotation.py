"""Small helpers for whoever draws: rigid motions in the forms that screens want."""

import numpy as np

from ikteach.arrays import Array, ArrayLike
from ikteach.body.jacobian import YZXY, cross


def transforms(orientations: Array, positions: Array) -> Array:
    """R (..., 3, 3) and p (..., 3) as one 3 × 4 matrix [R | p], (..., 3, 4)."""
    return np.concatenate([orientations, positions[..., None]], axis=-1)


def sticks(start: Array, end: Array) -> Array:
    """[R | p] (..., 3, 4) that lays the segment from (0, 0, 0) to (0, 1, 0) along start → end.

    The second column of R is end − start, so that R also stretches; the others have length 1.
    """
    along = end - start
    length = np.linalg.norm(along, axis=-1, keepdims=True)
    y = np.divide(along, length, out=np.zeros_like(along), where=length > 0)
    a, b, c = y[..., 0], y[..., 1], y[..., 2]
    lying = abs(a) >= 0.9  # then x = y × e_z, else y × e_x
    x = np.stack([np.where(lying, b, 0), np.where(lying, -a, c), np.where(lying, 0, -b)], axis=-1)
    x /= np.maximum(np.linalg.norm(x, axis=-1, keepdims=True), 1e-12)
    z = cross(x[..., YZXY, None], y[..., YZXY, None])[..., 0]
    return transforms(np.stack([x, along, z], axis=-1), start)


def quaternion_from_y(direction: ArrayLike) -> tuple[float, float, float, float]:
    """The quaternion (x, y, z, w) that turns the y axis to `direction` (3,) the shortest way."""
    x, y, z = np.asarray(direction, dtype=float) / np.linalg.norm(direction)
    if y < -1 + 1e-12:
        return (1.0, 0.0, 0.0, 0.0)
    q = np.array([z, 0.0, -x, 1 + y])
    x, y, z, w = q / np.linalg.norm(q)
    return (float(x), float(y), float(z), float(w))
