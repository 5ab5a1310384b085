"""Solutions of chapter 12."""

import numpy as np


# %% 12.column
def column(v, s, slide):
    """Rows (3,) of J of a direction s (3,) for a joint of axis v (3,); slide is True or False."""
    return np.zeros(3) if slide else np.cross(v, s)


# %% 12.sigma
def sigma(order, middle):
    """The smallest singular value of the axes of three hinges, the middle one at an angle [rad]."""
    return np.sqrt(1 - abs(np.sin(middle)))


# %% 12.fixed
def fixed(C, d, xyz, R, a):
    """Offset (3,) and axis (3,) of the hinge, in the frame of the row."""
    return d + C @ xyz, C @ R @ a
