"""The rank that a body can have: a pose is singular where its Jacobian has less.

J has three rows per effector, but an arm in a plane moves in two of them at most, and two points
of one bone keep their distance. A rank that no pose of the body can have, no pose has lost.
"""

from dataclasses import replace
from functools import lru_cache

import numpy as np

from ikteach.arrays import Array, ArrayLike
from ikteach.body import Effectors, Tree, forward, jacobian

POSES = 8  # a pose drawn at random has the full rank, but for bad luck
ROUNDING = 1e-9  # of the strongest direction: what is weaker has come of rounding


@lru_cache(maxsize=64)
def full_rank(tree: Tree, effectors: Effectors) -> int:
    """Return the largest rank of J in any pose.

    It is from 0 to min(3k, n). J depends on θ through sines, cosines and lengths alone, so that its
    rank is the same in almost every pose. It is looked for in some random poses, always the same
    ones: hinges anywhere in a full turn, slides as far as the body is large, joints whose limits
    are one number at that. It depends neither on units nor on where the ground is.
    """
    rng = np.random.default_rng(0)
    ground = (tree.parents < 0)[:, None]
    here = replace(tree, offsets=np.where(ground, 0, tree.offsets))  # far away, digits are lost
    size = np.linalg.norm(here.offsets, axis=-1).sum() + np.linalg.norm(effectors.offsets)
    theta = rng.uniform(-1, 1, (POSES, len(tree))) * np.where(tree.slide, size, np.pi)
    theta = np.where(tree.lower < tree.upper, theta, tree.rest)
    J = jacobian(here, forward(here, theta), effectors)
    # Metres per radian beside the 1 of a slide: of length 1, no column drowns in another.
    length = np.linalg.norm(J, axis=-2, keepdims=True)
    none = np.where(tree.slide, 0, ROUNDING * size)
    sigma = np.linalg.svdvals(J / np.where(length > none, length, np.inf))
    return int((sigma > ROUNDING * sigma.max(initial=0)).sum(axis=-1).max())


def smallest_sigma(tree: Tree, effectors: Effectors, theta: ArrayLike) -> Array:
    """Return the smallest σ of J in poses (..., n).

    It is (...) [m/rad], of as many σ as the body can have, and 0 where the pose is singular.
    """
    sigma = np.linalg.svdvals(jacobian(tree, forward(tree, theta), effectors))
    rank = full_rank(tree, effectors)
    return sigma[..., rank - 1] if rank else np.zeros(sigma.shape[:-1])
