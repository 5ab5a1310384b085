"""Chapter 0. Forward kinematics: from the angles θ to where everything is.

Each joint stands in its parent's frame at `offset`, turned by R(v, θ) about its axis v
(Rodrigues: R = I + sin θ [v]× + (1 − cos θ) [v]×²), so that, from the ground up,

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

    The products along the chains are taken by pointer doubling: once every row holds the last 1,
    2, 4 … transforms of its chain, one stacked product joins it to the row that many above it. Six
    joints in a chain take three rounds, and a batch of poses takes no more.
    Source: thesis section 3.1; MATHS "Tree, forward kinematics, Jacobian".
    """
    theta = np.asarray(theta, dtype=float)
    if theta.shape[-1:] != (len(tree),):
        n = len(tree)
        raise ValueError(f"{n} joints need theta of shape (..., {n}), not {theta.shape}")
    T = _in_parent(tree, theta)
    for rows, above in tree.plan.climbs:
        T[..., rows, :, :] = T.take(above, axis=-3) @ T[..., rows, :, :]
    T = T.take(tree.plan.rank, axis=-3)
    R, p = T[..., :3, :3], T[..., :3, 3]
    return Frames(p, np.matvec(R, tree.axes), R)


def locate(frames: Frames, effectors: Effectors) -> Array:
    """Positions s_i = p_j + R_j offset_i of the effectors, (..., k, 3) [m]."""
    p = frames.positions[..., effectors.joints, :]
    R = frames.orientations[..., effectors.joints, :, :]
    return p + np.matvec(R, effectors.offsets)


def _in_parent(tree: Tree, theta: Array) -> Array:
    """Each joint in its parent's frame, (..., n, 4, 4), in the order of the plan."""
    theta = theta.take(tree.plan.order, axis=-1)
    parts = np.empty((*theta.shape, 1, 4))
    parts[..., 0, 0] = 1
    parts[..., 0, 1] = np.sin(theta)
    parts[..., 0, 2] = 1 - np.cos(theta)
    parts[..., 0, 3] = theta
    T: Array = (parts @ tree.plan.motion).reshape(*theta.shape, 4, 4)
    return T
