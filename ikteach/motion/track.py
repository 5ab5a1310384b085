"""A figure that follows targets through time, one method, everything kept."""

import inspect
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from functools import cached_property
from time import perf_counter
from typing import Any

import numpy as np

from ikteach.arrays import Array, ArrayLike, Mask
from ikteach.body import Effectors, Tree, forward, locate
from ikteach.checks import common_batch, count, function, number, numbers, shown
from ikteach.motion.checks import checked, solver_of, wish_of
from ikteach.motion.rank import smallest_sigma
from ikteach.motion.step import step
from ikteach.names import unknown
from ikteach.solvers import Solver, name_of

ErrorClampRule = Callable[[Array, Array], ArrayLike]


@dataclass(frozen=True, eq=False)
class Track:
    """T frames of a figure following targets.

    Properties answer for all else that may be asked about them.

    method                      the solver's name
    tree, effectors             the figure
    times    (T,)               [s]
    targets  (T, ..., k, 3)     [m]
    start    (..., n)           the pose before the first frame [rad]
    theta    (T, ..., n)        the pose at the end of each frame [rad]
    error    (T, ..., k)        distance to target at the end of each frame [m]
    capped   (T, ...)           share of the frame's steps that the cap shortened, 0..1
    held     (T, ..., n)        True where a limit stopped the joint in the frame's last step
    seconds                     wall time of one step, on average over the run [s]
    """

    method: str
    tree: Tree
    effectors: Effectors
    times: Array
    targets: Array
    start: Array
    theta: Array
    error: Array
    capped: Array
    held: Mask
    seconds: float = field(compare=False)

    def __len__(self) -> int:
        return len(self.times)

    @cached_property
    def positions(self) -> Array:
        """Where the effectors are, (T, ..., k, 3) [m]."""
        return locate(forward(self.tree, self.theta), self.effectors)

    @cached_property
    def smallest_sigma(self) -> Array:
        """The smallest singular value of J at each pose, (T, ...) [m/rad]: 0 is singular.

        Of as many as the body can have in any pose (`motion.rank.full_rank`).
        """
        return smallest_sigma(self.tree, self.effectors, self.theta)

    @cached_property
    def jitter(self) -> Array:
        """‖Δ²θ‖ = ‖θ_t − 2θ_(t−1) + θ_(t−2)‖ (T, ...) [rad]; the figure stood still before."""
        before = [self.start[None], self.start[None]]
        theta = np.concatenate([*before, self.theta])
        return np.linalg.norm(np.diff(theta, n=2, axis=0), axis=-1)


def track(
    tree: Tree,
    effectors: Effectors,
    targets: ArrayLike,
    solver: Solver | str,
    *,
    theta: ArrayLike | None = None,
    dt: float | None = None,
    times: ArrayLike | None = None,
    iterations: int = 1,
    wish: ArrayLike | None = None,
    clamp_rule: ErrorClampRule | None = None,
    **options: Any,
) -> Track:
    """Follow targets (T, ..., k, 3) [m], one frame after the other, from the pose θ (..., n).

    theta       the start [rad], the rest pose if not given
    dt, times   seconds per frame (1/30 if not given), or the time (T,) of each: one of the two
    iterations  steps per frame
    wish        a pose for each frame, (T, ..., n), or one for all, to which joints go beside the
                targets
    clamp_rule  how far the error is clamped next: a function of e (..., 3k) before and the
                distances (..., k) after a step, giving max_error; before the first step no clamp.
                `growing_clamp` is Buss's for SDLS
    options     go to `step`: max_error, max_step, cap, mobility, limits, at_targets, weights

    ValueError if a shape is wrong or a number not finite, TypeError for an unknown option; the
    other errors are those of `step`.
    """
    for name in options:
        if name not in OPTIONS:
            raise TypeError(unknown("option", name, OPTIONS))
    start = numbers("theta", tree.rest if theta is None else theta)
    targets = numbers("targets", targets)
    if targets.ndim < 3:
        raise ValueError(f"targets over time have shape (T, ..., k, 3), not {targets.shape}")
    if not len(targets):
        raise ValueError(f"there are no frames in targets of shape {targets.shape}")
    iterations, clock = count("iterations", iterations), _clock(len(targets), dt, times)
    start, targets = checked(tree, start, effectors, targets)
    common_batch("theta and targets", start.shape[:-1], targets.shape[1:-2])
    chosen, wishes = solver_of(solver), _per_frame(tree, wish, len(targets))
    if clamp_rule is not None:
        function("clamp_rule", clamp_rule)
    kept: Any = [], [], [], []
    pose, frames, began = start, None, perf_counter()
    for goal, options["wish"] in zip(targets, wishes, strict=True):
        capped: Any = 0.0
        for _ in range(iterations):
            done = step(tree, pose, effectors, goal, chosen, frames=frames, **options)
            pose, capped = done.theta, capped + done.capped
            frames = forward(tree, pose)
            error = np.linalg.norm(goal - locate(frames, effectors), axis=-1)
            if clamp_rule is not None:
                options["max_error"] = clamp_rule(done.e, error)
        for column, value in zip(kept, (pose, error, capped / iterations, done.held), strict=True):
            column.append(value)
    seconds = (perf_counter() - began) / (len(targets) * iterations)
    poses, errors, shares, holds = map(np.array, kept)
    start, name = np.broadcast_to(start, np.shape(pose)), name_of(chosen)
    return Track(
        name, tree, effectors, clock, targets, start, poses, errors, shares, holds, seconds
    )


OPTIONS = [  # what `track` may be told: its own, and what goes to `step` at every frame
    name
    for asked in (track, step)
    for name, parameter in inspect.signature(asked).parameters.items()
    if parameter.kind is parameter.KEYWORD_ONLY and name != "frames"
]


def _per_frame(tree: Tree, wish: ArrayLike | None, frames: int) -> Iterable[Array | None]:
    """Give the wish of each frame, of (T, ..., n) or of one pose (n,) for all."""
    if (poses := wish_of(tree, wish)) is None or poses.ndim == 1:
        return [poses] * frames
    if len(poses) != frames:
        raise ValueError(f"{frames} frames need a wish for each, (T, ..., n), not {poses.shape}")
    return poses


def _clock(frames: int, dt: float | None, times: ArrayLike | None) -> Array:
    """Find the time (T,) of each frame [s]."""
    if times is None:
        dt = number("dt", 1 / 30 if dt is None else dt)
        if not dt:
            raise ValueError("dt must be more than 0")
        return np.asarray(dt * np.arange(1, frames + 1), dtype=float)
    if dt is not None:
        raise ValueError("give dt or times, not both: the times say how far frames are apart")
    clock = numbers("times", times)
    if clock.shape != (frames,):
        raise ValueError(f"{frames} frames need {frames} times, not {clock.shape}")
    if not (np.isfinite(clock).all() and (np.diff(clock) > 0).all()):
        raise ValueError(f"times must be finite and ascend, not {shown(times)}")
    return clock


def growing_clamp(e: Array, error: Array, *, base: float = 0.4) -> Array:
    """D_i = base + max(0, ‖e_i‖ after − ‖e_i‖ before): Buss's clamp for SDLS, in his lengths [m].

    e (..., 3k) is from before the step, error (..., k) from after it; returns D (..., k).
    Where a step drove an effector away from its target, the next may look further. (Buss's code
    reads wrong entries of e here; this is the corrected form.)
    """
    before = np.linalg.norm(e.reshape(*error.shape, 3), axis=-1)
    return base + np.maximum(0, error - before)
