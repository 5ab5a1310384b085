"""Chapter 12: how fast a frame turns, and how far feet give way, by damped least squares."""

import numpy as np

from ikteach.arrays import Array
from ikteach.body import forward, locate
from ikteach.body.figures import Figure
from ikteach.motion.paths.walk import turned
from ikteach.motion.step import step

NEAR = 0.01  # a frame is there when no part of it is farther [m]
LONGEST = 1000  # ticks


def ticks_to_turn(figure: Figure, start: Array, length: float, *, degrees: float = 60.0) -> int:
    """Count the steps until a frame has turned about y.

    figure  its effectors are a point and two directions of 1 m
    length  that the directions have by their weight [m]

    They end where no part is farther from its target than 1 cm.
    """
    tree, effectors = figure
    place, *arrows = locate(forward(tree, start), effectors)
    R = turned("y", np.asarray(degrees))
    targets = np.stack([place, *(R @ arrow for arrow in arrows)])
    theta, weights = start, [1.0, length, length]
    for tick in range(LONGEST):
        if np.linalg.norm(targets - locate(forward(tree, theta), effectors), axis=1).max() < NEAR:
            return tick
        theta = step(tree, theta, effectors, targets, "dls", weights=weights).theta
    return LONGEST


def feet_off(figure: Figure, start: Array, weight: float, *, steps: int = 600) -> float:
    """Return how far feet give way to a hand [m].

    The hand wants too much.

    figure  its effectors are heel and ball of both feet, a hand and the gaze
    weight  of the feet, where that of the hand is 1
    """
    tree, effectors = figure
    targets = locate(forward(tree, start), effectors)
    targets[:4, 1] = targets[:4, 1].min()
    targets[4] = targets[4] * [1, 0, 0] + [0, targets[0, 1] + 1.2, 1.4]
    theta, weights = start, [weight] * 4 + [1.0, 0.1]
    for _ in range(steps):
        theta = step(tree, theta, effectors, targets, "dls", weights=weights).theta
    gaps = np.linalg.norm(targets - locate(forward(tree, theta), effectors), axis=1)
    return float(gaps[:4].mean())
