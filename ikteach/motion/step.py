"""One tick: targets in, a new pose out. What stands around the solver, the same for every method.

Each rule (what a cap shortens, what a limit does) is a function that is handed in.
"""

from collections.abc import Callable, Mapping
from math import radians
from typing import NamedTuple

import numpy as np

from ikteach.arrays import Array, ArrayLike, Index, Mask, finite
from ikteach.body import Effectors, Frames, Tree, forward, jacobian, locate
from ikteach.body.forward import fits, not_finite, pose
from ikteach.checks import function, shown, together
from ikteach.checks import numbers as numbers  # for those who import it from here
from ikteach.solvers import SOLVERS, Solver, ask

# The step caps of Buss's code [rad]; SDLS bounds its own step. The thesis describes the one of the
# pseudoinverse (4.4.2). Caps that differ make an unfair race.
BUSS_CAPS: Mapping[str, float | None] = {
    "transpose": radians(30),
    "pseudoinverse": radians(5),
    "dls": radians(45),
    "sdls": None,
}

TINY = 1e-150  # keeps 0 / 0 away where nothing moves

Cap = Callable[[Array, ArrayLike, Index], Array]
Again = Callable[[Mask, Array], Array]
LimitRule = Callable[["Bounds", Array, Array, Again], tuple[Array, Mask]]


class Bounds(NamedTuple):
    """Where each joint may be at the end of this tick, (..., n) or (n,) [rad]."""

    lower: Array
    upper: Array

    def clip(self, theta: Array) -> Array:
        """θ (..., n), put back into the bounds where it is outside."""
        return np.minimum(np.maximum(theta, self.lower), self.upper)


class Step(NamedTuple):
    """What one tick did.

    theta   (..., n)      the new pose [rad]: finite, and where θ was within the limits, within them
                          (unless they are ignored)
    e       (..., 3k)     t − s before the step, not clamped [m]
    J       (..., 3k, n)  the Jacobian that the step is taken with [m/rad]
    wanted  (..., n)      what the solver asked for, before cap and limits [rad]
    dtheta  (..., n)      what was done [rad]
    capped  (...)         True where the cap shortened the step, or the way back of a joint that
                          was beyond its limits
    held    (..., n)      True where a limit stopped a joint, or brought it back
    """

    theta: Array
    e: Array
    J: Array
    wanted: Array
    dtheta: Array
    capped: Mask
    held: Mask


def whole(dtheta: Array, max_step: ArrayLike, chains: Index) -> Array:
    """Shorten the whole step so that no joint turns further than max_step (Buss; thesis 4.4.2).

    The direction stays, but one hand that cannot reach its target slows all four limbs.
    """
    peak = np.maximum(abs(dtheta).max(axis=-1), TINY)
    return dtheta * np.minimum(1, max_step / peak)[..., None]


def per_chain(dtheta: Array, max_step: ArrayLike, chains: Index) -> Array:
    """Shorten each independent chain (`Effectors.chains`) by itself."""
    shortened = dtheta.copy()
    for chain in np.unique(chains):
        joints = chains == chain
        shortened[..., joints] = whole(dtheta[..., joints], max_step, chains)
    return shortened


def ignore(bounds: Bounds, theta: Array, dtheta: Array, again: Again) -> tuple[Array, Mask]:
    """Let the joints turn past their limits, as in Buss's code."""
    to = theta + dtheta
    return to, np.zeros(to.shape, dtype=bool)


def clip(bounds: Bounds, theta: Array, dtheta: Array, again: Again) -> tuple[Array, Mask]:
    """Put a joint that passed its limit back to it, after the solve (thesis 5.1.1).

    What the solver meant the other joints to add is then wrong: this alone ruins the pseudoinverse.
    """
    wished = theta + dtheta
    to = bounds.clip(wished)
    return to, to != wished


