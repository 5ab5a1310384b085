"""One call to a pose: targets in, and the pose that meets them, or how near it came and why."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ikteach.arrays import Array, ArrayLike, Index, Mask
from ikteach.body import Effectors, Frames, Tree, forward, jacobian, locate
from ikteach.body.extent import extent
from ikteach.body.forward import check_effectors, pose
from ikteach.checks import common_batch, count, function, number, numbers, shown
from ikteach.motion.checks import goals as checked_targets
from ikteach.motion.checks import solver_of, wish_of
from ikteach.motion.here import Here, situated, wants
from ikteach.motion.rules import Bounds, Cap, LimitRule, hold, ignore, whole
from ikteach.motion.wish import beside
from ikteach.solvers import Solver, ask, dls_following
from ikteach.solvers.door import takes_stacks
from ikteach.solvers.stacked import SQUARE, unit

POOL = 128  # poses that are worked on at once: their Jacobians stay in the processor's cache
DRAWN = 24  # poses drawn for each restart; the one nearest to the targets begins
WORTH = 1e-3  # share by which the squared error must fall to count as progress …
PATIENCE = 12  # … at least once in so many iterations
HELPS = 1e-2  # share of the squared error that a joint must be able to take away, to be of help
NOISE = 1e-13  # of the body's size: an error below it has come of rounding

REASONS = (
    "arrived",
    "stands still: no joint helps",
    "at limits: the joints that would help stand at theirs",
    "out of patience: more iterations, another method or another start may help",
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
    wish: ArrayLike | None = None,
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
    wish        a pose (n,) to which joints go on the way, as far as the targets do not feel it

    Leading dimensions are batches: each pose stops when it has arrived, and the others go on.
    ValueError if a shape is wrong or a number not finite; FloatingPointError if the solver's answer
    is not finite. Source: the loop of thesis 5.1 without its clock.
    """
    tolerance, most = number("tolerance", tolerance), count("most", most, least=0)
    restarts, seed = count("restarts", restarts, least=0), count("seed", seed, least=0)
    max_step = None if max_step is None else number("max_step", max_step)
    limits, cap, method = function("limits", limits), function("cap", cap), solver_of(solver)
    starts, goals, batch = _flat(tree, theta, effectors, targets)
    if limits is not ignore:
        starts = np.minimum(np.maximum(starts, tree.lower), tree.upper)
    rows = None if weights is None else _row_weights(effectors, weights)
    plain = batch == () and not takes_stacks(method)
    if (aside := wish_of(tree, wish)) is not None and aside.ndim != 1:
        raise ValueError(f"one pose is wished for, ({len(tree)},), not {aside.shape}")
    rules = tolerance, most, limits, max_step, cap
    search = _Search(tree, effectors, method, *rules, rows, aside, plain)
    found = _descend(search, starts, goals)
    rng: np.random.Generator | None = None
    for _ in range(restarts):
        left = np.flatnonzero(found.why)  # those that have not ARRIVED
        if not len(left):
            break
        rng = rng or np.random.default_rng(seed)
        others = _elsewhere(tree, effectors, starts[left], goals[left], rng)
        again = _descend(search, others, goals[left])
        found = _better(found, again, left)
    return Solution(
        found.theta.reshape(*batch, len(tree)),
        found.error.reshape(*batch, len(effectors)),
        found.iterations.reshape(batch),
        found.why.reshape(batch),
    )


def _flat(
    tree: Tree, theta: ArrayLike | None, effectors: Effectors, targets: ArrayLike
) -> tuple[Array, Array, tuple[int, ...]]:
    """Check θ and targets, and lay the batch out in one row: (b, n), (b, k, 3), its shape."""
    if not isinstance(tree, Tree):
        raise TypeError(f"a Tree is needed here, not {shown(tree)}")
    check_effectors(effectors, len(tree))
    theta = pose(tree, tree.rest if theta is None else theta)
    targets = checked_targets(effectors, targets)
    batch = common_batch("theta and targets", theta.shape[:-1], targets.shape[:-2])
    if theta.shape[:-1] != batch or targets.shape[:-2] != batch:
        theta = np.broadcast_to(theta, (*batch, len(tree)))
        targets = np.broadcast_to(targets, (*batch, len(effectors), 3))
    return theta.reshape(-1, len(tree)), targets.reshape(-1, len(effectors), 3), batch


