"""Chapter 8. A verdict that follows from the log, and an experiment that can carry one."""

from typing import Any

import numpy as np
import pandas as pd

from ikteach import study
from ikteach.body import figures
from ikteach.course.checking import Answer, exercise, expect
from ikteach.course.forms import NAME, NAMES, NotYetError, WrongError, of_form, parts
from ikteach.motion import gait
from ikteach.solvers import SOLVERS

RATE = 30  # frames per second
LONGEST = 1000  # frames
LARGEST_CAP = np.pi  # [rad]


def made_up(seed: int) -> pd.DataFrame:
    """A small log with numbers at random, in which the seed decides order and lengths."""
    rng = np.random.default_rng(seed)
    rows = [
        {"frame": t, "method": m, "effector": e, "error": rng.exponential() ** 2, "jitter": shake}
        for m in SOLVERS
        for t, shake in enumerate(rng.exponential(rng.uniform(0.5, 2), rng.integers(3, 9)))
        for e in ("hand", "foot")
    ]
    return pd.DataFrame(rows)


def variants(seed: int) -> list[tuple[str, pd.DataFrame, dict[str, str]]]:
    """The log as it is, with its rows in another order, and with the methods under other names."""
    table, same = made_up(seed), {name: name for name in SOLVERS}
    other = {name: f"method {i}" for i, name in enumerate(SOLVERS)}
    return [
        ("", table, same),
        ("with the rows in another order ", table.sample(frac=1, random_state=seed), same),
        (
            "with the methods under other names ",
            table.assign(method=table["method"].map(other)),
            other,
        ),
        ("with `method` as a category ", table.astype({"method": "category"}), same),
    ]


def means(table: pd.DataFrame, measure: str) -> dict[str, float]:
    """{method: mean}."""
    return {
        str(m): float(table[measure][table["method"] == m].mean())
        for m in dict.fromkeys(table["method"])
    }


@exercise(
    "08.order",
    returns=NAMES,
    hints=[
        "Which rows belong to one method, and which two numbers of them decide?",
        'The mean of `error` and of `jitter` of each: `table.groupby("method", observed=True)`.',
        '`mean = table.groupby("method", observed=True)[["error", "jitter"]].mean()`, then '
        '`mean[mean["jitter"] <= most].sort_values("error").index`',
    ],
    seconds=40,
)
def order(answer: Answer) -> None:
    """order(table, most): names, the nearest first, of the methods that shake no more than most."""
    for seed in range(6):
        for how, table, names in variants(seed):
            error, jitter = means(table, "error"), means(table, "jitter")
            shakes = sorted(jitter.values())
            for calm in (4, 3, 2, 1):
                most = shakes[calm - 1] + 0.3 * (shakes[min(calm, 3)] - shakes[calm - 1])
                most = most if calm < 4 else 2 * shakes[-1]
                wanted = sorted((m for m in error if jitter[m] <= most), key=error.__getitem__)
                found = answer(table, float(most))
                told = (
                    f"{how}your order is {', '.join(found) or 'empty'}, with jitter up to "
                    f"{most:.3f}. In the log "
                    + ", ".join(f"{m} has {error[m]:.3f} and {jitter[m]:.3f}" for m in error)
                    + " (mean error and jitter)"
                )
                unknown = [name for name in found if name not in names.values()]
                expect(not unknown, f"{unknown[:1]} is no method of the log: {told}.")
                expect(
                    sorted(found) == sorted(wanted),
                    f"Name the methods with jitter of at most {most:.3f}, and no others: {told}.",
                )
                expect(
                    len(found) <= 2 or found != wanted[::-1],
                    f"Your order is upside down, the nearest comes first: {told}.",
                )
                expect(found == wanted, f"The least mean of `error` comes first: {told}.")


@exercise(
    "08.experiment",
    returns=parts("targets", "a cap", "a function that names the winner"),
    hints=[
        "What must be the same for all four methods, so that nothing but the method differs?",
        "The targets (a motion at the times of a clock), and one cap. The winner follows from the "
        "log: the method whose mean `error` is least, whatever is in it.",
        "`gait.running(gait.running.clock(60))`, `np.radians(10)` and "
        '`lambda log: log.groupby("method", observed=True)["error"].mean().idxmin()`',
    ],
    seconds=120,
)
def experiment(answer: Answer) -> None:
    """experiment() -> targets (T, 4, 3) [m], a cap [rad], and a function of a log."""
    made = given, cap, winner = answer()
    if any(part is ... for part in made):
        raise NotYetError("three things are asked for: targets, a cap and a function.")
    targets, max_step = designed(given, cap)
    if not callable(winner):
        raise WrongError(
            f"The third must be a function that names the winner of any log, not {winner!r}."
        )
    judge = Answer(winner, "winner", NAME)
    for seed in range(20):
        for how, table, names in variants(seed):
            follows(judge, table, f"a made-up log {how}", names.values())
    log = study.compare(*figures.human(), targets, max_step=max_step)
    follows(judge, log, "the log of your own experiment", SOLVERS)


def designed(given: Any, cap: Any) -> tuple[Any, float]:
    """The targets and the cap, or WrongError with what is not fair or too short about them."""
    shape = np.shape(given)
    if len(shape) != 3:
        raise WrongError(f"The targets must be (frames, 4, 3) [m], and yours have shape {shape}.")
    targets = of_form(given, (shape[0], 4, 3), "Your targets are")
    if isinstance(cap, dict):
        raise WrongError("One cap for all: with a cap of each author's own it is no fair race.")
    max_step = float(of_form(cap, (), "Your cap is"))
    expect(
        0 < max_step <= LARGEST_CAP,
        f"The cap is {max_step:.4g} rad; it must be above 0 and not above π. Is it in degrees?",
    )
    seconds = len(targets) / RATE
    expect(
        seconds >= gait.running.period,
        f"The race is over after {seconds:.2f} s, before one cycle of running, "
        f"{gait.running.period:.2f} s, is: make it longer.",
    )
    expect(
        len(targets) <= LONGEST,
        f"The race takes {len(targets)} frames; {LONGEST} are the most that this check runs.",
    )
    moved = float(np.ptp(targets, axis=0).max())
    expect(
        0.05 <= moved <= 5,
        f"The targets move by {moved:.3g} m in all; a motion of 0.05 to 5 m is wanted.",
    )
    return targets, max_step


def follows(judge: Answer, table: pd.DataFrame, what: str, names: Any) -> None:
    """The winner is that with the least mean distance."""
    mean = means(table, "error")
    best, found = min(mean, key=mean.__getitem__), judge(table)
    expect(found in mean, f"In {what} the winner is one of {', '.join(names)}, not {found!r}.")
    expect(
        found == best,
        f"In {what} you name {found} with a mean of {mean[found]:.4g} m, but {best} has "
        f"{mean[best]:.4g} m.",
    )
