"""Chapter 0. Forward kinematics: from the angles θ to where everything is.

Each joint stands in its parent's frame at `offset`, turned by R(v, θ) about its axis v
(Rodrigues: R = vvᵀ + sin θ [v]× + cos θ (I − vvᵀ)), so that, from the ground up,

    R_j = R_parent R(v_j, θ_j)        p_j = p_parent + R_parent offset_j

A slide adds θ_j v_j to its offset instead of turning.
"""

from typing import NamedTuple

import numpy as np

from ikteach.arrays import Array, ArrayLike, finite
from ikteach.body.tree import Effectors, Tree
from ikteach.checks import numbers, shown


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
    """Return the frames of all joints at pose θ (..., n) [rad, or m for slides].

    Each step of the climb joins all joints of one depth to their parents by one stacked product,
    a batch of poses with them (`body.plan`).
    ValueError if θ has another shape, or a number that is not finite.
    Source: thesis section 3.1.
    """
    theta, plan = pose(tree, theta), tree.plan
    T = plan.local(theta)  # [R(v, θ) offset v; 0 1 0], each in its parent's frame
    for T_j, T_parent in plan.climb(T):
        T_j[...] = T_parent @ T_j  # R_parent R(v, θ), p_parent + R_parent offset, R_parent v
    T = T.take(plan.inverse, axis=-3)
    return Frames(T[..., :3, 3], T[..., :3, 4], T[..., :3, :3])


def locate(frames: Frames, effectors: Effectors) -> Array:
    """Return s_i = w_i p_j + R_j offset_i of the effectors, (..., k, 3) [m].

    It is where a point is (w = 1), or how a direction points (w = 0).
    """
    check_frames(effectors, frames)
    p = frames.positions.take(effectors.joints, axis=-2)
    if effectors.directed:
        p = effectors.w[:, None] * p
    R = frames.orientations.take(effectors.joints, axis=-3)
    return p + np.matvec(R, effectors.offsets)


def pose(tree: Tree, theta: ArrayLike) -> Array:
    """Check that θ (..., n) is a pose of this tree.

    Return it as an array; ValueError if it is none.
    """
    if not isinstance(tree, Tree):
        raise TypeError(f"a Tree is needed here, not {shown(tree)}")
    theta, n = numbers("theta", theta), len(tree)
    if theta.shape[-1:] != (n,):
        needs = "1 joint needs" if n == 1 else f"{n} joints need"
        raise ValueError(f"{needs} theta of shape (..., {n}), not {theta.shape}")
    if not finite(theta):
        raise ValueError(f"the angle of {not_finite(theta, tree.names)} is not finite")
    return theta


def check_frames(effectors: Effectors, frames: Frames) -> None:
    """Refuse frames that are not of a body of these effectors."""
    if not isinstance(frames, Frames):
        raise TypeError(f"the frames of forward(tree, theta) are needed here, not {shown(frames)}")
    n = frames.positions.shape[-2]
    if not isinstance(effectors, Effectors) or effectors.carried.shape[1] != n:
        check_effectors(effectors, n)


def check_effectors(effectors: Effectors, n: int) -> None:
    """Refuse effectors that are not of a body of n joints."""
    if not isinstance(effectors, Effectors):
        raise TypeError(f"Effectors are needed here, not {shown(effectors)}")
    theirs = effectors.carried.shape[1]
    if theirs != n:
        raise ValueError(f"these effectors are of a body of {theirs} joints, not of {n}")


def not_finite(values: Array, names: tuple[str, ...]) -> str:
    """Name the first of values (..., n) that is not finite."""
    return shown(names[int(np.argwhere(~np.isfinite(values))[0][-1])])
