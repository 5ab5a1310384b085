"""Solutions of chapter 0."""

import numpy as np


# %% 00.hand
def hand(theta, lengths):
    """Where the hand is, (x, y) [m]."""
    along = np.cumsum(theta)
    return np.array([lengths @ np.cos(along), lengths @ np.sin(along)])


# %% 00.reach
def can_reach(x, y, a, b):
    """Whether links of a and b [m] reach the point (x, y)."""
    return abs(a - b) <= np.hypot(x, y) <= a + b
