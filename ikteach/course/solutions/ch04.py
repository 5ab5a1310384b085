"""Solutions of chapter 4."""

import numpy as np


# %% 04.projector
def projector(J):
    return np.eye(J.shape[1]) - np.linalg.pinv(J) @ J


# %% 04.cap
def cap(dtheta, max_step, chains):
    shorter = dtheta.copy()
    for chain in np.unique(chains):
        peak = abs(dtheta[chains == chain]).max()
        shorter[chains == chain] *= min(1, max_step / peak) if peak else 1
    return shorter