class _Search(NamedTuple):
    """What all poses of one call have in common.

    weights  (3k,) of the rows of J, or None
    aside    (n,) the pose that is wished for, or None
    plain    whether the solver is asked about one pose as `step` asks it, with no batch around
    """

    tree: Tree
    effectors: Effectors
    solver: Solver
    tolerance: float
    most: int
    limits: LimitRule
    max_step: float | None
    cap: Cap
    weights: Array | None
    aside: Array | None
    plain: bool

    def weighted(self, J: Array, e: Array) -> tuple[Array, Array]:
        """Let targets count by their weights."""
        return (J, e) if self.weights is None else (J * self.weights[:, None], e * self.weights)

    def advance(self, theta: Array, frames: Frames, e: Array, J: Array) -> Array:
        """Take one iteration from θ (p, n), given e (p, 3k) and J (p, 3k, n)."""
        tree, solver, bounds = self.tree, self.solver, Bounds(self.tree, theta)
        if wants(solver):
            each = None if self.weights is None else self.weights[::3]
            look = tree, self.effectors, frames, theta, self.limits, bounds, tree.mobility, each
            here = Here.of(*look)
            solver = situated(solver, here.at(0) if self.plain else here)
        J, e = self.weighted(J, e)
        J.setflags(write=False)  # no solver may change them
        e.setflags(write=False)

        def answer(J: Array) -> Array:
            return ask(solver, J[0], e[0])[None] if self.plain else ask(solver, J, e)

        def wish(s: Array | None) -> Array:
            """Ask how joints of mobility s would take e away."""
            A = J if s is None else J * s[..., None, :]
            dtheta = answer(A)
            if self.aside is not None:
                gap = self.aside - theta
                dtheta = dtheta + beside(A, gap if s is None else gap * (s != 0))
            dtheta = dtheta if s is None else s * dtheta
            if self.max_step is None:
                return dtheta
            return self.cap(dtheta, self.max_step, self.effectors.chains)

        wanted = wish(None if tree.free else tree.mobility)
        return self.limits(bounds, theta, wanted, lambda held, _: wish(tree.mobility * ~held))[0]


@dataclass
class _Pool:
    """The poses that are worked on, p of them, and what is known of each.

    rows    (p,)       its place in the whole batch
    theta   (p, n)     the pose; goals (p, k, 3) its targets
    count   (p,)       iterations so far
    best    (p, n)     the best pose so far, with its squared distances (p, k) and their sum (p,)
    before  (p,)       that sum one iteration ago
    mark    (p,)       that sum when it was last asked whether it still falls
    due     (p,)       the count at which that is asked next
    """

    rows: Index
    theta: Array
    goals: Array
    count: Index
    best: Array
    squares: Array
    least: Array
    before: Array
    mark: Array
    due: Index

    @classmethod
    def of(cls, starts: Array, goals: Array, first: int, last: int, most: int) -> "_Pool":
        """Begin with rows first to last − 1, at their starts."""
        rows, theta, goals = np.arange(first, last), starts[first:last], goals[first:last]
        never = np.full(len(rows), np.inf)
        count, squares = np.zeros(len(rows), np.intp), np.empty(goals.shape[:-1])
        due = count + min(PATIENCE - 1, most)
        return cls(rows, theta, goals, count, theta, squares, never, never, never, due)

    def remember(self, squares: Array) -> None:
        """Keep poses that are the best yet."""
        size = np.add.reduce(squares, axis=-1)
        better = size < self.least
        self.before = self.least
        if np.count_nonzero(better) == len(better):
            self.best, self.squares, self.least = self.theta, squares, size
        else:
            self.best = np.where(better[:, None], self.theta, self.best)
            self.squares = np.where(better[:, None], squares, self.squares)
            self.least = np.where(better, size, self.least)

    def out_of_patience(self, most: int) -> Mask:
        """Tell who took `most` iterations, or hardly improves, (p,)."""
        due = self.count >= self.due
        if not np.count_nonzero(due):
            return due
        still = due & (self.least > (1 - WORTH) * self.mark)
        self.mark = np.where(due, self.least, self.mark)
        self.due = np.where(due, np.minimum(self.due + PATIENCE, most), self.due)
        return still | (self.count >= most)

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
    tree, effectors, most = search.tree, search.effectors, search.most
    b, k = goals.shape[:2]
    out = Solution(np.empty_like(starts), np.empty((b, k)), *np.empty((2, b), np.intp))
    begun = min(b, POOL)
    pool = _Pool.of(starts, goals, 0, begun, most)
    while p := len(pool.rows):
        frames = forward(tree, pool.theta)
        s = locate(frames, effectors)
        e = pool.goals - s
        squares = np.vecdot(e, e)
        done = arrived = np.maximum.reduce(squares, axis=-1) <= search.tolerance**2
        if (finished := np.count_nonzero(arrived)) < p:
            pool.remember(squares)
            done = arrived | pool.out_of_patience(most)
            finished = np.count_nonzero(done)
        if finished:
            those = done if finished < p else slice(None)
            _hand_in(search, out, pool, those, arrived[those], squares[those])
            if finished == p and begun == b:
                break
            stay = ~done
            pool.keep(stay)
            frames, e, s = Frames(*(part[stay] for part in frames)), e[stay], s[stay]
        if finished < p:
            J = jacobian(tree, frames, effectors, at=s)
            pool.theta = search.advance(pool.theta, frames, e.reshape(len(e), 3 * k), J)
            pool.count = pool.count + 1
        if finished and begun < b:
            last = min(b, begun + finished)
            pool.join(_Pool.of(starts, goals, begun, last, most))
            begun = last
    return out


