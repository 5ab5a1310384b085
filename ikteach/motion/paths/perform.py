"""Runs of a walk: by its targets, as a body follows them, or by nothing but the norm's angles."""

from typing import Any

import numpy as np

from ikteach.arrays import Array, ArrayLike
from ikteach.body import forward, locate
from ikteach.body.figures import Figure
from ikteach.checks import count, number
from ikteach.motion.path import Motion
from ikteach.motion.paths import quality
from ikteach.motion.step import step
from ikteach.motion.track import Track, track
from ikteach.solvers import Solver

SETTLED = 60  # steps towards the first targets, before the run


def perform(
    path: Motion,
    figure: Figure,
    solver: Solver | str,
    *,
    cycles: float = 3,
    dt: float = 1 / 30,
    iterations: int = 2,
    start: ArrayLike | None = None,
    **options: Any,
) -> Track:
    """Follow a motion for some of its cycles.

    cycles      how often once round
    dt          seconds per frame
    iterations  steps per frame: with one alone, the figure lags behind what goes fast
    start       the pose before (n,); the rest pose, led to the first targets, if not given
    options     go to `step`

    The time of a frame is that of the motion: its phase is `path.rate` times it. ValueError if the
    motion is not for this figure, or a number is none; the other errors are those of `track`.
    """
    tree, effectors = figure
    course, times = path.on(tree, effectors), _times(path, cycles, dt)
    phases = path.rate * times
    targets = np.array([course.at(phase) for phase in phases])
    wishes = [course.wish(phase) for phase in phases]
    wish = None if wishes[0] is None else np.array(wishes)
    options = {"mobility": path.mobility(tree), **options}
    theta = tree.rest if start is None else start
    if start is None:
        for _ in range(SETTLED):
            theta = step(
                tree, theta, effectors, targets[0], solver, wish=wishes[0], **options
            ).theta
    return track(
        tree,
        effectors,
        targets,
        solver,
        theta=theta,
        times=times,
        iterations=iterations,
        wish=wish,
        **options,
    )


def imitate(
    path: Motion, figure: Figure, *, cycles: float = 3, dt: float = 1 / 30, speed: str = "Free"
) -> Track:
    """Move hips, knees, ankles and pelvis as the norm does.

    Nothing is solved and no target is followed, so that its `gait_score` is nearly 0. The pelvis is
    as high as lets the lower foot touch the ground. What its feet do then, the other measures say:
    a measure that becomes a target ceases to be a good one (Goodhart).

    figure  one with a free pelvis, as `figures.walker()`
    speed   of the norms, "Slow", "Free" or "Fast"

    The other joints go as `path` wishes. LookupError if the figure lacks such a joint.
    """
    tree, effectors = figure
    times = _times(path, cycles, dt)
    phases = path.rate * times
    means, marks = quality.norms(speed), np.arange(51) / 50
    wishes = path.wish(tree, phases)
    theta = np.tile(tree.rest, (len(times), 1)) if wishes is None else np.array(wishes)
    for side in "lr":
        u = (times - quality.strikes(path, times, side)[0]) / path.period % 1
        for curve in quality.CURVES[: 3 + (side == "l")]:  # there is one pelvis
            row = tree.index(quality.ROWS[curve].format(side))
            theta[:, row] = np.radians(np.interp(u, marks, means[curve]))
    course = path.on(tree, effectors)
    targets = np.array([course.at(phase) for phase in phases])
    up = tree.index("pelvis.y.slide")
    theta[:, up] = 0
    soles = locate(forward(tree, theta), quality.soles_of(tree))[..., 1].min(axis=-1)
    theta[:, up] = course.floor - soles
    error = np.linalg.norm(targets - locate(forward(tree, theta), effectors), axis=-1)
    held, capped = np.zeros(theta.shape, dtype=bool), np.zeros(len(times))
    rest = (times, targets, theta[0], theta, error, capped, held)
    return Track("norm", tree, effectors, *rest, seconds=float("nan"))


def _times(path: Motion, cycles: float, dt: float) -> Array:
    """Find the time of each frame [s]."""
    if not (dt := number("dt", dt)):
        raise ValueError("dt must be more than 0")
    frames = count("frames", round(number("cycles", cycles) * path.period / dt))
    return np.asarray(dt * np.arange(frames), dtype=float)
