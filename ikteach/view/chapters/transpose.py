"""Chapter 3's bench: how far to go downhill, on the error parabola and on the arm."""

from functools import partial

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ikteach.arrays import Array
from ikteach.body.figures import planar_arm
from ikteach.motion import ignore, step
from ikteach.solvers import transpose
from ikteach.study.experiment import downhill
from ikteach.view.charts import outline
from ikteach.view.live.bench import Bench, Shown
from ikteach.view.live.canvas import Canvas
from ikteach.view.live.panel import slider
from ikteach.view.stage.colours import BLUE, GREEN, ORANGE, RED
from ikteach.view.widgets.closing import making

BENT = np.array([0.9, -0.7, -0.6])  # [rad] an arm of three links, bent
GAINS = np.linspace(0, 3, 121)
TINY = 1e-30  # [m²] keeps 0 / 0 away where the hand is on the target


class TransposePlot:
    """The arm, and the curve that the next step descends.

    The arm is drawn in its pose.
    """

    def __init__(self) -> None:
        self.arm = planar_arm(3)
        self.theta = BENT
        self.steps = 0
        self._asked = (1.0, np.zeros((1, 3)))
        figure = Figure(figsize=(9.6, 3.9), dpi=90)
        left, right = figure.subplots(1, 2)
        figure.subplots_adjust(left=0.07, right=0.99, bottom=0.13, top=0.91, wspace=0.2)
        self._draw_arm(left)
        self._draw_parabola(right)
        self._canvas = Canvas(figure, [*left.lines, *right.lines[1:]])

    def _draw_arm(self, axes: Axes) -> None:
        axes.set(xlim=(-3.3, 3.3), ylim=(-2.1, 3.3), aspect="equal", xlabel="x [m]", ylabel="y [m]")
        axes.set_title("the arm, before and after one step")
        axes.grid(alpha=0.3)
        (self._before,) = axes.plot([], [], "o--", color="0.55", lw=2, label="before")
        (self._after,) = axes.plot([], [], "o-", color=BLUE, lw=4, label="after")
        (self._target,) = axes.plot([], [], "X", color=RED, ms=12, label="target")
        axes.legend(loc="lower left", fontsize=8)

    def _draw_parabola(self, axes: Axes) -> None:
        axes.set(xlim=(0, 3), ylim=(0, 2.5), xlabel="gain: α as a share of the best α")
        axes.set_ylabel("squared error, after / before the step")
        axes.set_title("the error parabola")
        axes.grid(alpha=0.3)
        axes.axhline(1, color="0.3", lw=1)
        (self._promised,) = axes.plot([], [], color=ORANGE, lw=2, label="promised: ‖e − αJJᵀe‖²")
        (self._actual,) = axes.plot([], [], "--", color=BLUE, lw=2, label="actual")
        (self._best,) = axes.plot([], [], "o", color=GREEN, ms=9, label="best α")
        (self._half,) = axes.plot([], [], "s", color="0.4", ms=8, label="half of it (thesis)")
        (self._chosen,) = axes.plot([], [], "D", color=RED, ms=9, label="chosen")
        axes.legend(loc="upper center", fontsize=8)

    def show(self, gain: float, x: float, y: float) -> Shown:
        """Draw the step with this gain towards a target at (x, y) [m]."""
        self._asked = gain, np.array([[x, y, 0.0]])
        targets = self._asked[1]
        curve = downhill(*self.arm, self.theta, targets, GAINS)
        marks = downhill(*self.arm, self.theta, targets, [0.0, 0.5, 1.0, gain])
        after = self._stepped()
        for line, pose in ((self._before, self.theta), (self._after, after)):
            line.set_data(*outline(*self.arm, pose))
        self._target.set_data([x], [y])
        unit = max(float(marks.actual[0]), TINY)
        self._promised.set_data(GAINS, curve.promised / unit)
        self._actual.set_data(GAINS, curve.actual / unit)
        self._half.set_data([0.5], [marks.promised[1] / unit])
        self._best.set_data([1.0], [marks.promised[2] / unit])
        self._chosen.set_data([gain], [marks.actual[3] / unit])
        now, left = np.sqrt([marks.actual[0], marks.actual[3]])
        words = (
            f"A planar arm after {self.steps} steps, target at ({x:.2f}, {y:.2f}) m. "
            f"Distance now {now:.3f} m. A step with {gain:.2f} of the best α promises "
            f"{np.sqrt(marks.promised[3]):.3f} m and leaves {left:.3f} m."
        )
        return Shown(self._canvas.png(), words, words)

    def take(self) -> None:
        """Take the step that is shown."""
        self.theta, self.steps = self._stepped(), self.steps + 1

    def reset(self) -> None:
        """Go back to the bent arm."""
        self.theta, self.steps = BENT, 0

    def straighten(self) -> None:
        """Stretch the arm along x, where a target inward cannot be neared."""
        self.theta, self.steps = np.zeros(3), 0

    def _stepped(self) -> Array:
        gain, targets = self._asked
        tree, effectors = self.arm
        solver = partial(transpose, gain=gain)
        return step(tree, self.theta, effectors, targets, solver, limits=ignore).theta


@making()
def slope_bench() -> Bench:
    """Make the bench of chapter 3.

    Its sliders are the gain and the target's place, its buttons take the step,
    start again, and stretch the arm.
    """
    plot = TransposePlot()
    controls = {
        "gain": slider("gain (share of best α)", 0.5, 0.0, 3.0, 0.05),
        "x": slider("target x [m]", 0.5, -2.5, 2.5, 0.05),
        "y": slider("target y [m]", 2.2, -1.5, 2.5, 0.05),
    }
    buttons = {"Take the step": plot.take, "Start again": plot.reset}
    buttons["Straight arm"] = plot.straighten
    return Bench(plot.show, controls, slot="slope", buttons=buttons)
