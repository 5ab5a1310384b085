"""Chapter 8. A verdict that follows from the log, and a log that can carry one."""

import numpy as np
import pandas as pd

from ikteach.course.checking import Answer, exercise, expect
from ikteach.motion import gait
from ikteach.solvers import SOLVERS

COLUMNS = ["frame", "time", "method", "effector", "error", "jitter", "capped", "held"]


def made_up(seed: int) -> pd.DataFrame:
    """A small log with numbers at random, in which the methods' order depends on the seed."""
    rng = np.random.default_rng(seed)
    rows = [
        {"frame": t, "method": m, "effector": e, "error": rng.exponential(), "jitter": rng.random()}
        for m in SOLVERS
        for t in range(9)
        for e in ("hand", "foot")
    ]
    return pd.DataFrame(rows)


@exercise(
    "08.order",
    returns=list,
    hints=[
        '`table.groupby("method", observed=True)` puts the rows of a method together.',
        "Take the mean of `error` of each group, `sort_values()`, and give its index as a list.",
    ],
)
def order(answer: Answer) -> None:
    for seed in range(4):
        table = made_up(seed)
        mean = {m: float(table["error"][table["method"] == m].mean()) for m in SOLVERS}
        wanted = sorted(mean, key=lambda m: mean[m])
        found = [str(name) for name in answer(table)]
        expect(
            sorted(found) == sorted(SOLVERS),
            f"The order must name each of {', '.join(SOLVERS)} once; yours is {found}.",
        )
        expect(
            found != wanted[::-1],
            "Your order is upside down: the nearest, with the least mean, first.",
        )
        expect(
            found == wanted,
            f"{found[0]} comes first in your order with a mean of {mean[found[0]]:.3f}, but "
            f"{wanted[0]} has {mean[wanted[0]]:.3f}: the order must follow from the mean of "
            "`error`."
            if found[0] != wanted[0]
            else "The first is right, but the others are not in the order of their mean `error`.",
        )
        shuffled = table.sample(frac=1, random_state=seed)
        expect(
            [str(name) for name in answer(shuffled)] == wanted,
            "With the rows in another order your verdict is another.",
        )
        names = {name: f"method {i}" for i, name in enumerate(SOLVERS)}
        renamed = table.assign(method=table["method"].map(names))
        expect(
            [str(name) for name in answer(renamed)] == [names[name] for name in wanted],
            "With the methods under other names your verdict is another: it must not know them.",
        )


@exercise(
    "08.experiment",
    returns=tuple,
    hints=[
        "`study.compare(*human, targets, max_step=...)` gives a log of all four methods.",
        "Do not write the winner down: `order(log)[0]` follows from the log, whatever is in it.",
    ],
    seconds=60,
)
def experiment(answer: Answer) -> None:
    made = answer()
    expect(len(made) == 2, f"Return two things, the log and the winner, not {len(made)}.")
    log, winner = made
    expect(isinstance(log, pd.DataFrame), "The first thing must be a log, a pandas DataFrame.")
    missing = [name for name in COLUMNS if name not in log]
    expect(not missing, f"The log has no column {missing[:1]}; `study.compare` makes them all.")
    methods = sorted(map(str, log["method"].unique()))
    expect(
        methods == sorted(SOLVERS), f"The log must hold {', '.join(SOLVERS)}; it holds {methods}."
    )
    expect(np.isfinite(log["error"]).all(), "The log has distances that are not numbers.")
    parts = log.groupby("method", observed=True)
    frames = {str(m): (len(part), part["time"].max()) for m, part in parts}
    expect(
        len(set(frames.values())) == 1,
        "The methods did not run for the same time on the same frames: that is no fair race.",
    )
    seconds = float(log["time"].max())
    expect(
        seconds >= gait.running.period,
        f"The race is over after {seconds:.2f} s, before one cycle of running is: make it longer.",
    )
    mean = log.groupby("method", observed=True)["error"].mean()
    expect(str(winner) in methods, f"The winner must be one of the methods, not {winner!r}.")
    expect(
        mean[winner] == mean.min(),
        f"Your winner is {winner} with a mean of {mean[winner]:.4f} m, but your own log says "
        f"{mean.idxmin()} with {mean.min():.4f} m.",
    )
