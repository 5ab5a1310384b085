"""Wrong answers to chapter 0 (see `tests.course.answers`)."""

import numpy as np


def hand_by(first, second):
    def hand(theta, lengths):
        along = np.cumsum(theta)
        return [lengths @ first(along), lengths @ second(along)]

    return hand


WRONG = {
    "00.hand": [
        (lambda t, a: [a @ np.cos(t), a @ np.sin(t)], "whole arm points up"),  # not added up
        (hand_by(np.sin, np.cos), "lies along x"),
        (lambda t, a: hand_by(np.cos, np.sin)(np.radians(t), a), "whole arm points up"),
        (lambda t, a: hand_by(np.cos, np.sin)(t[:2], a[:2]), "lies along x"),  # a link short
        (lambda t, a: hand_by(np.cos, np.sin)(t, np.ones(3)), "lies along x"),
        (lambda t, a: [*hand_by(np.cos, np.sin)(t, a), 0.0], "array of shape (3,)"),
        (lambda t, a: hand_by(np.cos, np.sin)(t[::-1], a), "whole arm points up"),
        (lambda t, a: hand_by(np.cos, np.sin)([t[0], t[1], 0], a), "For θ ="),
    ],
    "00.reach": [
        (lambda x, y, a, b: bool(np.hypot(x, y) <= a + b), "in the hole"),
        (
            lambda x, y, a, b: bool(a - b <= np.hypot(x, y) <= a + b),
            "in the hole",
        ),
        (lambda x, y, a, b: bool(abs(a - b) < np.hypot(x, y) < a + b), "on the edge of its reach"),
        (lambda x, y, a, b: bool(abs(a - b) <= x + y <= a + b), "can reach"),
        (lambda x, y, a, b: bool(abs(a - b) <= x * x + y * y <= a + b), "can reach"),
        (lambda x, y, a, b: True, "cannot reach"),
    ],
}
