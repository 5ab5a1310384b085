"""Solutions of chapter 7."""

import numpy as np


# %% 07.pace
def pace(A, omega, z):
    """The speed of the body at which a foot at z stands still, in m/s."""
    return abs(omega) * np.sqrt(A**2 - z**2)


# %% 07.path
def path(phase):
    """Height over the ground and z of a foot in m, (m, 2); phase (m,) in cycles."""
    p = np.mod(phase, 1)
    swing = np.clip((p - 0.6) / 0.4, 0, 1)  # 0 in the stance, then 0 to 1
    height = 0.06 * np.sin(np.pi * swing) ** 2
    z = np.where(p < 0.6, 0.25 - 0.5 * p / 0.6, 0.5 * (3 - 2 * swing) * swing**2 - 0.25)
    return np.stack([height, z], axis=-1)
