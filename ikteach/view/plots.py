"""Pictures drawn by matplotlib: the live error plot, and a still of the figure."""

import io
from collections.abc import Mapping

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from ikteach.arrays import Array
from ikteach.body import Effectors, Tree, forward, locate
from ikteach.motion import Track
from ikteach.view.picture import Still
from ikteach.view.skin import EFFECTOR_COLOURS

STYLES = ("-", "--", "-.", ":")
SECONDS = 10.0
LEAST, MOST = 1e-4, 3.0  # [m] the fixed range of the error axes: it never has to be drawn again


class ErrorPlot:
    """Distance to target over the last seconds: the shown method's effectors, and all methods.

    Only the lines are drawn anew each time, over axes that stay as they were.
    """

    def __init__(self, effectors: Effectors, methods: list[str]) -> None:
        self.figure = Figure(figsize=(9.6, 2.5), dpi=100, layout="constrained")
        self._canvas = FigureCanvasAgg(self.figure)
        left, right = self.figure.subplots(1, 2, sharey=True)
        self._effectors = _lines(left, list(effectors.names), "each effector, shown method")
        self._methods = _lines(right, methods, "mean of all effectors, each method")
        left.set_ylabel("distance to target [m]")
        self._canvas.draw()
        self._still = self._canvas.copy_from_bbox(self.figure.bbox)

    def png(self, tracks: Mapping[str, Track], shown: str) -> bytes:
        """The plot of these runs, as PNG."""
        self._canvas.restore_region(self._still)
        if shown in tracks:
            for line, error in zip(self._effectors, tracks[shown].error.T, strict=True):
                _draw(line, tracks[shown].times, error)
        for line, run in zip(self._methods, tracks.values(), strict=False):
            _draw(line, run.times, run.error.mean(axis=-1))
        return as_png(np.asarray(self._canvas.buffer_rgba()))


def _lines(axes: Axes, names: list[str], title: str) -> list[Line2D]:
    axes.set(
        title=title,
        xlim=(-SECONDS, 0),
        ylim=(LEAST, MOST),
        yscale="log",
        xlabel="seconds ago, × speed",
    )
    axes.grid(alpha=0.3)
    lines = []
    for i, name in enumerate(names):
        colour, style = EFFECTOR_COLOURS[i % len(EFFECTOR_COLOURS)], STYLES[i % len(STYLES)]
        lines += axes.plot([], [], style, color=colour, label=name, lw=1.6, animated=True)
    axes.legend(loc="lower left", ncols=4, fontsize=7, handlelength=2.6)
    return lines


def _draw(line: Line2D, times: Array, error: Array) -> None:
    line.set_data(times - times[-1], np.maximum(error, LEAST))
    line.axes.draw_artist(line)  # type: ignore[union-attr]


def as_png(pixels: Array) -> bytes:
    """RGBA pixels (h, w, 4) as a PNG of few colours."""
    from PIL import Image  # comes with matplotlib

    out = io.BytesIO()
    # A palette is a third of the bytes and half of the time of full colour.
    few = Image.fromarray(pixels[..., :3]).quantize(
        48, method=Image.Quantize.FASTOCTREE, dither=Image.Dither.NONE
    )
    few.save(out, "PNG", compress_level=1)
    return out.getvalue()


def phase_plot(table: pd.DataFrame) -> Still:
    """Distance to target over the cycle, a panel a method (the table of `study.by_phase`)."""
    methods = list(table.columns.unique(level=0))
    figure = Figure(figsize=(2.6 * len(methods), 2.8), dpi=100, layout="constrained")
    panels = figure.subplots(1, len(methods), sharey=True, squeeze=False)[0]
    for axes, method in zip(panels, methods, strict=True):
        for i, (effector, error) in enumerate(table[method].items()):
            colour, style = EFFECTOR_COLOURS[i % len(EFFECTOR_COLOURS)], STYLES[i % len(STYLES)]
            axes.semilogy(
                table.index, np.maximum(error, LEAST), style, color=colour, label=effector
            )
        axes.set(title=method, xlabel="phase of the cycle", xlim=(0, 1))
        axes.grid(alpha=0.3)
    panels[0].set_ylabel("distance to target [m]")
    panels[0].legend(fontsize=7)
    words = "; ".join(
        f"{method}: "
        + ", ".join(f"{name} {error.mean():.3f} m" for name, error in table[method].items())
        for method in methods
    )
    out = io.BytesIO()
    figure.savefig(out, format="png")
    return Still(out.getvalue(), f"Distance to target over the gait cycle. Means: {words}.")


def portrait(tree: Tree, effectors: Effectors, theta: Array, targets: Array) -> bytes:
    """A still of the figure and its targets from the front and from the side, as PNG."""
    figure = Figure(figsize=(6.4, 4), dpi=80, layout="constrained")
    frames = forward(tree, theta)
    s = locate(frames, effectors)
    views = [("from the front", 0, "x [m], left →"), ("from the left side", 2, "z [m], forward →")]
    for axes, (title, across, label) in zip(figure.subplots(1, 2), views, strict=True):
        for start, end in bones(tree, effectors, frames.positions, s):
            axes.plot([start[across], end[across]], [start[1], end[1]], "-", color="0.35", lw=3)
        for i, name in enumerate(effectors.names):
            colour = EFFECTOR_COLOURS[i % len(EFFECTOR_COLOURS)]
            mark = "s" if name.endswith(".r") else "o"
            axes.plot(targets[i, across], targets[i, 1], mark, color=colour, label=name)
        axes.set(title=title, xlabel=label, ylabel="y [m], up", aspect="equal")
    axes.legend(fontsize=7, title="targets")
    out = io.BytesIO()
    figure.savefig(out, format="png")
    return out.getvalue()


def bones(tree: Tree, effectors: Effectors, p: Array, s: Array) -> list[tuple[Array, Array]]:
    """Start and end of each straight piece of the body."""
    joints = [
        (p[parent] if parent >= 0 else np.zeros(3), p[j]) for j, parent in enumerate(tree.parents)
    ]
    return joints + [(p[j], point) for j, point in zip(effectors.joints, s, strict=True)]
