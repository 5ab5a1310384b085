"""Solutions of chapter 1."""

import numpy as np


# %% 01.column
def column(v, p, s):
    """How the effector at s moves per radian about the axis v through p."""
    return np.cross(v, s - p)


# %% 01.cramer
def cramer3(J, r):
    """The x with J x = r, by Cramer's rule; ValueError where the columns lie in a plane."""
    det = np.linalg.det(J)
    if abs(det) <= 1e-12 * np.prod(np.linalg.norm(J, axis=0)):
        raise ValueError("the columns lie in a plane: no inverse")
    swapped = [np.where(np.arange(3) == i, r[:, None], J) for i in range(3)]
    return np.array([np.linalg.det(A) for A in swapped]) / det
