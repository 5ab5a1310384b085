"""Chapter 8. A fair experiment: every method, from many poses, at several rates; its verdict."""

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
import pandas as pd

from ikteach.arrays import Array, Mask
from ikteach.body import Effectors, Tree
from ikteach.motion import Gait, reachable, track
from ikteach.solvers import SOLVERS, Solver
from ikteach.study import after, measures

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
    table["method"] = pd.Categorical(table["method"], categories=list(methods))
    return table


def reachable_throughout(
    tree: Tree, effectors: Effectors, motions: Mapping[str, Gait], phases: int = 8
) -> Mask:
    """Which effectors reach their targets in every one of so many phases of each motion: (m, k)."""
    angles = np.linspace(0, 2 * np.pi, phases, endpoint=False)
    targets = np.stack([motion.at(angles) for motion in motions.values()])
    return np.asarray(reachable(tree, effectors, targets).all(axis=1))


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


def claims(
    table: pd.DataFrame,
    reach: Mapping[str, Mask],
    times: Mapping[str, float],
    arrivals: Mapping[str, float],
) -> pd.DataFrame:
    """Sentences about the methods, each held against the numbers: `says`, `holds`, `numbers`.

    table     of `trials`
    reach     {motion: (k,)} of `reachable_throughout`, in the thesis's order: feet, then hands
    times     seconds a step, of `step_times`
    arrivals  steps until the target, of `iterations`
    SDLS counts as slower where it takes over a tenth more time than DLS, of which it is a variant.
    """
    walk, run = np.asarray(reach["walking"]), np.asarray(reach["running"])
    total = {name: times[name] * arrivals[name] for name in times}
    pace, wait = _ratios(times), _ratios(total)
    last = ranking(table, "jitter")["order"].str.endswith("transpose").mean()
    firsts = pd.concat(
        [ranking(table, measure)["first"] == "sdls" for measure in ("mean", "jitter", "reversals")]
    ).mean()
    feet, hands = walk[:2].sum(), walk[2:].sum()
    met = f"{feet} feet, {hands} hands"
    per_step, until = f"a step: {_told(pace)}", f"until it arrives: {_told(wait)}"
    slower = "SDLS is slower"
    rows = [
        ("thesis 5.2", "walking: both feet reach, no hand", feet == 2 and hands == 0, met),
        ("thesis 5.2", "running: none of the four reach", not run.any(), f"{run.sum()} of 4"),
        ("thesis 5.3", slower, pace["dls"] > 1.1, per_step),
        ("thesis 5.3", slower, wait["dls"] > 1.1, until),
        ("thesis 7.1", "SDLS is not slower", pace["dls"] <= 1.1, per_step),
        ("thesis 7.1", "SDLS is not slower", wait["dls"] <= 1.1, until),
        ("often said", "the transpose is the jerkiest", last == 1, f"in {last:.0%} of the cases"),
        ("often said", "SDLS is best in all", firsts == 1, f"first in {firsts:.0%} of the cases"),
    ]
    return pd.DataFrame(rows, columns=["source", "says", "holds", "numbers"]).set_index("source")


def _ratios(times: Mapping[str, float]) -> dict[str, float]:
    """How many times as long SDLS takes as each of the others."""
    return {name: times["sdls"] / seconds for name, seconds in times.items() if name != "sdls"}


def _told(ratios: Mapping[str, float]) -> str:
    return ", ".join(f"{ratio:.2f} × {name}" for name, ratio in ratios.items())
