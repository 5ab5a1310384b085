"""The panels that change the picture and not the session: what is seen, and from where."""

from collections.abc import Callable
from math import cos, radians, sin
from typing import Any

import numpy as np

from ikteach.body import forward, jacobian
from ikteach.motion.live.session import Session
from ikteach.motion.reachable import annulus
from ikteach.solvers import SOLVERS, ellipsoid
from ikteach.view.live.live import Live, recorded_bones
from ikteach.view.live.panel import Does, Panel, button, choice, dropdown, slider, tick_box
from ikteach.view.stage.layers import LAYERS, RECORDED_BONES
from ikteach.view.stage.stage import CAMERAS
from ikteach.view.stage.views import VIEWS
from ikteach.view.tools.session_panels import LABEL, LOOK, Guard
from ikteach.view.webgl.scene import Scene
from ikteach.view.widgets.ball import RotationBall

ONE, GHOST = "one figure", "one and a ghost"
BESIDE, OVER = "all, side by side", "all, overlaid"

NOT_RECORDED = (
    "The targets do not follow a recording now. Choose the motion “recorded”, or open a BVH file"
    " under Recording: then its skeleton is seen."
)


def scene_of(session: Session, figures: str) -> Scene:
    """Make the scene of one figure, or of several.

    There is one per method, if there are several; a ghost stands in the place of the other.
    """
    if figures == ONE:
        return Scene(session.tree, session.effectors, slot=None)
    if figures == GHOST:
        return Scene(session.tree, session.effectors, names=["shown", "ghost"], apart=0, slot=None)
    apart, width = (0.0, 540) if figures == OVER else (None, 720)
    names = list(SOLVERS)
    return Scene(session.tree, session.effectors, names=names, apart=apart, width=width, slot=None)


class ViewPanel(Panel):
    """Controls of the parts and the side that are seen.

    live       shows the scene; `live.scene` may become another
    turned     is called after the camera was put to another side
    set_figures  shows one figure or all of them
    """

    def __init__(
        self,
        live: Live,
        guard: Guard,
        turned: Callable[[], object],
        set_figures: Callable[[str], object],
    ) -> None:
        self.live, self._turned, self._set_figures = live, turned, set_figures
        self._dark_chosen = False
        names = list(live.session.effectors.names)
        layers = {
            f"layer.{name}": Does(
                tick_box(name, name == "targets", width="130px"),
                lambda on, name=name: self._switch(name, on),
            )
            for name in (*LAYERS, "targets")
        }
        projections = choice("Projection", ["perspective", "orthographic"], **LABEL)
        counts = [str(count) for count in VIEWS]
        figures = dropdown("Figures", [ONE, GHOST, BESIDE, OVER], **LABEL)
        ghost = dropdown("ghost", list(live.session.methods), **LABEL)
        super().__init__(
            "View",
            [
                {"side": Does(dropdown("View", list(CAMERAS), **LABEL), self.look_from)},
                {"views": Does(choice("Views at once", counts, "1", **LABEL), self._split)},
                {"projection": Does(projections, self._project)},
                {"figures": Does(figures, set_figures)},
                {"ghost": Does(ghost, lambda _: self._haunt())},
                layers,
                {"effector": dropdown("J and ellipsoid of", names, **LABEL)},
                {"dark": Does(tick_box("dark"), self._darken)},
            ],
            shows=lambda: {"dark": live.scene.dark, "views": str(live.scene.views)},
            guard=guard,
        )

    def look_from(self, side: str) -> None:
        """Put the camera to a side."""
        self.live.scene.look_from(side)
        self._turned()

    def straighten(self) -> None:
        """Put the camera back to its side."""
        self.look_from(self.values["side"])

    def renew(self) -> None:
        """Have the scene show what the controls say."""
        values = self.values
        for name, on in values.items():
            if name.startswith("layer."):
                self._switch(name.removeprefix("layer."), on)
        if self._dark_chosen:
            self._darken(values["dark"])
        self._project(values["projection"])
        self._split(values["views"])
        self.straighten()

    def about(self, theta: Any) -> dict[str, Any]:
        """Give the data that the layers need.

        Those of the layers that are on, at the poses (f, n).
        """
        on, session = self.live.scene.layers, self.live.session
        i = session.effectors.names.index(self.values["effector"])
        about: dict[str, Any] = {"effector": i}
        if on["columns of J"] or on["ellipsoid"]:
            J = jacobian(session.tree, forward(session.tree, theta), session.effectors)
            rows = J[:, 3 * i : 3 * i + 3]
            about |= {"columns": rows, "ellipsoid": ellipsoid(rows)}
        if on["reach"]:
            frames = forward(session.tree, theta)
            about["reach"] = [annulus(session.tree, session.effectors, i, frames)]
        if on[RECORDED_BONES]:
            about["skeletons"] = [recorded_bones(session)] * len(theta)
        return about

    def _switch(self, layer: str, on: bool) -> None:
        if layer == "targets":
            for target in self.live.scene.targets:
                target.visible = on
        else:
            self.live.scene.switch(layer, on)
        if on and layer == RECORDED_BONES and recorded_bones(self.live.session) is None:
            self.live.status.say(NOT_RECORDED)

    def _haunt(self) -> None:
        """Show a ghost, as soon as one is chosen."""
        if self.values["figures"] != GHOST:
            self.put(figures=GHOST)
            self._set_figures(GHOST)

    def _split(self, count: str) -> None:
        self.live.scene.views = int(count)

    def _project(self, how: str) -> None:
        self.live.scene.cameras.orthographic = how == "orthographic"

    def _darken(self, on: bool) -> None:
        self._dark_chosen = True
        self.live.scene.dark = on