def hold(bounds: Bounds, theta: Array, dtheta: Array, again: Again) -> tuple[Array, Mask]:
    """Hold the joints that stand at a limit and would cross it, and let the others step again.

    A joint beyond its limit, that does not come back by itself, is held to its way back.
    """
    to, stopped = clip(bounds, theta, dtheta, again)
    if not np.count_nonzero(stopped):
        return to, stopped
    held, home = np.zeros(to.shape, dtype=bool), bounds.clip(theta)
    while (crossing := stopped & (to == home) & ~held).any():
        held |= crossing
        to, stopped = clip(bounds, theta, again(held, home), again)
    return to, held | stopped


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
    frames: Frames | None = None,
) -> Step:
    """Move the pose θ (..., n) by one step of `solver` towards targets (..., k, 3) [m].

    solver      a function of (J, e), or the name of one of `SOLVERS`
    max_error   D [m], one number or (..., k): each e_i is shortened to D_i before the solve
    max_step    [rad], one number or (...): no joint turns further in one step
    cap         what is shortened to that: the `whole` step, or each chain by itself (`per_chain`)
    mobility    s (..., n), 0 locked .. 1 free, in place of the tree's: Δθ = s ∘ solver(J ∘ s, e)
    limits      what happens at a limit: `hold`, `clip` or `ignore`
    at_targets  form J at the targets in place of the effectors (thesis 3.2)
    frames      forward(tree, theta), from whoever has it already

    Where promises meet, the first of these is kept:
    1. a locked joint (mobility 0) does not move;
    2. no joint turns further than max_step;
    3. a joint within its limits stays there, and one that is beyond comes back, at once or as far
       as 2 lets it, and never goes further out (unless limits are ignored);
    4. the joints turn as the solver asks.

    ValueError if a shape is wrong or a number not finite; LookupError for an unknown method;
    FloatingPointError if the solver's answer is not finite. Order of one tick: see MATHS; Buss.
    """
    theta = numbers("theta", theta)
    if frames is None:
        frames = forward(tree, theta)  # which checks θ
    elif isinstance(frames, Frames) and frames.positions.shape != (*pose(tree, theta).shape, 3):
        raise ValueError(f"frames are of poses {frames.positions.shape[:-1]}, not {theta.shape}")
    s = locate(frames, effectors)
    targets = goals(effectors, targets)
    solver = solver_of(solver)
    max_step, max_error = _bound("max_step", max_step), _bound("max_error", max_error)
    if max_error is not None and max_error.shape[-1:] not in ((), (1,), (len(effectors),)):
        shape = f"(..., {len(effectors)})"
        raise ValueError(f"max_error needs one number, or {shape}, not {max_error.shape}")
    if not (callable(limits) and callable(cap)):
        function("limits", limits)
        function("cap", cap)
    free = tree.mobility if mobility is None else _checked_mobility(tree, mobility)
    batch = _batch(theta, targets, free, max_step, max_error)

    J = jacobian(tree, frames, effectors, at=targets if at_targets else s)
    e = aim = _stacked(targets - s)
    if max_error is not None:
        aim = _stacked(clamp_error(targets - s, max_error))
        aim.setflags(write=False)
    J.setflags(write=False)  # no solver may change them
    e.setflags(write=False)
    shortened = np.zeros(batch, dtype=bool)

    def ask_for(s: Array, e: Array) -> Array:
        """What the solver wants of joints with mobility s, to take e away."""
        if s is tree.mobility and tree.free:
            return ask(solver, J, e)
        return s * ask(solver, J * s[..., None, :], e)

    def capped(wanted: Array) -> Array:
        nonlocal shortened
        if max_step is None:
            return wanted
        dtheta = cap(wanted, max_step, effectors.chains)
        shortened = (dtheta != wanted).any(axis=-1)
        return dtheta

    def again(held: Mask, home: Array) -> Array:
        """The step in which held joints go home, and the others take what is then left of e."""
        way = np.where(held, home - theta, 0)
        left = aim - np.matvec(J, way) if np.count_nonzero(way) else aim
        return way + capped(ask_for(free * ~held, left))

    wanted = ask_for(free, aim)
    if wanted.ndim <= len(batch):  # there is a cap for each of a batch
        wanted = np.broadcast_to(wanted, (*batch, len(tree)))
    bounds = _bounds(tree, theta, free, max_step)
    to, held = limits(bounds, theta, capped(wanted), again)
    if max_step is not None and np.count_nonzero(held):
        beyond = (to < tree.lower) | (to > tree.upper)  # it would be back but for the cap
        shortened = shortened | (beyond & held & (free != 0)).any(axis=-1)
    return Step(to, e, J, wanted, to - theta, np.asarray(shortened), held)


