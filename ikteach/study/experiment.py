"""Chapter 8. Runs made to be compared: from many poses at once, at any rate, counted fairly."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from math import radians
from time import perf_counter
from typing import Any, NamedTuple

import numpy as np

from ikteach.arrays import Array, ArrayLike, Index
from ikteach.body import Effectors, Tree, forward, jacobian, locate
from ikteach.body.tree import GROUND
from ikteach.checks import count as whole_number
from ikteach.checks import number, numbers, shown
from ikteach.motion.checks import checked
from ikteach.motion.live.log import of_run
from ikteach.motion.methods import Methods, methods_of
from ikteach.motion.rules import Cap, whole
from ikteach.motion.solve import solve
from ikteach.motion.step import step
from ikteach.motion.track import Track
from ikteach.solvers import SOLVERS, Solver, name_of, transpose

SMALL = radians(0.1)  # [rad]; a joint that turns less in a frame counts as standing


def capped(solver: Solver, max_step: float | None, chains: Index, cap: Cap = whole) -> Solver:
    """Shorten the step of `solver` to max_step [rad] by `cap`.

    None leaves it as it is. For races in which each method has a cap of its own. `Effectors.chains`
    are the chains.
    """

    def shortened(J: Array, e: Array) -> Array:
        dtheta = solver(J, e)
        return dtheta if max_step is None else cap(dtheta, max_step, chains)

    shortened.__name__ = name_of(solver)
    return shortened


class Downhill(NamedTuple):
    """Promise and effect of a transpose step, per gain (g,).

    promised  (g,)  ‖e − gain α JJᵀe‖², by the linear model [m²]
    actual    (g,)  ‖e‖² at θ + gain α Jᵀe [m²]
    """

    promised: Array
    actual: Array


def downhill(
    tree: Tree, effectors: Effectors, theta: ArrayLike, targets: ArrayLike, gains: ArrayLike
) -> Downhill:
    """Measure the squared error along the transpose's step.

    From θ (n,) to targets (k, 3), for gains (g,). Limits are not asked.
    """
    (theta, goal), gains = checked(tree, theta, effectors, targets), numbers("gains", gains)
    if theta.ndim != 1 or goal.ndim != 2 or gains.ndim != 1:
        shapes = theta.shape, goal.shape, gains.shape
        raise ValueError(f"theta (n,), targets (k, 3) and gains (g,) are wanted, not {shapes}")
    gains = gains[:, None]
    frames = forward(tree, theta)
    e = np.ravel(goal - locate(frames, effectors))
    J = jacobian(tree, frames, effectors)
    dtheta = transpose(J, e)
    left = goal - locate(forward(tree, theta + gains * dtheta), effectors)
    return Downhill(
        np.square(e - gains * (J @ dtheta)).sum(axis=-1), np.square(left).sum(axis=(-1, -2))
    )


def starts(tree: Tree, count: int, *, spread: float = 0.5, seed: int = 0) -> Array:
    """Draw poses at random, the rest pose first: (count, n) [rad].

    Equal seeds give equal poses. Each joint turns from rest towards one of its limits, at most by
    the share `spread` of the way, from 0 to 1. A hinge's way is half a turn at most; that of a
    slide without a limit is as long as all links of the body.
    """
    count, spread = whole_number("count", count, least=0), number("spread", spread)
    if spread > 1:
        raise ValueError(f"spread is a share of the way to the limits, from 0 to 1, not {spread}")
    rng = np.random.default_rng(seed)
    links = np.linalg.norm(tree.offsets[tree.parents != GROUND], axis=-1).sum()
    down, up = tree.rest - tree.lower, tree.upper - tree.rest
    down, up = (
        np.where(tree.slide, np.where(np.isinf(way), links, way), np.minimum(way, np.pi))
        for way in (down, up)
    )
    share = rng.uniform(-spread, spread, size=(count, len(tree)))
    share[:1] = 0
    theta = tree.rest + share * np.where(share < 0, down, up)
    return np.minimum(np.maximum(theta, tree.lower), tree.upper)


def nearby(theta: ArrayLike, count: int = 40, *, apart: float = 1e-12, seed: int = 0) -> Array:
    """Make poses that hardly differ from θ (n,): (count, n) [rad].

    No angle differs from that of θ by more than `apart` [rad]. If runs from them come to different
    things, they are chaotic: rounding decides, and a single one says nothing. Tell such runs by
    their median and spread (`ikteach.study.many`). Equal seeds give equal poses.
    """
    nudge = np.random.default_rng(seed).uniform(-apart, apart, size=(count, np.size(theta)))
    nudge[:1] = 0
    return np.asarray(theta, dtype=float) + nudge


def reversals(run: Track) -> Array:
    """Count how often a joint turns back, (...) [1/s].

    On average over joints and time. A reversal is a frame in which a joint turns against its turn
    of the frame before, by more than 0.1° both times. A joint that swings once a second has two a
    second.
    """
    of_run(run)
    before = np.broadcast_to(run.start, run.theta.shape[1:])[None]
    turn = np.diff(np.concatenate([before, run.theta]), axis=0)
    moving = abs(turn) > SMALL
    back = (turn[1:] * turn[:-1] < 0) & moving[1:] & moving[:-1]
    elapsed = run.times[-1] - run.times[0]
    return back.sum(axis=0).mean(axis=-1) / elapsed if elapsed else np.zeros(run.theta.shape[1:-1])


def circle(
    times: ArrayLike, *, centre: ArrayLike = (2.4, 0.0, 0.0), radius: float = 0.8, turn: float = 2.0
) -> Array:
    """Lead a target round a circle at times (T,) [s]: (T, 1, 3) [m].

    The plane is z = const, and `turn` the time of one round [s]. With the arm of 3 m a quarter of
    this one is out of reach.
    """
    times, centre, turn = numbers("times", times), numbers("centre", centre), number("turn", turn)
    radius = number("radius", radius)
    if times.ndim != 1 or centre.shape != (3,) or not turn:
        raise ValueError("a circle has times (T,), a centre (3,) and a turn longer than 0 s")
    phase = 2 * np.pi * times[:, None] / turn
    way = np.stack([np.cos(phase), np.sin(phase), np.zeros_like(phase)], axis=-1)
    return np.asarray(centre + radius * way)


@dataclass(frozen=True)
class Round:
    """One target on a `circle`, as a motion for `trials`.

    centre (3,) and radius [m]; turn, the time of one round [s]
    """

    centre: Sequence[float] = (2.4, 0.0, 0.0)
    radius: float = 0.8
    turn: float = 2.0

    def __call__(self, T: ArrayLike) -> Array:
        """Find the target at times T (T,) [s], (T, 1, 3) [m]."""
        return circle(T, centre=self.centre, radius=self.radius, turn=self.turn)

    def at(self, phase: ArrayLike) -> Array:
        """Find the target at phases (p,) [rad], (p, 1, 3) [m]."""
        return circle(phase, centre=self.centre, radius=self.radius, turn=2 * np.pi)


def iterations(
    tree: Tree,
    effectors: Effectors,
    targets: ArrayLike,
    solver: Solver | str,
    *,
    theta: ArrayLike | None = None,
    within: float = 0.01,
    most: int = 500,
    **options: Any,
) -> Array:
    """Count the steps until every effector reaches its target: (...).

    targets (..., k, 3) are reached `within` some metres. Infinite where `most` steps are not
    enough, or bring it no nearer. `options` go to `solve`.
    """
    near = number("within", within)
    found = solve(
        tree, effectors, targets, solver, theta=theta, tolerance=near, most=most, **options
    )
    return np.where(found.converged, found.iterations, np.inf)


def arrivals(
    tree: Tree,
    effectors: Effectors,
    solver: Solver | str,
    *,
    poses: int = 20,
    most: int = 300,
    spread: float = 0.3,
    within: float = 0.01,
    **options: Any,
) -> Array:
    """Count `iterations` to targets that can be reached, (poses,).

    From as many poses to targets that other poses of the body meet. The poses are the same at every
    call.
    """
    theta = starts(tree, poses + 1, spread=spread)[1:]
    other = starts(tree, poses + 1, spread=spread, seed=1)[1:]
    goals = locate(forward(tree, other), effectors)
    return iterations(
        tree, effectors, goals, solver, theta=theta, most=most, within=within, **options
    )


def step_times(
    tree: Tree,
    effectors: Effectors,
    targets: ArrayLike,
    methods: Methods = SOLVERS,
    *,
    rounds: int = 15,
    **options: Any,
) -> dict[str, float]:
    """Time one step of each method [s], on targets (T, k, 3).

    From the rest pose. The methods take turns, round by round, so that what else the machine does
    falls on all alike; the quickest round counts, which it disturbed least.
    """
    pose, goals = checked(tree, tree.rest, effectors, targets)
    if goals.ndim != 3 or not len(goals):
        raise ValueError(f"targets over time have shape (T, k, 3), not {shown(goals.shape)}")
    named = methods_of(methods)

    def steps(solver: Solver) -> None:
        theta = pose
        for goal in goals:
            theta = step(tree, theta, effectors, goal, solver, **options).theta

    each = {name: partial(steps, solver) for name, solver in named.items()}
    seconds = turns(each, whole_number("rounds", rounds))
    return {name: float(times.min()) / len(goals) for name, times in seconds.items()}


def turns(calls: Mapping[Any, Callable[[], Any]], rounds: int = 15) -> dict[Any, Array]:
    """Time calls that take turns, {name: (rounds,)} [s].

    What else the machine does falls on all alike: compare them round by round.
    """
    seconds = {name: np.empty(rounds) for name in calls}
    for i in range(rounds):
        for name, call in calls.items():
            began = perf_counter()
            call()
            seconds[name][i] = perf_counter() - began
    return seconds
