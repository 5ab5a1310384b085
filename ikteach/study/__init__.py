"""Runs as tables: the tidy log, one row per frame, method and effector, and what it comes to.

Equal inputs give equal tables; wall time, which never is equal, stands apart in `timing`.
"""

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
import pandas as pd

from ikteach.arrays import ArrayLike, Mask
from ikteach.body import Effectors, Tree, forward, jacobian, locate
from ikteach.checks import count, number, numbers, shown
from ikteach.motion import Track, reachable, track
from ikteach.motion.checks import checked
from ikteach.motion.live.log import Log, of_run, same_targets
from ikteach.motion.methods import Methods, methods_of
from ikteach.motion.reach.packages import ReachingFigure, backs_reach
from ikteach.motion.reach.reaching import Reaching, trial
from ikteach.motion.reach.ways import WAYS, Way, Ways, advance
from ikteach.names import unknown
from ikteach.solvers import SOLVERS, sdls
from ikteach.solvers.response import directions, factors
from ikteach.study.experiment import reversals

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
    smallest_sigma  smallest singular value of J, of as many as the body can have [m/rad]: 0 is
                    singular

    ValueError if the run is a batch, has no frame or a number that is not finite.
    """
    if of_run(run).theta.ndim != 2:
        raise ValueError(f"a log is of one run, not of a batch of shape {run.theta.shape[1:-1]}")
    if can_reach is None:
        can_reach = reachable(run.tree, run.effectors, run.targets)
    frames, k = run.error.shape
    can_reach = np.asarray(can_reach)
    if can_reach.shape != (frames, k):
        raise ValueError(f"can_reach needs the shape {(frames, k)}, not {can_reach.shape}")

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
            "reachable": can_reach.astype(bool).ravel(),
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
    methods: Methods = SOLVERS,
    *,
    max_step: Mapping[str, float | None] | ArrayLike | None = None,
    **options: Any,
) -> dict[str, Track]:
    """Every method on the same targets (T, k, 3) from the same start: {method: Track}.

    methods   {name: solver}, or one or more solvers or names of `SOLVERS` (`methods_of`)
    max_step  one step cap for all [rad], or a cap for each method, such as `BUSS_CAPS`; methods
              that it does not name have none
    options   go to `track` and `step`, the same for all
    """
    chosen = methods_of(methods)
    if isinstance(max_step, Mapping):
        for name in set(max_step) - set(chosen) - set(SOLVERS):  # BUSS_CAPS may name more
            raise LookupError(unknown("method", name, chosen))

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
    methods: Methods = SOLVERS,
    **options: Any,
) -> pd.DataFrame:
    """The logs of every method on the same targets, one under the other. Arguments as in `runs`."""
    return together(runs(tree, effectors, targets, methods, **options))


def together(tracks: Mapping[str, Track]) -> pd.DataFrame:
    """One log of several runs on the same targets; `method` is the name each has in `tracks`.

    ValueError if there is none, or if they do not follow the same targets at the same times.
    """
    can_reach: dict[tuple[int, int], Mask] = {}  # of each body once
    logs = []
    for name, run in zip(tracks, same_targets(tracks), strict=True):
        body = id(run.tree), id(run.effectors)
        if body not in can_reach:
            can_reach[body] = reachable(run.tree, run.effectors, run.targets)
        logs.append(log(run, can_reach=can_reach[body]).assign(method=name))
    table = pd.concat(logs, ignore_index=True)
    table["method"] = pd.Categorical(table["method"], categories=list(tracks))
    return table


def columns_of(table: pd.DataFrame, columns: Iterable[str], numeric: bool = False) -> list[str]:
    """Check that a table has rows and these columns, of numbers where `numeric`: their names.

    `columns` may be one name alone. LookupError for one that is not there.
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
    """What a log comes to, a row for each value of `by`.

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
    """Measure batches (b,) of runs: what they come to at least, in the middle and at most.

    Rows and measures are those of `summary`; each measure is three columns, least, median and most
    over the batch. For runs that may be chaotic, from starts such as those of
    `ikteach.study.experiment.nearby`: there one run says nothing.
    """
    if not tracks:
        raise ValueError("there are no runs to measure")
    return pd.concat({m: _spread(run) for m, run in tracks.items()}, names=["method", "effector"])


def _spread(run: Track) -> pd.DataFrame:
    """Least, median and most of each measure over the members of a batch, a row per effector."""
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
    """Write a table of `many` to be read: two digits of the median, and the range in brackets.

    Where all runs agree to two digits there is no range.
    """

    def told(least: float, median: float, most: float) -> str:
        low, middle, high = (f"{round(value, 4):.2g}" for value in (least, median, most))
        return middle if low == high else f"{middle} ({low} to {high})"

    measures = dict.fromkeys(table.columns.get_level_values(0))
    cells = {name: [told(*row) for row in table[name].to_numpy()] for name in measures}
    return pd.DataFrame(cells, table.index)


def by_phase(table: pd.DataFrame, period: float, parts: int = 24) -> pd.DataFrame:
    """Mean distance to target [m] in each part of the cycle: rows phase 0..1, a column for each
    method and effector. `period` is the gait's [s].
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
    """A glance at live runs: a row a method, the mean distance of each effector in cm, and beside
    it what distance hides: the worst distance [cm], jitter [°] and joints held at limits.

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
    """Names of columns for effectors, other than those of what stands beside them."""
    taken = "worst", "jitter", "held"
    return [f"effector {name}" if name in taken else name for name in effectors.names]


def timing(tracks: Mapping[str, Track]) -> pd.Series:
    """Wall time of one step of each run [s]; it belongs to this machine and this moment."""
    same_targets(tracks)
    seconds = {name: run.seconds for name, run in tracks.items()}
    return pd.Series(seconds, name="seconds a step", dtype=float).rename_axis("method")


def ticks(run: Log) -> pd.DataFrame:
    """What happened in a session, tidy: a row per tick, method and effector.

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
    """The poses of a session [rad]: a row per tick and method, a column per joint."""
    index = pd.MultiIndex.from_product([_session(run).tick, run.methods], names=["tick", "method"])
    theta = run.theta.reshape(-1, len(run.tree))
    return pd.DataFrame(theta, index=index, columns=list(run.tree.names))


