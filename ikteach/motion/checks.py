"""Refusals of `step` and its like: one sentence each, with the name of the culprit."""

import numpy as np

from ikteach.arrays import Array, ArrayLike, finite
from ikteach.body import Effectors, Frames, Tree, forward
from ikteach.body.forward import check_frames, not_finite, pose
from ikteach.checks import common_batch, numbers, shown
from ikteach.solvers import SOLVERS, Solver


def solver_of(solver: Solver | str) -> Solver:
    """Return a solver, given itself or its name.

    LookupError for an unknown name.
    """
    if isinstance(solver, str):
        return SOLVERS[solver]
    if not callable(solver):
        raise TypeError(f"a solver is a function of (J, e) or a name, not {shown(solver)}")
    return solver


def checked(
    tree: Tree, theta: ArrayLike, effectors: Effectors, targets: ArrayLike
) -> tuple[Array, Array]:
    """Make arrays of θ and targets.

    ValueError if shapes do not fit or a number is not finite.
    """
    theta = pose(tree, theta)
    check_frames(effectors, forward(tree, tree.rest))
    return theta, goals(effectors, targets)


def goals(effectors: Effectors, targets: ArrayLike) -> Array:
    """Make an array of targets (..., k, 3), one finite point per effector."""
    targets, k = numbers("targets", targets), len(effectors)
    if targets.shape[-2:] != (k, 3):
        needs = "1 effector needs" if k == 1 else f"{k} effectors need"
        hint = "; a target is a point, and no pose" if targets.shape[-2:] == (4, 4) else ""
        raise ValueError(f"{needs} targets of shape (..., {k}, 3), not {targets.shape}{hint}")
    if not finite(targets):
        culprit = not_finite(targets.swapaxes(-1, -2), effectors.names)
        raise ValueError(f"the target of {culprit} is not finite")
    return targets


def bound(name: str, bound: ArrayLike | None) -> Array | None:
    """Make an array of a bound, 0 or more.

    None, for no bound, stays None.
    """
    if bound is None:
        return None
    array = numbers(name, bound)
    if not (array >= 0).all():
        raise ValueError(f"{name} must be 0 or more, not {shown(bound)}")
    return array


def mobility_of(tree: Tree, mobility: ArrayLike) -> Array:
    """Make an array of mobilities (..., n), each from 0 to 1."""
    s = numbers("mobility", mobility)
    if s.shape[-1:] != (len(tree),):
        raise ValueError(f"mobility needs one number per joint, ({len(tree)},), not {s.shape}")
    bad = ~((s >= 0) & (s <= 1))
    if bad.any():
        culprit = tree.names[int(np.argwhere(bad)[0][-1])]
        raise ValueError(f"the mobility of {shown(culprit)} must be from 0 to 1")
    return s


def weights_of(effectors: Effectors, weights: ArrayLike | None) -> Array | None:
    """Make an array of weights (..., k), each 0 or more.

    None stays None.
    """
    if weights is None:
        return None
    array, k = numbers("weights", weights), len(effectors)
    if array.shape[-1:] != (k,) or not finite(array) or (array < 0).any():
        needs = f"weights need a number from 0 up for each effector, (..., {k})"
        raise ValueError(f"{needs}, not {shown(weights)}")
    return array


def wish_of(tree: Tree, wish: ArrayLike | None) -> Array | None:
    """Make an array of a pose that is wished for, (..., n).

    None stays None.
    """
    if wish is None:
        return None
    try:
        return pose(tree, wish)
    except ValueError as error:
        raise ValueError(f"the wish is no pose: {error}") from None


def frames_of(tree: Tree, theta: ArrayLike, frames: Frames | None) -> Frames:
    """Return the frames of a pose.

    Frames that are given for it are checked.
    """
    if frames is None:
        return forward(tree, theta)  # which checks θ
    if isinstance(frames, Frames) and frames.positions.shape != (*pose(tree, theta).shape, 3):
        given = frames.positions.shape[:-1]
        raise ValueError(f"frames are of poses {given}, not {np.shape(theta)}")
    return frames


def error_bound(effectors: Effectors, max_error: ArrayLike | None) -> Array | None:
    """Make an array of max_error.

    It is one number or (..., k) [m]; None, for no bound, stays None.
    """
    array, k = bound("max_error", max_error), len(effectors)
    if array is not None and array.shape[-1:] not in ((), (1,), (k,)):
        raise ValueError(f"max_error needs one number, or (..., {k}), not {array.shape}")
    return array


def batch_of(
    theta: Array,
    targets: Array,
    free: Array,
    max_step: Array | None,
    max_error: Array | None,
    weights: Array | None = None,
    wish: Array | None = None,
) -> tuple[int, ...]:
    """Return the batch of all that is given.

    ValueError if its parts do not fit together.
    """
    plain = max_step is None and max_error is None and weights is None and wish is None
    if plain and theta.ndim == free.ndim == targets.ndim - 1 == 1:
        return ()  # one pose, the common case
    batches = [theta.shape[:-1], targets.shape[:-2], free.shape[:-1]]
    if max_step is not None:
        batches.append(max_step.shape)
    batches += [one.shape[:-1] for one in (max_error, weights, wish) if one is not None]
    names = "theta, targets, mobility, max_step, max_error, weights and wish"
    return common_batch(names, *batches)
