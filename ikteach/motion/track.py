"""A figure that follows targets through time, one method, everything kept."""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from numbers import Real
from time import perf_counter
from typing import Any

import numpy as np

from ikteach.arrays import Array, ArrayLike, Mask
from ikteach.body import Effectors, Tree, forward, locate
from ikteach.motion.rank import smallest_sigma
from ikteach.motion.step import checked, numbers, solver_of, step
from ikteach.solvers import Solver, name_of

ErrorClampRule = Callable[[Array, Array], ArrayLike]


@dataclass(frozen=True, eq=False)
class Track:
    """T frames of a figure following targets, with whatever else may be asked about them.

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
        """The smallest σ that the body can have, at each pose (T, ...) [m/rad]: 0 is singular."""
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
    dt: float = 1 / 30,
    times: ArrayLike | None = None,
    iterations: int = 1,
    clamp_rule: ErrorClampRule | None = None,
    **options: Any,
) -> Track:
    """Follow targets (T, ..., k, 3) [m], one frame after the other, from the pose θ (..., n).

    theta       the start [rad], the rest pose if not given
    dt, times   seconds a frame, or the time (T,) of each
    iterations  steps a frame
    clamp_rule  how far the error is clamped next: a function of e (..., 3k) before and the
                distances (..., k) after a step, giving max_error; before the first step no clamp.
                `growing_clamp` is Buss's for SDLS
    options     go to `step`: max_error, max_step, cap, mobility, limits, at_targets
    """
    start = numbers("theta", tree.rest if theta is None else theta)
    targets = numbers("targets", targets)
    if targets.ndim < 3:
        raise ValueError(f"targets over time have shape (T, ..., k, 3), not {targets.shape}")
    if not len(targets):
        raise ValueError(f"there are no frames in targets of shape {targets.shape}")
    if not (isinstance(iterations, Real) and iterations >= 1 and iterations % 1 == 0):
        raise ValueError(f"iterations must be 1 or more, not {iterations!r}")
    start, targets = checked(tree, start, effectors, targets)
    function = solver_of(solver)
    poses, errors, caps, holds = [], [], [], []
    pose, began = start, perf_counter()
    for goal in targets:
        capped = 0.0
        for _ in range(int(iterations)):
            done = step(tree, pose, effectors, goal, function, **options)
            pose, capped = done.theta, capped + done.capped
            error = np.linalg.norm(goal - locate(forward(tree, pose), effectors), axis=-1)
            if clamp_rule is not None:
                options["max_error"] = clamp_rule(done.e, error)
        poses.append(pose)
        errors.append(error)
        caps.append(capped / iterations)
        holds.append(done.held)
    seconds = (perf_counter() - began) / (len(targets) * iterations)
    clock = dt * np.arange(1, len(targets) + 1) if times is None else np.asarray(times, dtype=float)
    if clock.shape != (len(targets),):
        raise ValueError(f"{len(targets)} frames need {len(targets)} times, not {clock.shape}")
    return Track(
        name_of(solver if not isinstance(solver, str) else function),
        tree, effectors, clock, targets, np.broadcast_to(start, np.shape(pose)),
        *map(np.array, (poses, errors, caps, holds)), seconds,
    )  # fmt: skip


def growing_clamp(e: Array, error: Array, *, base: float = 0.4) -> Array:
    """D_i = base + max(0, ‖e_i‖ after − ‖e_i‖ before): Buss's clamp for SDLS, in his lengths [m].

    e (..., 3k) is from before the step, error (..., k) from after it; returns D (..., k).
    Where a step drove an effector away from its target, the next may look further. (Buss's code
    reads wrong entries of e here; this is the corrected form.)
    """
    before = np.linalg.norm(e.reshape(*error.shape, 3), axis=-1)
    return base + np.maximum(0, error - before)
