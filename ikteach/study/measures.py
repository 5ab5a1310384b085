"""Measures of runs: distances to target, and what distance hides."""

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
import pandas as pd

from ikteach.arrays import Array
from ikteach.body import Effectors
from ikteach.checks import count, number, shown
from ikteach.motion import Track
from ikteach.motion.live.log import of_run, same_targets
from ikteach.names import unknown
from ikteach.study.experiment import reversals

MEASURES = ["mean", "median", "p95", "max", "jitter", "capped", "held", "smallest_sigma"]


def columns_of(table: pd.DataFrame, columns: Iterable[str], numeric: bool = False) -> list[str]:
    """Check that a table has rows and these columns.

    columns  names, or one name alone
    numeric  whether they must be made of numbers
    LookupError for one that is not there.
    """
    if not isinstance(table, pd.DataFrame):
        raise TypeError(f"a table is a DataFrame, not {shown(table)}")
    if not len(table):
        raise ValueError("the table has no rows")
    if isinstance(columns, str) or not isinstance(columns, Iterable):
        columns = [columns]
    names = list(columns)
    if not names:
        raise ValueError("at least one column is needed")
    for name in names:
        if name not in table.columns:
            raise LookupError(unknown("column", name, map(str, table.columns)))
        if numeric and not pd.api.types.is_numeric_dtype(table[name]):
            raise ValueError(f"the column {shown(name)} is not made of numbers")
    return names


def summary(table: pd.DataFrame, by: Iterable[str] = ("method", "effector")) -> pd.DataFrame:
    """Summarise a log, a row per value of `by`.

    mean, median, p95, max  of the distance to target [m]
    jitter                  mean ‖Δ²θ‖ [rad]
    capped                  share of capped steps
    held                    joints held at limits, on average
    smallest_sigma          the smallest met [m/rad]

    LookupError if the table lacks a column, ValueError if it has no rows.
    """
    by = columns_of(table, by)
    columns_of(table, ["error", "jitter", "capped", "held", "smallest_sigma"], numeric=True)
    groups = table.groupby(by, observed=True)
    error = groups["error"]
    return pd.DataFrame(
        {
            "mean": error.mean(),
            "median": error.median(),
            "p95": error.quantile(0.95),
            "max": error.max(),
            "jitter": groups["jitter"].mean(),
            "capped": groups["capped"].mean(),
            "held": groups["held"].mean(),
            "smallest_sigma": groups["smallest_sigma"].min(),
        }
    )


def many(tracks: Mapping[str, Track]) -> pd.DataFrame:
    """Measure batches (b,) of runs: least, median and most.

    Rows and measures are those of `summary`; each measure is three columns, least, median and most
    over the batch. For runs that may be chaotic, from starts such as those of
    `ikteach.study.experiment.nearby`: there one run says nothing.
    """
    if not tracks:
        raise ValueError("there are no runs to measure")
    return pd.concat({m: _spread(run) for m, run in tracks.items()}, names=["method", "effector"])


def _spread(run: Track) -> pd.DataFrame:
    """Measure a batch over its members, a row per effector."""
    if run.theta.ndim != 3:
        raise ValueError(f"many runs are a batch (b,), not one of shape {run.theta.shape[1:-1]}")
    error, k = run.error, len(run.effectors)
    values = {
        "mean": error.mean(axis=0),
        "median": np.median(error, axis=0),
        "p95": np.quantile(error, 0.95, axis=0),
        "max": error.max(axis=0),
        "jitter": run.jitter.mean(axis=0)[:, None],
        "capped": run.capped.mean(axis=0)[:, None],
        "held": (run.held[:, :, None] & run.effectors.carried).sum(axis=-1).mean(axis=0),
        "smallest_sigma": run.smallest_sigma.min(axis=0)[:, None],
    }  # (b, k), or (b, 1) of the whole body
    shares = {"least": 0.0, "median": 0.5, "most": 1.0}
    columns = {
        (measure, word): np.broadcast_to(np.quantile(values[measure], share, axis=0), k)
        for measure in MEASURES
        for word, share in shares.items()
    }
    return pd.DataFrame(columns, index=list(run.effectors.names))


