"""Runs as tables: the tidy log, one row per frame, method and effector, and what it comes to.

Equal inputs give equal tables; wall time, which never is equal, stands apart in `timing`.
"""

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
import pandas as pd

from ikteach.arrays import Array, ArrayLike, Mask
from ikteach.body import Effectors, Tree
from ikteach.motion import Gait, Track, reachable, track
from ikteach.motion.experiment import reversals
from ikteach.solvers import SOLVERS, Solver

MEASURES = ["mean", "median", "p95", "max", "jitter", "capped", "held", "smallest_sigma"]


def log(run: Track, *, can_reach: Mask | None = None) -> pd.DataFrame:
    """The tidy log of one run without batches: a row per frame and effector.

    frame, time [s], method, effector
    error           distance to target at the end of the frame [m]
    reachable       whether any pose within the limits reaches it (`ikteach.motion.reachable`);
                    pass `can_reach` (T, k) where it is known already
    capped          share of the frame's steps that the cap shortened, 0..1
    held            how many joints of the effector's chain a limit stopped
    jitter          ‖Δ²θ‖ of the whole body [rad]
    smallest_sigma  smallest singular value of J [m/rad]: 0 is singular
    """
    if run.theta.ndim != 2:
        raise ValueError(f"a log is of one run, not of a batch of shape {run.theta.shape[1:-1]}")
    if can_reach is None:
        can_reach = reachable(run.tree, run.effectors, run.targets)
    frames, k = run.error.shape

    def per_frame(values: Any) -> Any:
        return np.repeat(values, k)

    return pd.DataFrame(
        {
            "frame": per_frame(np.arange(frames)),
            "time": per_frame(run.times),
            "method": pd.Categorical([run.method] * (frames * k)),
            "effector": pd.Categorical(
                list(run.effectors.names) * frames, categories=list(run.effectors.names)
            ),
            "error": run.error.ravel(),
            "reachable": np.asarray(can_reach).ravel(),
            "capped": per_frame(run.capped),
            "held": (run.held[:, None, :] & run.effectors.carried).sum(axis=-1).ravel(),
            "jitter": per_frame(run.jitter),
            "smallest_sigma": per_frame(run.smallest_sigma),
        }
    )


def runs(
    tree: Tree,
    effectors: Effectors,
    targets: ArrayLike,
    methods: Mapping[str, Solver] | Iterable[str] = SOLVERS,
    *,
    max_step: Mapping[str, float | None] | ArrayLike | None = None,
    **options: Any,
) -> dict[str, Track]:
    """Every method on the same targets (T, k, 3) from the same start: {method: Track}.

    methods   {name: solver}, or names of `SOLVERS`
    max_step  one step cap for all [rad], or a cap for each method, such as `BUSS_CAPS`
    options   go to `track` and `step`, the same for all
    """
    chosen = dict(methods) if isinstance(methods, Mapping) else {m: SOLVERS[m] for m in methods}

    def cap(name: str) -> Any:
        return max_step.get(name) if isinstance(max_step, Mapping) else max_step

    return {
        name: track(tree, effectors, targets, solver, max_step=cap(name), **options)
        for name, solver in chosen.items()
    }


def compare(
    tree: Tree,
    effectors: Effectors,
    targets: ArrayLike,
    methods: Mapping[str, Solver] | Iterable[str] = SOLVERS,
    **options: Any,
) -> pd.DataFrame:
    """The logs of every method on the same targets, one under the other. Arguments as in `runs`."""
    return together(runs(tree, effectors, targets, methods, **options))


def together(tracks: Mapping[str, Track]) -> pd.DataFrame:
    """One log of several runs on the same targets; `method` is the name each has in `tracks`."""
    if not tracks:
        raise ValueError("there is no run to log")
    first = next(iter(tracks.values()))
    can_reach = reachable(first.tree, first.effectors, first.targets)
    logs = [log(run, can_reach=can_reach).assign(method=name) for name, run in tracks.items()]
    table = pd.concat(logs, ignore_index=True)
    table["method"] = pd.Categorical(table["method"], categories=list(tracks))
    return table


