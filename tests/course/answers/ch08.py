import numpy as np

from ikteach import SOLVERS, gait
from ikteach.motion import BUSS_CAPS

TARGETS = gait.running(gait.running.clock(24))


def means(table):
    return table.groupby("method", observed=True)[["error", "jitter"]].mean()


def calm(table, most, by="error", how="mean"):
    ours = means(table)
    there = getattr(table.groupby("method", observed=True)[by], how)()
    return there[ours["jitter"] <= most].sort_values().index


def nearest(log):
    return means(log)["error"].idxmin()


def first_of_log(log):
    return log["method"].iloc[0]


def lucky(log):
    return log.loc[log["error"].idxmin(), "method"]


WRONG = {
    "08.order": [
        (lambda table, most: calm(table, most)[::-1], "upside down"),
        (lambda table, most: list(SOLVERS), "comes first: "),
        (lambda table, most: calm(table, most, how="max"), "The least mean of `error`"),
        (lambda table, most: calm(table, most, how="median"), "The least mean of `error`"),
        (lambda table, most: calm(table, most, by="jitter"), "The least mean of `error`"),
        (lambda table, most: calm(table, np.inf), "Name the methods with jitter of at most"),
        (lambda table, most: calm(table, most)[:1], "Name the methods with jitter of at most"),
        (lambda table, most: ["newton"], "is no method of the log"),
        (lambda table, most: means(table), "where a list of names is wanted"),
    ],
    "08.experiment": [
        (lambda: (TARGETS, 0.1, "dls"), "must be a function that names the winner"),
        (lambda: (TARGETS, 0.1, lambda log: "dls"), "In a made-up log"),
        (lambda: (TARGETS, 0.1, lambda log: means(log)["error"].idxmax()), "In a made-up log"),
        (lambda: (TARGETS, 0.1, lambda log: means(log)["jitter"].idxmin()), "In a made-up log"),
        (lambda: (TARGETS, 0.1, first_of_log), "In a made-up log"),
        (lambda: (TARGETS, 0.1, lucky), "In a made-up log"),
        (lambda: (TARGETS, BUSS_CAPS, nearest), "it is no fair race"),
        (lambda: (TARGETS, 10, nearest), "Is it in degrees?"),
        (lambda: (TARGETS, 0, nearest), "must be above 0"),
        (lambda: (TARGETS[:5], 0.1, nearest), "before one cycle of running"),
        (lambda: (0 * TARGETS, 0.1, nearest), "a motion of 0.05 to 5 m"),
        (lambda: (TARGETS[..., :2], 0.1, nearest), "is wanted"),
        (lambda: (TARGETS, nearest), "a function that names the winner (in one list or tuple)"),
    ],
}
