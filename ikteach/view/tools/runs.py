"""A run as a plot, in words, and as a table."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from ikteach.arrays import Array, Index
from ikteach.motion.live.log import Log
from ikteach.view import charts
from ikteach.view.stage.lengths import Lengths, decade, misses, units
from ikteach.view.widgets.picture import png_of


def error_picture(run: Log, error: Array) -> tuple[bytes, list[float]]:
    """Draw the distances (T, k) over the clock.

    Gives PNG, and where its axis lies: left and right, 0..1. A triangle above the axes is a change.
    """
    figure = Figure(figsize=(9, 2.5), dpi=100, layout="constrained")
    canvas = FigureCanvasAgg(figure)
    axes = figure.subplots()
    least = charts.LEAST * decade(run.tree, run.effectors)
    names = run.effectors.names
    charts.draw_distances(axes, run.clock, dict(zip(names, error.T, strict=True)), least)
    changes = [event.tick * run.dt for event in run.events if event.run == _last_run(run)]
    changes = [at for at in changes if run.clock[0] <= at <= run.clock[-1]]
    if changes:
        look: Any = {"color": "0.25", "transform": axes.get_xaxis_transform(), "clip_on": False}
        axes.plot(changes, np.ones(len(changes)), "v", label="change", **look)
    last = run.clock[-1] if len(run) > 1 else run.clock[0] + run.dt
    ylabel = "distance to target [m]"
    ylabel += "" if run.effectors.w.all() else "\ndirections: 2ℓ sin(φ/2)"
    axes.set(xlim=(run.clock[0], last), xlabel="clock [s]", ylabel=ylabel)
    figure.legend(loc="outside upper center", ncols=6, fontsize=8, handlelength=2.6, frameon=False)
    canvas.draw()
    box = axes.get_position()
    return png_of(figure), [float(box.x0), float(box.x1)]


def error_words(run: Log, error: Array) -> str:
    """Put the plot of the distances (T, k) into words."""
    far = misses(run.effectors, error)
    each = "; ".join(
        f"{name} {unit(one.mean())} on average, at most {unit(one.max())} at "
        f"{run.clock[one.argmax()]:.2f} s"
        for name, unit, one in zip(run.effectors.names, units_of(run), far.T, strict=True)
    )
    return f"Distance to target from {run.clock[0]:.2f} to {run.clock[-1]:.2f} s: {each}."


def units_of(run: Log) -> list[Lengths]:
    """Give the units in which the run's distances are read."""
    return units(run.tree, run.effectors)


def _last_run(run: Log) -> int:
    """Find the run of the ticks of this log: no reset came after it."""
    return max((event.run + (event.kind == "reset") for event in run.events), default=0)


def places(clock: Array) -> list[float]:
    """Place each tick on the axis, 0..1."""
    span = max(clock[-1] - clock[0], 1e-9)
    return ((clock - clock[0]) / span).tolist()


def error_rows(run: Log, columns: Index, error: Array) -> list[list[str]]:
    """Write a row per tick.

    Its number, clock, method, distances (T, k) and changes.

    columns  (T,) the number of the method
    """
    changed: dict[int, list[str]] = {}
    for event in run.events:
        if event.run == _last_run(run):
            changed.setdefault(event.tick, []).append(str(event))
    notes, far = _at_rows(run, changed), misses(run.effectors, error)
    return [
        [
            str(run.tick[t]),
            f"{run.clock[t]:.2f}",
            run.methods[columns[t]],
            *(unit.number(d, 2) for unit, d in zip(units_of(run), far[t], strict=True)),
            "; ".join(notes.get(t, [])),
        ]
        for t in range(len(run))
    ]


def _at_rows(run: Log, changed: Mapping[int, list[str]]) -> dict[int, list[str]]:
    """Find the row in which each change first acts: that of the next tick in the log."""
    notes: dict[int, list[str]] = {}
    for tick, words in changed.items():
        row = int(np.searchsorted(run.tick, tick, side="right"))
        notes.setdefault(min(row, len(run) - 1), []).extend(words)
    return notes
