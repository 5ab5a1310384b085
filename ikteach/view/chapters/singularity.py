"""Chapter 2's live figure: an arm that is bent, and what it can then do about an error."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from ikteach.arrays import Array
from ikteach.body import forward, jacobian, locate
from ikteach.body.figures import planar_arm
from ikteach.solvers import SOLVERS, conditioning, ellipsoid, manipulability
from ikteach.view.live.bench import Bench, Shown
from ikteach.view.live.canvas import Canvas
from ikteach.view.live.panel import slider
from ikteach.view.stage.colours import PURPLE, SKY, effector_colour
from ikteach.view.webgl.scene import Scene
from ikteach.view.webgl.targets import Targets

LEAST = 1e-5  # [rad] shorter bars are not seen
SIZE = 0.1  # ‖e‖ [m]


class BendBench(Bench):
    """A two-link arm with its ellipsoid.

    Sliders bend it and turn an error of 10 cm round it. Beside it: its singular values, and the
    length of the step that each method would take.
    """

    def __init__(self, *, slot: str | None = "bend") -> None:
        tree, effectors = arm = planar_arm(2)
        chart, scene = SingularityPlot(), Scene(*arm, width=460, height=400, slot=None)
        handles = Targets(scene, [[2.0 - SIZE, 0.0, 0.0]], slot=None)
        controls = {
            "bend": slider("bend of the elbow [°]", 40, -180, 180, 1),
            "way": slider("direction of the error [°]", 180, -180, 180, 5),
        }

        def show(*, bend: int, way: int) -> Shown:
            theta = np.radians([0, bend])
            frames = forward(tree, theta)
            # Rounded, so that a right angle is one, and a straight arm quite straight.
            J, s = jacobian(tree, frames, effectors).round(12), locate(frames, effectors)
            e = SIZE * np.array([np.cos(np.radians(way)), np.sin(np.radians(way)), 0]).round(12)
            sigma = np.linalg.svdvals(J)
            steps = {name: solver(J, e) for name, solver in SOLVERS.items()}
            lengths = {name: float(np.linalg.norm(step)) for name, step in steps.items()}
            handles.follow(s + e)
            scene.show(theta, s + e, columns=J, ellipsoid=ellipsoid(J))
            listed = ", ".join(f"{name} {length:.3g} rad" for name, length in lengths.items())
            words = (
                f"An arm bent by {bend}°, its error of {SIZE:g} m in the direction {way}°. "
                f"σ₁ = {sigma[0]:.3f}, σ₂ = {sigma[1]:.3g} m/rad, √det(JJᵀ) = "
                f"{manipulability(J[:2]):.3g}, condition {conditioning(J):.3g}. "
                f"Jᵀe has the length {np.linalg.norm(J.T @ e):.3g}. Steps: {listed}."
            )
            return Shown(chart.png(sigma, [*lengths.values()]), words, words)

        super().__init__(show, controls, slot=slot, scene=scene)
        self.targets = handles

        @handles.on_change
        def pulled(_: int, place: Array) -> None:
            """Turn the error towards where its end was pulled."""
            hand = locate(forward(tree, np.radians([0, self.values["bend"]])), effectors)[0]
            x, y, _ = place - hand
            controls["way"].value = round(np.degrees(np.arctan2(y, x)))

        scene.switch("ellipsoid")
        scene.switch("columns of J")


class SingularityPlot:
    """Bars of singular values and of each method's step."""

    def __init__(self) -> None:
        figure = Figure(figsize=(5.0, 3.1), dpi=90)  # beside the arm
        above, below = figure.subplots(2, 1, height_ratios=[1, 1.9])
        figure.subplots_adjust(left=0.25, right=0.97, bottom=0.09, top=0.92, hspace=0.75)
        above.set(title="singular values [m/rad]", xlim=(0, 2.5))
        self._sigma = above.barh([1, 0], [1, 1], color=[PURPLE, SKY], hatch="//", edgecolor="white")
        above.set_yticks([1, 0], ["σ₁", "σ₂"])
        below.set(title="length of the step ‖Δθ‖ [rad]", xscale="log", xlim=(LEAST, 1e3))
        below.axvline(np.pi, color="0.4", ls=":")
        at = range(len(SOLVERS))
        colours = list(map(effector_colour, at))
        self._steps = below.barh(at, [1.0] * len(SOLVERS), color=colours, edgecolor="white")
        below.set_yticks(at, list(SOLVERS))
        below.invert_yaxis()
        for axes in above, below:
            axes.grid(alpha=0.3, axis="x")
            axes.set_axisbelow(True)
        self._canvas = Canvas(figure, [*self._sigma, *self._steps])

    def png(self, sigma: Array, lengths: Sequence[float]) -> bytes:
        """Draw singular values (2,) [m/rad] and lengths of steps [rad]."""
        for bar, value in zip(self._sigma, sigma, strict=True):
            bar.set_width(float(value))
        for bar, length in zip(self._steps, lengths, strict=True):
            bar.set_width(max(length, LEAST))
        return self._canvas.png()
