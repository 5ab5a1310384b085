"""One tick: targets in, a new pose out. What stands around the solver, the same for every method.

Each rule (what a cap shortens, what a limit does) is a function that is handed in.
"""

from collections.abc import Callable, Mapping
from math import radians
from typing import NamedTuple

import numpy as np

from ikteach.arrays import Array, ArrayLike, Index, Mask, finite
from ikteach.body import Effectors, Frames, Tree, forward, jacobian, locate
from ikteach.solvers import SOLVERS, Solver, name_of

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
Again = Callable[[Mask], Array]
LimitRule = Callable[[Tree, Array, Array, Again], tuple[Array, Mask]]


class Step(NamedTuple):
    """What one tick did.

    theta   (..., n)      the new pose [rad]: finite and, unless limits are ignored, within them
    e       (..., 3k)     t − s before the step, not clamped [m]
    J       (..., 3k, n)  the Jacobian that the step is taken with [m/rad]
    wanted  (..., n)      what the solver asked for, before cap and limits [rad]
    dtheta  (..., n)      what was done [rad]
    capped  (...)         True where the cap shortened the step
    held    (..., n)      True where a joint was stopped by its limit
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


def ignore(tree: Tree, theta: Array, dtheta: Array, again: Again) -> tuple[Array, Mask]:
    """Let the joints turn past their limits, as in Buss's code."""
    to = theta + dtheta
    return to, np.zeros(to.shape, dtype=bool)


def clip(tree: Tree, theta: Array, dtheta: Array, again: Again) -> tuple[Array, Mask]:
    """Put a joint that passed its limit back to it, after the solve (thesis 5.1.1).

    What the solver meant the other joints to add is then wrong: this alone ruins the pseudoinverse.
    """
    wished = theta + dtheta
    to = np.minimum(np.maximum(wished, tree.lower), tree.upper)
    return to, to != wished


def hold(tree: Tree, theta: Array, dtheta: Array, again: Again) -> tuple[Array, Mask]:
    """Hold the joints that stand at a limit and would cross it, and let the others step again."""
    to, stopped = clip(tree, theta, dtheta, again)
    if not np.count_nonzero(stopped):
        return to, stopped
    held = np.zeros(to.shape, dtype=bool)
    while (crossing := stopped & (to == theta) & ~held).any():
        held |= crossing
        to, stopped = clip(tree, theta, again(held), again)
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

    ValueError if a shape is wrong or a number not finite; LookupError for an unknown method;
    FloatingPointError if the solver's answer is not finite. Order of one tick: see MATHS; Buss.
    """
    theta, targets = checked(tree, theta, effectors, targets)
    function = solver_of(solver)
    max_step, max_error = _bound("max_step", max_step), _bound("max_error", max_error)
    if max_error is not None and max_error.shape[-1:] not in ((), (1,), (len(effectors),)):
        shape = f"(..., {len(effectors)})"
        raise ValueError(f"max_error needs one number, or {shape}, not {max_error.shape}")
    for name, rule in (("limits", limits), ("cap", cap)):
        if not callable(rule):
            raise TypeError(f"{name} must be a function, not {rule!r}")
    free = tree.mobility if mobility is None else _checked_mobility(tree, mobility)

    if frames is None:
        frames = forward(tree, theta)
    elif frames.positions.shape != (*theta.shape, 3):
        raise ValueError(f"frames are of poses {frames.positions.shape[:-1]}, not {theta.shape}")
    s = locate(frames, effectors)
    J = jacobian(tree, frames, effectors, at=targets if at_targets else s)
    e = _stacked(targets - s)
    aim = e if max_error is None else _stacked(clamp_error(targets - s, max_error))

    def ask(s: Array) -> Array:
        """What the solver wants of joints with mobility s."""
        dtheta: Array = s * function(J * s[..., None, :], aim)
        if not finite(dtheta):
            raise FloatingPointError(f"{name_of(solver)} gave a step that is not finite")
        return dtheta

    def capped(dtheta: Array) -> Array:
        return dtheta if max_step is None else cap(dtheta, max_step, effectors.chains)

    wanted = ask(free)
    dtheta = capped(wanted)
    to, held = limits(tree, theta, dtheta, lambda held: capped(ask(free * ~held)))
    shortened = np.zeros(to.shape[:-1], dtype=bool)
    if max_step is not None:
        shortened |= (dtheta != wanted).any(axis=-1)
    return Step(to, e, J, wanted, to - theta, shortened, held)


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
        raise TypeError(f"a solver is a function of (J, e) or a name, not {solver!r}")
    return solver


def checked(
    tree: Tree, theta: ArrayLike, effectors: Effectors, targets: ArrayLike
) -> tuple[Array, Array]:
    """θ and targets as arrays, if their shapes fit and their numbers are finite."""
    theta, targets = numbers("theta", theta), numbers("targets", targets)
    n, k = len(tree), len(effectors)
    if theta.shape[-1:] != (n,):
        raise ValueError(f"{n} joints need theta of shape (..., {n}), not {theta.shape}")
    if targets.shape[-2:] != (k, 3):
        raise ValueError(f"{k} effectors need targets of shape (..., {k}, 3), not {targets.shape}")
    if not finite(theta):
        raise ValueError(f"the angle of {_culprit(theta, tree.names)!r} is not finite")
    if not finite(targets):
        culprit = _culprit(targets.swapaxes(-1, -2), effectors.names)
        raise ValueError(f"the target of {culprit!r} is not finite")
    return theta, targets


def _bound(name: str, bound: ArrayLike | None) -> Array | None:
    """A bound that is 0 or more, or none."""
    if bound is None:
        return None
    array = numbers(name, bound)
    if not (array >= 0).all():
        raise ValueError(f"{name} must be 0 or more, not {bound}")
    return array


def numbers(name: str, values: ArrayLike) -> Array:
    """The values as an array of numbers; ValueError with their name if they are none."""
    try:
        return np.asarray(values, dtype=float)
    except (TypeError, ValueError):
        raise ValueError(f"{name} must be made of numbers, not {values!r}") from None


def _culprit(values: Array, names: tuple[str, ...]) -> str:
    return names[int(np.argwhere(~np.isfinite(values))[0][-1])]


def _checked_mobility(tree: Tree, mobility: ArrayLike) -> Array:
    s = numbers("mobility", mobility)
    bad = ~((s >= 0) & (s <= 1)) if s.shape[-1:] == (len(tree),) else None
    if bad is None:
        raise ValueError(f"mobility needs one number a joint, ({len(tree)},), not {s.shape}")
    if bad.any():
        culprit = tree.names[int(np.argwhere(bad)[0][-1])]
        raise ValueError(f"the mobility of {culprit!r} must be from 0 to 1")
    return s
