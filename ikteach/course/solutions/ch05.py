"""Solutions of chapter 5."""

import numpy as np


# %% 05.svd
def damped(J, e, damping):
    U, sigma, Vt = np.linalg.svd(J, full_matrices=False)
    return Vt.T @ (sigma / (sigma**2 + damping**2) * (U.T @ e))


# %% 05.bound
def safe_damping(e, longest):
    return np.linalg.norm(e) / (2 * longest)


# %% 05.unit
def damping_in(damping, per_metre, per_radian):
    return damping * per_metre / per_radian  # λ has the unit of σ
