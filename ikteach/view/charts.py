"""Still charts of tables, for the logs of the chapters: each with its numbers in words."""

import io

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ikteach.markup import as_label
from ikteach.view.plots import STYLES
from ikteach.view.stage.colours import effector_colour
from ikteach.view.widgets.picture import Still

HATCHES = ("", "//", "..", "xx", "--", "oo")
MARKS = ("o", "s", "^", "D", "v", "P")


def lines(
    table: pd.DataFrame, *, title: str, xlabel: str, ylabel: str, log: str = "", marks: bool = True
) -> Still:
    """The columns of a table over its index; `log` names the axes that are logarithmic: "xy"."""
    figure, axes = _axes(title, xlabel, ylabel, log)
    for i, name in enumerate(table):
        style = MARKS[i % len(MARKS)] * marks + STYLES[i % len(STYLES)]
        colour = effector_colour(i)
        axes.plot(table.index, table[name], style, color=colour, ms=4, label=as_label(name))
    axes.legend(fontsize=8)
    told = (
        f"{name} from {part.iloc[0]:.3g} to {part.iloc[-1]:.3g}, "
        f"least {part.min():.3g} at {part.idxmin():.3g}"
        for name, part in ((name, table[name].dropna()) for name in table)
    )
    return _still(figure, f"{title}: {ylabel} over {xlabel}. {'; '.join(told)}.")


def bars(
    table: pd.DataFrame, *, title: str, ylabel: str, log: str = "",
    spread: pd.DataFrame | None = None,
) -> Still:  # fmt: skip
    """A group of bars for each row of a table, a bar a column; `spread` gives whiskers."""
    figure, axes = _axes(title, "", ylabel, log)
    at, width = np.arange(len(table)), 0.8 / len(table.columns)
    for i, name in enumerate(table):
        axes.bar(
            at + (i - (len(table.columns) - 1) / 2) * width, table[name], 0.92 * width,
            yerr=None if spread is None else spread[name], capsize=3, label=as_label(name),
            color=effector_colour(i), hatch=HATCHES[i % len(HATCHES)],
            edgecolor="white", ecolor="0.25",
        )  # fmt: skip
    labels = [", ".join(row) if isinstance(row, tuple) else str(row) for row in table.index]
    axes.set_xticks(at, map(as_label, labels))
    axes.legend(fontsize=8)
    told = (
        f"{label}: " + ", ".join(f"{name} {value:.3g}" for name, value in row.items())
        for label, (_, row) in zip(labels, table.iterrows(), strict=True)
    )
    return _still(figure, f"{title}: {ylabel}. {'; '.join(told)}.")


def _axes(title: str, xlabel: str, ylabel: str, log: str) -> tuple[Figure, Axes]:
    figure = Figure(figsize=(8.4, 3.4), dpi=100, layout="constrained")
    axes = figure.subplots()
    axes.set(title=title, xlabel=xlabel, ylabel=ylabel)
    if "x" in log:
        axes.set_xscale("log")
    if "y" in log:
        axes.set_yscale("log")
    axes.grid(alpha=0.3)
    return figure, axes


def _still(figure: Figure, words: str) -> Still:
    out = io.BytesIO()
    figure.savefig(out, format="png")
    return Still(out.getvalue(), words)
