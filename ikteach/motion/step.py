"""One tick: targets in, a new pose out. All around the solver is the same for every method.

Each rule (how a cap shortens, how a limit stops) is a function that is handed in (`rules`).
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ikteach.arrays import Array, ArrayLike, Index, Mask
from ikteach.body import Effectors, Frames, Tree, jacobian, locate
from ikteach.checks import function, numbers
from ikteach.motion.checks import (
    batch_of,
    bound,
    error_bound,
    frames_of,
    goals,
    mobility_of,
    solver_of,
    weights_of,
    wish_of,
)
from ikteach.motion.here import Here, situated, wants
from ikteach.motion.rules import Bounds, Cap, LimitRule, clamp_error, hold, whole
from ikteach.motion.wish import beside
from ikteach.solvers import Solver, ask


class Step(NamedTuple):
    """The outcome of one tick.

    theta   (..., n)      the new pose [rad]: finite, and where θ was within the limits, within them
                          (unless they are ignored)
    e       (..., 3k)     t − s before the step, not clamped [m]
    J       (..., 3k, n)  the Jacobian that the step is taken with [m/rad]
    wanted  (..., n)      the solver's answer, before cap and limits [rad]
    dtheta  (..., n)      the step that was taken [rad]
    capped  (...)         True where the cap shortened the step, or the way back of a joint that
                          was beyond its limits
    held    (..., n)      True where a limit stopped a joint, or brought it back
    aim     (..., 3k)     e as the solver was given it: shortened to max_error [m]
    allowed (..., n)      wanted after the cap [rad]
    mobility (n,)         s that the step was taken with; (..., n) where it was given so
    weights (k,)          of the targets; (..., k) where they were given so
    """

    theta: Array
    e: Array
    J: Array
    wanted: Array
    dtheta: Array
    capped: Mask
    held: Mask
    aim: Array
    allowed: Array
    mobility: Array
    weights: Array


def step(
    tree: Tree,
    theta: ArrayLike,
    effectors: Effectors,
    targets: ArrayLike,
    solver: Solver | str,
    *,
    max_error: ArrayLike | None = None,
    max_step: ArrayLike | None = None,
    cap: Cap = whole,
    mobility: ArrayLike | None = None,
    limits: LimitRule = hold,
    at_targets: bool = False,
    weights: ArrayLike | None = None,
    wish: ArrayLike | None = None,
    frames: Frames | None = None,
) -> Step:
    """Move the pose θ (..., n) by one step of `solver` towards targets (..., k, 3) [m].

    solver      a function of (J, e), or the name of one of `SOLVERS`
    max_error   D [m], one number or (..., k): each e_i is shortened to D_i before the solve
    max_step    [rad], one number or (...): no joint turns further in one step
    cap         shortens the `whole` step to that, or each chain by itself (`per_chain`)
    mobility    s (..., n), 0 locked .. 1 free, in place of the tree's: Δθ = s ∘ solver(J ∘ s, e)
    limits      the rule at a limit: `hold`, `clip` or `ignore`
    at_targets  form J at the targets in place of the effectors (thesis 3.2)
    weights     (..., k), 0 or more: the solver is given w_i J_i and w_i e_i, so that where targets
                contradict each other the heavier is met more nearly
    wish        a pose (..., n) to which joints go as far as the targets do not feel it (`wish`)
    frames      forward(tree, theta), from whoever has it already

    Where promises meet, the first of these is kept:
    1. a locked joint (mobility 0) does not move;
    2. no joint turns further than max_step;
    3. a joint within its limits stays there, and one that is beyond comes back, at once or as far
       as 2 lets it, and never goes further out (unless limits are ignored);
    4. the joints turn as the solver asks;
    5. and beside that towards the wish.

    ValueError if a shape is wrong or a number not finite; LookupError for an unknown method;
    FloatingPointError if the solver's answer is not finite. Order of one tick: Buss.
    """
    theta = numbers("theta", theta)
    frames = frames_of(tree, theta, frames)
    s = locate(frames, effectors)
    targets, solver = goals(effectors, targets), solver_of(solver)
    max_step, max_error = bound("max_step", max_step), error_bound(effectors, max_error)
    cap, limits = function("cap", cap), function("limits", limits)
    free = tree.mobility if mobility is None else mobility_of(tree, mobility)
    weights, wish = weights_of(effectors, weights), wish_of(tree, wish)
    batch = batch_of(theta, targets, free, max_step, max_error, weights, wish)

    J = jacobian(tree, frames, effectors, at=targets if at_targets else s)
    e = _stacked(targets - s)
    aim = e if max_error is None else _stacked(clamp_error(targets - s, max_error))
    for array in (J, e, aim):  # no solver may change them
        array.setflags(write=False)
    all_free = free is tree.mobility and tree.free
    asked = (solver, theta, J, aim, free, all_free, max_step, cap, effectors.chains, weights, wish)
    question = _Question(*asked)
    bounds = Bounds(tree, theta, question.turn())
    if wants(solver):
        here = Here.of(tree, effectors, frames, theta, limits, bounds, free, weights)
        question.solver = situated(solver, here)
    wanted = question.answer(free, aim)
    if wanted.ndim <= len(batch):  # there is a cap for each of a batch
        wanted = np.broadcast_to(wanted, (*batch, len(tree)))
    allowed = question.shorten(wanted)
    to, held = limits(bounds, theta, allowed, question.again)
    capped = np.zeros(batch, dtype=bool) if question.capped is None else question.capped
    if max_step is not None and np.count_nonzero(held):
        beyond = (to < tree.lower) | (to > tree.upper)  # it would be back but for the cap
        capped = capped | (beyond & held & (free != 0)).any(axis=-1)
    capped, each = np.asarray(capped), effectors.alike if weights is None else weights
    return Step(to, e, J, wanted, to - theta, capped, held, aim, allowed, free, each)


@dataclass
class _Question:
    """The question of one tick to a solver; a limit rule may ask it again."""

    solver: Solver
    theta: Array
    J: Array
    aim: Array
    free: Array
    all_free: bool
    max_step: Array | None
    cap: Cap
    chains: Index
    weights: Array | None
    wish: Array | None
    capped: Mask | None = None  # where the cap shortened the last answer

    def answer(self, s: Array, e: Array) -> Array:
        """Ask how joints with mobility s would take e away: s ∘ solver(J ∘ s, e)."""
        J = self.J
        as_it_is = s is self.free and self.all_free
        if self.weights is not None:
            w = np.repeat(self.weights, 3, axis=-1)
            J, e = w[..., None] * J, w * e
        if not as_it_is:
            J = J * s[..., None, :]
        dtheta = ask(self.solver, J, e)
        if self.wish is not None:
            dtheta = dtheta + beside(J, (self.wish - self.theta) * (s != 0))
        return dtheta if as_it_is else s * dtheta

    def shorten(self, wanted: Array) -> Array:
        """Apply the cap."""
        if self.max_step is None:
            return wanted
        dtheta = self.cap(wanted, self.max_step, self.chains)
        self.capped = (dtheta != wanted).any(axis=-1)
        return dtheta

    def again(self, held: Mask, home: Array) -> Array:
        """Step again with the joints that are not held.

        Held joints go home, and the others take the part of e that is then left.
        """
        way = np.where(held, home - self.theta, 0)
        left = self.aim - np.matvec(self.J, way) if np.count_nonzero(way) else self.aim
        return way + self.shorten(self.answer(self.free * ~held, left))

    def turn(self) -> Array | None:
        """Return the largest turn of each joint [rad].

        It is for this tick; None for any way.
        """
        locked = not self.all_free and np.count_nonzero(self.free) < self.free.size
        if self.max_step is None and not locked:
            return None
        far = np.array([np.inf]) if self.max_step is None else self.max_step[..., None]
        return np.where(self.free == 0, 0, far) if locked else far


def _stacked(e: Array) -> Array:
    """(..., k, 3) to (..., 3k)."""
    return e.reshape(*e.shape[:-2], 3 * e.shape[-2])
