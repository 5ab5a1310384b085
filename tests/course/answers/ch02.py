"""Wrong answers to chapter 2 (see `tests.course.answers`)."""

import numpy as np


def by_pose(J, e):
    """The class of the pose alone: e is not asked."""
    sigma = np.linalg.svdvals(J)[-1]
    return "lost" if sigma < 1e-9 else "near" if sigma < 0.1 else "free"


def never_lost(J, e):
    """Of `pinv` alone."""
    return "near" if np.linalg.norm(np.linalg.pinv(J) @ e) > 10 * np.linalg.norm(e) else "free"


def by_size(J, e):
    """Asks how long e is."""
    if np.linalg.norm(J.T @ e) < 1e-9:
        return "lost"
    return "near" if np.linalg.norm(np.linalg.pinv(J) @ e) > 1 else "free"


def never_near(J, e):
    return "lost" if np.linalg.norm(J.T @ e) < 1e-9 * np.linalg.norm(e) else "free"


def by_first(J, e):
    """Looks at x alone."""
    if abs(J[0]).max() < 1e-9 and e[0]:
        return "lost"
    return "near" if abs(J[0]).max() < 0.1 and e[0] else "free"


WRONG = {
    "02.classify": [
        (by_pose, "'free' and not 'lost' with the arm straight, the error across it"),
        (never_lost, "'lost' and not 'free'"),
        (by_size, ", 10 times: "),
        (never_near, "and not 'free'"),
        (by_first, "and not"),
        (lambda J, e: "singular", "must say 'free', 'near', 'partly lost' or 'lost'"),
        (lambda J, e: np.linalg.det(J), "where a name is wanted"),
    ],
    "02.bend": [
        (lambda a, b, bend: abs(np.sin(bend)), "√det(JJᵀ) is"),
        (lambda a, b, bend: a * b * np.sin(bend), "not -"),
        (lambda a, b, bend: a * b * abs(np.cos(bend)), "bent by 0°"),
        (lambda a, b, bend: a * b * abs(np.sin(np.radians(bend))), "bent by 90°"),
        (lambda a, b, bend: a * a * abs(np.sin(bend)), "√det(JJᵀ) is"),
        (lambda a, b, bend: 90.0, "√det(JJᵀ) is"),
    ],
}
