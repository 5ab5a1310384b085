"""Chapter 6's bench: what each method does along each singular direction of the human's J."""

from functools import lru_cache
from math import radians

import numpy as np
from matplotlib.figure import Figure

from ikteach.arrays import Array
from ikteach.body import forward, jacobian, locate
from ikteach.body.figures import human
from ikteach.markup import Markup
from ikteach.motion import gait, step
from ikteach.solvers import sdls
from ikteach.solvers.dls import filtered
from ikteach.solvers.response import Directions, directions, factors
from ikteach.view.live.bench import Bench, Canvas, Shown, log_slider, slider
from ikteach.view.plots import bones
from ikteach.view.stage.colours import BLUE, EFFECTOR_COLOURS, GREEN, ORANGE
from ikteach.view.widgets.closing import making
from ikteach.view.widgets.prose import grid

TREE, EFFECTORS = human()
COUNT = 3 * len(EFFECTORS)
LOW, HIGH = 1e-3, 1e3  # [rad/m] of the factors' axis
ARROW = 0.45  # [m] for a whole unit of u_i


@lru_cache(maxsize=64)
def pose(phase: float, steps: int) -> Array:
    """θ (n,) after so many steps of SDLS from rest to the walk's targets at that phase [rad]."""
    theta = TREE.rest
    for _ in range(steps):
        theta = step(TREE, theta, EFFECTORS, gait.walking.at(phase), sdls).theta
    return theta


class Spectrum:
    """Bars of the filter factors, and the chosen direction drawn on the body."""

    def __init__(self) -> None:
        figure = Figure(figsize=(10.4, 4.2), dpi=90)
        bars, front, side = figure.subplots(1, 3, width_ratios=[2.1, 1.3, 0.95])
        figure.subplots_adjust(left=0.065, right=0.99, bottom=0.12, top=0.91, wspace=0.3)
        bars.set(
            yscale="log", ylim=(LOW, HIGH), xlim=(0.3, COUNT + 0.7), xticks=range(1, COUNT + 1)
        )
        bars.set(xlabel="singular direction i, strongest first", ylabel="answer f [rad/m]")
        bars.set_title("Δθ = Σ f (uᵀe) v: what f each method takes")
        bars.grid(alpha=0.3, axis="y")
        at = np.arange(1, COUNT + 1)
        looks = [("1/σ", BLUE, ""), ("σ/(σ²+λ²)", ORANGE, "//"), ("SDLS", GREEN, "..")]
        self._bars = [
            bars.bar(at + 0.27 * (k - 1), 1, 0.25, LOW, color=c, hatch=h, ec="white", label=label)
            for k, (label, c, h) in enumerate(looks)
        ]
        (self._mark,) = bars.plot([], [], "v", color="black", ms=9, label="direction drawn")
        bars.legend(loc="upper left", fontsize=8, ncols=2)
        self._views = [(front, 0, "from the front", "x [m]"), (side, 2, "left side", "z [m]")]
        moving = [rod for group in self._bars for rod in group] + [self._mark]
        self._bones, self._arrows = [], []
        for axes, _, title, label in self._views:
            half = 1.2 if title == "from the front" else 0.85
            axes.set(xlim=(-half, half), ylim=(-1.7, 1.1), aspect="equal", title=title)
            axes.set(xlabel=label)
            (line,) = axes.plot([], [], "-", color="0.45", lw=3)
            arrows = [axes.plot([], [], "-", color=c, lw=3)[0] for c in EFFECTOR_COLOURS[:4]]
            tips = [
                axes.plot([], [], "s" if name.endswith(".r") else "o", color=c, ms=7)[0]
                for name, c in zip(EFFECTORS.names, EFFECTOR_COLOURS, strict=False)
            ]
            self._bones.append(line)
            self._arrows.append((arrows, tips))
            moving += [line, *arrows, *tips]
        self._canvas = Canvas(figure, moving)

    def show(
        self, direction: int, damping: float, max_angle: float, steps: int, phase: float
    ) -> Shown:
        """The directions at the pose after `steps`; `max_angle` in degrees, `phase` a share."""
        theta = pose(round(2 * np.pi * phase, 6), steps)
        frames = forward(TREE, theta)
        s = locate(frames, EFFECTORS)
        J = jacobian(TREE, frames, EFFECTORS)
        e = np.ravel(gait.walking.at(2 * np.pi * phase) - s)
        found = directions(J, e, max_angle=radians(max_angle))
        selective = sdls(J, e, max_angle=radians(max_angle))
        answers = [filtered(found.sigma), filtered(found.sigma, damping), factors(J, e, selective)]
        for group, f in zip(self._bars, answers, strict=True):
            for rod, height in zip(group, np.nan_to_num(abs(f), nan=LOW), strict=True):
                rod.set_height(np.clip(height, LOW, HIGH) - LOW)
        i = direction - 1
        self._mark.set_data([direction], [HIGH / 20])
        self._draw(frames.positions, s, found.U[:, i].reshape(-1, 3))
        pinv, damped, selected = (f[i] for f in answers)
        words = (
            f"Direction {direction} of {COUNT} after {steps} steps of SDLS: "
            f"σ = {found.sigma[i]:.4f} m/rad, error along it {found.alpha[i]:.3f} m. "
            f"N = {found.N[i]:.3f}, M = {found.M[i]:.3f}, γ = {np.degrees(found.gamma[i]):.2f}°. "
            f"Answers in rad/m: "
            f"1/σ is {pinv:.3f}, damped {damped:.3f}, SDLS takes {_number(selected)}."
        )
        return Shown(
            self._canvas.png(), words, Markup("<p>{}</p>").format(words) + _table(found, answers)
        )

    def _draw(self, p: Array, s: Array, u: Array) -> None:
        """The bones, and from each effector the way that it goes."""
        pieces = bones(TREE, EFFECTORS, p, s)
        gap = np.full(3, np.nan)
        path = np.array([point for start, end in pieces for point in (start, end, gap)])
        for line, (arrows, tips), (_, x, *_) in zip(
            self._bones, self._arrows, self._views, strict=True
        ):
            line.set_data(path[:, x], path[:, 1])
            for arrow, tip, start, way in zip(arrows, tips, s, u, strict=True):
                end = start + ARROW * way
                arrow.set_data([start[x], end[x]], [start[1], end[1]])
                tip.set_data([end[x]], [end[1]])


def _table(found: Directions, answers: list[Array]) -> Markup:
    """All directions in numbers."""
    heads = ["σ [m/rad]", "uᵀe [m]", "N", "M", "γ [°]", "1/σ", "σ/(σ²+λ²)", "SDLS"]
    columns = [found.sigma, found.alpha, found.N, found.M, np.degrees(found.gamma), *answers]
    rows = [[i, *map(_number, row)] for i, row in enumerate(np.transpose(columns), start=1)]
    return grid(["i", *heads], rows)


def _number(value: float) -> str:
    """The number, or a word where the error asks for nothing along a direction."""
    return "none" if np.isnan(value) else f"{value:.3g}"


@making()
def spectrum_bench() -> Bench:
    """The bench of chapter 6."""
    controls = {
        "direction": slider("direction drawn", COUNT, 1, COUNT, 1),
        "damping": log_slider("damping λ of DLS", 0.1, -3, 0.5),
        "max_angle": slider("γ max of SDLS [°]", 45.0, 1.0, 90.0, 1.0),
        "steps": slider("steps of SDLS taken", 5, 0, 20, 1),
        "phase": slider("phase of the walk", 0.25, 0.0, 1.0, 0.05),
    }
    return Bench(Spectrum().show, controls, slot="spectrum")
