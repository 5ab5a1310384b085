"""The live scene: solid figures, targets, the floor and layers, in pythreejs. Told poses, no more.

Every frame goes to the page as one message of the driver: a matrix for each thing that moves.
"""

from collections.abc import Sequence
from math import radians, tan
from typing import Any

import ipywidgets as widgets
import numpy as np
import pythreejs as three

from ikteach.arrays import Array, ArrayLike
from ikteach.body import Effectors, Tree
from ikteach.body.rotation import sticks, transforms
from ikteach.names import unknown
from ikteach.view import solids
from ikteach.view.cameras import Cameras
from ikteach.view.closing import close_all
from ikteach.view.driver import Driver, rows
from ikteach.view.flesh import mesh
from ikteach.view.overlays import MAKERS, Layer, effector_colour
from ikteach.view.picture import Still
from ikteach.view.skin import DARK, EFFECTOR_COLOURS, LIGHT, SHIRT, Part, skin_of
from ikteach.view.solids import node
from ikteach.view.stage import CAMERAS, FIELD, LAYERS, SQUARE, Stage
from ikteach.view.still import StillScene

__all__ = ["CAMERAS", "LAYERS", "Scene"]

STILL = np.eye(3, 4)
UPRIGHT = np.array([[1.0, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0]])  # a floor turned into a wall


