"""Can a target be reached? A property of target, chain and limits, not of a method or a pose.

The thesis takes the remaining distance of a run for it (d ≤ 0 is "reachable"), which a slow method
fails on targets that are near. Here a search from many starts within the limits decides, for each
effector by itself. Nothing in it is human: hinges may have their limits anywhere, slides any
travel or none, and lengths are compared with the chain's own.
"""

from dataclasses import replace
from math import pi
from typing import NamedTuple

import numpy as np

from ikteach.arrays import Array, ArrayLike, Mask
from ikteach.body import Effectors, Frames, Tree, forward, jacobian, locate
from ikteach.checks import number
from ikteach.motion.checks import checked
from ikteach.solvers import dls

NEAR = 1e-3  # of a chain's length: what is so near is reached
VOLLEYS = (3, 8, 20)  # starts after the rest pose, for what has not been reached till then
SWARM = 24  # poses tried for each start, of which the nearest is improved
FEW = 4  # the same where each goal has a swarm of its own
OVER = 1 / 4  # of its range that a joint is drawn beyond its limits, and then put to them
ROUNDS = 60  # of improving it; most take 20
STILL = 1e-9  # of the chain's length: a step that moves no joint further has arrived
ROUNDING = 1e-12  # keeps H + λ²W regular where λ is 0
FREE = 2 * pi - 1e-9  # [rad]; a hinge that can turn so far has no limits: it gets to every angle


def reachable(
    tree: Tree, effectors: Effectors, targets: ArrayLike, *, within: float | None = None
) -> Mask:
    """Check which effectors can reach their targets, limits on: (..., k) for (..., k, 3) [m].

    An effector reaches a target that it can come within `within` metres of. If `within` is not
    given, it is a thousandth of the length of its chain (`annulus`), where slides without limits
    do not count; of the way to the target where nothing else has a length.

    It is sure of True, as it has found a pose. False means that many starts have led to none.
    """
    _, targets = checked(tree, tree.rest, effectors, targets)
    near = _tolerance(tree, effectors, targets) if within is None else number("within", within)
    return np.asarray(_search(tree, effectors, targets, near) <= near)


def nearest(tree: Tree, effectors: Effectors, targets: ArrayLike, *, within: float = 0.0) -> Array:
    """Return how near effectors come to targets (..., k) [m].

    Each effector goes to its own target, with limits on. The search has several starts: its answer
    is an upper bound, which more starts could only lower. It stops early where `within` is met [m].
    """
    _, targets = checked(tree, tree.rest, effectors, targets)
    return _search(tree, effectors, targets, number("within", within))


def annulus(
    tree: Tree, effectors: Effectors, i: int, frames: Frames | None = None
) -> tuple[Array, float, float]:
    """Return effector i's base, and how near and far it stretches.

    The base is where its chain is fixed (3,) [m]; the two distances [m] are how near and far the
    chain could stretch. A body that floats gets everywhere, so its reach is asked from where it is
    carried: the base of a walker's hand is its pelvis, (..., 3) where `frames` (...) have it, or as
    it is at rest.

    It is as if every joint could turn any way: links ℓ reach from max(0, 2 max ℓ − Σℓ) to Σℓ.
    Limits and axes only take from that. A slide makes its link as long, or as short, as its limits
    let it.
    """
    rows = sorted(tree.above(int(effectors.joints[i])))
    carried = _carried(tree, rows)
    frames = forward(tree, tree.rest) if frames is None else frames
    if carried == len(rows):  # it is on what is carried, and stays as far from its middle
        length = float(effectors.w[i] * np.linalg.norm(effectors.offsets[i]))
        return frames.positions[..., rows[-1], :], length, length
    limb = _limb(tree, effectors, i, rows[carried:])
    if carried:
        under = frames.orientations[..., rows[carried - 1], :, :]
        base = frames.positions[..., rows[carried - 1], :] + np.matvec(under, limb.base)
        limb = limb._replace(base=base)
    if limb.endless.any():
        raise ValueError(f"a slide without limits has no reach: effector {effectors.names[i]!r}")
    inner = (limb.near + limb.far).max() - limb.length  # a long link, less all others stretched
    return limb.base, max(0.0, float(inner)), limb.length


class _Limb(NamedTuple):
    """The joints that carry one effector, alone and standing in the origin.

    base    (3,)  where they stand in the world [m]
    near, far  (n + 1,)  how short and how long each link can be [m]
    """

    tree: Tree
    end: Effectors
    base: Array
    near: Array
    far: Array

    @property
    def length(self) -> float:
        """Σℓ, the stretched length [m].

        Slides without limits count as short as they can be.
        """
        return float(np.where(np.isfinite(self.far), self.far, self.near).sum())

    @property
    def endless(self) -> Mask:
        """The slides that lack a limit, (n,)."""
        return self.tree.slide & ~(np.isfinite(self.tree.lower) & np.isfinite(self.tree.upper))


