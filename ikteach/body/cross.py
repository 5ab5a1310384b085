"""Cross products of many vectors at once, by slices.

a × b = (a_y b_z − a_z b_y, a_z b_x − a_x b_z, a_x b_y − a_y b_x): with coordinates in the order
y, z, x, y the factors of all three are slices, and nothing is copied.
"""

import numpy as np

from ikteach.arrays import Array

YZXY = np.array([1, 2, 0, 1])


def across_joints(vectors: Array) -> Array:
    """Lay one vector per joint side by side.

    (..., n, 3) to (..., 1, 4, n), in the order YZXY.
    """
    return vectors.mT.take(YZXY, axis=-2)[..., None, :, :]


def down_effectors(points: Array) -> Array:
    """Lay one point per effector below each other.

    (..., k, 3) to (..., k, 4, 1), in the order YZXY.
    """
    return points.take(YZXY, axis=-1)[..., None]


def cross(a: Array, b: Array) -> Array:
    """Multiply a × b of vectors in columns.

    (..., 4, n) in the order YZXY to (..., 3, n) in the order XYZ.
    """
    product = a[..., :3, :] * b[..., 1:, :]
    product -= a[..., 1:, :] * b[..., :3, :]
    return product
