"""The live scene: solid figures, targets, the floor and layers, in pythreejs. It solves nothing.

Every frame goes to the page as one message of the driver: a matrix for each thing that moves.
"""

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Unpack

import ipywidgets as widgets
import numpy as np
import pythreejs as three

from ikteach.arrays import Array, finite
from ikteach.body import Effectors, Tree
from ikteach.names import unknown
from ikteach.view.raster.split import Split
from ikteach.view.raster.still import png
from ikteach.view.stage.basics import BASICS, TargetMarks
from ikteach.view.stage.colours import effector_colour, paper
from ikteach.view.stage.layers import LAYERS
from ikteach.view.stage.stage import About, Now, Stage
from ikteach.view.stage.views import needed, views_of
from ikteach.view.webgl import objects
from ikteach.view.webgl.driver import Driver
from ikteach.view.webgl.layers import LayerObjects
from ikteach.view.webgl.views import Views
from ikteach.view.widgets import doors
from ikteach.view.widgets.closing import Living
from ikteach.view.widgets.lacking import Note
from ikteach.view.widgets.picture import Still

HIDDEN: Array = np.c_[1e-6 * np.eye(3), [0, -1e4, 0]]  # tiny, and far outside the picture


class Scene(Living):
    """One or several figures with k targets each; a `stage.View`.

    Display its `widget`.

    names    one figure for each, with its name over its head (a lone figure needs none)
    apart    how far they stand from each other [m]; 0 lays them over each other, in which case
             they share the targets, and all but the first can be seen through
    dark     light on dark, or dark on light; as the page is, if nobody has set it
    slot     only one of a slot lives at a time: to run a cell again closes the older one. Name it
             for a second scene in a notebook

    now      the moment that was shown last, None before the first
    targets  the objects of the targets, figure by figure

    Left targets are balls, right ones boxes, so that colour is not the only sign; a grey rod joins
    each effector to its target. A direction is a rod from its joint, its target an arrow. A figure
    in a plane stands before a wall of squares instead of on a floor. Several figures wear the
    colours of `colours.EFFECTOR_COLOURS`, in their order.
    """

    def __init__(
        self,
        tree: Tree,
        effectors: Effectors,
        *,
        names: Sequence[str] = ("",),
        apart: float | None = None,
        width: int = 540,
        height: int = 480,
        dark: bool = False,
        slot: str | None = "scene",
    ) -> None:
        self.slot = slot
        size = doors.scene(tree, effectors, names, apart, width, height)
        self.tree, self.effectors = tree, effectors
        self.stage = stage = Stage(tree, effectors, names, apart)
        self._basics = [LayerObjects(layer(stage), dark) for layer in BASICS]
        self._over: dict[str, LayerObjects] = {}
        self._groups: dict[str, three.Group] = {}
        self._on: set[str] = set()
        self._dark, self._chosen = dark, dark
        (marks,) = (one for one in self._basics if isinstance(one.layer, TargetMarks))
        self.targets = marks.by_row
        self._furnish(size)
        self._split = Split(stage, size)
        self.look_from(stage.side)
        colours = [[name, effector_colour(i)] for i, name in enumerate(effectors.names)]
        self.driver = Driver(
            self.renderer,
            description=stage.words,
            effectors=colours,
            panes=self._views.panes,
            needed=needed(stage, size[0] / size[1]),
            splits=len(views_of(stage)) > 1,
        )
        self.driver.on_page, self.driver.on_act = self._greet, self._perform
        self.driver.observe(lambda _: self._send(), "measuring")
        self.driver.observe(self._follow_page, "dark")
        self._acts: dict[str, Callable[[], object]] = {}
        self.driver.as_png = lambda: self.still().png
        self._plan()
        self.note = Note()
        self.now: Now | None = None
        self._change = 0
        self.widget = widgets.VBox([self.renderer, self.driver, self.note.widget])
        self.widget.add_class("ikteach-scene")

    def _furnish(self, size: tuple[int, int]) -> None:
        """Make scene, cameras and renderer."""
        things = [thing for shown in self._basics for thing in shown.things]
        self.scene = three.Scene(
            children=[*things, *objects.lights()], background=paper(self._dark).back
        )
        self._views = Views(self.stage, self.scene, size)
        self.renderer, self.cameras = self._views.renderer, self._views.free
        self.camera = self.cameras.perspective

    @property
    def layers(self) -> dict[str, bool]:
        """Tell which layers are drawn."""
        return {name: name in self._on for name in LAYERS}

    def switch(self, layer: str, on: bool = True) -> None:
        """Draw a layer from the next `show` on, or do not.

        LookupError for an unknown name.
        """
        if layer not in LAYERS:
            raise LookupError(unknown("layer", layer, LAYERS))
        if on and layer not in self._over:
            shown = self._over[layer] = LayerObjects(LAYERS[layer](self.stage), self._dark)
            self._groups[layer] = three.Group(children=shown.things)
            self.scene.children = [*self.scene.children, self._groups[layer]]
        if on != (layer in self._on):
            self._on ^= {layer}
            self._groups[layer].visible = on
            self._plan()
            self._send()

    def look_from(self, side: str) -> None:
        """Put the camera to one of `CAMERAS`, or to "plane".

        "plane" looks along the normal of the figure's plane. Of several views it is the first.
        """
        self._views.look_from(side)
        self._split.look_from(side)

    @property
    def views(self) -> int:
        """Tell how many views there are; may be set.

        1 is the free one, 2 have the side beside it, 4 front, side and top. A planar figure has
        one. ValueError for another number.
        """
        return self._views.count

    @views.setter
    def views(self, count: int) -> None:
        self._views.count = self._split.count = count
        self.driver.panes = self._views.panes

    @property
    def dark(self) -> bool:
        """Tell whether the background is dark; may be set."""
        return self._dark

    @dark.setter
    def dark(self, on: bool) -> None:
        self._chosen = True
        self._paint(on)

    def _follow_page(self, change: Any) -> None:
        """Be as dark as the page, unless somebody has chosen."""
        if not self._chosen:
            self._paint(change["new"])

    def _paint(self, on: bool) -> None:
        if on != self._dark:
            self._dark = on
            self.scene.background = paper(on).back
            for shown in (*self._basics, *self._over.values()):
                shown.paint(on)

    def show(self, theta: Array, targets: Array, **about: Unpack[About]) -> None:
        """Draw poses and targets; see `stage.View.show`.

        `about` has the facts that layers need.
        """
        self.now = self.stage.now(theta, targets, **about)
        self._change = about.get("change", 0)
        self._send()

    def clear(self) -> None:
        """Forget trails and footprints."""
        for shown in self._over.values():
            shown.layer.clear()

    def offer(self, acts: Mapping[str, tuple[str, Callable[[], object]]]) -> None:
        """Have keys at the picture do this: {key: (what it does, action)}.

        "0" puts the camera of the chosen view back to its side, and "v" shows one view, two or
        four.
        """
        self._acts = {key: act for key, (_, act) in acts.items()}
        self.driver.acts = {key: words for key, (words, _) in acts.items()}

    def mount(self, *more: widgets.Widget) -> None:
        """Have the page show these widgets under the picture."""
        self.widget.children = [*self.widget.children, *more]

    def still(self) -> Still:
        """Draw the last moment as a picture.

        It needs no kernel to be seen.
        """
        if self.now is None:
            return Still(b"", self.driver.description)
        layers = [shown.layer for shown in self._drawn()]
        return Still(png(self._split, layers, self.now, self._dark), self.driver.description)

    def _repr_mimebundle_(self, **kwargs: Any) -> Any:
        """Show the live widget, and beside it a still for places without a kernel."""
        return self.note.beside(self.widget._repr_mimebundle_(**kwargs), self.still())

    def _perform(self, key: str) -> None:
        """Do what a key at the picture does; a key that does nothing may come late."""
        usual = {"0": lambda: self._views.put_back(self.driver.view), "v": self._split_more}
        (self._acts | usual).get(key, lambda: None)()

    def _split_more(self) -> None:
        self.views = self._views.more

    def _greet(self, new: bool) -> None:
        """Show a page that begins to look what was shown last."""
        if new:
            self._send()

    def _send(self) -> None:
        """Send the page where everything is, if anything was shown."""
        if self.now is None:
            return
        frame = []
        for shown in self._drawn():
            shown.layer.note(self.now)
            frame.append(shown.layer.place(self.now))
        rows = np.concatenate(frame)
        if not finite(rows):
            rows[np.isnan(rows[:, 0, 3])] = HIDDEN
        self.driver.show(rows, self._change, self._far() if self.driver.measuring else None)

    def _far(self) -> list[str]:
        """Say how far each effector of the first figure is from its target."""
        assert self.now is not None
        return self.stage.far(self.now)[0]

    def _drawn(self) -> list[LayerObjects]:
        """List the layers that are drawn, in the order of their rows."""
        return [*self._basics, *(one for name, one in self._over.items() if name in self._on)]

    def _plan(self) -> None:
        """Have the driver move what is always there, and the layers that are on."""
        moves, rows = [], 0
        for shown in self._drawn():
            moves += shown.moves_from(rows)
            rows += shown.layer.rows
        self.driver.move(moves, rows)
