"""Wrong answers to chapter 11 (see `tests.course.answers`)."""

import numpy as np

from ikteach.course.solutions import ch11


def in_radians(order, degrees):
    return ch11.turn(order, np.degrees(degrees))


def added(order, degrees):
    """Angles as if they were one vector."""
    return sum(ch11.turn(letter, [angle]) for letter, angle in zip(order, degrees, strict=True))


def mean_of_sides(angles, norm):
    return np.sqrt(np.mean((angles.mean(axis=1) - norm) ** 2))


WRONG = {
    "11.turn": [
        (lambda order, degrees: ch11.turn(order[::-1], degrees[::-1]), "other order"),
        (lambda order, degrees: ch11.turn(order, degrees).T, "other way round"),
        (in_radians, "you say"),
        (added, "keeps lengths"),
        (lambda order, degrees: ch11.turn("ZXY"[: len(order)], degrees), "you say"),
        (lambda order, degrees: np.eye(3), "you say"),
    ],
    "11.stands": [
        (lambda phase, duty, late: np.mod(phase + late, 1) < duty, "came down"),
        (lambda phase, duty, late: np.mod(phase - late, 1) > duty, "came down"),
        (lambda phase, duty, late: phase - late < duty, "came down"),
        (lambda phase, duty, late: np.fmod(phase - late, 1) < duty, "came down"),
        (lambda phase, duty, late: np.mod(phase - late, 1), "stands or does not"),
        (lambda phase, duty, late: np.mod(phase - late, 1) < 0.6, "came down"),
    ],
    "11.score": [
        (mean_of_sides, "squares are averaged"),
        (lambda angles, norm: np.mean((angles - norm[:, None]) ** 2), "score is"),
        (lambda angles, norm: np.mean(abs(angles - norm[:, None])), "root of the mean square"),
        (lambda angles, norm: np.sqrt(np.mean(angles**2)), "On the norm itself"),
        (lambda angles, norm: np.sqrt(np.sum((angles - norm[:, None]) ** 2)), "score is"),
    ],
}
