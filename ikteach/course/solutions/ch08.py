"""Solutions of chapter 8."""

import numpy as np

from ikteach import gait


# %% 08.order
def order(table, most):
    mean = table.groupby("method", observed=True)[["error", "jitter"]].mean()
    return mean[mean["jitter"] <= most].sort_values("error").index


# %% 08.experiment
def experiment():
    def winner(log):
        return log.groupby("method", observed=True)["error"].mean().idxmin()

    return gait.running(gait.running.clock(30)), np.radians(10), winner
