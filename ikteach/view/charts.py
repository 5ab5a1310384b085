"""Tables as pictures, each with its numbers in words."""

from collections.abc import Mapping, Sequence
from numbers import Real
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ikteach.arrays import Array
from ikteach.body import Effectors, Tree, forward, locate
from ikteach.checks import shown
from ikteach.markup import as_label
from ikteach.view.stage.colours import effector_colour
from ikteach.view.widgets.picture import Still, png_of

STYLES = ("-", "--", "-.", ":")  # these, hatches and marks: colour is never the only sign
HATCHES = ("", "///", "...", "xxx", "\\\\\\", "++")
MARKS = ("o", "s", "^", "D", "v", "P")
SIGNED = "PuOr_r"  # a scale that all eyes can read, white at 0
ZERO = 1e-12  # an entry below it counts as zero
LEAST = 1e-4  # [m] distances below it are drawn as it: the axes are logarithmic


def lines(
    table: pd.DataFrame, *, title: str, xlabel: str, ylabel: str, log: str = "", marks: bool = True
) -> Still:
    """Draw the columns of a table over its index.

    log  the axes that are logarithmic: "", "x", "y" or "xy"
    """
    _numbers(table)
    figure, axes = _axes(title, xlabel, ylabel, log)
    for i, name in enumerate(table):
        style = MARKS[i % len(MARKS)] * marks + STYLES[i % len(STYLES)]
        colour = effector_colour(i)
        axes.plot(table.index, table[name], style, color=colour, ms=4, label=as_label(name))
    axes.legend(fontsize=8)
    words = (
        f"{name} from {part.iloc[0]:.3g} to {part.iloc[-1]:.3g}, "
        f"least {part.min():.3g} at {part.idxmin():.3g}"
        for name, part in ((name, table[name].dropna()) for name in table)
        if len(part)
    )
    alt = f"{title}: {ylabel} over {xlabel}. {'; '.join(words)}."
    return Still(png_of(figure), alt, chart=True)


def bars(
    table: pd.DataFrame,
    *,
    title: str,
    ylabel: str,
    log: str = "",
    spread: pd.DataFrame | None = None,
) -> Still:
    """Draw a group of bars per row of a table.

    It has a bar per column.

    spread  half the length of each whisker, as the table
    """
    _numbers(table)
    figure, axes = _axes(title, "", ylabel, log)
    labels = [", ".join(row) if isinstance(row, tuple) else str(row) for row in table.index]
    draw_bars(axes, labels, {name: table[name] for name in table}, spread=spread)
    axes.legend(fontsize=8)
    words = (
        f"{label}: " + ", ".join(f"{name} {value:.3g}" for name, value in row.items())
        for label, (_, row) in zip(labels, table.iterrows(), strict=True)
    )
    return Still(png_of(figure), f"{title}: {ylabel}. {'; '.join(words)}.", chart=True)


def heat(table: pd.DataFrame, *, title: str, unit: str) -> Still:
    """Draw a table as coloured squares.

    They are orange above 0, blue below, with a dot where it is 0.
    """
    values = _numbers(table)
    rows, columns = values.shape
    figure = Figure(figsize=(2.2 + 0.36 * columns, 1.9 + 0.26 * rows), dpi=90, layout="constrained")
    axes = figure.subplots()
    image = draw_heat(axes, values, list(table.index), list(table.columns))
    axes.tick_params("x", rotation=90)
    down, across = np.nonzero(abs(values) < ZERO)
    axes.plot(across, down, ".", color="0.6", ms=3)
    axes.set_title(title)
    scale = figure.colorbar(image, ax=axes, label=unit, shrink=0.9)
    if np.nanmin(values) >= 0:
        scale.ax.set_ylim(0, None)  # lengths have no half below 0
    row, column = (int(i) for i in np.unravel_index(np.nanargmax(abs(values)), values.shape))
    words = (
        f"{title}: {rows} rows by {columns} columns, {len(down)} of {values.size} entries are 0. "
        f"The largest is {values[row, column]:.2f} {unit}, in row {table.index[row]}, column "
        f"{table.columns[column]}."
    )
    return Still(png_of(figure), words, chart=True)