def _hand_in(
    search: _Search, out: Solution, pool: _Pool, done: Mask | slice, arrived: Mask, squares: Array
) -> None:
    """Write down what was found by those that are done, and why they ended.

    Of those, arrived (p,) are where they wanted to be, and squares (p, k) their squared distances.
    """
    rows, theta = pool.rows[done], pool.theta[done]
    why: Index | int = ARRIVED
    if np.count_nonzero(arrived) < len(arrived):
        best, least = pool.best[done], pool.least[done]
        falling = (pool.count[done] > 0) & (least < (1 - WORTH) * pool.before[done])
        failed = np.where(falling, IMPATIENT, _why_not(search, best, pool.goals[done]))
        why = np.where(arrived, ARRIVED, failed)
        there = arrived[:, None]
        theta = np.where(there, theta, best)
        squares = np.where(there, squares, pool.squares[done])
    out.theta[rows] = theta
    out.error[rows] = np.sqrt(squares)
    out.iterations[rows] = pool.count[done]
    out.why[rows] = why


def _why_not(search: _Search, theta: Array, goals: Array) -> Index:
    """Say why poses came no nearer, as places in `REASONS`.

    They are θ (p, n), and their goals (p, k, 3).
    A joint alone can take the share cos² of ‖e‖² away, of the angle between its column of J and e;
    the share has no unit.
    """
    tree, frames = search.tree, forward(search.tree, theta)
    s = locate(frames, search.effectors)
    J, e = search.weighted(
        jacobian(tree, frames, search.effectors, at=s), (goals - s).reshape(len(s), -1)
    )
    columns, way = unit(J.mT), unit(e)
    along = np.matvec(columns, way)  # J_j · e
    share = along * along / np.maximum(np.square(columns).sum(axis=-1), SQUARE)
    share = share / np.maximum(np.vecdot(way, way), SQUARE)[:, None]
    noise = NOISE * np.maximum(abs(frames.positions), abs(s).max(axis=-2, keepdims=True))
    matters = abs(e).max(axis=-1) > noise.max(axis=(-1, -2))
    helps = (share > HELPS) & (tree.mobility > 0) & matters[:, None]
    blocked = np.where(along > 0, theta >= tree.upper, theta <= tree.lower)
    if search.limits is ignore:
        blocked[:] = False
    stopped = np.where(helps.any(axis=-1), AT_LIMITS, STILL)
    return np.where((helps & ~blocked).any(axis=-1), IMPATIENT, stopped)


def _elsewhere(
    tree: Tree, effectors: Effectors, starts: Array, goals: Array, rng: np.random.Generator
) -> Array:
    """Draw poses, and take the nearest to each goal.

    DRAWN are drawn for all of the goals (b, k, 3), of which each gets one, (b, n).

    Joints that are locked, or that move no effector, stay where they are in starts (b, n).
    """
    half = np.where(tree.slide, extent(tree, effectors).radius, np.pi)
    lower = np.where(np.isfinite(tree.lower), tree.lower, np.minimum(tree.rest, tree.upper) - half)
    upper = np.where(np.isfinite(tree.upper), tree.upper, np.maximum(tree.rest, tree.lower) + half)
    swarm = rng.uniform(lower, upper, size=(DRAWN, len(tree)))
    s = locate(forward(tree, swarm), effectors)
    away = np.square(goals[:, None] - s).sum(axis=(-1, -2))  # (b, DRAWN)
    moves = (tree.mobility > 0) & effectors.carried.any(axis=0)
    return np.where(moves, swarm[away.argmin(axis=-1)], starts)


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
