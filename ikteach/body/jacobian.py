"""Chapter 1. The Jacobian: how far each effector moves for a small turn of each joint."""

import numpy as np

from ikteach.arrays import Array, ArrayLike
from ikteach.body.forward import Frames, locate
from ikteach.body.tree import Effectors, Tree

YZX = np.array([1, 2, 0])


def jacobian(
    tree: Tree, frames: Frames, effectors: Effectors, *, at: ArrayLike | None = None
) -> Array:
    """J (..., 3k, n) [m/rad; 1 for slides]: row 3i + c is coordinate c of effector i.

    The column of a hinge j that carries effector i is v_j × (s_i − p_j), of a slide v_j, and zero
    where j does not carry i. `at` (..., k, 3) [m] puts other points in place of the s_i: with the
    targets there it is the second form of thesis section 3.2, v_j × (t_i − p_j).
    """
    s = locate(frames, effectors) if at is None else np.asarray(at, dtype=float)
    v, p = _as_columns(frames.axes), _as_columns(frames.positions)
    columns = cross(v, s[..., None] - p)  # (..., k, 3, n)
    if tree.plan.slides:
        columns = np.where(tree.slide, v, columns)
    columns *= effectors.mask
    return columns.reshape(*columns.shape[:-3], 3 * len(effectors), len(tree))


def cross(a: Array, b: Array) -> Array:
    """a × b along the last axis but one: (a b′ − a′ b)′, where ′ puts y, z, x for x, y, z."""
    difference = b.take(YZX, axis=-2)
    difference *= a
    difference -= a.take(YZX, axis=-2) * b
    return difference.take(YZX, axis=-2)


def _as_columns(vectors: Array) -> Array:
    """(..., n, 3) to (..., 1, 3, n), side by side in memory: a long last axis is the fast one."""
    return vectors.mT.copy()[..., None, :, :]