def _carried(tree: Tree, rows: list[int]) -> int:
    """Count the first rows of a chain by which the whole body floats, 0 if it does not.

    They are slides without limits, and hinges without limits that stand where these have come to.
    """
    endless = np.isinf(tree.upper) & np.isinf(tree.lower)
    free = endless | (~tree.slide & (tree.upper - tree.lower >= FREE))
    there = np.array([not tree.offsets[row].any() for row in rows]) | tree.slide[rows]
    stops = np.flatnonzero(~(free[rows] & there))
    count = int(stops[0]) if len(stops) else len(rows)
    return count if (tree.slide[rows] & endless[rows])[:count].any() else 0


def _limb(tree: Tree, effectors: Effectors, i: int, chain: list[int] | None = None) -> _Limb:
    """Find the joints that carry effector i, full turns without limits.

    They are those of `chain`, all of them if it is not given. A direction is a point on joints that
    all stand in one place, and whose slides stay.
    """
    rows = np.array(sorted(tree.above(int(effectors.joints[i]))) if chain is None else chain)
    free = ~tree.slide[rows] & (tree.upper[rows] - tree.lower[rows] >= FREE)
    names, offsets = tuple(tree.names[row] for row in rows), effectors.w[i] * tree.offsets[rows]
    base, offsets[0] = offsets[0].copy(), 0
    stays = tree.slide[rows] & (effectors.w[i] == 0)
    alone = replace(
        tree,
        names=names,
        parents=np.arange(len(rows)) - 1,
        offsets=offsets,
        lower=np.where(stays, 0, np.where(free, -np.inf, tree.lower[rows])),
        upper=np.where(stays, 0, np.where(free, np.inf, tree.upper[rows])),
        rest=np.where(stays, 0, tree.rest[rows]),
        **{what: getattr(tree, what)[rows] for what in ("axes", "slide", "mobility")},
    )
    end = Effectors.of(alone, {"end": (names[-1], effectors.offsets[i].tolist())})
    return _Limb(alone, end, base, *_links(alone, end))


def _links(tree: Tree, end: Effectors) -> tuple[Array, Array]:
    """How short and how long each link of a chain can be, (n + 1,) [m].

    The link to a slide at o in its parent's frame along v is o + θv, that to a hinge is o.
    """
    o = np.concatenate([tree.offsets, end.offsets])
    v = np.concatenate([tree.axes, np.zeros((1, 3))])
    lower, upper = (np.append(np.where(tree.slide, x, 0), 0) for x in (tree.lower, tree.upper))
    along = np.vecdot(o, v)
    across = np.linalg.norm(o - along[:, None] * v, axis=1)
    least, most = along + lower, along + upper
    near = np.hypot(across, np.clip(0, least, most))
    return near, np.hypot(across, np.maximum(abs(least), abs(most)))


def _tolerance(tree: Tree, effectors: Effectors, targets: Array) -> Array:
    limbs = [_limb(tree, effectors, i) for i in range(len(effectors))]
    away = np.linalg.norm(targets - [limb.base for limb in limbs], axis=-1)
    length = np.array([limb.length for limb in limbs])
    return NEAR * np.where(length > 0, length, away)


def _search(tree: Tree, effectors: Effectors, targets: Array, near: ArrayLike) -> Array:
    """Find the least distance (..., k) found to targets (..., k, 3); enough is `near` (..., k)."""
    out = np.empty(targets.shape[:-1])
    enough = np.broadcast_to(near, out.shape)
    for i in range(len(effectors)):
        limb = _limb(tree, effectors, i)
        flat = np.column_stack([targets[..., i, :].reshape(-1, 3), enough[..., i].ravel()])
        cases, back = np.unique(flat, axis=0, return_inverse=True)
        best = _volleys(limb, cases[:, :3] - limb.base, cases[:, 3])
        out[..., i] = best[back].reshape(out.shape[:-1])
    return out


def _volleys(limb: _Limb, goals: Array, near: Array) -> Array:
    """Find the least distance (g,) found for goals (g, 3) from the rest pose, then random ones."""
    rest, rng = np.tile(limb.tree.rest, (len(goals), 1)), np.random.default_rng(0)
    best = _descend(limb, goals, rest, near)
    for count in VOLLEYS:
        left = np.flatnonzero(best > near)
        if not len(left):
            break
        of, starts = left.repeat(count), _starts(limb, goals[left], count, rng)
        found = _descend(limb, goals[of], starts.reshape(len(of), -1), near[of])
        best[left] = np.minimum(best[left], found.reshape(-1, count).min(axis=1))
    return best


