"""Rules by which a table of runs says whether a sentence holds, and on what it depends."""

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
import pandas as pd

from ikteach.checks import number
from ikteach.names import unknown
from ikteach.study.measures import columns_of

FACTORS = {  # what may turn a verdict, as columns of a table, and in words
    "who": "the method",
    "whom": "whom it is compared with",
    "measure": "the measure",
    "motion": "the motion",
    "damping": "λ",
    "limits": "the limit rule",
    "caps": "the caps",
    "method": "the method",
    "effector": "the effector",
    "bend": "the bend",
    "pose": "the pose",
    "start": "the start pose",
    "round": "the round",
}
LEAST = {  # smaller differences nobody sees: 0 against 1e-9 is no victory
    **dict.fromkeys(("mean", "p95", "max", "reach", "out_of_reach"), 1e-4),  # [m]
    "jitter": 1e-4,  # [rad]
    "acceleration": 0.1,  # [rad/s²]
    "reversals": 0.01,  # [1/s]
}
DRAWN = {"start", "round"}  # factors whose values have no meaning
MARGIN = 0.1  # numbers that differ by less than a tenth are equal
MOST = 0.9  # a sentence holds if it does in nine cells of ten


def against(
    table: pd.DataFrame,
    who: Iterable[object],
    whom: Iterable[object],
    measures: Iterable[str],
    factor: str = "method",
) -> pd.DataFrame:
    """Divide the measures of some by those of others.

    A row per cell: each of `who` against each of `whom`, values of the column `factor`, where all
    other factors are equal; `ratio` is below 1 where it has less.
    """
    measures, who, whom = columns_of(table, measures, numeric=True), list(who), list(whom)
    columns_of(table, [factor])
    keys = [name for name in FACTORS if name in table and name != factor]
    tall = table.melt([*keys, factor], measures, "measure", "value").dropna(subset=["value"])
    wide = tall.set_index(["measure", *keys, factor])["value"].unstack(factor)
    for name in (*who, *whom):
        if name not in wide:
            raise LookupError(unknown(factor, name, map(str, wide.columns)))
    least = wide.index.get_level_values("measure").map(lambda name: LEAST.get(name, 0.0))
    with np.errstate(invalid="ignore", divide="ignore"):  # ∞ steps against ∞ steps are equal
        ratios = {
            (one, other): ((wide[one] + least) / (wide[other] + least)).fillna(1.0)
            for one in who
            for other in whom
        }
    return pd.concat(ratios, names=["who", "whom"]).rename("ratio").reset_index()


def against_bound(table: pd.DataFrame, measure: str, bound: float) -> pd.DataFrame:
    """Divide a measure by a bound.

    A row per cell; `ratio` is below 1 within the bound.
    """
    columns_of(table, [measure], numeric=True)
    if not number("bound", bound):
        raise ValueError("nothing is measured by a bound of 0")
    kept = table.dropna(subset=[measure])
    return kept[[name for name in FACTORS if name in kept]].assign(ratio=kept[measure] / bound)


def as_said(ratio: pd.Series, relation: str = "less", margin: float = MARGIN) -> pd.Series:
    """Hold ratios against a relation.

    1 where they are as it says, 0 for no difference, −1 for the other way round.

    relation  "less", "more", or "at most": no more than, by the margin
    margin    by which share numbers must differ; ratios from 1/(1 + margin) to 1 + margin are ties
    """
    size = 1 + number("margin", margin)
    less, more = ratio < 1 / size, ratio > size
    match relation:
        case "less":
            return less.astype(int) - more
        case "more":
            return more.astype(int) - less
        case "at most":
            return 1 - 2 * more.astype(int)
    raise LookupError(unknown("relation", relation, ["less", "more", "at most"]))


def turning(cells: pd.DataFrame, yes: pd.Series) -> pd.Series:
    """Tell how often each factor turns a yes into a no, 0..1.

    Of all pairs of cells that differ in this factor alone. The factor that turns most comes first.
    """
    names = [name for name in FACTORS if name in cells and cells[name].nunique() > 1]
    shares = {}
    for name in names:
        others = [other for other in names if other != name]
        groups = yes.groupby([cells[other] for other in others] or np.zeros(len(cells)))
        n, said = groups.count(), groups.sum()
        pairs = (n * (n - 1) / 2).sum()
        shares[name] = float((said * (n - said)).sum() / pairs) if pairs else 0.0
    return pd.Series(shares, dtype=float).sort_values(ascending=False, kind="stable")


class Finding(NamedTuple):
    """What cells say of a sentence.

    word    holds, does not hold (the other way round, no difference), or depends on …
    turns   the factors on which it depends, the one that turns it most first
    share   of the cells in which it holds, 0..1
    cells   how many there are
    ratios  of the cells: the tenth part, the half and nine tenths of them are below
    where   in which share of the cells it holds at each value of these factors
    margin  within which numbers count as equal
    """

    word: str
    turns: tuple[str, ...]
    share: float
    cells: int
    ratios: tuple[float, float, float]
    where: str
    margin: float

    def __str__(self) -> str:
        return f"{self.word}{self.where and f' ({self.where})'}"


def weigh(cells: pd.DataFrame, relation: str = "less", margin: float = MARGIN) -> Finding:
    """Judge a sentence by the `ratio` of each cell (`against`, `against_bound`).

    It holds if it does in nine cells of ten, and does not if in one of ten at most. Between them it
    depends on the factor that turns most cells, and on any that turns at least half as many.
    """
    columns_of(cells, ["ratio"], numeric=True)
    said = as_said(cells["ratio"], relation, margin)
    yes, turns, where = said == 1, [], ""
    share = float(yes.mean())
    if share >= MOST:
        word = "holds"
    elif share <= 1 - MOST:
        word = "does not hold"
        for value, why in (-1, "the other way round"), (0, "no difference"):
            if relation != "at most" and (said == value).mean() >= MOST:
                word += f": {why}"
    else:
        shares = turning(cells, yes)
        turns = list(shares[shares >= shares.max() / 2].index[:2])
        word = "depends on " + " and ".join(FACTORS[name] for name in turns)
        where = "; ".join(_shares(cells[name], yes) for name in turns if name not in DRAWN)
    low, middle, high = cells["ratio"].quantile([0.1, 0.5, 0.9], interpolation="nearest")
    ratios = float(low), float(middle), float(high)
    return Finding(word, tuple(turns), share, len(cells), ratios, where, margin)


def holding(table: pd.DataFrame, orders: Iterable[str], measure: str) -> list[str]:
    """Keep the orders "a < b" that hold.

    a and b are methods, which are ordered by a measure of `trials`.
    """

    def holds(order: str) -> bool:
        one, _, other = (word.strip() for word in order.partition("<"))
        return weigh(against(table, [one], [other], [measure])).word == "holds"

    return [order for order in orders if holds(order)]


def _shares(values: pd.Series, yes: pd.Series) -> str:
    """Tell in which share of the cells it holds at each value of a factor."""
    shares = yes.groupby(values, observed=True).mean()
    return ("λ " if values.name == "damping" else "") + ", ".join(
        f"{f'{value:g}' if isinstance(value, float) else value} {share:.0%}"
        for value, share in shares.items()
    )
