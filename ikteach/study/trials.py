"""Chapter 8. A fair experiment: every method, from many poses, at several rates; its verdict."""

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
import pandas as pd

from ikteach.arrays import Array, ArrayLike, Mask
from ikteach.body import Effectors, Tree
from ikteach.checks import count, number, numbers, shown
from ikteach.motion import Gait, reachable, track
from ikteach.motion.methods import Methods, methods_of
from ikteach.names import unknown
from ikteach.solvers import SOLVERS
from ikteach.study import after, columns_of, measures

Caps = Mapping[str, float | None]  # a cap for each method [rad]; None: no cap


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
    """The fair experiment: every method on every motion, under every set of caps, from every start.

    motions   {name: gait}, or any function of times (T,) that gives targets (T, k, 3) [m] and has
              them by phase under `at`, as a `Gait` has
    caps      {name of the set: {method: cap [rad]}}
    starts    (s, n) poses to begin from [rad]
    rates     frames a second, one step a frame
    settle    the first seconds of each run, which are left out of all measures
    can_reach (m, k) of `reachable_throughout`, where it is known already
    options   go to `step`, the same for all

    Returns a row for each motion, set of caps, rate, start and method, with the measures of
    `variants`; beside them the mean distance of the effectors that can `reach` their targets
    through the whole cycle, and of those that cannot (`out_of_reach`); not a number where there
    are none [m]. All runs of one method and rate go through one batch.
    ValueError or LookupError says what of this does not fit.
    """
    named, starts, rates = methods_of(methods), _starts(tree, starts), list(rates)
    for rate in rates:
        if not number("a rate", rate) * (seconds - settle) >= 1:
            raise ValueError(
                f"at {rate} frames per second none is left of {seconds} s after {settle} s"
            )
    _check_caps(caps, named)
    if can_reach is None:
        can_reach = reachable_throughout(tree, effectors, motions)
    can_reach = np.asarray(can_reach, dtype=bool)
    if can_reach.shape != (len(motions), len(effectors)):
        wanted = len(motions), len(effectors)
        raise ValueError(f"can_reach needs the shape {wanted}, not {can_reach.shape}")
    rows = []
    for rate in rates:
        times = np.arange(1, round(seconds * rate) + 1) / rate
        targets = _targets(effectors, motions, times, by_phase=False).swapaxes(0, 1)
        for method, solver in named.items():
            chosen = [group.get(method) for group in caps.values()]
            bounds = [np.inf if bound is None else bound for bound in chosen]
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
                        **measures(run, (c, m, s)),
                        "reach": error[:, reach].mean() if reach.any() else np.nan,
                        "out_of_reach": error[:, ~reach].mean() if not reach.all() else np.nan,
                    }
                )
    table = pd.DataFrame(rows)
    table["method"] = pd.Categorical(table["method"], categories=list(named))
    return table


def _starts(tree: Tree, starts: ArrayLike) -> Array:
    poses = numbers("starts", starts)
    if poses.ndim != 2 or poses.shape[1] != len(tree) or not len(poses):
        raise ValueError(f"starts need the shape (s, {len(tree)}), not {poses.shape}")
    return poses


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
    """The targets (m, T, k, 3) of each motion at times, or phases, (T,)."""
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
    """Which effectors reach their targets in every one of so many phases of each motion: (m, k)."""
    angles = np.linspace(0, 2 * np.pi, count("phases", phases), endpoint=False)
    targets = _targets(effectors, motions, angles, by_phase=True)
    return np.asarray(reachable(tree, effectors, targets).all(axis=1))


def spread(
    table: pd.DataFrame,
    measures: Iterable[str] = ("mean", "jitter", "reversals"),
    by: Iterable[str] = ("caps", "motion", "method"),
) -> pd.DataFrame:
    """Mean and standard deviation of measures of `trials`, over starts and rates."""
    by, measures = columns_of(table, by), columns_of(table, measures, numeric=True)
    return table.groupby(by, observed=True)[measures].agg(["mean", "std"])


def ranking(
    table: pd.DataFrame, measure: str, by: Iterable[str] = ("caps", "motion")
) -> pd.DataFrame:
    """The methods in order of a measure of `trials`, the least first, a row for each value of `by`.

    order   the methods by their mean over starts and rates
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
        wide = part.pivot_table(
            index=["motion", "caps", "rate", "start"], columns="method", values=measure,
            observed=True,
        )  # fmt: skip
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
    """Sentences about the methods, each held against the numbers: a row for each.

    table     of `trials`
    reach     {motion: (k,)} of `reachable_throughout`, in the thesis's order: feet, then hands
    times     seconds a step, of `step_times`
    arrivals  steps until the target, of `iterations`
    SDLS counts as slower where it takes over a tenth more time than DLS, of which it is a variant.
    """
    for what, needed, given in (
        ("motion", ("walking", "running"), reach),
        ("method", SOLVERS, times),
        ("method", SOLVERS, arrivals),
    ):
        for name in needed:
            if name not in given:
                raise LookupError(f"the claims are about {name!r}: {unknown(what, name, given)}")
    walk, run = np.asarray(reach["walking"]), np.asarray(reach["running"])
    total = {name: times[name] * arrivals[name] for name in times}
    pace, wait = _ratios(times), _ratios(total)
    last = ranking(table, "jitter")["order"].str.endswith("transpose").mean()
    firsts = pd.concat(
        [ranking(table, measure)["first"] == "sdls" for measure in ("mean", "jitter", "reversals")]
    ).mean()
    feet, hands = walk[:2].sum(), walk[2:].sum()
    slower, not_slower = "SDLS is slower", "SDLS is not slower"
    rows = [
        ("thesis 5.2", "walking: both feet reach, no hand", "nearest pose",
         feet == 2 and hands == 0, f"{feet} feet, {hands} hands"),
        ("thesis 5.2", "running: none of the four reach", "nearest pose",
         not run.any(), f"{run.sum()} of {run.size}"),
        ("thesis 5.3", slower, "time a step", pace["dls"] > 1.1, _told(pace)),
        ("thesis 5.3", slower, "time to arrive", wait["dls"] > 1.1, _told(wait)),
        ("thesis 7.1", not_slower, "time a step", pace["dls"] <= 1.1, _told(pace)),
        ("thesis 7.1", not_slower, "time to arrive", wait["dls"] <= 1.1, _told(wait)),
        ("often said", "the transpose is the jerkiest", "jitter, last",
         last == 1, f"in {last:.0%} of the cases"),
        ("often said", "SDLS is best in all", "distance, jitter, reversals",
         firsts == 1, f"first in {firsts:.0%} of the cases"),
    ]  # fmt: skip
    columns = ["source", "says", "measured by", "holds", "numbers"]
    return pd.DataFrame(rows, columns=columns).astype({"holds": bool})


def _ratios(times: Mapping[str, float]) -> dict[str, float]:
    """How many times as long SDLS takes as each of the others."""
    return {name: times["sdls"] / seconds for name, seconds in times.items() if name != "sdls"}


def _told(ratios: Mapping[str, float]) -> str:
    return ", ".join(f"{ratio:.1f} × {name}" for name, ratio in ratios.items())
