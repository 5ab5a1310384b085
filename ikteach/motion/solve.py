"""One call to a pose: targets in, and the pose that meets them, or how near it came and why."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ikteach.arrays import Array, ArrayLike, Index, Mask
from ikteach.body import Effectors, Frames, Tree, forward, jacobian, locate
from ikteach.body.extent import extent
from ikteach.body.forward import pose
from ikteach.checks import common_batch, count, function, number, numbers, shown
from ikteach.motion.checks import goals as checked_targets
from ikteach.motion.checks import solver_of
from ikteach.motion.here import Here, situated, wants
from ikteach.motion.rules import Bounds, Cap, LimitRule, hold, whole
from ikteach.solvers import Solver, ask, dls_following

POOL = 128  # poses that are worked on at once: their Jacobians stay in the processor's cache
DRAWN = 24  # poses drawn for each restart; the one nearest to the targets begins
WORTH = 1e-3  # share by which the error must fall to count as progress …
PATIENCE = 12  # … at least once in so many iterations

REASONS = (
    "arrived",
    "stands still: no joint helps",
    "at limits: the joints that would help stand at theirs",
    "out of patience: more iterations may help",
)
ARRIVED, STILL, AT_LIMITS, IMPATIENT = range(len(REASONS))


class Solution(NamedTuple):
    """The poses that were found, the best of each search.

    theta       (..., n)  finite and, unless limits are ignored, within them [rad]
    error       (..., k)  distance to target [m]
    iterations  (...)     steps that were taken, those of restarts with them
    why         (...)     why the search ended, as the place in `REASONS`
    """

    theta: Array
    error: Array
    iterations: Index
    why: Index

    @property
    def converged(self) -> Mask:
        """Whether every effector is within the tolerance of its target, (...)."""
        return np.equal(self.why, ARRIVED)

    @property
    def reason(self) -> "str | np.ndarray[tuple[int, ...], np.dtype[np.str_]]":
        """Why the search ended, in words; an array (...) for a batch."""
        words = np.array(REASONS)[self.why]
        return words if words.ndim else str(words)


def solve(
    tree: Tree,
    effectors: Effectors,
    targets: ArrayLike,
    solver: Solver | str = dls_following,
    *,
    theta: ArrayLike | None = None,
    tolerance: float = 1e-4,
    most: int = 100,
    limits: LimitRule = hold,
    max_step: float | None = None,
    cap: Cap = whole,
    restarts: int = 0,
    seed: int = 0,
    weights: ArrayLike | None = None,
) -> Solution:
    """Find a pose that meets targets (..., k, 3) [m], from the pose θ (..., n).

    solver      a function of (J, e), or the name of one of `SOLVERS`
    theta       the start [rad], the rest pose if not given; brought within its limits first
    tolerance   how near every effector must come to its target [m]
    most        iterations at most, from each start
    limits      what happens at a limit: `hold`, `clip` or `ignore`
    max_step    [rad]: no joint turns further in one iteration; `cap` says what is shortened
    restarts    searches from other poses, drawn at random within the limits, where the first fails
    seed        of these draws: equal seeds give equal poses
    weights     (k,) how much each target counts against the others, 1 if not given

    Leading dimensions are batches: each pose stops when it has arrived, and the others go on.
    ValueError if a shape is wrong or a number not finite; FloatingPointError if the solver's answer
    is not finite. Source: the loop of thesis 5.1 without its clock.
    """
    tolerance, most = number("tolerance", tolerance), count("most", most, least=0)
    restarts, seed = count("restarts", restarts, least=0), count("seed", seed, least=0)
    max_step = None if max_step is None else number("max_step", max_step)
    limits, cap = function("limits", limits), function("cap", cap)
    rows = None if weights is None else _row_weights(effectors, weights)
    method = solver_of(solver)
    search = _Search(tree, effectors, method, tolerance, most, limits, max_step, cap, rows)
    starts, goals, batch = _flat(tree, tree.rest if theta is None else theta, effectors, targets)
    found = _descend(search, starts, goals)
    rng: np.random.Generator | None = None
    for _ in range(restarts):
        left = np.flatnonzero(found.why)  # those that have not ARRIVED
        if not len(left):
            break
        rng = rng or np.random.default_rng(seed)
        again = _descend(search, _elsewhere(tree, effectors, goals[left], rng), goals[left])
        found = _better(found, again, left)
    return Solution(
        found.theta.reshape(*batch, len(tree)),
        found.error.reshape(*batch, len(effectors)),
        found.iterations.reshape(batch),
        found.why.reshape(batch),
    )


def _flat(
    tree: Tree, theta: ArrayLike, effectors: Effectors, targets: ArrayLike
) -> tuple[Array, Array, tuple[int, ...]]:
    """Check θ and targets, and lay the batch out in one row: (b, n), (b, k, 3), its shape."""
    theta, targets = pose(tree, theta), checked_targets(effectors, targets)
    batch = common_batch("theta and targets", theta.shape[:-1], targets.shape[:-2])
    if theta.shape[:-1] != batch or targets.shape[:-2] != batch:
        theta = np.broadcast_to(theta, (*batch, len(tree)))
        targets = np.broadcast_to(targets, (*batch, len(effectors), 3))
    starts = np.minimum(np.maximum(theta, tree.lower), tree.upper)
    return starts.reshape(-1, len(tree)), targets.reshape(-1, len(effectors), 3), batch


@dataclass(frozen=True)
class _Search:
    """What all poses of one call have in common."""

    tree: Tree
    effectors: Effectors
    solver: Solver
    tolerance: float
    most: int
    limits: LimitRule
    max_step: float | None
    cap: Cap
    weights: Array | None  # (3k,)

    def advance(self, theta: Array, frames: Frames, e: Array, J: Array) -> tuple[Array, Mask]:
        """Take one iteration from θ (p, n); tell also which joints a limit stopped."""
        tree, solver, bounds = self.tree, self.solver, Bounds(self.tree, theta)
        if wants(solver):
            here = Here.of(tree, self.effectors, frames, theta, self.limits, bounds)
            solver = situated(solver, here)
        if self.weights is not None:
            J, e = J * self.weights[:, None], e * self.weights
        J.setflags(write=False)  # no solver may change them
        e.setflags(write=False)

        def wish(s: Array | None) -> Array:
            """Ask how joints of mobility s would take e away."""
            dtheta = ask(solver, J, e) if s is None else s * ask(solver, J * s[..., None, :], e)
            if self.max_step is None:
                return dtheta
            return self.cap(dtheta, self.max_step, self.effectors.chains)

        wanted = wish(None if tree.free else tree.mobility)
        return self.limits(bounds, theta, wanted, lambda held, _: wish(tree.mobility * ~held))


@dataclass
class _Pool:
    """The poses that are worked on, p of them, and what is known of each.

    rows    (p,)       its place in the whole batch
    theta   (p, n)     the pose; goals (p, k, 3) its targets
    count   (p,)       iterations so far
    held    (p, n)     which joints a limit stopped in the last one
    best    (p, n)     the best pose so far, with its squared distances (p, k) and their sum (p,)
    mark    (p,)       that sum when it was last asked whether it still falls
    """

    rows: Index
    theta: Array
    goals: Array
    count: Index
    held: Mask
    best: Array
    squares: Array
    least: Array
    mark: Array

    @classmethod
    def of(cls, rows: Index, starts: Array, goals: Array) -> "_Pool":
        """Begin with these rows at their starts."""
        theta, targets, p = starts[rows], goals[rows], len(rows)
        count, held, least = np.zeros(p, np.intp), np.zeros(theta.shape, bool), np.full(p, np.inf)
        squares = np.full(targets.shape[:-1], np.inf)
        return cls(rows, theta, targets, count, held, theta, squares, least, least)

    def remember(self, squares: Array) -> None:
        """Keep the pose where it is the best so far."""
        size = np.add.reduce(squares, axis=-1)
        better = size < self.least
        if np.count_nonzero(better) == len(better):
            self.best, self.squares, self.least = self.theta, squares, size
        else:
            self.best = np.where(better[:, None], self.theta, self.best)
            self.squares = np.where(better[:, None], squares, self.squares)
            self.least = np.where(better, size, self.least)

    def stands_still(self) -> Mask:
        """Tell whose error hardly falls any more, (p,)."""
        still = self.least > (1 - WORTH) * self.mark
        self.mark = self.least
        return still

    def keep(self, those: Mask) -> None:
        """Let the others go."""
        for name, values in vars(self).items():
            setattr(self, name, values[those])

    def join(self, other: "_Pool") -> None:
        """Take the others in."""
        for name, values in vars(self).items():
            setattr(self, name, np.concatenate([values, getattr(other, name)]))


def _row_weights(effectors: Effectors, weights: ArrayLike) -> Array:
    """Check weights, and repeat them for the rows of J, (3k,)."""
    each, k = numbers("weights", weights), len(effectors)
    if each.shape != (k,):
        raise ValueError(f"weights needs one number per effector, ({k},), not {each.shape}")
    if not ((each >= 0) & (each < np.inf)).all():
        raise ValueError(f"weights must be 0 or more, and finite, not {shown(weights)}")
    return each.repeat(3)


def _descend(search: _Search, starts: Array, goals: Array) -> Solution:
    """Search from every start (b, n) for its goals (b, k, 3).

    At most POOL poses are worked on at once; who is done makes room for the next.
    """
    tree, effectors, tolerance, most = (
        search.tree,
        search.effectors,
        search.tolerance,
        search.most,
    )
    b, k = goals.shape[:2]
    out = Solution(
        np.empty_like(starts), np.empty((b, k)), np.empty(b, np.intp), np.empty(b, np.intp)
    )
    waiting = np.arange(b)
    pool, waiting = _Pool.of(waiting[:POOL], starts, goals), waiting[POOL:]
    rounds = 0
    while len(pool.rows):
        frames = forward(tree, pool.theta)
        s = locate(frames, effectors)
        e = pool.goals - s
        squares = np.vecdot(e, e)
        pool.remember(squares)
        rounds += 1
        arrived = np.maximum.reduce(squares, axis=-1) <= tolerance * tolerance
        done = arrived | (pool.count >= most)
        if rounds % PATIENCE == 0:
            done |= pool.stands_still()
        if finished := np.count_nonzero(done):
            _hand_in(out, pool, done if finished < len(done) else slice(None), arrived, most)
            if finished == len(done) == b:
                break
            stay = ~done
            pool.keep(stay)
            frames, e, s = Frames(*(part[stay] for part in frames)), e[stay], s[stay]
        if len(pool.rows):
            J = jacobian(tree, frames, effectors, at=s)
            pool.theta, pool.held = search.advance(pool.theta, frames, e.reshape(len(e), 3 * k), J)
            pool.count = pool.count + 1
        if len(waiting) and (room := POOL - len(pool.rows)):
            pool.join(_Pool.of(waiting[:room], starts, goals))
            waiting = waiting[room:]
    return out


def _hand_in(out: Solution, pool: _Pool, done: Mask | slice, arrived: Mask, most: int) -> None:
    """Write down what was found by those that are done, and why they ended."""
    rows, there = pool.rows[done], arrived[done]
    out.theta[rows] = pool.best[done]
    out.error[rows] = np.sqrt(pool.squares[done])
    out.iterations[rows] = pool.count[done]
    out.why[rows] = ARRIVED
    if np.count_nonzero(there) < len(there):
        stopped = np.where(pool.held[done].any(axis=-1), AT_LIMITS, STILL)
        failed = np.where(pool.count[done] >= most, IMPATIENT, stopped)
        out.why[rows] = np.where(there, ARRIVED, failed)


def _elsewhere(tree: Tree, effectors: Effectors, goals: Array, rng: np.random.Generator) -> Array:
    """Draw DRAWN poses, and take for each of the goals (b, k, 3) the nearest, (b, n)."""
    half = np.where(tree.slide, extent(tree, effectors).radius, np.pi)
    lower = np.where(np.isfinite(tree.lower), tree.lower, np.minimum(tree.rest, tree.upper) - half)
    upper = np.where(np.isfinite(tree.upper), tree.upper, np.maximum(tree.rest, tree.lower) + half)
    swarm = rng.uniform(lower, upper, size=(DRAWN, len(tree)))
    s = locate(forward(tree, swarm), effectors)
    away = np.square(goals[:, None] - s).sum(axis=(-1, -2))  # (b, DRAWN)
    return swarm[away.argmin(axis=-1)]


def _better(found: Solution, again: Solution, rows: Index) -> Solution:
    """Keep the better of both for these rows; iterations add up."""
    won = again.converged | (again.error.max(axis=-1) < found.error[rows].max(axis=-1))
    at = rows[won]
    found.theta[at], found.error[at], found.why[at] = (
        again.theta[won],
        again.error[won],
        again.why[won],
    )
    found.iterations[rows] += again.iterations
    return found
