"""Sessions as tables: the ticks, poses and events of a live figure."""

from typing import Any

import numpy as np
import pandas as pd

from ikteach.checks import shown
from ikteach.motion.live.log import Log


def ticks(run: Log) -> pd.DataFrame:
    """Tabulate a session: a row per tick, method and effector.

    tick, clock [s], time [s]   ticks and clock time since the reset, and gait time
    shown                       whether this method was on the screen
    method, effector
    target.x, target.y, target.z   [m]
    error                       distance to target at the end of the tick [m]
    capped                      whether the cap shortened the step
    held                        how many joints of the effector's chain a limit stopped
    """
    T, m, k = _session(run).error.shape
    methods, names = list(run.methods), list(run.effectors.names)

    def per_tick(values: Any) -> Any:
        return np.repeat(values, m * k)

    target = np.repeat(run.targets[:, None], m, axis=1).reshape(-1, 3)
    return pd.DataFrame(
        {
            "tick": per_tick(run.tick),
            "clock": per_tick(run.clock),
            "time": per_tick(run.time),
            "shown": np.repeat(run.shown[:, None] == np.arange(m), k),
            "method": pd.Categorical(np.tile(np.repeat(methods, k), T), categories=methods),
            "effector": pd.Categorical(names * (T * m), categories=names),
            **{f"target.{axis}": target[:, i] for i, axis in enumerate("xyz")},
            "error": run.error.ravel(),
            "capped": np.repeat(run.capped, k),
            "held": (run.held[:, :, None, :] & run.effectors.carried).sum(axis=-1).ravel(),
        }
    )


def angles(run: Log) -> pd.DataFrame:
    """Tabulate poses [rad]: a row per tick and method."""
    index = pd.MultiIndex.from_product([_session(run).tick, run.methods], names=["tick", "method"])
    theta = run.theta.reshape(-1, len(run.tree))
    return pd.DataFrame(theta, index=index, columns=list(run.tree.names))


def events(run: Log) -> pd.DataFrame:
    """Tabulate the changes of a session, a row per event."""
    rows = [(e.run, e.tick, e.time, e.kind, str(e)) for e in _session(run).events]
    return pd.DataFrame(rows, columns=["run", "tick", "time", "kind", "words"])


def _session(run: Log) -> Log:
    if not isinstance(run, Log):
        raise TypeError(f"what happened is in a Log, as `session.log()` makes, not {shown(run)}")
    return run