def summary(table: pd.DataFrame, by: Iterable[str] = ("method", "effector")) -> pd.DataFrame:
    """What a log comes to, a row for each value of `by`.

    mean, median, p95, max  of the distance to target [m]
    jitter                  mean ‖Δ²θ‖ [rad]
    capped                  share of capped steps
    held                    joints held at limits, on average
    smallest_sigma          the smallest met [m/rad]
    """
    groups = table.groupby(list(by), observed=True)
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


def by_phase(table: pd.DataFrame, period: float, parts: int = 24) -> pd.DataFrame:
    """Mean distance to target [m] in each part of the cycle: rows phase 0..1, a column for each
    method and effector. `period` is the gait's [s].
    """
    phase = (table["time"] % period / period * parts).astype(int).clip(upper=parts - 1)
    middle = ((phase + 0.5) / parts).rename("phase")
    return table.pivot_table(
        index=middle, columns=["method", "effector"], values="error", observed=True
    )


def distances(tracks: Mapping[str, Track]) -> pd.DataFrame:
    """A glance at live runs: a row a method, the mean distance of each effector in cm, and beside
    it what distance hides: the worst distance [cm], jitter [°] and joints held at limits.

    It takes a millisecond where `summary` of a full log takes a hundred.
    """
    rows = {
        name: {
            **dict(zip(run.effectors.names, 100 * run.error.mean(axis=0), strict=True)),
            "worst": 100 * run.error.max(),
            "jitter": np.degrees(run.jitter.mean()),
            "held": run.held.sum(axis=-1).mean(),
        }
        for name, run in tracks.items()
    }
    return pd.DataFrame.from_dict(rows, orient="index").rename_axis("method")


def timing(tracks: Mapping[str, Track]) -> pd.Series:
    """Wall time of one step of each run [s]; it belongs to this machine and this moment."""
    seconds = {name: run.seconds for name, run in tracks.items()}
    return pd.Series(seconds, name="seconds a step", dtype=float).rename_axis("method")


Caps = Mapping[str, float | None]  # a cap for each method [rad]; None: no cap


def trials(
    tree: Tree,
    effectors: Effectors,
    motions: Mapping[str, Gait],
    *,
    caps: Mapping[str, Caps],
    starts: Array,
    rates: Iterable[int] = (15, 30, 60),
    seconds: float = 3.0,
    settle: float = 1.0,
    methods: Mapping[str, Solver] = SOLVERS,
    **options: Any,
) -> pd.DataFrame:
    """The fair experiment: every method on every motion, under every set of caps, from every start.

    caps      {name of the set: {method: cap [rad]}}
    starts    (s, n) poses to begin from [rad]
    rates     frames a second, one step a frame
    settle    the first seconds of each run, which are left out of all measures
    options   go to `step`, the same for all

    Returns a row for each motion, set of caps, rate, start and method, with the measures of
    `variants`; beside them the mean distance of the effectors that can `reach` their targets
    through the whole cycle, and of those that cannot (`out_of_reach`); not a number where there
    are none [m]. All runs of one method and rate go through one batch.
    """
    can_reach = reachable_throughout(tree, effectors, motions)
    rows = []
    for rate in rates:
        times = np.arange(1, round(seconds * rate) + 1) / rate
        targets = np.stack([motion(times) for motion in motions.values()], axis=1)
        for method, solver in methods.items():
            bounds = [
                np.inf if (c := chosen.get(method)) is None else c for chosen in caps.values()
            ]
            run = track(
                tree, effectors, targets[:, None, :, None], solver, times=times,
                theta=np.broadcast_to(starts, (len(caps), len(motions), *starts.shape)),
                max_step=np.array(bounds)[:, None, None], **options,
            )  # fmt: skip
            run = after(run, settle)
            for c, m, s in np.ndindex(run.theta.shape[1:-1]):
                error, reach = run.error[:, c, m, s], can_reach[m]
                rows.append(
                    {
                        "motion": list(motions)[m],
                        "caps": list(caps)[c],
                        "rate": rate,
                        "start": s,
                        "method": method,
                        **_measures(run, (c, m, s)),
                        "reach": error[:, reach].mean() if reach.any() else np.nan,
                        "out_of_reach": error[:, ~reach].mean() if not reach.all() else np.nan,
                    }
                )
    table = pd.DataFrame(rows)
    table["method"] = pd.Categorical(table["method"], categories=list(methods))
    return table


