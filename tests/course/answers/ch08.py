from functools import cache

import numpy as np

from ikteach import SOLVERS, figures, gait, study


def means(table):
    return table.groupby("method", observed=True)["error"].mean().sort_values()


@cache
def run(methods=tuple(SOLVERS), frames=24):
    return study.compare(*figures.human(), gait.running(gait.running.clock(frames)), methods)


def worst_wins():
    log = run()
    return log, means(log).index[-1]


def unequal():
    log = run()
    log = log[(log["method"] != "sdls") | (log["frame"] < 22)]
    return log, means(log).index[0]


WRONG = {
    "08.order": [
        (lambda table: list(means(table).index[::-1]), "upside down"),
        (lambda table: list(SOLVERS), "must follow from the mean"),
        (
            lambda table: list(
                table.groupby("method", observed=True)["error"].max().sort_values().index
            ),
            "mean",
        ),
        (
            lambda table: list(
                table.groupby("method", observed=True)["jitter"].mean().sort_values().index
            ),
            "mean",
        ),
        (lambda table: list(means(table).index[:1]), "must name each"),
    ],
    "08.experiment": [
        (worst_wins, "your own log says"),
        (unequal, "no fair race"),
        (lambda: (run(("dls", "sdls")), "sdls"), "must hold transpose, pseudoinverse"),
        (lambda: (run(frames=5), "sdls"), "before one cycle"),
        (lambda: (run().drop(columns="jitter"), "sdls"), "no column"),
        (lambda: (np.zeros(3), "sdls"), "DataFrame"),
        (lambda: (run(), "SDLS"), "must be one of"),
    ],
}