def _starts(limb: _Limb, goals: Array, count: int, rng: np.random.Generator) -> Array:
    """Draw poses (g, count, n) for goals (g, 3), each the nearest of a random swarm.

    Limits may lie anywhere: a joint with one goes on from it, and a joint with none starts around
    rest, hinges in a full turn, slides as far as there and as the chain is long.
    """
    tree, end = limb.tree, limb.end
    endless = limb.endless.any()  # if not, the swarm is the same for all goals
    far = limb.length + np.linalg.norm(goals, axis=1) if endless else np.array([limb.length])
    span = np.where(tree.slide, far[:, None], pi)
    from_above = np.where(np.isfinite(tree.upper), tree.upper - 2 * span, tree.rest - span)
    lower = np.where(np.isfinite(tree.lower), tree.lower, from_above)
    upper = np.where(np.isfinite(tree.upper), tree.upper, lower + 2 * span)
    share = rng.uniform(-OVER, 1 + OVER, (count, FEW if endless else SWARM, len(tree)))
    swarm = lower[:, None, None] + share * (upper - lower)[:, None, None]
    swarm = np.minimum(np.maximum(swarm, tree.lower), tree.upper)  # some stand at their limits
    s = locate(forward(tree, swarm), end)[..., 0, :]
    gap = np.linalg.norm(goals[:, None, None] - s, axis=-1)  # (g, count, SWARM)
    of = np.arange(len(swarm))[:, None] if endless else 0
    theta = swarm[of, np.arange(count), gap.argmin(axis=-1)]
    if endless:  # what is far away along slides is met before hinges turn for it
        frames = forward(tree, theta)
        e = goals[:, None] - locate(frames, end)[..., 0, :]
        theta = theta + dls(jacobian(tree, frames, end) * limb.endless, e, damping=0.0)
        theta = np.minimum(np.maximum(theta, tree.lower), tree.upper)
    return theta


def _descend(limb: _Limb, goals: Array, theta: Array, near: Array) -> Array:
    """Find the distance (b,) to goals (b, 3) that poses θ (b, n) come down to within their limits.

    Newton steps with damping: (H + λ²W) Δθ = Jᵀe. λ falls after a step that came nearer, and rises
    after one that did not, which is taken back. Joints that the slope holds at a limit stay there
    (Bertsekas 1982, SIAM J. Control Optim. 20:221).
    """
    tree = limb.tree
    size = limb.length + limb.endless.any() * np.linalg.norm(goals, axis=1)
    size[size == 0] = 1  # it cannot move at all
    pose, damping = theta.copy(), np.full(len(goals), 1 / pi)  # so odd that no A is singular
    gap, slope, H, W = _slope(limb, goals, pose)
    best, of = gap.copy(), np.arange(len(goals))
    for _ in range(ROUNDS):
        free = ((pose > tree.lower) | (slope > 0)) & ((pose < tree.upper) | (slope < 0))
        A = H * (free[:, :, None] & free[:, None, :])
        np.einsum("bii->bi", A)[:] += (damping * gap / size + ROUNDING)[:, None] * W
        dtheta = np.linalg.solve(A, (slope * free)[..., None])[..., 0]
        trial = np.minimum(np.maximum(pose + dtheta, tree.lower), tree.upper)
        moved = (abs(trial - pose) * np.sqrt(W)).max(axis=1)
        on = (gap > near) & (moved > STILL * size)
        if not on.any():
            break
        pose, trial, gap, slope, H, W, damping, goals, near, size, of = (
            part[on] for part in (pose, trial, gap, slope, H, W, damping, goals, near, size, of)
        )
        tried = _slope(limb, goals, trial)
        nearer = tried[0] < gap
        for now, then in zip((pose, gap, slope, H, W), (trial, *tried), strict=True):
            now[nearer] = then[nearer]
        damping *= np.where(nearer, 1 / 4, 4)
        best[of] = gap
    return best


def _slope(limb: _Limb, goals: Array, theta: Array) -> tuple[Array, Array, Array, Array]:
    """‖e‖ (b,), Jᵀe (b, n), H (b, n, n) and W (b, n): how ½‖e‖² goes down from poses θ (b, n).

    H = JᵀJ − K, K_ij = eᵀ ∂J_j/∂θ_i = eᵀ (v_i × J_j) for a hinge i above j, or j itself. Without K
    (Gauss–Newton) the way to a target that is out of reach is long. W makes one unit of all joints:
    1 for a slide, for a hinge ‖J_i‖² and the square of the chain's length [m²/rad²].
    """
    frames = forward(limb.tree, theta)
    J = jacobian(limb.tree, frames, limb.end)  # (b, 3, n)
    e = goals - locate(frames, limb.end)[:, 0]
    turned = np.cross(J.mT, e[:, None])  # v · (J × e) = e · (v × J)
    K = np.triu(frames.axes * ~limb.tree.slide[:, None] @ turned.mT)
    lever2 = np.square(J).sum(axis=1) + limb.length**2
    W = np.where(limb.tree.slide | (lever2 == 0), 1, lever2)
    return np.linalg.norm(e, axis=1), np.vecmat(e, J), J.mT @ J - K - np.triu(K, 1).mT, W
