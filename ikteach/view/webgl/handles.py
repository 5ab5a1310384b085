"""Targets that are taken hold of in the scene: by mouse, by finger, by keys."""

from typing import Any

import anywidget
import pythreejs as three
import traitlets
from ipywidgets import Widget, widget_serialization

from ikteach.view.stage.colours import SKY
from ikteach.view.webgl.positions import Positions
from ikteach.view.webgl.scene import Scene
from ikteach.view.widgets.actor import Actor, message_of
from ikteach.view.widgets.closing import Living
from ikteach.view.widgets.page import script, style

STEP = 0.05  # [m] one press of an arrow key, on a figure of a human's size


class Handles(Living, anywidget.AnyWidget):
    """Handles at the targets of a scene, which move `positions`.

    Mouse, touch   drag a target in the plane that faces the camera, which stands still meanwhile;
                   that of a direction by its tip, round its joint
    Tab            chooses a target, or leaves the picture after the last one
    arrows         move it along the axes of the world that lie nearest to right and up in the
                   picture, Page Up and Page Down away and near, with Shift a tenth as far; they
                   turn and move the camera while no target is chosen
    Escape         takes the last change back, as `undo` does

    Whoever wants to know asks `positions.on_change`. Display the scene; the handles are under it.
    """

    foreign = frozenset({"renderer", "nodes"})  # the scene's
    _esm, _css = script("view/webgl/handles.js"), style("view/webgl/handles.css")
    renderer = traitlets.Instance(Widget).tag(sync=True, **widget_serialization)
    halo = traitlets.Instance(Widget).tag(sync=True, **widget_serialization)
    nodes = traitlets.List(traitlets.Instance(Widget)).tag(sync=True, **widget_serialization)
    names = traitlets.List(traitlets.Unicode()).tag(sync=True)
    places: Any = traitlets.List().tag(sync=True)
    low: Any = traitlets.List().tag(sync=True)
    high: Any = traitlets.List().tag(sync=True)
    lengths: Any = traitlets.List().tag(sync=True)
    step = traitlets.Float().tag(sync=True)
    chosen = traitlets.Int(-1).tag(sync=True)
    alert = traitlets.Unicode().tag(sync=True)

    def __init__(self, scene: Scene, positions: Positions) -> None:
        self.positions, self._act = positions, Actor()
        unit = scene.stage.unit
        ring = three.Mesh(
            three.TorusBufferGeometry(0.09 * unit, 0.009 * unit, 8, 40),
            three.MeshBasicMaterial(color=SKY, depthTest=False, transparent=True),
            renderOrder=10,
            frustumCulled=False,
        )
        super().__init__(
            renderer=scene.renderer,
            halo=ring,
            nodes=scene.targets,
            names=positions.names,
            places=scene.stage.places.tolist(),
            low=positions.low.tolist(),
            high=positions.high.tolist(),
            lengths=positions.lengths.tolist(),
            step=STEP * unit,
        )
        self.on_msg(self._hear)
        scene.mount(self)

    def undo(self) -> None:
        """Take the last change back."""
        said = self.positions.undo()
        self.send({"let": True})
        self.send({"say": said})

    def _hear(self, _: Any, content: dict[str, Any], __: Any) -> None:
        self._act(lambda: self._obey(content))

    def _obey(self, content: dict[str, Any]) -> None:
        try:
            if "undo" in content:
                self.undo()
            elif "target" in content:
                going_on = not content["fresh"]
                self.positions.drag(int(content["target"]), content["at"], going_on=going_on)
            self.alert = ""
        except Exception as error:  # of whoever follows the targets
            self.alert = message_of(error)
        finally:
            if "number" in content:
                self.send({"heard": content["number"]})
