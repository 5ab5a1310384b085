"""Wrong answers to chapter 12 (see `tests.course.answers`)."""

import numpy as np

WRONG = {
    "12.column": [
        (lambda v, s, slide: np.cross(s, v), "other way round"),
        (lambda v, s, slide: np.cross(v, s), "still the same direction"),
        (lambda v, s, slide: v if slide else np.cross(v, s), "still the same direction"),
        (lambda v, s, slide: s - v * (v @ s), "you say"),
        (lambda v, s, slide: np.zeros(3), "you say"),
    ],
    "12.sigma": [
        (lambda order, middle: abs(np.cos(middle)), "the axes that"),
        (lambda order, middle: np.sqrt(1 - np.sin(middle)), "the axes that"),
        (lambda order, middle: 1 - abs(np.sin(middle)), "the axes that"),
        (lambda order, middle: np.sqrt(1 - abs(np.cos(middle))), "the axes that"),
        (lambda order, middle: 1.0, "the axes that"),
    ],
    "12.fixed": [
        (lambda C, d, xyz, R, a: (d + xyz, C @ R @ a), "Of the offset"),
        (lambda C, d, xyz, R, a: (d + R @ C @ xyz, C @ R @ a), "Of the offset"),
        (lambda C, d, xyz, R, a: (d + C @ xyz, R @ a), "Of the axis"),
        (lambda C, d, xyz, R, a: (d + C @ xyz, R @ C @ a), "Of the axis"),
        (lambda C, d, xyz, R, a: (d + C @ xyz, C @ a), "Of the axis"),
    ],
}
