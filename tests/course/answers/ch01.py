"""Wrong answers to chapter 1 (see `tests.course.answers`)."""

import numpy as np


def adjugate(J):
    return np.linalg.det(J) * np.linalg.inv(J)


def unguarded(J, r):
    return np.linalg.pinv(J) @ r


def zero_if_singular(J, r):
    return np.linalg.solve(J, r) if abs(np.linalg.det(J)) > 1e-12 else np.zeros(3)


def refuses_all(J, r):
    raise ValueError("no inverse")


WRONG = {
    "01.column": [
        (lambda v, p, s: np.cross(s - p, v), "the other way round"),
        (lambda v, p, s: np.cross(v, p - s), "the other way round"),
        (lambda v, p, s: np.cross(v, s), "per radian"),  # forgets where the joint is
        (lambda v, p, s: s - p, "along the axis"),
        (lambda v, p, s: np.radians(np.cross(v, s - p)), "per radian"),
        (lambda v, p, s: v * (s - p), "along the axis"),
        (lambda v, p, s: np.dot(v, s - p), "one number, where an array of shape (3,)"),
        (lambda v, p, s: np.cross(v, s - p) / np.linalg.norm(s - p), "per radian"),
    ],
    "01.cramer": [
        (lambda J, r: J @ r, "That is J r"),
        (lambda J, r: adjugate(J) @ r, "J times your x"),
        (lambda J, r: np.linalg.inv(J).T @ r, "J times your x"),
        (unguarded, "yours returns something"),
        (zero_if_singular, "J times your x"),  # it refuses what is only small,
        (lambda J, r: np.linalg.solve(J, r)[:2], "array of shape (2,)"),
        (refuses_all, "but it has an inverse"),
        (lambda J, r: J.T @ r, "J times your x"),
    ],
}
