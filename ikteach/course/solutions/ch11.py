"""Solutions of chapter 11."""

import numpy as np


# %% 11.turn
def turn(order, degrees):
    """R (3, 3) of channels such as "ZXY", with an angle [°] for each, as the file has them."""
    R = np.eye(3)
    for letter, angle in zip(order, np.radians(degrees), strict=True):
        i = "XYZ".index(letter)
        j, k = (i + 1) % 3, (i + 2) % 3
        A = np.eye(3)
        A[j, j] = A[k, k] = np.cos(angle)
        A[k, j], A[j, k] = np.sin(angle), -np.sin(angle)
        R = R @ A
    return R


# %% 11.stands
def stands(phase, duty, late):
    """Whether the foot stands, (m,) of True and False; phase (m,) and late in cycles."""
    return np.mod(phase - late, 1) < duty


# %% 11.score
def score(angles, norm):
    """How far angles (c, s, 51) are from the norm (c, 51), root mean square [°]."""
    return np.sqrt(np.mean((angles - norm[:, None]) ** 2))
