"""Solutions of chapter 2."""

import numpy as np


# %% 02.classify
def classify(J, e):
    """What this pose can do about the error e: "free", "near" or "lost"."""
    size = np.linalg.norm(e)
    if np.linalg.norm(J.T @ e) < 1e-9 * size:
        return "lost"
    return "near" if np.linalg.norm(np.linalg.pinv(J) @ e) > 10 * size else "free"


# %% 02.bend
best_bend = 90.0
