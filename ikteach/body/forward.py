"""Chapter 0. Forward kinematics: from the angles θ to where everything is.

Each joint stands in its parent's frame at `offset`, turned by R(v, θ) about its axis v
(Rodrigues: R = vvᵀ + sin θ [v]× + cos θ (I − vvᵀ)), so that, from the ground up,

    R_j = R_parent R(v_j, θ_j)        p_j = p_parent + R_parent offset_j

A slide adds θ_j v_j to its offset instead of turning.
"""

from typing import NamedTuple

import numpy as np

from ikteach.arrays import Array, ArrayLike
from ikteach.body.tree import Effectors, Tree


class Frames(NamedTuple):
    """Where every joint is, in the world.

    positions     (..., n, 3)     p_j [m]
    axes          (..., n, 3)     unit axis of rotation or of sliding
    orientations  (..., n, 3, 3)  R_j, whose columns are the joint's own x, y and z
    """

    positions: Array
    axes: Array
    orientations: Array


def forward(tree: Tree, theta: ArrayLike) -> Frames:
    """The frames of all joints at pose θ (..., n) [rad, or m for slides].

    All joints of one depth are joined to their parents by one stacked product, a batch of poses
    with them. Of long chains (`tree.DEEP`) every row first holds the last 1, 2, 4 … transforms, so
    that 64 joints take six rounds and not 63.
    Source: thesis section 3.1; MATHS "Tree, forward kinematics, Jacobian".
    """
    theta = np.asarray(theta, dtype=float)
    if theta.shape[-1:] != (len(tree),):
        n = len(tree)
        raise ValueError(f"{n} joints need theta of shape (..., {n}), not {theta.shape}")
    T = _in_parent(tree, theta)
    for rows, above in tree.plan.climbs:
        low = T[..., rows, :, :]
        low[..., :3, :] = T.take(above, axis=-3)[..., :3, :4] @ low
    T = T.take(tree.plan.rank, axis=-3)
    return Frames(T[..., :3, 3], T[..., :3, 4], T[..., :3, :3])


def locate(frames: Frames, effectors: Effectors) -> Array:
    """Positions s_i = p_j + R_j offset_i of the effectors, (..., k, 3) [m]."""
    p = frames.positions.take(effectors.joints, axis=-2)
    R = frames.orientations.take(effectors.joints, axis=-3)
    return p + np.matvec(R, effectors.offsets)


def _in_parent(tree: Tree, theta: Array) -> Array:
    """[R p v; 0 1 0] of each joint in its parent's frame, (..., n, 4, 5), in the plan's order."""
    plan = tree.plan
    theta = theta.take(plan.order, axis=-1)
    x = np.empty((*theta.shape, 3 + plan.slides))  # 1, sin θ, cos θ and, for slides, θ
    x[..., 0] = 1
    np.sin(theta, out=x[..., 1])
    np.cos(theta, out=x[..., 2])
    if plan.slides:
        x[..., 3] = theta
    return np.vecmat(x, plan.terms).reshape(*theta.shape, 4, 5)
