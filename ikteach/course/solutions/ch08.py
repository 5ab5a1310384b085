"""Solutions of chapter 8."""

import numpy as np

from ikteach import figures, gait, study


# %% 08.order
def order(table):
    return list(table.groupby("method", observed=True)["error"].mean().sort_values().index)


# %% 08.experiment
def experiment():
    targets = gait.running(gait.running.clock(30))
    log = study.compare(*figures.human(), targets, max_step=np.radians(10))
    return log, log.groupby("method", observed=True)["error"].mean().idxmin()