def phase_plot(table: pd.DataFrame) -> Still:
    """Draw distances over the gait cycle, a panel per method (see `study.by_phase`)."""
    _numbers(table)
    methods = list(table.columns.unique(level=0))
    figure = Figure(figsize=(2.6 * len(methods), 2.8), dpi=100, layout="constrained")
    panels = figure.subplots(1, len(methods), sharey=True, squeeze=False)[0]
    for axes, method in zip(panels, methods, strict=True):
        draw_distances(axes, table.index, dict(table[method].items()))
        axes.set(title=as_label(method), xlabel="phase of the cycle", xlim=(0, 1))
    panels[0].set_ylabel("distance to target [m]")
    panels[0].legend(fontsize=7)
    words = "; ".join(
        f"{method}: "
        + ", ".join(f"{name} {error.mean():.3f} m" for name, error in table[method].items())
        for method in methods
    )
    alt = f"Distance to target over the gait cycle. Means: {words}."
    return Still(png_of(figure), alt, chart=True)


def outline(tree: Tree, effectors: Effectors, theta: Array) -> Array:
    """Locate joints and effectors of a planar figure: their x and y, (2, n + k) [m]."""
    frames = forward(tree, theta)
    return np.concatenate([frames.positions, locate(frames, effectors)[effectors.w == 1]])[:, :2].T


def draw_distances(axes: Axes, at: Any, error: Mapping[Any, Any], least: float = LEAST) -> None:
    """Draw a curve per effector of {name: distances} on a logarithmic axis.

    at     where they lie on the other axis
    least  shorter distances are drawn as this one [m]
    """
    for i, (name, far) in enumerate(error.items()):
        style = STYLES[i % len(STYLES)]
        axes.semilogy(
            at,
            np.maximum(far, least),
            style,
            color=effector_colour(i),
            label=as_label(name),
            lw=1.6,
        )
    axes.grid(alpha=0.3)


def draw_bars(
    axes: Axes,
    labels: Sequence[str],
    groups: Mapping[Any, Any],
    *,
    first: int = 0,
    spread: pd.DataFrame | None = None,
) -> None:
    """Draw a bar per group at each label.

    The bars of a label are side by side.

    first  the place of the first group's look among the colours and hatches
    """
    at, width = np.arange(len(labels)), 0.84 / len(groups)
    for i, (name, values) in enumerate(groups.items()):
        axes.bar(
            at + (i - (len(groups) - 1) / 2) * width,
            values,
            width,
            yerr=None if spread is None else spread[name],
            capsize=3,
            label=as_label(name),
            color=effector_colour(i + first),
            hatch=HATCHES[(i + first) % len(HATCHES)],
            edgecolor="white",
            linewidth=0.4,
            ecolor="0.25",
        )
    axes.set_xticks(at, list(map(as_label, labels)))
    axes.grid(axis="y", alpha=0.3)


def draw_heat(axes: Axes, values: Array, rows: Sequence[Any], columns: Sequence[Any]) -> Any:
    """Draw a matrix in colours, and give the image.

    White is 0. Its rows and columns are named.
    """
    most = max(float(np.nanmax(abs(values))), ZERO)
    image = axes.imshow(values, cmap=SIGNED, vmin=-most, vmax=most, aspect="auto")
    axes.set_xticks(range(len(columns)), list(map(as_label, columns)), fontsize=8)
    axes.set_yticks(range(len(rows)), list(map(as_label, rows)), fontsize=8)
    return image


def _numbers(table: Any) -> Array:
    """Check the numbers of a table; TypeError or ValueError says what is wrong."""
    if not isinstance(table, pd.DataFrame):
        raise TypeError(f"a chart needs a pandas DataFrame, not {shown(table)}")
    if table.empty:
        raise ValueError(f"a chart needs rows and columns, not {len(table)} by {table.shape[1]}")
    for name, column in table.items():
        if not all(isinstance(value, Real) for value in column):
            raise ValueError(f"column {name!r} of a chart's table must be made of numbers")
    values = table.to_numpy(dtype=float)
    if np.isnan(values).all():
        raise ValueError("a chart needs numbers, and all of this table are missing")
    return values


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
