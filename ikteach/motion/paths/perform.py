"""A motion followed by a body: targets, wishes and wound of a path, for `track`."""

from typing import Any

import numpy as np

from ikteach.arrays import ArrayLike
from ikteach.body.figures import Figure
from ikteach.checks import count, number
from ikteach.motion.path import Motion
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
    course, dt = path.on(tree, effectors), number("dt", dt)
    frames = count("frames", round(number("cycles", cycles) * path.period / dt))
    times = dt * np.arange(frames)
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
