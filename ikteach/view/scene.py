"""The scene: a solid figure, its targets and the floor, in pythreejs. It is told poses, no more."""

from collections.abc import Sequence
from typing import Any

import ipywidgets as widgets
import numpy as np
import pythreejs as three

from ikteach.arrays import Array
from ikteach.body import Effectors, Frames, Tree, forward, locate
from ikteach.body.rotation import sticks, transforms
from ikteach.view.driver import Driver, rows
from ikteach.view.flesh import mesh
from ikteach.view.skin import EFFECTOR_COLOURS, GREY, skin_of

STILL = np.eye(3, 4)
CAMERAS = {  # where from, seen from the pelvis
    "three-quarter": (1.5, 0.35, 2.1),
    "front": (0.0, 0.0, 2.7),
    "side": (2.7, 0.0, 0.01),
    "top": (0.0, 2.9, 0.05),
}
TILE = 0.5  # [m] a square of the floor


class Scene:
    """One figure with k targets. `widget` is what to display; `show` moves it.

    Left targets are balls, right ones boxes, so that colour is not the only sign; a grey rod joins
    each effector to its target.
    """

    def __init__(
        self, tree: Tree, effectors: Effectors, *, width: int = 540, height: int = 480
    ) -> None:
        self.tree, self.effectors = tree, effectors
        self._ground, self._floor = _node(), _node()
        self._joints = [_node() for _ in tree.names]
        self._targets = [
            _node(_target(name, EFFECTOR_COLOURS[i % len(EFFECTOR_COLOURS)]))
            for i, name in enumerate(effectors.names)
        ]
        self._gaps = [_node(_rod()) for _ in effectors.names]
        holders: dict[str | None, three.Group] = dict(zip(tree.names, self._joints, strict=True))
        holders[None] = self._ground
        parts = skin_of(tree, effectors)
        for joint in dict.fromkeys(part.joint for part in parts):
            holders[joint].children = [mesh([part for part in parts if part.joint == joint])]
        self._floor.children = [_grid()]
        nodes = [self._ground, self._floor, *self._joints, *self._targets, *self._gaps]

        self.camera = three.PerspectiveCamera(
            position=CAMERAS["three-quarter"], fov=45, aspect=width / height, near=0.05, far=40
        )
        self.scene = three.Scene(children=[*nodes, *_lights()], background="#f4f6f8")
        self.renderer = three.Renderer(
            scene=self.scene, camera=self.camera, antialias=False, width=width, height=height,
            controls=[three.OrbitControls(controlling=self.camera)],
        )  # fmt: skip
        self.driver = Driver(self.renderer, nodes)
        self.widget = widgets.VBox([self.renderer, self.driver])

    def look_from(self, side: str) -> None:
        """Put the camera to one of `CAMERAS`."""
        self.camera.position = CAMERAS[side]

    def show(
        self, theta: Array, targets: Array, *, floor: float, advance: float = 0.0, change: int = 0
    ) -> None:
        """Draw the pose θ (n,) and targets (k, 3) over a floor at height `floor` [m].

        `advance` [m] is how far the figure has gone: the floor glides back under it.
        """
        frames: Frames = forward(self.tree, theta)
        floor_at = STILL + [[0, 0, 0, 0], [0, 0, 0, floor], [0, 0, 0, -(advance % TILE)]]
        at = np.broadcast_to(np.eye(3), (len(targets), 3, 3))
        self.driver.show(
            rows(
                STILL,
                floor_at,
                transforms(frames.orientations, frames.positions),
                transforms(at, targets),
                sticks(locate(frames, self.effectors), targets),
            ),
            change,
        )

    def close(self) -> None:
        """Free what the page and the kernel hold of this scene."""
        self.driver.close()
        for widget in _below(self.renderer):
            widget.close()
        self.widget.close()


def _lights() -> list[three.Light]:
    # A light's target and shadow are given here because pythreejs would else make them in the page
    # and choke on their echo from the kernel ("Error setting state: t.on is not a function").
    shadow = three.DirectionalLightShadow(camera=three.OrthographicCamera(-1, 1, 1, -1))
    return [
        three.AmbientLight(color="#ffffff", intensity=0.55),
        three.DirectionalLight(
            color="#ffffff", intensity=0.6, position=[2, 4, 3],
            target=three.Object3D(), shadow=shadow,
        ),
    ]  # fmt: skip


def _node(children: Sequence[Any] = ()) -> three.Group:
    """Something that the driver moves: its matrix is given, not made from position and so on."""
    return three.Group(children=list(children), matrixAutoUpdate=False)


def _target(name: str, colour: str) -> list[three.Mesh]:
    material = three.MeshLambertMaterial(color=colour, transparent=True, opacity=0.85)
    boxed = name.endswith(".r")
    shape = (
        three.BoxBufferGeometry(0.07, 0.07, 0.07)
        if boxed
        else three.SphereBufferGeometry(0.045, 16, 12)
    )
    return [three.Mesh(shape, material)]


def _rod() -> list[three.Mesh]:
    material = three.MeshBasicMaterial(color=GREY)
    return [
        three.Mesh(three.CylinderBufferGeometry(0.006, 0.006, 1, 6), material, position=(0, 0.5, 0))
    ]


def _grid() -> three.GridHelper:
    return three.GridHelper(6, round(6 / TILE), "#9aa5b1", "#cbd2d9")


def _below(widget: widgets.Widget) -> list[widgets.Widget]:
    """The widget and all that it holds, each once."""
    found: dict[str, widgets.Widget] = {}
    waiting = [widget]
    while waiting:
        one = waiting.pop()
        if not isinstance(one, widgets.Widget) or one.model_id in found:
            continue
        found[one.model_id] = one
        for name in one.keys:
            value = getattr(one, name, None)
            waiting += value if isinstance(value, list | tuple) else [value]
    return list(found.values())
