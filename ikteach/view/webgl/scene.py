"""The live scene: solid figures, targets, the floor and layers, in pythreejs. Told poses, no more.

Every frame goes to the page as one message of the driver: a matrix for each thing that moves.
"""

from collections.abc import Sequence
from typing import Any

import ipywidgets as widgets
import numpy as np
import pythreejs as three

from ikteach.arrays import Array, ArrayLike
from ikteach.body import Effectors, Frames, Tree
from ikteach.body.rotation import sticks
from ikteach.names import unknown
from ikteach.view.raster.still import StillScene
from ikteach.view.stage import shapes
from ikteach.view.stage.skin import DARK, EFFECTOR_COLOURS, GREY, LIGHT, SHIRT, Part
from ikteach.view.stage.stage import CAMERAS, FIELD, LAYERS, Stage
from ikteach.view.webgl import bodies as flesh
from ikteach.view.webgl import objects as solids
from ikteach.view.webgl.cameras import Cameras
from ikteach.view.webgl.driver import Driver, Move
from ikteach.view.webgl.layers import MAKERS, Layer
from ikteach.view.webgl.mesh import Piece, fused, shifted
from ikteach.view.webgl.objects import node
from ikteach.view.widgets import doors
from ikteach.view.widgets.closing import Living, close_all
from ikteach.view.widgets.lacking import Note
from ikteach.view.widgets.picture import Still

__all__ = ["CAMERAS", "LAYERS", "Scene"]

STILL = np.eye(3, 4)


