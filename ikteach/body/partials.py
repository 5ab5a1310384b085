"""Chapter 1. Two other ways to the Jacobian: derivatives by hand, and differences."""

import numpy as np

from ikteach.arrays import Array, ArrayLike
from ikteach.body.forward import forward, locate
from ikteach.body.tree import Effectors, Tree


def by_hand(theta: ArrayLike, lengths: ArrayLike) -> Array:
    """Write out the Jacobian of a planar arm.

    J (..., 2, n) [m/rad], its partial derivatives as in CS 490.

    With φ_i = θ_1 + … + θ_i the hand is at x = Σ l_i cos φ_i, y = Σ l_i sin φ_i, so that

        ∂x/∂θ_j = −Σ_(i≥j) l_i sin φ_i        ∂y/∂θ_j = Σ_(i≥j) l_i cos φ_i

    theta (..., n) [rad], lengths (n,) [m].
    """
    phi, links = np.cumsum(theta, axis=-1), np.asarray(lengths, dtype=float)
    x, y = links * np.cos(phi), links * np.sin(phi)
    return np.stack([-_from_here_on(y), _from_here_on(x)], axis=-2)


def by_differences(tree: Tree, theta: ArrayLike, effectors: Effectors, *, h: float = 1e-6) -> Array:
    """Return J (..., 3k, n) from central differences (s(θ + h) − s(θ − h)) / 2h, joint by joint.

    theta (..., n), h [rad]. It needs no formula, and is as wrong as h is large: by O(h²).
    ValueError unless h is more than 0.
    """
    if not h > 0:
        raise ValueError(f"the difference h must be more than 0, not {h}")
    turns = h * np.eye(len(tree))
    each = np.asarray(theta, dtype=float)[..., None, :]
    ahead = locate(forward(tree, each + turns), effectors)  # (..., n, k, 3)
    behind = locate(forward(tree, each - turns), effectors)
    columns = (ahead - behind) / (2 * h)
    return columns.reshape(*columns.shape[:-2], -1).swapaxes(-1, -2)


def _from_here_on(values: Array) -> Array:
    """Σ_(i≥j) of the last axis."""
    return np.cumsum(values[..., ::-1], axis=-1)[..., ::-1]
