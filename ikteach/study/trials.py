"""Chapter 8. A fair experiment: every method, from many poses, at several rates; its verdict."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd

from ikteach.arrays import Array, ArrayLike, Mask
from ikteach.body import Effectors, Tree
from ikteach.checks import count, number, numbers, shown
from ikteach.motion import Gait, Track, reachable, track
from ikteach.motion.methods import Methods, methods_of
from ikteach.names import unknown
from ikteach.solvers import SOLVERS
from ikteach.study.measures import columns_of, measures
from ikteach.study.runs import after

Caps = Mapping[str, float | None]  # a cap per method [rad]; None: no cap


def trials(
    tree: Tree,
    effectors: Effectors,
    motions: Mapping[str, Gait],
    *,
    caps: Mapping[str, Caps],
    starts: ArrayLike,
    rates: Iterable[int] = (15, 30, 60),
    seconds: float = 3.0,
    settle: float = 1.0,
    can_reach: Mask | None = None,
    methods: Methods = SOLVERS,
    **options: Any,
) -> pd.DataFrame:
    """Run every method on every motion under all caps.

    motions   {name: gait}, or any function of times (T,) that gives targets (T, k, 3) [m] and has
              them by phase under `at`, as a `Gait` has
    caps      {name of the set: {method: cap [rad]}}
    starts    (s, n) poses to begin from [rad]
    rates     frames per second, one step per frame
    settle    the first seconds of each run, which are left out of all measures
    can_reach (m, k) of `reachable_throughout`, where it is known already
    options   go to `step`, the same for all

    Returns a row per motion, set of caps, rate, start and method, with the measures of `variants`
    and the mean distance [m] of the effectors that can `reach` their targets through the whole
    cycle, and of the others (`out_of_reach`); NaN where there are none.
    ValueError or LookupError says what of this does not fit.
    """
    named, poses = methods_of(methods), _poses(tree, starts)
    rates = _rates(rates, seconds, settle)
    _check_caps(caps, named)
    can_reach = _can_reach(tree, effectors, motions, can_reach)
    theta = np.broadcast_to(poses, (len(caps), len(motions), *poses.shape))
    rows: list[dict[str, Any]] = []
    for rate in rates:
        times = np.arange(1, round(seconds * rate) + 1) / rate
        targets = _targets(effectors, motions, times, by_phase=False).swapaxes(0, 1)
        targets = targets[:, None, :, None]  # (T, caps, motions, starts, k, 3)
        for method, solver in named.items():
            cap = _caps(caps, method)
            run = track(
                tree, effectors, targets, solver, times=times, theta=theta, max_step=cap, **options
            )
            run = replace(after(run, settle), method=method)
            rows += _rows(run, can_reach, list(motions), list(caps), rate)
    table = pd.DataFrame(rows)
    table["method"] = pd.Categorical(table["method"], categories=list(named))
    return table


def _rows(
    run: Track, can_reach: Mask, motions: list[str], caps: list[str], rate: int
) -> Iterator[dict[str, Any]]:
    """Measure each trial of a run of batch (caps, motions, starts)."""
    for c, m, s in np.ndindex(run.theta.shape[1:-1]):
        error, reach = run.error[:, c, m, s], can_reach[m]
        yield {
            "motion": motions[m],
            "caps": caps[c],
            "rate": rate,
            "start": s,
            "method": run.method,
            **measures(run, (c, m, s)),
            "reach": error[:, reach].mean() if reach.any() else np.nan,
            "out_of_reach": error[:, ~reach].mean() if not reach.all() else np.nan,
        }


def _rates(rates: Iterable[int], seconds: float, settle: float) -> list[int]:
    """Refuse rates at which no frame is left to be measured."""
    rates = list(rates)
    for rate in rates:
        if not number("a rate", rate) * (seconds - settle) >= 1:
            raise ValueError(
                f"at {rate} frames per second none is left of {seconds} s after {settle} s"
            )
    return rates


def _can_reach(
    tree: Tree, effectors: Effectors, motions: Mapping[str, Gait], known: Mask | None
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
    """Give the cap of a method in each set [rad], (caps, 1, 1)."""
    chosen = [group.get(method) for group in caps.values()]
    return np.array([np.inf if cap is None else cap for cap in chosen])[:, None, None]


def _check_caps(caps: Mapping[str, Caps], methods: Iterable[str]) -> None:
    if not (isinstance(caps, Mapping) and caps):
        raise ValueError(f"caps are {{name: {{method: cap}}}}, at least one, not {shown(caps)}")
    for group in caps.values():
        if not isinstance(group, Mapping):
            raise ValueError(f"a set of caps is {{method: cap}}, not {shown(group)}")
        for name in set(group) - set(methods) - set(SOLVERS):
            raise LookupError(unknown("method", name, methods))


def _targets(
    effectors: Effectors, motions: Mapping[str, Gait], when: Array, *, by_phase: bool
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
    tree: Tree, effectors: Effectors, motions: Mapping[str, Gait], phases: int = 8
) -> Mask:
    """Tell which effectors reach their targets in all phases: (m, k)."""
    angles = np.linspace(0, 2 * np.pi, count("phases", phases), endpoint=False)
    targets = _targets(effectors, motions, angles, by_phase=True)
    return np.asarray(reachable(tree, effectors, targets).all(axis=1))


def spread(
    table: pd.DataFrame,
    measures: Iterable[str] = ("mean", "jitter", "reversals"),
    by: Iterable[str] = ("caps", "motion", "method"),
) -> pd.DataFrame:
    """Average measures of `trials` over starts and rates."""
    by, measures = columns_of(table, by), columns_of(table, measures, numeric=True)
    return table.groupby(by, observed=True)[measures].agg(["mean", "std"])


def ranking(
    table: pd.DataFrame, measure: str, by: Iterable[str] = ("caps", "motion")
) -> pd.DataFrame:
    """Rank the methods by a measure of `trials`.

    order   the methods by their mean over starts and rates, the least first
    wins    in what share of the trials the first has less than the second: 1 is a clear verdict,
            ½ is a toss-up

    ValueError unless there are two methods at least.
    """
    by = columns_of(table, by)
    columns_of(table, [measure], numeric=True)
    columns_of(table, ["motion", "caps", "rate", "start", "method"])
    if table["method"].nunique() < 2:
        raise ValueError("a ranking needs trials of two methods or more")
    rows: dict[Any, dict[str, Any]] = {}
    for key, part in table.groupby(by, observed=True):
        trial = ["motion", "caps", "rate", "start"]
        wide = part.pivot_table(measure, index=trial, columns="method", observed=True)
        order = list(wide.mean().sort_values().index)
        if len(order) < 2:  # nothing was measured, as of `reach` where nothing can be reached
            rows[key] = {"order": " < ".join(order), "first": "", "wins": np.nan}
            continue
        wins = (wide[order[0]] < wide[order[1]]).mean()
        rows[key] = {"order": " < ".join(order), "first": order[0], "wins": wins}
    ranked = pd.DataFrame.from_dict(rows, orient="index")
    ranked.index = pd.MultiIndex.from_tuples(rows, names=by)
    return ranked


def claims(
    table: pd.DataFrame,
    reach: Mapping[str, Mask],
    times: Mapping[str, float],
    arrivals: Mapping[str, float],
) -> pd.DataFrame:
    """Hold claims about the methods against the numbers.

    table     of `trials`
    reach     {motion: (k,)} of `reachable_throughout`, in the thesis's order: feet, then hands
    times     seconds per step, of `step_times`
    arrivals  steps until the target, of `iterations`
    SDLS counts as slower where it takes over a tenth more time than DLS, of which it is a variant.
    """
    _check_known(reach, times, arrivals)
    walk, run = np.asarray(reach["walking"]), np.asarray(reach["running"])
    total = {name: times[name] * arrivals[name] for name in times}
    pace, wait = _ratios(times), _ratios(total)
    last = ranking(table, "jitter")["order"].str.endswith("transpose").mean()
    firsts = pd.concat(
        [ranking(table, measure)["first"] == "sdls" for measure in ("mean", "jitter", "reversals")]
    ).mean()
    feet, hands = walk[:2].sum(), walk[2:].sum()
    rows = [
        ("thesis 5.2", "walking: both feet reach, no hand", "nearest pose"),
        ("thesis 5.2", "running: none of the four reach", "nearest pose"),
        ("thesis 5.3", "SDLS is slower", "time per step"),
        ("thesis 5.3", "SDLS is slower", "time to arrive"),
        ("thesis 7.1", "SDLS is not slower", "time per step"),
        ("thesis 7.1", "SDLS is not slower", "time to arrive"),
        ("often said", "the transpose is the jerkiest", "jitter, last"),
        ("often said", "SDLS is best in all", "distance, jitter, reversals"),
    ]
    table = pd.DataFrame(rows, columns=["source", "says", "measured by"])
    slower = [ratios["dls"] > 1.1 for ratios in (pace, wait)]
    holds = [feet == 2 and hands == 0, not run.any(), *slower, *np.logical_not(slower)]
    table["holds"] = np.array([*holds, last == 1, firsts == 1], dtype=bool)
    table["numbers"] = [
        f"{feet} feet, {hands} hands",
        f"{run.sum()} of {run.size}",
        *map(_told, [pace, wait, pace, wait]),
        f"in {last:.0%} of the cases",
        f"first in {firsts:.0%} of the cases",
    ]
    return table


def _check_known(
    reach: Mapping[str, Mask], times: Mapping[str, float], arrivals: Mapping[str, float]
) -> None:
    for what, needed, given in (
        ("motion", ("walking", "running"), reach),
        ("method", SOLVERS, times),
        ("method", SOLVERS, arrivals),
    ):
        for name in needed:
            if name not in given:
                raise LookupError(f"the claims are about {name!r}: {unknown(what, name, given)}")


def _ratios(times: Mapping[str, float]) -> dict[str, float]:
    """How many times as long SDLS takes as each of the others."""
    return {name: times["sdls"] / seconds for name, seconds in times.items() if name != "sdls"}


def _told(ratios: Mapping[str, float]) -> str:
    return ", ".join(f"{ratio:.1f} × {name}" for name, ratio in ratios.items())