def events(run: Log) -> pd.DataFrame:
    """What was changed in a session: a row per event, in words."""
    rows = [(e.run, e.tick, e.time, e.kind, str(e)) for e in _session(run).events]
    return pd.DataFrame(rows, columns=["run", "tick", "time", "kind", "words"])


def _session(run: Log) -> Log:
    if not isinstance(run, Log):
        raise TypeError(f"what happened is in a Log, as `session.log()` makes, not {shown(run)}")
    return run


def after(run: Track, seconds: float) -> Track:
    """The run without its first seconds, in which a method finds its targets."""
    late = of_run(run).times > number("seconds", seconds)
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
    names = list(labels) if isinstance(labels, Iterable) else [labels]
    if of_run(run).theta.ndim != 3 or run.theta.shape[1] != len(names):
        raise ValueError(f"{len(names)} labels do not fit a batch of {run.theta.shape[1:-1]}")
    rows = [measures(run, (i,)) for i in range(len(names))]
    return pd.DataFrame(rows, index=pd.Index(names, name=name))


def overview(tracks: Mapping[str, Track], name: str = "method") -> pd.DataFrame:
    """What runs without batches come to, a row for each: the columns of `variants`.

    It asks nobody what can be reached, and is quick where the full `log` is not.
    """
    rows = [measures(run, ()) for run in same_targets(tracks)]
    return pd.DataFrame(rows, index=pd.Index(list(tracks), name=name))


