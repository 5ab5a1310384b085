"""The renderer without WebGL: the same figures, targets and layers as a PNG."""

import io
from collections.abc import Sequence
from typing import Unpack

from ikteach.arrays import Array
from ikteach.body import Effectors, Tree
from ikteach.names import unknown
from ikteach.view.raster.drawing import legend
from ikteach.view.raster.split import Split
from ikteach.view.stage.basics import BASICS
from ikteach.view.stage.colours import effector_colour, paper
from ikteach.view.stage.forms import kinds
from ikteach.view.stage.layer import Layer
from ikteach.view.stage.layers import LAYERS
from ikteach.view.stage.stage import About, Now, Stage
from ikteach.view.widgets import doors
from ikteach.view.widgets.closing import Living
from ikteach.view.widgets.picture import Picture


class StillScene(Living):
    """Figures with targets, drawn in the kernel; a `stage.View`.

    One or several figures have k targets each; the arguments are those of `scene.Scene`. `widget`
    is a picture with words for people who cannot see it; `png` and `alt` are the two themselves.
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
        slot: str | None = "still",
    ) -> None:
        self.slot = slot
        size = doors.scene(tree, effectors, names, apart, width, height)
        self.tree, self.effectors = tree, effectors
        self.stage = stage = Stage(tree, effectors, names, apart)
        self._split = Split(stage, size)
        self._basics = [layer(stage) for layer in BASICS]
        self._over = {name: layer(stage) for name, layer in LAYERS.items()}
        self._on: set[str] = set()
        self._dark, self._side = dark, stage.side
        self._widget: Picture | None = None
        self._png = b""  # of what was shown last, once somebody has asked for it
        self._now: Now | None = None

    @property
    def dark(self) -> bool:
        """Tell whether the background is dark; may be set."""
        return self._dark

    @dark.setter
    def dark(self, on: bool) -> None:
        self._dark = on
        self._changed()

    @property
    def layers(self) -> dict[str, bool]:
        """Tell which layers are drawn."""
        return {name: name in self._on for name in LAYERS}

    @property
    def widget(self) -> Picture:
        """The picture as a widget.

        It is made when it is first asked for, and drawn at each change from then.
        """
        if self._widget is None:
            self._widget = Picture(png=self.png, alt=self.alt)
        return self._widget

    @property
    def png(self) -> bytes:
        """The last moment as a PNG; empty if there is none."""
        if not self._png and self._now is not None:
            over = [layer for name, layer in self._over.items() if name in self._on]
            self._png = png(self._split, [*self._basics, *over], self._now, self._dark)
        return self._png

    @property
    def alt(self) -> str:
        """The last moment in words."""
        return "" if self._now is None else self._words(self._now)

    def switch(self, layer: str, on: bool = True) -> None:
        """Draw a layer, or do not; LookupError for an unknown name."""
        if layer not in LAYERS:
            raise LookupError(unknown("layer", layer, LAYERS))
        self._on = self._on | {layer} if on else self._on - {layer}
        self._changed()

    def look_from(self, side: str) -> None:
        """Put the camera to one of `CAMERAS`, or to "plane".

        "plane" looks along the normal of the figure's plane.
        """
        self._split.look_from(side)
        self._side = side
        self._changed()

    @property
    def views(self) -> int:
        """Tell how many views there are; may be set.

        See `Scene.views`.
        """
        return self._split.count

    @views.setter
    def views(self, count: int) -> None:
        self._split.count = count
        self._changed()

    def show(self, theta: Array, targets: Array, **about: Unpack[About]) -> None:
        """Draw poses and targets; see `stage.View.show`.

        `about` has the facts that layers need.
        """
        self._now = self.stage.now(theta, targets, **about)
        for layer in self._over.values():
            layer.note(self._now)
        self._changed()

    def clear(self) -> None:
        """Forget trails and footprints."""
        for layer in self._over.values():
            layer.clear()

    def close(self) -> None:
        """Free the picture."""
        super().close()
        if self._widget is not None:
            self._widget.close()

    def _repr_mimebundle_(self, **kwargs: object) -> dict[str, object]:
        return {"image/png": self.png, "text/plain": self.alt}

    def _changed(self) -> None:
        self._png = b""
        if self._widget is not None:
            self._widget.png, self._widget.alt = self.png, self.alt

    def _words(self, now: Now) -> str:
        rows = []
        for name, row in zip(self.stage.names, self.stage.far(now), strict=True):
            pairs = zip(self.effectors.names, row, strict=True)
            distances = ", ".join(f"{effector} {far}" for effector, far in pairs)
            rows.append(f"{name + ': ' if name else ''}{distances}")
        figure = "human" if self.stage.human else "figure"
        layers = "".join(f", {layer}" for layer, on in self.layers.items() if on)
        beside = "".join(f", from {name}" for name in self._split.names[1:])
        return f"A {figure} from {self._side}{beside}{layers}. From the target: {'; '.join(rows)}."


def png(drawing: Split, layers: Sequence[Layer], now: Now, dark: bool) -> bytes:
    """Draw one moment of these layers as a PNG.

    It has a legend of the targets.
    """
    image, out = drawing.picture(layers, now, dark), io.BytesIO()
    ends = drawing.stage.effectors
    each = enumerate(zip(ends.names, kinds(ends.names, ends.w), strict=True))
    rows = [(name, effector_colour(i), kind) for i, (name, kind) in each]
    legend(image, "targets", rows, paper(dark).ink)
    image.save(out, "PNG")
    return out.getvalue()
