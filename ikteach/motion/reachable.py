"""Can a target be reached? A property of target, chain and limits, not of a method or a pose.

The thesis takes the remaining distance of a run for it (d ≤ 0 is "reachable"), which a slow method
fails on targets that are near. Here a converged bounded least-squares solve from several starts
decides, for each effector by itself.
"""

import numpy as np

from ikteach.arrays import Array, ArrayLike, Mask
from ikteach.body import Effectors, Joint, Tree, forward, locate
from ikteach.body.tree import GROUND
from ikteach.motion.step import checked, step
from ikteach.solvers import dls_following

STARTS = 6
ROUNDS = 60
SWARM = 24  # poses tried for each start before one is improved
STILL = 1e-7  # [rad]; a step below it has arrived


def reachable(
    tree: Tree, effectors: Effectors, targets: ArrayLike, *, within: float = 1e-3
) -> Mask:
    """Whether each effector can come within so many metres of its target: (..., k) for (..., k, 3).

    Joints without limits are searched through a full turn, slides through a metre either way.
    """
    return nearest(tree, effectors, targets, within=within) <= within


def nearest(tree: Tree, effectors: Effectors, targets: ArrayLike, *, within: float = 0.0) -> Array:
    """How near each effector can come to its target with limits on, (..., k) [m].

    A search from several starts: an upper bound that more starts could only lower. It stops early
    where `within` is met.
    """
    _, targets = checked(tree, tree.rest, effectors, targets)
    flat = targets.reshape(-1, len(effectors), 3)
    out = np.empty(flat.shape[:-1])
    for i in range(len(effectors)):
        limb, alone = _limb(tree, effectors, i)
        goals, back = np.unique(flat[:, i], axis=0, return_inverse=True)
        out[:, i] = _descend(limb, alone, goals[:, None, :], within)[back.reshape(-1)]
    return out.reshape(targets.shape[:-1])


def annulus(tree: Tree, effectors: Effectors, i: int) -> tuple[Array, float, float]:
    """Where effector i's chain is fixed (3,), and how near and how far it could stretch [m].

    As if every joint could turn any way: the links ℓ reach from max(0, 2 max ℓ − Σℓ) to Σℓ. Limits
    and axes only take from that; a slide lengthens its link, and brings it near.
    """
    first, *chain = sorted(tree.above(int(effectors.joints[i])))
    slides = np.where(tree.slide, np.maximum(abs(tree.lower), abs(tree.upper)), 0.0)
    if not np.isfinite(slides[[first, *chain]]).all():
        raise ValueError(f"a slide without limits has no reach: effector {effectors.names[i]!r}")
    links = np.linalg.norm([*tree.offsets[chain], effectors.offsets[i]], axis=1)
    outer = links.sum() + slides[[first, *chain]].sum()
    inner = 0.0 if slides[[first, *chain]].any() else max(0.0, 2 * links.max() - outer)
    return tree.offsets[first], float(inner), float(outer)


def _limb(tree: Tree, effectors: Effectors, i: int) -> tuple[Tree, Effectors]:
    """The joints that carry effector i, alone, and that effector on them."""
    joints = sorted(tree.above(int(effectors.joints[i])))
    limb = Tree.of(
        Joint(
            tree.names[j],
            tree.names[tree.parents[j]] if tree.parents[j] != GROUND else None,
            tree.offsets[j], tree.axes[j], bool(tree.slide[j]),
            tree.lower[j], tree.upper[j], tree.rest[j],
        )
        for j in joints
    )  # fmt: skip
    return limb, Effectors.of(limb, {"end": (limb.names[-1], effectors.offsets[i])})


def _descend(limb: Tree, alone: Effectors, goals: Array, within: float) -> Array:
    """The least distance (g,) found for each goal (g, 1, 3)."""
    best = np.full(len(goals), np.inf)
    for theta in _starts(limb, alone, goals):
        left = np.flatnonzero(best > within)
        if not len(left):
            break
        pose = theta[left]
        for _ in range(ROUNDS):
            before = pose
            pose = step(limb, pose, alone, goals[left], dls_following).theta
            if abs(pose - before).max() < STILL:
                break
        s = locate(forward(limb, pose), alone)
        best[left] = np.minimum(best[left], np.linalg.norm(goals[left] - s, axis=-1)[:, 0])
    return best


def _starts(limb: Tree, alone: Effectors, goals: Array) -> list[Array]:
    """For each start a pose (g, n) per goal: the rest pose, then the nearest of some at random."""
    rng = np.random.default_rng(0)
    span = np.where(limb.slide, 1.0, np.pi)
    lower, upper = np.maximum(limb.lower, -span), np.minimum(limb.upper, span)
    starts = [np.broadcast_to(limb.rest, (len(goals), len(limb)))]
    for _ in range(STARTS - 1):
        swarm = rng.uniform(lower, np.maximum(lower, upper), size=(SWARM, len(limb)))
        s = locate(forward(limb, swarm), alone)[:, 0]
        gap = np.linalg.norm(goals - s, axis=-1)  # (g, SWARM)
        starts.append(swarm[gap.argmin(axis=-1)])
    return starts