class Scene:
    """One or several figures with k targets each; a `stage.View`. `widget` is what to display.

    names    one figure for each, with its name over its head (a lone figure needs none)
    apart    how far they stand from each other [m]; 0 lays them over each other, in which case
             they share the targets, and all but the first can be seen through
    dark     light on dark, or dark on light

    Left targets are balls, right ones boxes, so that colour is not the only sign; a grey rod joins
    each effector to its target. A figure in a plane stands before a wall of squares instead of on
    a floor. The other figures wear the colours of `skin.EFFECTOR_COLOURS`, in their order.
    """

    def __init__(
        self, tree: Tree, effectors: Effectors, *, names: Sequence[str] = ("",),
        apart: float | None = None, width: int = 540, height: int = 480, dark: bool = False,
    ) -> None:  # fmt: skip
        self.tree, self.effectors = tree, effectors
        self.stage = stage = Stage(tree, effectors, names, apart)
        unit = stage.unit
        self._grounds = [node() for _ in names]
        self._floor = node([solids.grid(unit, dark)])
        self._joints = [[node() for _ in tree.names] for _ in names]
        shared = 1 if stage.overlaid else len(names)  # sets of targets
        self.targets = [
            node(solids.target(name, effector_colour(i), unit))
            for _ in range(shared)
            for i, name in enumerate(effectors.names)
        ]
        gaps = [node(solids.gap(unit)) for _ in range(len(names) * len(effectors))]
        for f in range(len(names)):
            self._dress(f)
        joints = [group for figure in self._joints for group in figure]
        nodes = [*self._grounds, self._floor, *joints, *self.targets, *gaps]

        aspect = width / height
        scale = max(unit, stage.spread / (aspect * tan(radians(FIELD / 2)) * 2.7))
        self.camera = three.PerspectiveCamera(
            fov=FIELD, aspect=aspect, near=0.05 * unit, far=40 * max(scale, 1)
        )
        self.scene = three.Scene(
            children=[*nodes, *solids.lights()], background=DARK if dark else LIGHT
        )
        self.renderer = three.Renderer(
            scene=self.scene, camera=self.camera, antialias=False, width=width, height=height,
            controls=[three.OrbitControls(controlling=self.camera)],
        )  # fmt: skip
        self.cameras = Cameras(self.renderer, aspect, scale)
        self.look_from(stage.side)
        self.driver = Driver(self.renderer, nodes, description=stage.words)
        self._made: dict[str, Layer] = {}  # in the order of their nodes in the driver
        self._on: set[str] = set()
        self._dark = dark
        self._last: dict[str, Any] = {}
        self.widget = widgets.VBox([self.renderer, self.driver])
        self.widget.add_class("ikteach-scene")

    @property
    def layers(self) -> dict[str, bool]:
        """Which layers are drawn."""
        return {name: name in self._on for name in LAYERS}

    def switch(self, layer: str, on: bool = True) -> None:
        """Draw a layer from the next `show` on, or do not; LookupError for an unknown name."""
        if layer not in LAYERS:
            raise LookupError(unknown("layer", layer, LAYERS))
        if on and layer not in self._made:
            self._make(layer)
        if on != (layer in self._on):
            self._on ^= {layer}
            for thing in self._made[layer].things:
                thing.visible = on
            self.show(**self._last) if self._last else None

    def look_from(self, side: str) -> None:
        """Put the camera to one of `CAMERAS`, or to "plane": along −z."""
        self.cameras.look_from(side)

    @property
    def dark(self) -> bool:
        """Whether the background is dark; may be set."""
        return self._dark

    @dark.setter
    def dark(self, on: bool) -> None:
        if on != self._dark:
            (before,) = self._floor.children
            self._dark = on
            self._floor.children = [solids.grid(self.stage.unit, on)]
            self.scene.background = DARK if on else LIGHT
            close_all(before)

    def show(
        self, theta: Array, targets: Array, *, floor: float | None = None, advance: float = 0.0,
        change: int = 0, effector: int = 0, columns: ArrayLike | None = None,
        ellipsoid: tuple[ArrayLike, ArrayLike] | None = None,
        reach: Sequence[tuple[ArrayLike, float, float]] = (),
    ) -> None:  # fmt: skip
        """Draw poses and targets, and what the layers need; see `stage.View.show`."""
        stage = self.stage
        now = stage.now(theta, targets, floor, advance, effector, columns, ellipsoid, reach)
        places = stage.places[:, None]
        at = now.targets + places
        marks = at[: len(self.targets) // len(self.effectors)].reshape(-1, 3)
        upright = np.broadcast_to(np.eye(3), (len(marks), 3, 3))
        matrices = [
            transforms(np.broadcast_to(np.eye(3), (len(stage), 3, 3)), stage.places),
            self._ground(now.floor, advance),
            transforms(now.orientations, now.positions + places),
            transforms(upright, marks),
            sticks(now.effectors + places, at),
        ]
        for name, layer in self._made.items():
            moved = layer.place(now) if name in self._on else np.zeros((len(layer.nodes), 3, 4))
            matrices.append(moved)
        self._last = {
            "theta": theta, "targets": targets, "floor": floor, "advance": advance,
            "change": change, "effector": effector, "columns": columns, "ellipsoid": ellipsoid,
            "reach": reach,
        }  # fmt: skip
        self.driver.show(rows(*matrices), change)

    def clear(self) -> None:
        """Forget trails and footprints."""
        for layer in self._made.values():
            layer.clear()

    def mount(self, *more: widgets.Widget) -> None:
        """Have the page show the driver, with all it moves, and these widgets under the picture."""
        kept = [child for child in self.widget.children if child is not self.driver]
        # The driver reads what it moves when it is put into the page: take it out, and in again.
        self.widget.children = [*kept, *more]
        self.widget.children = [*kept, *more, self.driver]

    def still(self) -> Still:
        """What was shown last as a picture, which needs no kernel to be seen."""
        picture = StillScene(
            self.tree, self.effectors, names=self.stage.names, apart=self.stage.apart,
            dark=self._dark, width=self.renderer.width, height=self.renderer.height,
        )  # fmt: skip
        try:
            for name in self._on:
                picture.switch(name)
            if self._last:
                picture.show(**self._last)
            return Still(picture.png, self.driver.description or picture.alt)
        finally:
            picture.close()

    def close(self) -> None:
        """Free what the page and the kernel hold of this scene, and of what is mounted in it."""
        close_all(self.widget, *self.cameras.parts)

    def _repr_mimebundle_(self, **kwargs: Any) -> Any:
        """The live widget, and beside it a still for places without a kernel."""
        bundle = self.widget._repr_mimebundle_(**kwargs)
        still = self.still()
        return {**bundle, "image/png": still.png, "text/plain": still.alt}

    def _make(self, layer: str) -> None:
        made = self._made[layer] = MAKERS[layer](self.stage, self._joints)
        for thing in made.things:
            thing.visible = False
        if made.roots:
            self.scene.children = [*self.scene.children, *made.roots]
        if made.nodes:
            self.driver.nodes = [*self.driver.nodes, *made.nodes]
            self.mount()

    def _ground(self, floor: float, advance: float) -> Array:
        if self.stage.planar:
            return UPRIGHT + [[0, 0, 0, 0], [0, 0, 0, 0], [0, 0, 0, -0.2 * self.stage.unit]]
        glide = -(advance % (SQUARE * self.stage.unit))
        return STILL + [[0, 0, 0, 0], [0, 0, 0, floor], [0, 0, 0, glide]]

    def _dress(self, f: int) -> None:
        """Put flesh, or rods, on the joints of figure f, and its name over its head."""
        stage, thick = self.stage, 0.03 * self.stage.unit
        holders: dict[str | None, three.Group] = dict(
            zip(self.tree.names, self._joints[f], strict=True)
        )
        holders[None] = self._grounds[f]
        parts = [self._coloured(part, f) for part in skin_of(self.tree, self.effectors, thick)]
        opacity = 0.5 if stage.overlaid and f > 0 else 1.0
        for joint in dict.fromkeys(part.joint for part in parts):
            here = [part for part in parts if part.joint == joint]
            holders[joint].children = [mesh(here, opacity)]
        if stage.names[f]:
            words = solids.label(
                stage.names[f], self._colour(f), 0.13 * stage.unit, stage.name_at(f)
            )
            holders[None].children = [*holders[None].children, words]

    def _colour(self, f: int) -> str:
        return SHIRT if len(self.stage) == 1 else EFFECTOR_COLOURS[f % len(EFFECTOR_COLOURS)]

    def _coloured(self, part: Part, f: int) -> Part:
        return part._replace(colour=self._colour(f)) if part.colour == SHIRT else part
