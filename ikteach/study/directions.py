"""Chapter 6. One step taken apart, a row per singular direction."""

from typing import Any

import numpy as np
import pandas as pd

from ikteach.arrays import ArrayLike
from ikteach.body import Effectors, Tree, forward, jacobian, locate
from ikteach.motion.step import checked
from ikteach.solvers import sdls
from ikteach.solvers.response import directions, factors


def by_direction(
    tree: Tree, effectors: Effectors, theta: ArrayLike, targets: ArrayLike, **options: Any
) -> pd.DataFrame:
    """Take a step of SDLS apart, a row per direction.

    σ [m/rad], asked u_iᵀe [m], N, M, γ [rad], the factor f that SDLS takes [rad/m], and the share
    of 1/σ that it leaves, for each direction i at a pose θ (n,) with targets (k, 3); no number
    where nothing is asked. `options` go to `sdls`.
    """
    theta, targets = checked(tree, theta, effectors, targets)
    if theta.ndim != 1 or targets.ndim != 2:
        batch = theta.shape[:-1] or targets.shape[:-2]
        raise ValueError(f"one pose and its targets are taken apart at a time, not {batch}")
    frames = forward(tree, theta)
    e = np.ravel(targets - locate(frames, effectors))
    J = jacobian(tree, frames, effectors)
    max_angle = {k: v for k, v in options.items() if k == "max_angle"}
    found, f = directions(J, e, **max_angle), factors(J, e, sdls(J, e, **options))
    columns = {
        "σ": found.sigma,
        "asked": found.alpha,
        "N": found.N,
        "M": found.M,
        "γ": found.gamma,
        "f": f,
        "share": f * found.sigma,
    }
    return pd.DataFrame(columns, index=pd.RangeIndex(1, len(f) + 1, name="i"))
