"""Wrong answers to chapter 2 (see `tests.course.answers`)."""

import numpy as np


def by_pose(J, e):
    """The class of the pose alone: e is not asked."""
    sigma = np.linalg.svdvals(J)[-1]
    return "lost" if sigma < 1e-9 else "near" if sigma < 0.1 else "free"


def never_lost(J, e):
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
        (by_pose, "across the arm"),
        (never_lost, "'lost' and not 'free'"),
        (by_size, "The class is of the direction of e"),
        (never_near, "'near' and not 'free'"),
        (by_first, "seen from other axes"),
        (lambda J, e: "singular", "must say 'free', 'near' or 'lost'"),
        (lambda J, e: np.linalg.det(J), "where a str is wanted"),
    ],
    "02.bend": [
        (0.0, "try more"),
        (180, "try less"),
        (45.0, "try more"),
        (np.pi / 2, "try more"),  # in radians
        (-90.0, "Between 0"),
    ],
}
