"""Solutions of chapter 6."""

import numpy as np

from ikteach.solvers.sdls import lengths


# %% 06.gamma
def gamma(J, max_angle):
    U, sigma, Vt = np.linalg.svd(J, full_matrices=False)
    N = lengths(U).sum(axis=0)
    M = abs(Vt) @ lengths(J).sum(axis=0) / sigma
    return np.minimum(1, N / M) * max_angle


# %% 06.clamp
def clamp(phi, bound):
    peak = abs(phi).max()
    return phi * min(1, bound / peak) if peak else phi
