"""Chapter 8. A fair experiment: every method in every condition, and what it came to."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property, partial
from inspect import signature
from itertools import product
from types import MappingProxyType
from typing import Any, Protocol

import numpy as np
import pandas as pd

from ikteach.arrays import Array, ArrayLike, Mask
from ikteach.body import Effectors, Tree
from ikteach.checks import count, function, number, numbers, shown
from ikteach.motion import Track, hold, reachable, track
from ikteach.motion.methods import Methods, methods_of
from ikteach.motion.rules import LimitRule
from ikteach.names import unknown
from ikteach.solvers import SOLVERS, Solver
from ikteach.study.measures import columns_of, measures
from ikteach.study.runs import after

Caps = Mapping[str, float | None]  # a cap per method [rad]; None: no cap
NO_CAPS: Mapping[str, Caps] = MappingProxyType({"none": {}})
HOLD: Mapping[str, LimitRule] = MappingProxyType({"hold": hold})
FACTORS = ["method", "limits", "motion", "caps", "damping", "start"]  # of an experiment


class TargetsOfTime(Protocol):
    """Targets of time, as a `Gait` gives them."""

    def __call__(self, T: Array, /) -> Array:
        """Find the targets (T, k, 3) at times (T,) [s]."""

    def at(self, phase: Array, /) -> Array:
        """Find the targets (p, k, 3) at phases (p,) [rad]."""


@dataclass(frozen=True, eq=False)
class Trials:
    """The runs of an experiment, and their measures.

    table   a row per run
            method, limits, motion, caps, damping (λ), start   its factors
            mean, median, p95, max    of the distance to target [m]
            reach, out_of_reach       its mean over effectors that can reach their targets through
                                      the whole cycle, and over the others; NaN where there are none
            jitter, acceleration      mean ‖Δ²θ‖ [rad], and that by the square of a tick [rad/s²]
            reversals                 of a joint [1/s]
            capped, held, smallest_sigma   as in `summary`
    tracks  the runs in the order of the rows, a batch (motions, caps, starts) after the other
    settle  how long no run was measured [s]
    """

    table: pd.DataFrame
    tracks: tuple[Track, ...]
    settle: float

    def run(self, row: int) -> Track:
        """Return the run of a row of `table`, all of its frames."""
        if not 0 <= row < len(self.table):
            raise IndexError(f"the experiment has rows 0 to {len(self.table) - 1}, not {row}")
        part, place = divmod(row, len(self.table) // len(self.tracks))
        batch = self.tracks[part]
        return member_of(batch, np.unravel_index(place, batch.theta.shape[1:-1]))

    def at_every_damping(self, row: int) -> bool:
        """Tell whether the run of a row stands at several λ.

        So it is if its method has none.
        """
        batch = self.tracks[row // (len(self.table) // len(self.tracks))]
        return sum(one is batch for one in self.tracks) > 1

    @cached_property
    def distances(self) -> pd.DataFrame:
        """The distance [m], a row per run and effector.

        Its mean, p95 and max; `run` is the row of `table`.
        """
        runs = [after(self.run(row), self.settle) for row in range(len(self.table))]
        error = np.stack([run.error for run in runs])  # (rows, T, k)
        names = list(runs[0].effectors.names)
        columns = {"mean": error.mean(axis=1), "p95": np.quantile(error, 0.95, axis=1)}
        columns |= {"max": error.max(axis=1)}
        far = pd.DataFrame({name: values.ravel() for name, values in columns.items()})
        far = far.assign(effector=pd.Categorical(names * len(runs), categories=names))
        rows = self.table.loc[np.repeat(self.table.index, len(names)), FACTORS]
        return pd.concat([rows.reset_index(names="run"), far], axis=1)


def trials(
    tree: Tree,
    effectors: Effectors,
    motions: Mapping[str, TargetsOfTime],
    *,
    starts: ArrayLike,
    caps: Mapping[str, Caps] = NO_CAPS,
    limits: Mapping[str, LimitRule] = HOLD,
    dampings: Iterable[float] = (0.1,),
    methods: Methods = SOLVERS,
    rate: float = 30,
    seconds: float = 3.0,
    settle: float = 1.0,
    can_reach: Mask | None = None,
) -> Trials:
    """Run every method on every motion in every condition.

    motions   {name: gait}, or any function of times (T,) that gives targets (T, k, 3) [m] and has
              them by phase under `at`, as a `Gait` has
    starts    (s, n) poses to begin from [rad]
    caps      {name of the set: {method: cap [rad]}}
    limits    {name: limit rule}, such as `hold` and `clip`
    dampings  λ of each method that has an option `damping` which is not bound [m/rad]; the others
              run once, and their rows stand at every λ
    rate      frames per second, one step per frame
    settle    the first seconds of each run, which are left out of all measures
    can_reach (m, k) of `reachable_throughout`, where it is known already

    ValueError or LookupError says what of this does not fit.
    """
    named, poses = methods_of(methods), _poses(tree, starts)
    _check_caps(caps, named)
    _check_limits(limits)
    times, lambdas = _times(rate, seconds, settle), _dampings(dampings)
    can_reach = _can_reach(tree, effectors, motions, can_reach)
    targets = _targets(effectors, motions, times, by_phase=False).swapaxes(0, 1)
    targets = targets[:, :, None, None]  # (T, motions, caps, starts, k, 3)
    theta = np.broadcast_to(poses, (len(motions), len(caps), *poses.shape))
    levels: dict[str, Any] = {"motion": [*motions], "caps": [*caps], "start": range(len(poses))}
    cells = pd.DataFrame(product(*levels.values()), columns=[*levels])
    tracks, tables = [], []
    for (rule, limit), (method, solver) in product(limits.items(), named.items()):
        cap = _caps(caps, method)
        follow = partial(track, tree, effectors, targets, times=times, theta=theta, max_step=cap)
        for bound, at in _at_each(lambdas, solver):
            run = replace(follow(bound, limits=limit), method=method)
            measured = _measured(after(run, settle), can_reach, rate)
            columns = {name: values.ravel() for name, values in measured.items()}
            for damping in at:
                tracks.append(run)
                tables.append(cells.assign(method=method, limits=rule, damping=damping, **columns))
    table = pd.concat(tables, ignore_index=True)
    table["method"] = pd.Categorical(table["method"], categories=list(named))
    table = table[[*FACTORS, *table.columns.difference(FACTORS, sort=False)]]
    return Trials(table, tuple(tracks), settle)


def _measured(run: Track, can_reach: Mask, rate: float) -> dict[str, Array]:
    """Measure a batch (motions, caps, starts) of runs; effectors (m, k) reach or not."""
    found = measures(run)
    jitter = found["jitter"]
    return found | {
        "acceleration": jitter * rate**2,
        "reach": _mean_where(run.error, can_reach),
        "out_of_reach": _mean_where(run.error, ~can_reach),
    }


def _mean_where(error: Array, those: Mask) -> Array:
    """Average distances (T, m, caps, starts, k) over those effectors (m, k); NaN of none."""
    each, those = error.mean(axis=0), those[:, None, None].astype(float)
    many = those.sum(axis=-1)
    return np.divide((each * those).sum(axis=-1), np.where(many, many, np.nan))


def member_of(run: Track, member: tuple[Any, ...]) -> Track:
    """Take one run out of a batch."""
    batch = run.theta.shape[1:-1]
    targets = np.broadcast_to(run.targets, (len(run), *batch, *run.targets.shape[-2:]))
    of: dict[str, Any] = {
        name: getattr(run, name)[:, *member] for name in ("theta", "error", "capped", "held")
    }
    of |= {"targets": targets[:, *member], "start": run.start[member]}
    return replace(run, **of)


def _times(rate: float, seconds: float, settle: float) -> Array:
    """Find the time of each frame (T,) [s], and refuse that none is left to be measured."""
    rate, seconds, settle = (
        number("rate", rate),
        number("seconds", seconds),
        number("settle", settle),
    )
    if not rate * (seconds - settle) >= 1:
        raise ValueError(
            f"at {rate:g} frames per second none is left of {seconds:g} s after {settle:g} s"
        )
    return np.arange(1, round(seconds * rate) + 1) / rate


def _dampings(dampings: Iterable[float]) -> list[float]:
    """Check the values of λ."""
    lambdas = [number("λ", one) for one in np.atleast_1d(numbers("dampings", list(dampings)))]
    if not lambdas or len(set(lambdas)) < len(lambdas):
        raise ValueError(f"dampings are one λ or more, each once, not {shown(lambdas)}")
    return lambdas


def _at_each(lambdas: list[float], solver: Solver) -> list[tuple[Solver, list[float]]]:
    """Bind λ; a solver that has none, or none that is free, stands for all of them."""
    bound = solver.keywords if isinstance(solver, partial) else {}
    if "damping" in bound or "damping" not in signature(solver).parameters:
        return [(solver, lambdas)]
    return [(partial(solver, damping=one), [one]) for one in lambdas]


def _check_limits(limits: Mapping[str, LimitRule]) -> None:
    if not (isinstance(limits, Mapping) and limits):
        raise ValueError(f"limits are {{name: limit rule}}, at least one, not {shown(limits)}")
    for name, rule in limits.items():
        function(f"the limit rule {shown(name)}", rule)


def _can_reach(
    tree: Tree, effectors: Effectors, motions: Mapping[str, TargetsOfTime], known: Mask | None
) -> Mask:
    """Find which effectors can reach (m, k), where it is not `known`."""
    if known is None:
        return reachable_throughout(tree, effectors, motions)
    known = np.asarray(known, dtype=bool)
    if known.shape != (len(motions), len(effectors)):
        wanted = len(motions), len(effectors)
        raise ValueError(f"can_reach needs the shape {wanted}, not {known.shape}")
    return known


def _poses(tree: Tree, starts: ArrayLike) -> Array:
    poses = numbers("starts", starts)
    if poses.ndim != 2 or poses.shape[1] != len(tree) or not len(poses):
        raise ValueError(f"starts need the shape (s, {len(tree)}), not {poses.shape}")
    return poses


def _caps(caps: Mapping[str, Caps], method: str) -> Array:
    """Give the cap of a method in each set [rad], (caps, 1)."""
    chosen = [group.get(method) for group in caps.values()]
    return np.array([np.inf if cap is None else cap for cap in chosen])[:, None]


def _check_caps(caps: Mapping[str, Caps], methods: Iterable[str]) -> None:
    if not (isinstance(caps, Mapping) and caps):
        raise ValueError(f"caps are {{name: {{method: cap}}}}, at least one, not {shown(caps)}")
    for group in caps.values():
        if not isinstance(group, Mapping):
            raise ValueError(f"a set of caps is {{method: cap}}, not {shown(group)}")
        for name in set(group) - set(methods) - set(SOLVERS):
            raise LookupError(unknown("method", name, methods))


def _targets(
    effectors: Effectors, motions: Mapping[str, TargetsOfTime], when: Array, *, by_phase: bool
) -> Array:
    """Find the targets (m, T, k, 3) of each motion at times or phases (T,)."""
    if not (isinstance(motions, Mapping) and motions):
        raise ValueError(f"motions are {{name: gait}}, at least one, not {shown(motions)}")
    found = []
    for name, motion in motions.items():
        if not (callable(motion) and hasattr(motion, "at")):
            raise TypeError(f"the motion {shown(name)} is no gait but {shown(motion)}")
        given = motion.at(when) if by_phase else motion(when)
        targets = numbers(f"targets of {shown(name)}", given)
        if targets.shape != (len(when), len(effectors), 3):
            k = len(effectors)
            raise ValueError(
                f"the motion {shown(name)} gives targets {targets.shape}, and this body needs"
                f" ({len(when)}, {k}, 3)"
            )
        found.append(targets)
    return np.stack(found)


def reachable_throughout(
    tree: Tree, effectors: Effectors, motions: Mapping[str, TargetsOfTime], phases: int = 8
) -> Mask:
    """Tell which effectors reach their targets in all phases: (m, k)."""
    angles = np.linspace(0, 2 * np.pi, count("phases", phases), endpoint=False)
    targets = _targets(effectors, motions, angles, by_phase=True)
    return np.asarray(reachable(tree, effectors, targets).all(axis=1))


def ranking(
    table: pd.DataFrame,
    measure: str,
    by: Iterable[str] = ("limits", "motion", "caps", "damping"),
) -> pd.DataFrame:
    """Rank the methods by a measure of `trials`.

    order   the methods by their median over the starts, the least first
    wins    in what share of the starts the first has less than the second: 1 is a clear verdict,
            ½ is a toss-up

    ValueError unless there are two methods at least.
    """
    by = columns_of(table, by)
    columns_of(table, [measure], numeric=True)
    columns_of(table, FACTORS)
    if table["method"].nunique() < 2:
        raise ValueError("a ranking needs trials of two methods or more")
    trial = [name for name in FACTORS if name != "method"]
    rows: dict[Any, dict[str, Any]] = {}
    for key, part in table.groupby(by, observed=True):
        wide = part.pivot_table(measure, index=trial, columns="method", observed=True)
        order = list(wide.median().sort_values().index)
        if len(order) < 2:  # nothing was measured, as of `reach` where nothing can be reached
            rows[key] = {"order": " < ".join(order), "first": "", "wins": np.nan}
            continue
        wins = (wide[order[0]] < wide[order[1]]).mean()
        rows[key] = {"order": " < ".join(order), "first": order[0], "wins": wins}
    ranked = pd.DataFrame.from_dict(rows, orient="index")
    ranked.index = pd.MultiIndex.from_tuples(rows, names=by)
    return ranked