def reachable_throughout(
    tree: Tree, effectors: Effectors, motions: Mapping[str, Gait], phases: int = 8
) -> Mask:
    """Which effectors reach their targets in every one of so many phases of each motion: (m, k)."""
    angles = np.linspace(0, 2 * np.pi, phases, endpoint=False)
    targets = np.stack([motion.at(angles) for motion in motions.values()])
    return reachable(tree, effectors, targets).all(axis=1)


def after(run: Track, seconds: float) -> Track:
    """The run without its first seconds, in which a method finds its targets."""
    late = run.times > seconds
    if not late.any():
        raise ValueError(f"nothing of a run of {run.times[-1]:g} s is left after {seconds:g} s")
    return Track(
        run.method, run.tree, run.effectors, run.times[late], run.targets[late],
        run.theta[late][0], run.theta[late], run.error[late], run.capped[late], run.held[late],
        run.seconds,
    )  # fmt: skip


def variants(run: Track, labels: Iterable[Any], name: str = "variant") -> pd.DataFrame:
    """What a run of a batch (b,) comes to, a row for each member under its label.

    The columns are those of `summary`, with `reversals` [1/s] of a joint beside the jitter.
    """
    names = list(labels)
    if run.theta.ndim != 3 or run.theta.shape[1] != len(names):
        raise ValueError(f"{len(names)} labels do not fit a batch of {run.theta.shape[1:-1]}")
    rows = [_measures(run, (i,)) for i in range(len(names))]
    return pd.DataFrame(rows, index=pd.Index(names, name=name))


def _measures(run: Track, member: tuple[int, ...]) -> dict[str, float]:
    """The measures of one member of a batch."""
    error = run.error[:, *member]
    return {
        "mean": error.mean(),
        "median": np.median(error),
        "p95": np.quantile(error, 0.95),
        "max": error.max(),
        "jitter": run.jitter[:, *member].mean(),
        "reversals": reversals(run)[member],
        "capped": run.capped[:, *member].mean(),
        "held": run.held[:, *member].sum(axis=-1).mean(),
        "smallest_sigma": run.smallest_sigma[:, *member].min(),
    }


def spread(
    table: pd.DataFrame,
    measures: Iterable[str] = ("mean", "jitter", "reversals"),
    by: Iterable[str] = ("caps", "motion", "method"),
) -> pd.DataFrame:
    """Mean and standard deviation of measures of `trials`, over starts and rates."""
    return table.groupby(list(by), observed=True)[list(measures)].agg(["mean", "std"])


def ranking(
    table: pd.DataFrame, measure: str, by: Iterable[str] = ("caps", "motion")
) -> pd.DataFrame:
    """The methods in order of a measure of `trials`, the least first, a row for each value of `by`.

    order   the methods by their mean over starts and rates
    wins    in what share of the trials the first has less than the second: 1 is a clear verdict,
            ½ is a toss-up
    """
    by = list(by)
    rows = {}
    for key, part in table.groupby(by, observed=True):
        wide = part.pivot_table(
            index=["motion", "caps", "rate", "start"], columns="method", values=measure,
            observed=True,
        )  # fmt: skip
        order = list(wide.mean().sort_values().index)
        wins = (wide[order[0]] < wide[order[1]]).mean()
        rows[key] = {"order": " < ".join(order), "first": order[0], "wins": wins}
    ranked = pd.DataFrame.from_dict(rows, orient="index")
    ranked.index = pd.MultiIndex.from_tuples(rows, names=by)
    return ranked
