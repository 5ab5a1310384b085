"""Chapter 6's bench: what each method does along each singular direction of the human's J."""

from functools import lru_cache
from math import radians

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ikteach.arrays import Array
from ikteach.body import forward, jacobian, locate
from ikteach.body.figures import human
from ikteach.markup import Markup
from ikteach.motion import gait, step
from ikteach.solvers import sdls
from ikteach.solvers.dls import filtered
from ikteach.solvers.response import Directions, directions, factors
from ikteach.view.live.bench import Bench, Shown
from ikteach.view.live.canvas import Canvas
from ikteach.view.live.panel import log_slider, slider
from ikteach.view.stage.colours import BLUE, GREEN, ORANGE, effector_colour
from ikteach.view.widgets.closing import making
from ikteach.view.widgets.prose import grid

TREE, EFFECTORS = human()
COUNT = 3 * len(EFFECTORS)
LOW, HIGH = 1e-3, 1e3  # [rad/m] of the factors' axis
ARROW = 0.45  # [m] for a whole unit of u_i


@lru_cache(maxsize=64)
def pose_after(phase: float, steps: int) -> Array:
    """Take `steps` of SDLS towards the walk's targets.

    They start at rest, towards the targets at that phase [rad]; gives θ (n,).
    """
    theta = TREE.rest
    for _ in range(steps):
        theta = step(TREE, theta, EFFECTORS, gait.walking.at(phase), sdls).theta
    return theta


class SdlsPlot:
    """Bars of the filter factors, and the chosen direction.

    The direction is drawn on the body.
    """

    def __init__(self) -> None:
        figure = Figure(figsize=(10.4, 4.2), dpi=90)
        bars, front, side = figure.subplots(1, 3, width_ratios=[2.1, 1.3, 0.95])
        figure.subplots_adjust(left=0.065, right=0.99, bottom=0.12, top=0.91, wspace=0.3)
        self._draw_factors(bars)
        self._bodies = [
            Body(front, 0, 1.2, title="from the front", xlabel="x [m]"),
            Body(side, 2, 0.85, title="left side", xlabel="z [m]"),
        ]
        rods = [rod for group in self._bars for rod in group]
        moving = [rods, [self._mark], *(body.moving for body in self._bodies)]
        self._canvas = Canvas(figure, [artist for group in moving for artist in group])

    def _draw_factors(self, axes: Axes) -> None:
        at = np.arange(1, COUNT + 1)
        axes.set(yscale="log", ylim=(LOW, HIGH), xlim=(0.3, COUNT + 0.7), xticks=at)
        axes.set(xlabel="singular direction i, strongest first", ylabel="answer f [rad/m]")
        axes.set_title("Δθ = Σ f (uᵀe) v: what f each method takes")
        axes.grid(alpha=0.3, axis="y")
        looks = [("1/σ", BLUE, ""), ("σ/(σ²+λ²)", ORANGE, "//"), ("SDLS", GREEN, "..")]
        self._bars = [
            axes.bar(at + 0.27 * (k - 1), 1, 0.25, LOW, color=c, hatch=h, ec="white", label=label)
            for k, (label, c, h) in enumerate(looks)
        ]
        (self._mark,) = axes.plot([], [], "v", color="black", ms=9, label="direction drawn")
        axes.legend(loc="upper left", fontsize=8, ncols=2)

    def show(
        self, direction: int, damping: float, max_angle: float, steps: int, phase: float
    ) -> Shown:
        """Draw the directions at the pose after `steps`.

        direction  which is drawn on the body, 1 for the strongest
        max_angle  γ_max of SDLS [°]
        phase      of the walk, 0 to 1
        """
        theta = pose_after(round(2 * np.pi * phase, 6), steps)
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
        for body in self._bodies:
            body.draw(frames.positions, s, found.U[:, i].reshape(-1, 3))
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


class Body:
    """The human seen along an axis.

    From each effector comes an arrow.

    across  the coordinate that runs from left to right: 0 for x, 2 for z
    half    of the width that is seen [m]
    """

    def __init__(self, axes: Axes, across: int, half: float, **words: str) -> None:
        axes.set(xlim=(-half, half), ylim=(-1.7, 1.1), aspect="equal", **words)
        self._across = across
        (self._bones,) = axes.plot([], [], "-", color="0.45", lw=3)
        self._arrows, self._tips = [], []
        for i, name in enumerate(EFFECTORS.names):
            self._arrows += axes.plot([], [], "-", color=effector_colour(i), lw=3)
            sign = "s" if name.endswith(".r") else "o"
            self._tips += axes.plot([], [], sign, color=effector_colour(i), ms=7)
        self.moving = [self._bones, *self._arrows, *self._tips]

    def draw(self, p: Array, s: Array, u: Array) -> None:
        """Draw joints p (n, 3), effectors s (k, 3) and from each its way u (k, 3)."""
        x, y = self._across, 1
        gap = np.full(3, np.nan)  # between one bone and the next
        joints = zip([p[i] if i >= 0 else np.zeros(3) for i in TREE.parents], p, strict=True)
        tips = zip(p[EFFECTORS.joints], s, strict=True)
        path = np.array([point for bone in [*joints, *tips] for point in (*bone, gap)])
        self._bones.set_data(path[:, x], path[:, y])
        ends = s + ARROW * u
        for arrow, tip, start, end in zip(self._arrows, self._tips, s, ends, strict=True):
            arrow.set_data([start[x], end[x]], [start[y], end[y]])
            tip.set_data([end[x]], [end[y]])


def _table(found: Directions, answers: list[Array]) -> Markup:
    """Write all directions in numbers."""
    heads = ["σ [m/rad]", "uᵀe [m]", "N", "M", "γ [°]", "1/σ", "σ/(σ²+λ²)", "SDLS"]
    columns = [found.sigma, found.alpha, found.N, found.M, np.degrees(found.gamma), *answers]
    rows = [[i, *map(_number, row)] for i, row in enumerate(np.transpose(columns), start=1)]
    return grid(["i", *heads], rows)


def _number(value: float) -> str:
    """Write the number, or "none" where the error asks for nothing along a direction."""
    return "none" if np.isnan(value) else f"{value:.3g}"


@making()
def spectrum_bench() -> Bench:
    """Make the bench of chapter 6."""
    controls = {
        "direction": slider("direction drawn", COUNT, 1, COUNT, 1),
        "damping": log_slider("damping λ of DLS", 0.1, -3, 0.5),
        "max_angle": slider("γ max of SDLS [°]", 45.0, 1.0, 90.0, 1.0),
        "steps": slider("steps of SDLS taken", 5, 0, 20, 1),
        "phase": slider("phase of the walk", 0.25, 0.0, 1.0, 0.05),
    }
    return Bench(SdlsPlot().show, controls, slot="spectrum")
