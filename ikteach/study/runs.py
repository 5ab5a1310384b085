"""Runs as tables: the tidy log, one row per frame, method and effector.

Equal inputs give equal tables; wall time, which never is equal, stands apart in `timing`.
"""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd

from ikteach.arrays import ArrayLike, Mask
from ikteach.body import Effectors, Tree
from ikteach.checks import number
from ikteach.motion import Track, reachable, track
from ikteach.motion.live.log import of_run, same_targets
from ikteach.motion.methods import Methods, methods_of
from ikteach.names import unknown
from ikteach.solvers import SOLVERS

PER_FRAME = ("times", "targets", "theta", "error", "capped", "held")  # of a Track


def log(run: Track, *, can_reach: Mask | None = None) -> pd.DataFrame:
    """Tabulate one run: a row per frame and effector.

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
    """Run every method on the same targets (T, k, 3): {method: Track}.

    methods   {name: solver}, or one or more solvers or names of `SOLVERS` (`methods_of`)
    max_step  one step cap for all [rad], or a cap per method, such as `BUSS_CAPS`; methods that it
              does not name have none
    options   go to `track` and `step`, the same for all, as does the start
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
    """Log every method on the same targets, as `runs` does."""
    return together(runs(tree, effectors, targets, methods, **options))


def together(tracks: Mapping[str, Track]) -> pd.DataFrame:
    """Log several runs on the same targets in one table.

    `method` is the name that each has in `tracks`. ValueError if there is none, or if they do not
    follow the same targets at the same times.
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


def after(run: Track, seconds: float) -> Track:
    """Leave out the first seconds, spent finding the targets."""
    late = of_run(run).times > number("seconds", seconds)
    if not late.any():
        raise ValueError(f"nothing of a run of {run.times[-1]:g} s is left after {seconds:g} s")
    kept = {name: getattr(run, name)[late] for name in PER_FRAME}
    return replace(run, start=kept["theta"][0], **kept)


def timing(tracks: Mapping[str, Track]) -> pd.Series:
    """Tell the wall time per step of each run [s]."""
    same_targets(tracks)
    seconds = {name: run.seconds for name, run in tracks.items()}
    return pd.Series(seconds, name="seconds a step", dtype=float).rename_axis("method")
