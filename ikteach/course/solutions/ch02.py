"""Solutions of chapter 2."""

import numpy as np


# %% 02.classify
def classify(J, e):
    """What this pose can do about e: "free", "near", "partly lost" or "lost"."""
    size, dtheta = np.linalg.norm(e), np.linalg.pinv(J) @ e
    if np.linalg.norm(J.T @ e) < 1e-9 * np.linalg.norm(J) * size:
        return "lost"
    if np.linalg.norm(J @ dtheta - e) > 1e-9 * size:
        return "partly lost"
    return "near" if np.linalg.norm(dtheta) > 10 * size else "free"


# %% 02.bend
def volume(a, b, bend):
    """√det(JJᵀ) of links of a and b [m], the elbow bent by `bend` [rad]: most at 90°."""
    return a * b * abs(np.sin(bend))
