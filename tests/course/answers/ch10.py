"""Wrong answers to chapter 10 (see `tests.course.answers`)."""

import numpy as np

LIMITS = np.radians([-30, 60])


def looks(y, z, eyes):
    return np.arcsin(eyes / np.hypot(y, z)) - np.arctan2(y, z)


def too_little(J, wish):
    """In the null space, but half of what could be."""
    return 0.5 * (wish - np.linalg.pinv(J) @ J @ wish)


WRONG = {
    "10.null": [
        (lambda J, wish: wish, "the whole wish"),
        (lambda J, wish: 0 * wish, "nothing moves at all"),
        (lambda J, wish: np.linalg.pinv(J) @ J @ wish, "the hand notices"),
        (lambda J, wish: wish - J.T @ (J @ wish), "the hand notices"),
        (lambda J, wish: wish + np.linalg.pinv(J) @ J @ wish, "the hand notices"),
        (too_little, "more of the wish"),
        (lambda J, wish: np.where(J.any(axis=0), 0, wish), "more of the wish"),
        (lambda J, wish: J @ wish, "shape"),
    ],
    "10.nod": [
        (lambda y, z, eyes: np.clip(-np.arctan2(y, z), *LIMITS), "line of sight"),
        (lambda y, z, eyes: np.clip(np.arctan2(y, z), *LIMITS), "line of sight"),
        (looks, "from −30° to 60°"),
        (lambda y, z, eyes: np.degrees(np.clip(looks(y, z, eyes), *LIMITS)), "from −30° to 60°"),
        (lambda y, z, eyes: np.clip(-looks(y, z, eyes), *LIMITS), "line of sight"),
        (lambda y, z, eyes: 0.0, "line of sight"),
        (lambda y, z, eyes: np.clip(looks(y, z, eyes), 0, 1), "limit"),
    ],
}
