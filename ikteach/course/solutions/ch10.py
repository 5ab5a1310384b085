"""Solutions of chapter 10."""

import numpy as np


# %% 10.null
def to_rest(J, wish):
    """The part of the wish (n,) that J (3, n) does not notice."""
    return wish - np.linalg.pinv(J) @ J @ wish


# %% 10.nod
def nod(y, z, eyes):
    """The nod [rad] for a cursor at y and z from the neck [m], eyes so far above it [m]."""
    angle = np.arcsin(eyes / np.hypot(y, z)) - np.arctan2(y, z)
    return np.clip(angle, np.radians(-30), np.radians(60))
