"""Wrong answers to chapter 7 (see `tests.course.answers`)."""

import numpy as np

from ikteach.course.solutions.ch07 import path


def sine(phase):
    """The thesis's foot: it never lifts."""
    return np.stack([0 * phase, 0.25 * np.sin(2 * np.pi * phase)], axis=-1)


def lifted_sine(phase):
    """A sine that lifts while it goes forward: what carries still skates."""
    swing = 2 * np.pi * phase
    return np.stack([0.06 * np.maximum(0, np.cos(swing)) ** 2, 0.25 * np.sin(swing)], axis=-1)


def moonwalk(phase):
    y, z = path(phase).T
    return np.stack([y, -z], axis=-1)


def digging(phase):
    return np.stack([0.06 * np.sin(2 * np.pi * phase), 0.25 * np.cos(2 * np.pi * phase)], axis=-1)


def hopping(phase):
    """Stands for less than half of the cycle."""
    p = np.mod(phase, 1)
    swing = np.clip((p - 0.3) / 0.7, 0, 1)
    z = np.where(p < 0.3, 0.25 - 0.5 * p / 0.3, 0.5 * (3 - 2 * swing) * swing**2 - 0.25)
    return np.stack([0.06 * np.sin(np.pi * swing) ** 2, z], axis=-1)


def saw(phase):
    """Comes back in no time."""
    return np.stack([0 * phase, 0.25 - 0.5 * np.mod(phase, 1)], axis=-1)


def wandering(phase):
    return path(phase) + 0.1 * np.stack([0 * phase, phase], axis=-1)


WRONG = {
    "07.pace": [
        (lambda A, omega, z: A * omega, "a speed is not negative"),
        (lambda A, omega, z: abs(A * omega), "the foot goes back at"),
        (lambda A, omega, z: abs(A) * omega * np.sqrt(1 - (z / A) ** 2), "is not negative"),
        (lambda A, omega, z: abs(omega * z), "the foot goes back at"),
        (lambda A, omega, z: 2 * abs(A * omega) / np.pi, "the foot goes back at"),  # the mean
        (lambda A, omega, z: abs(omega) * np.sqrt(A**2 + z**2), "the foot goes back at"),
        (lambda A, omega, z: np.array([A, omega]), "shape"),
    ],
    "07.path": [
        (sine, "lifts by"),
        (lifted_sine, "skates"),
        (moonwalk, "z must fall"),
        (digging, "into the ground"),
        (hopping, "neither this foot nor the other"),
        (saw, "jumps"),
        (wandering, "goes round and round"),
        (lambda phase: np.sin(phase), "shape"),
    ],
}
