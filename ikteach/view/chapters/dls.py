"""Chapter 5's bench: what a larger λ costs in nearness, and what it buys in calm."""

from functools import cache, partial

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ikteach.body.figures import Figure as Body
from ikteach.body.figures import planar_arm
from ikteach.motion import Track, track
from ikteach.solvers import dls
from ikteach.study import after, variants
from ikteach.study.experiment import circle
from ikteach.view.chapters.transpose import BENT
from ikteach.view.charts import outline
from ikteach.view.live.bench import Bench, Shown
from ikteach.view.live.canvas import Canvas
from ikteach.view.live.panel import choice, log_slider, slider
from ikteach.view.stage.colours import BLUE, GREEN, ORANGE, RED
from ikteach.view.widgets.closing import making

LOW, HIGH, STEP = -3.0, 1.0, 0.1  # λ from 10^LOW to 10^HIGH
DAMPINGS = 10 ** np.arange(LOW, HIGH + STEP / 2, STEP)
TIMES = np.arange(1, 121) / 30  # [s] two rounds of the target
UNITS = {"metres": 1.0, "centimetres": 100.0}


def arm_in(unit: float) -> Body:
    """Make the arm of three links of 1 m, each `unit` long."""
    return planar_arm([unit] * 3)


@cache
def sweep(unit: float, centre: float) -> Track:
    """Have the arm follow the circle with every λ.

    All run at once, with lengths in that unit.
    """
    targets = unit * circle(TIMES, centre=(centre, 0, 0))
    theta = np.broadcast_to(BENT, (len(DAMPINGS), len(BENT)))
    return track(*arm_in(unit), targets, partial(dls, damping=DAMPINGS), theta=theta, times=TIMES)


class DlsPlot:
    """The arm on its round, and two measures of it.

    Nearness is drawn against jitter, for every λ.
    """

    def __init__(self) -> None:
        figure = Figure(figsize=(9.6, 4.0), dpi=90)
        left, right = figure.subplots(1, 2)
        figure.subplots_adjust(left=0.07, right=0.99, bottom=0.13, top=0.91, wspace=0.22)
        self._draw_arm(left)
        self._draw_tradeoff(right)
        self._canvas = Canvas(figure, [*left.lines[1:], *right.lines])

    def _draw_arm(self, axes: Axes) -> None:
        axes.set(xlim=(-1.2, 4), ylim=(-2.4, 2.4), aspect="equal", xlabel="x [m]", ylabel="y [m]")
        axes.set_title("the arm, its hand's path, the target's")
        axes.grid(alpha=0.3)
        turn = np.linspace(0, 2 * np.pi, 200)
        axes.plot(3 * np.cos(turn), 3 * np.sin(turn), ":", color="0.4", label="reach")
        (self._goal,) = axes.plot([], [], "--", color=RED, lw=1.5, label="target's path")
        (self._path,) = axes.plot([], [], "-", color=GREEN, lw=1.5, label="hand's path")
        (self._arm,) = axes.plot([], [], "o-", color=BLUE, lw=4, label="arm")
        (self._target,) = axes.plot([], [], "X", color=RED, ms=11, label="target")
        axes.legend(loc="lower left", fontsize=8)

    def _draw_tradeoff(self, axes: Axes) -> None:
        axes.set(xscale="log", yscale="log", xlim=(5e-4, 3), ylim=(2e-3, 3))
        axes.set(xlabel="jitter: mean ‖Δ²θ‖ [rad]", ylabel="mean distance to target [m]")
        axes.set_title("each dot is one λ: down is near, left is calm")
        axes.grid(alpha=0.3, which="both")
        (self._all,) = axes.plot([], [], ".-", color=ORANGE, lw=1, label="λ from 0.001 to 10")
        (self._this,) = axes.plot([], [], "D", color=BLUE, ms=10, label="this λ")
        axes.legend(loc="lower left", fontsize=8)

    def show(self, damping: float, unit: str, centre: float, time: float) -> Shown:
        """Draw the run with the λ nearest to `damping`, at one moment [s].

        unit    of the lengths in the solver, one of `UNITS`
        centre  of the circle, along x [m]
        """
        scale = UNITS[unit]
        run = sweep(scale, round(centre, 3))
        table = variants(after(run, 1.0), DAMPINGS)
        i = int(abs(np.log(DAMPINGS / damping)).argmin())
        frame = int(abs(TIMES - time).argmin())
        near, calm = table["mean"].to_numpy() / scale, table["jitter"].to_numpy()
        self._goal.set_data(*(run.targets[:, 0, :2].T / scale))
        self._path.set_data(*(run.positions[:, i, 0, :2].T / scale))
        self._arm.set_data(*(outline(*arm_in(scale), run.theta[frame, i]) / scale))
        self._target.set_data(*(run.targets[frame, :, :2].T / scale))
        self._all.set_data(calm, near)
        self._this.set_data(calm[i : i + 1], near[i : i + 1])
        best = int(near.argmin())
        words = (
            f"λ = {DAMPINGS[i]:.3g}, lengths in {unit}. Mean distance to target {near[i]:.3f} m, "
            f"jitter {calm[i]:.4f} rad. Nearest of all is λ = {DAMPINGS[best]:.3g} with "
            f"{near[best]:.3f} m and jitter {calm[best]:.4f} rad. At {TIMES[frame]:.2f} s the hand "
            f"is {run.error[frame, i, 0] / scale:.3f} m from the target."
        )
        return Shown(self._canvas.png(), words, words)


@making()
def tradeoff_bench() -> Bench:
    """Make the bench of chapter 5.

    Its controls: λ, its unit, the target's circle, the moment shown.
    """
    controls = {
        "damping": log_slider("damping λ", 0.1, LOW, HIGH, STEP),
        "unit": choice("lengths in", list(UNITS)),
        "centre": slider("centre of the circle [m]", 2.4, 1.2, 3.2, 0.1),
        "time": slider("moment shown [s]", 2.0, 0.0, 4.0, 0.05),
    }
    return Bench(DlsPlot().show, controls, slot="tradeoff")
