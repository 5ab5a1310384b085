"""The bench of chapters 2 and 4 to 6: a circle of Δθ, and the ellipse that J makes of it."""

from typing import Any

import numpy as np
from matplotlib.figure import Figure

from ikteach.arrays import Array
from ikteach.body import forward, jacobian, locate
from ikteach.body.figures import planar_arm
from ikteach.markup import minus
from ikteach.motion.methods import Methods, methods_of
from ikteach.solvers import ask
from ikteach.solvers.circle import Image, along, image
from ikteach.view.charts import outline
from ikteach.view.live.bench import Bench, Shown
from ikteach.view.live.panel import slider
from ikteach.view.stage.colours import BLUE, GREY, ORANGE, PURPLE, RED, effector_colour
from ikteach.view.widgets.picture import Still, png_of
from ikteach.view.widgets.plane import Plane, Stroke

SHOULDER = np.radians(20)  # [rad] of the first link; it turns both ellipse and arm, no more
STEPS, PLACES = 1.5, 2.6  # [rad], [m] from the middle of a plane to its edges
FINE = 0.005  # of a slider, and of a key with Shift: else the page would move the point [rad, m]
DASHES = ("", "7 4", "2 3", "9 3 2 3", "1 5")  # of methods: colour is never the only sign


class SvdBench(Bench):
    """A two-link arm's Δθ and JΔθ, in two planes.

    The circle of all steps of length 1 becomes an ellipse. Without methods Δθ is dragged, and JΔθ
    seen; with methods the error e is, and the Δθ of each is seen in both planes.

    methods  as a live figure takes them: names, solvers or {name: solver}
    """

    def __init__(self, methods: Methods | None = None, *, slot: str | None = "svd") -> None:
        self.arm = planar_arm(2)
        self.methods = {} if methods is None else methods_of(methods)
        of_step, of_error = "" if self.methods else "Δθ", "e" if self.methods else ""
        self.steps = Plane(title="steps", xlabel="Δθ₁ [rad]", ylabel="Δθ₂ [rad]", half=STEPS)
        self.places = Plane(title="the hand", xlabel="x [m]", ylabel="y [m]", half=PLACES)
        self.steps.handle, self.places.handle = of_step, of_error
        self.held = self.places if self.methods else self.steps
        controls = {
            "bend": slider("bend of the elbow [°]", 20 if self.methods else 60, -180, 180, 1)
        }
        if self.methods:
            controls["x"] = slider("error e, x [m]", -0.15, -PLACES, PLACES, FINE)
            controls["y"] = slider("error e, y [m]", -0.1, -PLACES, PLACES, FINE)
        else:
            controls["x"] = slider("Δθ₁, shoulder [rad]", 0.8, -STEPS, STEPS, FINE)
            controls["y"] = slider("Δθ₂, elbow [rad]", 0.6, -STEPS, STEPS, FINE)
        planes = [self.steps, self.places]
        super().__init__(self._show, controls, slot=slot, planes=planes)
        self.held.observe(lambda _: self._after(self._dragged), "at")

    def _dragged(self) -> None:
        """Have the sliders agree with the point."""
        self.controls["x"].value, self.controls["y"].value = self.held.at

    def _show(self, *, bend: int, x: float, y: float) -> Shown:
        tree, effectors = self.arm
        theta = np.array([SHOULDER, np.radians(bend)])
        frames = forward(tree, theta)
        J = jacobian(tree, frames, effectors)  # (3, 2); the third row is 0 in the plane
        bones = outline(tree, effectors, theta).T - locate(frames, effectors)[0, :2]
        seen, at = image(J[:2]), np.array([x, y])
        self.held.at = at.tolist()
        told = self._answers(J, seen, bones, at) if self.methods else _told(J, seen, bones, at)
        left, right, words = told
        words = (
            f"An elbow bent by {bend}°: σ₁ = {seen.sigma[0]:.3f}, σ₂ = {seen.sigma[1]:.3f} m/rad; "
            f"v₁ = {_pair(seen.V[0])}, v₂ = {_pair(seen.V[1])}, "
            f"u₁ = {_pair(seen.U[0])}, u₂ = {_pair(seen.U[1])}. {words}"
        )
        self.steps.show(left, words)
        self.places.show(right, words)
        self.held.said = _pair(at)
        return Shown(b"", words, words)

    def _answers(self, J: Array, seen: Image, bones: Array, e: Array) -> Any:
        left, right = _circle(seen), [*_ellipse(seen, bones), _arrow(e, PURPLE, "e", width=4)]
        said = [f"The error e is {_pair(e)} m."]
        for i, (name, solver) in enumerate(self.methods.items()):
            dtheta = ask(solver, J, np.array([*e, 0.0]))
            look: dict[str, Any] = {"dashes": DASHES[i % len(DASHES)]}
            look |= {"width": 3, "legend": True}
            left.append(_arrow(dtheta, effector_colour(i), name, **look))
            right.append(_arrow(J[:2] @ dtheta, effector_colour(i), name, **look))
            size = np.linalg.norm(dtheta)
            beyond = ", beyond the picture" if abs(dtheta).max() > STEPS else ""
            said.append(
                f"{name}: Δθ = {_pair(dtheta)} rad, long {size:.3g}{beyond}; "
                f"JΔθ = {_pair(J[:2] @ dtheta)} m."
            )
        return left, right, " ".join(said)

    def still(self) -> Still:
        """Draw both planes for a place without a kernel."""
        figure = Figure(figsize=(9, 4.6), dpi=90, layout="constrained")
        for plane, axes in zip((self.steps, self.places), figure.subplots(1, 2), strict=True):
            plane.draw(axes)
        return Still(png_of(figure), self.words)