def ranges(table: pd.DataFrame) -> pd.DataFrame:
    """Write a table of `many` in words: median and range.

    Two digits of the median, and the range in brackets; where all runs agree to two digits there is
    no range.
    """

    def told(least: float, median: float, most: float) -> str:
        low, middle, high = (f"{round(value, 4):.2g}" for value in (least, median, most))
        return middle if low == high else f"{middle} ({low} to {high})"

    measures = dict.fromkeys(table.columns.get_level_values(0))
    cells = {name: [told(*row) for row in table[name].to_numpy()] for name in measures}
    return pd.DataFrame(cells, table.index)


def by_phase(table: pd.DataFrame, period: float, parts: int = 24) -> pd.DataFrame:
    """Average the distance to target [m] over the cycle.

    A row per phase 0..1, a column per method and effector. `period` is the gait's [s].
    """
    columns_of(table, ["time", "error"], numeric=True)
    columns_of(table, ["method", "effector"])
    period, parts = number("period", period), count("parts", parts)
    if not period:
        raise ValueError("a cycle lasts longer than 0 s")
    phase = (table["time"] % period / period * parts).astype(int).clip(upper=parts - 1)
    middle = ((phase + 0.5) / parts).rename("phase")
    return table.pivot_table(
        index=middle, columns=["method", "effector"], values="error", observed=True
    )


def distances(tracks: Mapping[str, Track]) -> pd.DataFrame:
    """Summarise live runs at a glance, a row per method.

    The mean distance of each effector [cm], and what distance hides: the worst distance [cm],
    jitter [°] and joints held at limits.

    It takes a millisecond where `summary` of a full log takes a hundred.
    """
    same_targets(tracks)
    rows = {
        name: {
            **dict(zip(_beside(run.effectors), 100 * run.error.mean(axis=0), strict=True)),
            "worst": 100 * run.error.max(),
            "jitter": np.degrees(run.jitter.mean()),
            "held": run.held.sum(axis=-1).mean(),
        }
        for name, run in tracks.items()
    }
    return pd.DataFrame.from_dict(rows, orient="index").rename_axis("method")


def _beside(effectors: Effectors) -> list[str]:
    """Name columns for effectors, apart from the columns beside them."""
    taken = "worst", "jitter", "held"
    return [f"effector {name}" if name in taken else name for name in effectors.names]


def variants(run: Track, labels: Iterable[Any], name: str = "variant") -> pd.DataFrame:
    """Measure a batch (b,) of runs, a row per labelled member.

    The columns are those of `summary`, with `reversals` [1/s] of a joint beside the jitter.
    """
    names = list(labels) if isinstance(labels, Iterable) else [labels]
    if of_run(run).theta.ndim != 3 or run.theta.shape[1] != len(names):
        raise ValueError(f"{len(names)} labels do not fit a batch of {run.theta.shape[1:-1]}")
    return pd.DataFrame(measures(run), index=pd.Index(names, name=name))


def measures(run: Track) -> dict[str, Array]:
    """Measure a run, or each run of a batch: {measure: (...)}.

    Those of `summary`, of all effectors and joints, and `reversals` [1/s].
    """
    error = run.error
    return {
        "mean": error.mean(axis=(0, -1)),
        "median": np.median(error, axis=(0, -1)),
        "p95": np.quantile(error, 0.95, axis=(0, -1)),
        "max": error.max(axis=(0, -1)),
        "jitter": run.jitter.mean(axis=0),
        "reversals": reversals(run),
        "capped": run.capped.mean(axis=0),
        "held": run.held.sum(axis=-1).mean(axis=0),
        "smallest_sigma": run.smallest_sigma.min(axis=0),
    }