class ObjectPanel(Panel):
    """Controls that turn, move and zoom the figure.

    The thesis calls this the transformation of the object.
    """

    def __init__(self, live: Live, guard: Guard, straighten: Callable[[], object]) -> None:
        self.live, self.ball = live, RotationBall(azimuth=36.0, elevation=6.0)
        sliders = {
            "azimuth": slider("turn [°]", 36.0, -180.0, 180.0, 1.0, **LOOK),
            "elevation": slider("tilt [°]", 6.0, -85.0, 85.0, 1.0, **LOOK),
            "zoom": slider("zoom [×]", 1.0, 0.3, 3.0, 0.05, **LOOK),
            "right": slider("move right [m]", 0.0, -1.5, 1.5, 0.05, **LOOK),
            "up": slider("move up [m]", 0.0, -1.5, 1.5, 0.05, **LOOK),
        }
        rows: list[Any] = [{name: Does(one, self._turn)} for name, one in sliders.items()]
        straight = {"straight": Does(button("As it was"), straighten)}
        super().__init__("Object", [self.ball, *rows, straight], guard=guard)
        turned = guard(self._turn)

        def by_ball(change: Any) -> None:
            if not self._quiet:
                super(ObjectPanel, self).put(
                    azimuth=self.ball.azimuth, elevation=self.ball.elevation
                )
                self.turns.ask(change["name"])
                turned(change["new"])

        self.ball.observe(by_ball, ["azimuth", "elevation"])

    def begin(self) -> None:
        """Set controls to where the camera is.

        From there the figure is turned.
        """
        azimuth, elevation = self.live.scene.cameras.angles
        self._distance = self.live.scene.cameras.distance
        self.put(azimuth=azimuth, elevation=elevation, zoom=1.0, right=0.0, up=0.0)

    def put(self, **values: Any) -> None:
        """Set controls, and the ball with them."""
        super().put(**values)
        self._turn_ball()

    def _turn_ball(self) -> None:
        self._quiet = True
        try:
            for name in ("azimuth", "elevation"):
                self.ball.set_trait(name, self.values[name])
        finally:
            self._quiet = False

    def _turn(self, _: float) -> None:
        get = self.values
        self._turn_ball()
        a, e = radians(get["azimuth"]), radians(get["elevation"])
        # To move the figure right is to look at a point left of it.
        sideways, upwards = np.array([cos(a), 0, -sin(a)]), np.array([0.0, 1, 0])
        scene = self.live.scene
        middle = scene.stage.extent.centre - get["right"] * sideways - get["up"] * upwards
        away = np.array([sin(a) * cos(e), sin(e), cos(a) * cos(e)]) * self._distance / get["zoom"]
        scene.cameras.put(middle + away, middle)