def _told(J: Array, seen: Image, bones: Array, dtheta: Array) -> Any:
    """Draw Δθ and its parts along v_i, and where J takes them; the same in words."""
    parts = along(seen, dtheta)
    first, moved = parts[0] * seen.V[0], parts[0] * seen.sigma[0] * seen.U[0]
    a, b = parts.round(2) + 0.0  # no −0
    goes = J[:2] @ dtheta
    left = [*_circle(seen), _path(first, dtheta), _arrow(dtheta, RED, "Δθ", width=4)]
    right = [*_ellipse(seen, bones), _path(moved, goes), _arrow(goes, RED, "JΔθ", width=4)]
    return (
        left,
        right,
        (
            f"Δθ = {_pair(dtheta)} rad = {a:.2f} v₁ + {b:.2f} v₂. So JΔθ = {a:.2f} σ₁ u₁ + "
            f"{b:.2f} σ₂ u₂ = {_pair(goes)} m."
        ),
    )


def _circle(seen: Image) -> list[Stroke]:
    v = [_arrow(seen.V[i], c, f"v{'₁₂'[i]}") for i, c in enumerate((BLUE, ORANGE))]
    return [Stroke(seen.circle, GREY), *v]


def _ellipse(seen: Image, bones: Array) -> list[Stroke]:
    ends = seen.sigma[:, None] * seen.U
    u = [_arrow(ends[i], c, f"σ{'₁₂'[i]}u{'₁₂'[i]}") for i, c in enumerate((BLUE, ORANGE))]
    return [Stroke(bones, GREY, width=6), Stroke(seen.ellipse, GREY), *u]


def _arrow(to: Array, colour: str, name: str, **look: Any) -> Stroke:
    return Stroke(np.array([[0.0, 0.0], to]), colour, name, arrow=True, **look)


def _path(first: Array, to: Array) -> Stroke:
    """Go along the first direction, and from there to the end."""
    return Stroke(np.array([[0.0, 0.0], first, to]), RED, dashes="2 4")


def _pair(values: Array) -> str:
    return minus("({:.2f}, {:.2f})".format(*(np.round(values, 2) + 0.0)))  # no −0
