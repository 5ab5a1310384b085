"""Chapter 1. The Jacobian: how far each effector moves for a small turn of each joint."""

import numpy as np

from ikteach.arrays import Array, ArrayLike
from ikteach.body.forward import Frames, fits, locate
from ikteach.body.tree import Effectors, Tree
from ikteach.checks import numbers, together

YZXY = np.array([1, 2, 0, 1])


def jacobian(
    tree: Tree, frames: Frames, effectors: Effectors, *, at: ArrayLike | None = None
) -> Array:
    """J (..., 3k, n) [m/rad; 1 for slides]: row 3i + c is coordinate c of effector i.

    The column of a hinge j that carries effector i is v_j × (s_i − p_j), of a slide v_j, and zero
    where j does not carry i. `at` (..., k, 3) [m] puts other points in place of the s_i: with the
    targets there it is the second form of thesis section 3.2, v_j × (t_i − p_j).
    ValueError if shapes do not fit.
    """
    s = locate(frames, effectors) if at is None else _points(frames, effectors, at)
    if (n := frames.positions.shape[-2]) != len(tree):
        raise ValueError(f"these frames are of {n} joints, not of {len(tree)}")
    v, p = frames.axes.mT, frames.positions.mT  # (..., 3, n), side by side
    arms = s.take(YZXY, axis=-1)[..., None] - p.take(YZXY, axis=-2)[..., None, :, :]
    columns = cross(v.take(YZXY, axis=-2)[..., None, :, :], arms)  # (..., k, 3, n)
    if tree.plan.slides:
        columns = np.where(tree.slide, v[..., None, :, :], columns)
    columns *= effectors.mask
    return columns.reshape(*columns.shape[:-3], 3 * len(effectors), len(tree))


def _points(frames: Frames, effectors: Effectors, at: ArrayLike) -> Array:
    """A point (..., k, 3) per effector, as an array."""
    fits(effectors, frames)
    at, k = numbers("at", at), len(effectors)
    if at.shape[-2:] != (k, 3):
        raise ValueError(f"at needs a point per effector, (..., {k}, 3), not the shape {at.shape}")
    if at.ndim != 2 != frames.positions.ndim:
        together("frames and at", frames.positions.shape[:-2], at.shape[:-2])
    return at


def cross(a: Array, b: Array) -> Array:
    """a × b of vectors in columns, each given as y, z, x and again y: (..., 4, n) to (..., 3, n).

    a × b = (a_y b_z − a_z b_y, a_z b_x − a_x b_z, a_x b_y − a_y b_x): so ordered, the factors of
    all three are slices.
    """
    product = a[..., :3, :] * b[..., 1:, :]
    product -= a[..., 1:, :] * b[..., :3, :]
    return product