class Scene(Living):
    """One or several figures with k targets each; a `stage.View`. `widget` is what to display.

    names    one figure for each, with its name over its head (a lone figure needs none)
    apart    how far they stand from each other [m]; 0 lays them over each other, in which case
             they share the targets, and all but the first can be seen through
    dark     light on dark, or dark on light
    slot     only one of a slot lives at a time: to run a cell again closes the older one. Name it
             for a second scene in a notebook

    Left targets are balls, right ones boxes, so that colour is not the only sign; a grey rod joins
    each effector to its target. A figure in a plane stands before a wall of squares instead of on
    a floor. The other figures wear the colours of `skin.EFFECTOR_COLOURS`, in their order.
    """

    def __init__(
        self, tree: Tree, effectors: Effectors, *, names: Sequence[str] = ("",),
        apart: float | None = None, width: int = 540, height: int = 480, dark: bool = False,
        slot: str | None = "scene",
    ) -> None:  # fmt: skip
        self.slot = slot
        width, height = doors.scene(tree, effectors, names, apart, width, height)
        self.tree, self.effectors = tree, effectors
        self.stage = stage = Stage(tree, effectors, names, apart)
        unit, f, n, k = stage.unit, len(names), len(tree), len(effectors)
        # The rows of a frame: grounds (f), floor, joints (f, n), targets (sets, k), gaps (f, k).
        self._sets = 1 if stage.overlaid else f
        counts = [f, 1, f * n, self._sets * k, f * k]
        floor, joint, target, gap, self._rows = np.cumsum(counts).tolist()
        self._blank = np.tile(STILL, (self._rows, 1, 1))  # a frame, but for what moves
        self._blank[:f, :, 3] = stage.places
        self._parts = floor, slice(joint, target), slice(target, gap), slice(gap, None)
        self._floor = node([solids.grid(unit, dark)])
        self.targets = solids.marks(effectors.names, unit, self._sets)
        bodies = [self._body(i, i, joint + i * n) for i in range(f)]
        rod = shapes.rod(0.006 * unit)
        gaps = fused([Piece(row, rod, GREY) for row in range(gap, self._rows)])
        self._moves: list[Move] = [
            (self._floor, floor), *zip(self.targets, range(target, gap), strict=True), *bodies, gaps
        ]  # fmt: skip

        aspect = width / height
        self.camera = three.PerspectiveCamera(fov=FIELD, aspect=aspect)
        self.scene = three.Scene(
            children=[*(thing for thing, _ in self._moves), *self._names(), *solids.lights()],
            background=DARK if dark else LIGHT,
        )
        self.renderer = three.Renderer(
            scene=self.scene, camera=self.camera, antialias=False, width=width, height=height,
            controls=[three.OrbitControls(controlling=self.camera)],
        )  # fmt: skip
        self.cameras = Cameras(self.renderer, stage, aspect)
        self.look_from(stage.side)
        self.driver = Driver(self.renderer, description=stage.words)
        self.driver.on_page = self._greet
        self.driver.as_png = lambda: self.still().png
        self.driver.move(self._moves, self._rows)
        self.note = Note()
        self._made: dict[str, Layer] = {}
        self._on: set[str] = set()
        self._dark = dark
        self._last: dict[str, Any] = {}
        self.widget = widgets.VBox([self.renderer, self.driver, self.note.widget])
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
            made = self._made[layer] = MAKERS[layer](self.stage)
            self.scene.children = [*self.scene.children, made.root]
        if on != (layer in self._on):
            self._on ^= {layer}
            self._made[layer].root.visible = on
            self._plan()
            self.show(**self._last) if self._last else None

    def look_from(self, side: str) -> None:
        """Put the camera to one of `CAMERAS`, or to "plane": along the normal of its plane."""
        self.cameras.look_from(side)
        self._side = side

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
        reach: Sequence[tuple[ArrayLike, float, float]] = (), frames: Frames | None = None,
    ) -> None:  # fmt: skip
        """Draw poses and targets, and what the layers need; see `stage.View.show`."""
        stage = self.stage
        now = stage.now(theta, targets, floor, advance, effector, columns, ellipsoid, reach, frames)
        places = stage.places[:, None]
        at = now.targets + places
        ground, joints, marks, gaps = self._parts
        frame = self._blank.copy()
        frame[ground] = stage.ground(now.floor, advance)
        frame[joints, :, :3] = now.orientations.reshape(-1, 3, 3)
        frame[joints, :, 3] = (now.positions + places).reshape(-1, 3)
        frame[marks, :, 3] = at[: self._sets].reshape(-1, 3)
        frame[gaps] = sticks(now.effectors + places, at).reshape(-1, 3, 4)
        layers = [layer.place(now) for layer in self._drawn()]
        self._last = {
            "theta": theta, "targets": targets, "floor": floor, "advance": advance,
            "change": change, "effector": effector, "columns": columns, "ellipsoid": ellipsoid,
            "reach": reach,
        }  # fmt: skip
        self.driver.show(np.concatenate([frame, *layers]) if layers else frame, change)

    def clear(self) -> None:
        """Forget trails and footprints."""
        for layer in self._made.values():
            layer.clear()

    def mount(self, *more: widgets.Widget) -> None:
        """Have the page show these widgets under the picture."""
        self.widget.children = [*self.widget.children, *more]

    def still(self) -> Still:
        """What was shown last as a picture, which needs no kernel to be seen."""
        picture = StillScene(
            self.tree, self.effectors, names=self.stage.names, apart=self.stage.apart,
            dark=self._dark, width=self.renderer.width, height=self.renderer.height, slot=None,
        )  # fmt: skip
        try:
            picture.look_from(self._side)
            for name in self._on:
                picture.switch(name)
            if self._last:
                picture.show(**self._last)
            return Still(picture.png, self.driver.description or picture.alt)
        finally:
            picture.close()

    def _repr_mimebundle_(self, **kwargs: Any) -> Any:
        """The live widget, and beside it a still for places without a kernel."""
        return self.note.beside(self.widget._repr_mimebundle_(**kwargs), self.still())

    def _greet(self, new: bool) -> None:
        """Show a page that begins to look what was shown last."""
        if new and self._last:
            self.show(**self._last)

    def _drawn(self) -> list[Layer]:
        """The layers that are on, in the order of their rows."""
        return [layer for name, layer in self._made.items() if name in self._on]

    def _plan(self) -> None:
        """Tell the driver what it is to move: what is always there, and the layers that are on."""
        moves, rows = list(self._moves), self._rows
        for layer in self._drawn():
            moves += [(thing, shifted(runs, rows)) for thing, runs in layer.moves]
            rows += layer.rows
        self.driver.move(moves, rows)

    def _body(self, f: int, ground: int, joint: int) -> Move:
        """The flesh, or rods, of figure f, moved by the rows of its ground and its joints."""
        stage = self.stage
        rows: dict[str | None, int] = {name: joint + j for j, name in enumerate(self.tree.names)}
        rows[None] = ground
        parts = [self._coloured(part, f) for part in stage.skin]
        pieces = flesh.pieces(parts, rows, flesh.FINE if len(stage) == 1 else flesh.PLAIN)
        return fused(pieces, opacity=0.5 if stage.overlaid and f > 0 else 1.0)

    def _names(self) -> list[three.Sprite]:
        """The names of the figures, over their heads."""
        stage, names = self.stage, self.stage.names
        return [
            label
            for f, name in enumerate(names)
            if name
            for label in solids.labels(
                brief(name), self._colour(f), 0.13 * stage.unit,
                [stage.places[f] + stage.name_at(f)],
            )
        ]  # fmt: skip

    def _colour(self, f: int) -> str:
        return SHIRT if len(self.stage) == 1 else EFFECTOR_COLOURS[f % len(EFFECTOR_COLOURS)]

    def _coloured(self, part: Part, f: int) -> Part:
        return part._replace(colour=self._colour(f)) if part.colour == SHIRT else part


def brief(name: str, letters: int = 16) -> str:
    """A name as it fits over a head."""
    return name if len(name) <= letters else f"{name[: letters - 1]}…"
