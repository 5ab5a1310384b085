"""Chapter 9. A time trial: whose solver brings hands and feet to places drawn at random?"""

from time import perf_counter
from typing import Any

import numpy as np
import pandas as pd

from ikteach.arrays import Array
from ikteach.body import Effectors, Tree, forward, locate
from ikteach.checks import count, number
from ikteach.motion import track
from ikteach.motion.methods import Methods, methods_of
from ikteach.solvers import Solver
from ikteach.study.experiment import starts


def time_trial(
    tree: Tree,
    effectors: Effectors,
    methods: Methods,
    *,
    courses: int = 20,
    most: int = 60,
    within: float = 0.01,
    spread: float = 0.4,
    seed: int = 0,
    **options: Any,
) -> pd.DataFrame:
    """Race methods to reachable targets, a row per method.

    Each course leads from one pose drawn at random to where another puts the effectors; all
    methods run the same ones, in at most so many steps, one pose at a time.

    reached  share of the courses on which all effectors came `within` [m]
    steps    until they did, the median; `most` where they did not
    jitter   mean ‖Δ²θ‖ until then [rad]
    time     of one step [s], the median of the courses; never equal twice
    score    0 to 100: the mean over the courses of 1 − steps / most
    fell     what a method did wrong, in words; its score is then 0

    The best come first. `spread` and `seed` are those of `starts`, options those of `step`.
    """
    most, within = count("most", most), number("within", within)
    begin, end = (
        starts(tree, count("courses", courses) + 1, spread=spread, seed=2 * seed + i)[1:]
        for i in (0, 1)
    )
    goals = locate(forward(tree, end), effectors)

    def ridden(solver: Solver) -> dict[str, Any]:
        rides = []
        for theta, goal in zip(begin, goals, strict=True):
            began = perf_counter()
            targets = np.broadcast_to(goal, (most, *goal.shape))
            run = track(tree, effectors, targets, solver, theta=theta, **options)
            seconds = (perf_counter() - began) / most
            rides.append([*arrival(run.error, run.jitter, within), seconds])
        reached, steps, jitter, seconds = np.transpose(rides)
        return {
            "reached": reached.mean(),
            "steps": np.median(steps),
            "jitter": jitter.mean(),
            "time": np.median(seconds),
            "score": 100 * np.mean(1 - steps / most),
            "fell": "",
        }

    rows = {}
    for name, solver in methods_of(methods).items():
        try:
            rows[name] = ridden(solver)
        except Exception as error:  # of a student's own solver: the others ride on
            rows[name] = {"reached": 0.0, "score": 0.0, "fell": str(error)}
    columns = ["reached", "steps", "jitter", "time", "score", "fell"]
    table = pd.DataFrame.from_dict(rows, orient="index").reindex(columns=columns)
    return table.rename_axis("method").sort_values("score", ascending=False, kind="stable")


def arrival(error: Array, jitter: Array, within: float) -> tuple[bool, int, float]:
    """Tell whether a run arrived, when, and its jitter.

    error (T, k) [m], jitter (T,) [rad]. It has arrived once all effectors are `within` [m].
    """
    near = np.all(error <= within, axis=-1)
    reached = bool(near.any())
    steps = int(near.argmax()) + 1 if reached else len(error)
    return reached, steps, float(jitter[:steps].mean())