def by_direction(
    tree: Tree, effectors: Effectors, theta: ArrayLike, targets: ArrayLike, **options: Any
) -> pd.DataFrame:
    """What SDLS makes of each singular direction i at a pose θ (n,) with targets (k, 3).

    σ [m/rad], asked u_iᵀe [m], N, M, γ [rad], the factor f that SDLS takes [rad/m], and the share
    of 1/σ that it leaves; no number where nothing is asked. `options` go to `sdls`.
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
        "σ": found.sigma, "asked": found.alpha, "N": found.N, "M": found.M, "γ": found.gamma,
        "f": f, "share": f * found.sigma,
    }  # fmt: skip
    return pd.DataFrame(columns, index=pd.RangeIndex(1, len(f) + 1, name="i"))


def measures(run: Track, member: tuple[Any, ...]) -> dict[str, float]:
    """The measures of one member of a batch; () where there is no batch."""
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


def standings(session: Reaching) -> pd.DataFrame:
    """How each way stands with the cursor where it is now, a row a way (chapter 10).

    distance [cm]      from the hand to the cursor
    largest step [°]   of a joint in one tick, since the cursor moved
    det                of the 3 × 3 J of CS 490 [m³/rad³]; for the general methods √det JJᵀ
    smallest σ         of the J in use [m/rad]
    ticks              after which the hand arrived and stayed; none if it has not
    how it stands      in words
    """
    rows = {
        name: {
            "distance [cm]": 100 * float(one.tick.distance),
            "largest step [°]": np.degrees(one.largest),
            "det": float(one.tick.det),
            "smallest σ": float(one.tick.sigma),
            "ticks": one.arrived,
            "how it stands": one.words,
        }
        for name, one in session.standing.items()
    }
    table = pd.DataFrame.from_dict(rows, orient="index").rename_axis("method")
    return table.astype({"ticks": "Int64"})


def reaches(cursors: ArrayLike, ways: Mapping[str, Way] = WAYS, **options: Any) -> pd.DataFrame:
    """Each way from rest to each of the cursors (b, 3), a row a way (chapter 10).

    arrived        share that came within a centimetre and stayed
    median, p95    ticks that those took
    largest [°]    the largest step of a joint in one tick, of all runs
    silent         share that no package answers
    oscillates     share whose poses repeat themselves for ever
    unsettled      share that still moves at the end and does not repeat itself
    options        go to `motion.reach.trial`
    """
    body, rows = ReachingFigure(), {}
    for name, way in Ways.of(ways).items():
        run = trial(body, cursors, way, **options)
        ticks = run.ticks[run.arrived]
        rows[name] = {
            "arrived": run.arrived.mean(),
            "median": np.median(ticks) if len(ticks) else np.nan,
            "p95": np.percentile(ticks, 95) if len(ticks) else np.nan,
            "largest [°]": np.degrees(run.largest.max()),
            "silent": run.silent.mean(),
            "oscillates": (run.period > 0).mean(),
            "unsettled": (~run.settled & (run.period == 0)).mean(),
        }
    return pd.DataFrame.from_dict(rows, orient="index").rename_axis("method")


def follow(cursors: ArrayLike, way: Way, ticks: int | None = None, **options: Any) -> pd.DataFrame:
    """One way from rest after cursors (T, 3), or for so many `ticks` after (3,): a row a tick.

    distance [cm]      from the hand to the cursor
    elbow, back [°]    how far they are bent
    det, smallest σ    of J in use, as in `standings`
    largest step [°]   of a joint, the neck's left out
    options            go to `motion.ways.advance`
    """
    body, places = ReachingFigure(), numbers("the cursors", cursors)
    if ticks is not None:
        if places.shape != (3,):
            raise ValueError(f"for some ticks a cursor is x, y and z, not of shape {places.shape}")
        places = np.broadcast_to(places, (count("ticks", ticks), 3))
    if places.ndim != 2 or places.shape[1] != 3 or not len(places):
        raise ValueError(
            f"cursors have the shape (T, 3), or say how many ticks; not {places.shape}"
        )
    theta, rows = body.tree.rest, []
    for cursor, backs in zip(places, backs_reach(body, places), strict=True):
        tick = advance(body, theta, cursor, way, backs=backs, **options)
        turned = np.delete(abs(tick.theta - theta), body.neck)
        theta = tick.theta
        rows.append(
            {
                "distance [cm]": 100 * float(tick.distance),
                "elbow [°]": np.degrees(theta[body.arm("r" if cursor[0] < 0 else "l")[2]]),
                "back [°]": np.degrees(theta[body.back]),
                "det": float(tick.det),
                "smallest σ": float(tick.sigma),
                "largest step [°]": np.degrees(turned.max()),
            }
        )
    return pd.DataFrame(rows, index=pd.RangeIndex(1, len(rows) + 1, name="tick"))