def _batch(
    theta: Array, targets: Array, free: Array, max_step: Array | None, max_error: Array | None
) -> tuple[int, ...]:
    """The batch of all that is given; ValueError if its parts do not fit together."""
    if max_step is None and max_error is None and theta.ndim == free.ndim == targets.ndim - 1 == 1:
        return ()  # one pose, the common case
    batches = [theta.shape[:-1], targets.shape[:-2], free.shape[:-1]]
    if max_step is not None:
        batches.append(max_step.shape)
    if max_error is not None:
        batches.append(max_error.shape[:-1])
    return together("theta, targets, mobility, max_step and max_error", *batches)


def _bounds(tree: Tree, theta: Array, free: Array, max_step: Array | None) -> Bounds:
    """The limits; for a joint that is beyond one, from there to as near to it as it may turn."""
    locked = not (free is tree.mobility and tree.free) and np.count_nonzero(free) < free.size
    if max_step is None and not locked:
        return Bounds(tree.lower, tree.upper)
    far = np.array(np.inf) if max_step is None else max_step
    reach = np.where(free == 0, 0, far[..., None]) if locked else far[..., None]
    return Bounds(np.minimum(tree.lower, theta + reach), np.maximum(tree.upper, theta - reach))


def _stacked(e: Array) -> Array:
    """(..., k, 3) to (..., 3k)."""
    return e.reshape(*e.shape[:-2], 3 * e.shape[-2])


def clamp_error(e: Array, max_error: ArrayLike) -> Array:
    """Each error e_i (..., k, 3) shortened to length max_error, one number or (..., k) [m]."""
    length = np.maximum(np.sqrt(np.vecdot(e, e)), TINY)
    return e * np.minimum(1, max_error / length)[..., None]


def solver_of(solver: Solver | str) -> Solver:
    """The solver itself, or the one that is called so; LookupError for an unknown name."""
    if isinstance(solver, str):
        return SOLVERS[solver]
    if not callable(solver):
        raise TypeError(f"a solver is a function of (J, e) or a name, not {shown(solver)}")
    return solver


def checked(
    tree: Tree, theta: ArrayLike, effectors: Effectors, targets: ArrayLike
) -> tuple[Array, Array]:
    """θ and targets as arrays, if their shapes fit and their numbers are finite."""
    theta = pose(tree, theta)
    fits(effectors, forward(tree, tree.rest))
    return theta, goals(effectors, targets)


def goals(effectors: Effectors, targets: ArrayLike) -> Array:
    """Targets (..., k, 3) as an array, if there is a finite one per effector."""
    targets, k = numbers("targets", targets), len(effectors)
    if targets.shape[-2:] != (k, 3):
        needs = "1 effector needs" if k == 1 else f"{k} effectors need"
        hint = "; a target is a point, and no pose" if targets.shape[-2:] == (4, 4) else ""
        raise ValueError(f"{needs} targets of shape (..., {k}, 3), not {targets.shape}{hint}")
    if not finite(targets):
        culprit = not_finite(targets.swapaxes(-1, -2), effectors.names)
        raise ValueError(f"the target of {culprit} is not finite")
    return targets


def _bound(name: str, bound: ArrayLike | None) -> Array | None:
    """A bound that is 0 or more, or none."""
    if bound is None:
        return None
    array = numbers(name, bound)
    if not (array >= 0).all():
        raise ValueError(f"{name} must be 0 or more, not {shown(bound)}")
    return array


def _checked_mobility(tree: Tree, mobility: ArrayLike) -> Array:
    s = numbers("mobility", mobility)
    if s.shape[-1:] != (len(tree),):
        raise ValueError(f"mobility needs one number per joint, ({len(tree)},), not {s.shape}")
    bad = ~((s >= 0) & (s <= 1))
    if bad.any():
        culprit = tree.names[int(np.argwhere(bad)[0][-1])]
        raise ValueError(f"the mobility of {shown(culprit)} must be from 0 to 1")
    return s
