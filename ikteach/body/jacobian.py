"""Chapter 1. The Jacobian: how far each effector moves for a small turn of each joint."""

import numpy as np

from ikteach.arrays import Array, ArrayLike
from ikteach.body.cross import across_joints, cross, down_effectors
from ikteach.body.forward import Frames, check_frames, locate
from ikteach.body.tree import Effectors, Tree
from ikteach.checks import common_batch, numbers


def jacobian(
    tree: Tree, frames: Frames, effectors: Effectors, *, at: ArrayLike | None = None
) -> Array:
    """Return J (..., 3k, n) [m/rad; 1 for slides]: row 3i + c is coordinate c of effector i.

    The column of a hinge j that carries effector i is v_j × (s_i − w_i p_j), of a slide w_i v_j,
    and zero where j does not carry i; w_i is 1 for a point and 0 for a direction. `at` (..., k, 3)
    [m] puts other points in place of the s_i: with the targets there it is the second form of
    thesis section 3.2, v_j × (t_i − p_j).
    ValueError if shapes do not fit.
    """
    s = locate(frames, effectors) if at is None else _points(frames, effectors, at)
    k, n = effectors.carried.shape
    if n != len(tree.names):
        raise ValueError(f"these frames are of {n} joints, not of {len(tree)}")
    s, p, v = down_effectors(s), across_joints(frames.positions), across_joints(frames.axes)
    if effectors.directed:
        p = effectors.w[:, None, None] * p
    columns = cross(v, s - p)  # (..., k, 3, n)
    if tree.plan.slides:
        columns = np.where(tree.slide, frames.axes.mT[..., None, :, :], columns)
    columns *= effectors.mask
    return columns.reshape(*columns.shape[:-3], 3 * k, n)


def _points(frames: Frames, effectors: Effectors, at: ArrayLike) -> Array:
    """Make an array of one point per effector, (..., k, 3)."""
    check_frames(effectors, frames)
    at, k = numbers("at", at), len(effectors)
    if at.shape[-2:] != (k, 3):
        raise ValueError(f"at needs a point per effector, (..., {k}, 3), not the shape {at.shape}")
    if at.ndim != 2 != frames.positions.ndim:
        common_batch("frames and at", frames.positions.shape[:-2], at.shape[:-2])
    return at
