"""Solutions of chapter 3."""

import numpy as np


# %% 03.alpha
def alpha(J, e):
    g = J @ (J.T @ e)
    return (e @ g) / (g @ g)


# %% 03.gain
largest_gain = 2


# %% 03.safe
def careful(J, e):
    g = J @ (J.T @ e)
    return (e @ g) / (g @ g) * (J.T @ e) if g.any() else np.zeros(J.shape[1])
