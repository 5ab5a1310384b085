"""Cyclic coordinate descent: one joint after the other, from the tips to the ground.

The method of first programs and of many games, named in thesis 4.4. It needs no Jacobian: each
joint alone turns as far as brings its effectors nearest to their targets, and the next one below
starts from there.
"""

import numpy as np

from ikteach.arrays import TINY, Array
from ikteach.body import Effectors, Frames, Tree, locate


def ccd(
    J: Array,
    e: Array,
    *,
    tree: Tree,
    effectors: Effectors,
    frames: Frames,
    low: Array,
    high: Array,
    weights: Array | None = None,
) -> Array:
    """Turn each joint once, from tips to ground: (..., n) [rad].

    J (..., 3k, n) is not asked; it is there so that all methods are called alike.

    e                      (..., 3k)  t − s [m]
    tree, effectors, frames           the body, and where its joints are
    low, high              (..., n)   how far each joint may turn down and up [rad]
    weights                (..., k)   of the targets, by which e was multiplied
    With a = s − wp and b = t − wp for each effector that a hinge carries (w is 1 for a point, 0 for
    a direction), the turn φ about its axis v that brings all a nearest to b has
    tan φ = Σ v·(a × b) / Σ (a·b − (a·v)(b·v)). A slide moves by the mean of v·(t − s). Weights
    square in these sums.
    Source: Wang & Chen 1991, IEEE Trans. Robotics and Automation 7:489; thesis 4.4.
    """
    s = locate(frames, effectors)
    weights = np.ones(len(effectors)) if weights is None else weights
    square = np.square(weights)
    off = e.reshape(*e.shape[:-1], len(effectors), 3)
    t = s + np.divide(off, weights[..., None], out=np.zeros_like(off), where=weights[..., None] > 0)
    batch = np.broadcast_shapes(t.shape[:-2], low.shape[:-1])
    s = np.broadcast_to(s, (*batch, *s.shape[-2:])).copy()
    dtheta = np.zeros((*batch, len(tree)))
    for j in reversed(range(len(tree))):  # a joint comes after what it hangs from
        ours = effectors.carried[:, j]
        if not ours.any():
            continue
        v, p = frames.axes[..., j, None, :], frames.positions[..., j, None, :]
        p, w = effectors.w[ours, None] * p, square[..., ours]
        a, b = s[..., ours, :] - p, t[..., ours, :] - p
        if tree.slide[j]:
            total = np.maximum(w.sum(axis=-1), TINY)
            turn = (w * np.vecdot(v, b - a)).sum(axis=-1) / total
        else:
            across = (w * np.vecdot(v, np.cross(a, b))).sum(axis=-1)
            along = (w * (np.vecdot(a, b) - np.vecdot(a, v) * np.vecdot(b, v))).sum(axis=-1)
            turn = np.arctan2(across, along)
        turn = np.minimum(np.maximum(turn, low[..., j]), high[..., j])
        dtheta[..., j] = turn
        turn = turn[..., None, None]
        if tree.slide[j]:
            s[..., ours, :] += turn * v
        else:  # Rodrigues
            c, along_v = np.cos(turn), np.vecdot(v, a)[..., None] * v
            s[..., ours, :] = p + c * a + np.sin(turn) * np.cross(v, a) + (1 - c) * along_v
    return dtheta


ccd.wants = ("tree", "effectors", "frames", "low", "high", "weights")  # type: ignore[attr-defined]
