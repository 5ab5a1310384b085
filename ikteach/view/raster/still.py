"""The renderer without WebGL: the same figures, targets and layers as a PNG, in parallel view."""

from collections.abc import Iterable, Sequence

import numpy as np

from ikteach.arrays import Array, ArrayLike
from ikteach.body import Effectors, Frames, Tree
from ikteach.names import unknown
from ikteach.view.raster.sheet import BEFORE, BEHIND, DPI, Sheet
from ikteach.view.stage import skin
from ikteach.view.stage.lengths import Lengths
from ikteach.view.stage.skin import EFFECTOR_COLOURS
from ikteach.view.stage.stage import LAYERS, SHOWN_AT, SQUARE, Now, Stage
from ikteach.view.stage.trails import MARKS, PRINTS, Prints, Trail, feet
from ikteach.view.widgets import doors
from ikteach.view.widgets.closing import Living
from ikteach.view.widgets.picture import Picture


class StillScene(Living):
    """One or several figures with k targets each, drawn by matplotlib; a `stage.View`.

    It takes what `scene.Scene` takes. `widget` is a picture with words for those who cannot see
    it; `png` and `alt` are the two themselves.
    """

    def __init__(
        self, tree: Tree, effectors: Effectors, *, names: Sequence[str] = ("",),
        apart: float | None = None, width: int = 540, height: int = 480, dark: bool = False,
        slot: str | None = "still",
    ) -> None:  # fmt: skip
        self.slot = slot
        width, height = doors.scene(tree, effectors, names, apart, width, height)
        self.tree, self.effectors = tree, effectors
        self.stage = Stage(tree, effectors, names, apart)
        self._dark = dark
        self._widget: Picture | None = None
        self._png = b""  # of what was shown last, once somebody has asked for it
        self._size = (width / DPI, height / DPI)
        self._on: set[str] = set()
        self._side = self.stage.side
        f, unit = len(self.stage), self.stage.unit
        self._trail = Trail((f, len(effectors)), MARKS, 0.05 * unit)
        self._prints = Prints((f, len(feet(effectors))), PRINTS, 1e-4 * unit)
        self._now: Now | None = None

    @property
    def dark(self) -> bool:
        """Whether the background is dark; may be set."""
        return self._dark

    @dark.setter
    def dark(self, on: bool) -> None:
        self._dark = on
        self._changed()

    @property
    def layers(self) -> dict[str, bool]:
        """Which layers are drawn."""
        return {name: name in self._on for name in LAYERS}

    @property
    def widget(self) -> Picture:
        """The picture, made when it is first asked for, and drawn anew at each change from then."""
        if self._widget is None:
            self._widget = Picture(png=self.png, alt=self.alt)
        return self._widget

    @property
    def png(self) -> bytes:
        """What was shown last; empty if nothing was."""
        if not self._png and self._now is not None:
            self._png = self._draw(self._now)
        return self._png

    @property
    def alt(self) -> str:
        """What was shown last, in words."""
        return "" if self._now is None else self._words(self._now)

    def switch(self, layer: str, on: bool = True) -> None:
        """Draw a layer, or do not; LookupError for an unknown name."""
        if layer not in LAYERS:
            raise LookupError(unknown("layer", layer, LAYERS))
        self._on = self._on | {layer} if on else self._on - {layer}
        self._changed()

    def look_from(self, side: str) -> None:
        """Put the camera to one of `CAMERAS`, or to "plane": along the normal of its plane."""
        self.stage.eye(side, 1.0)
        self._side = side
        self._changed()

    def show(
        self, theta: Array, targets: Array, *, floor: float | None = None, advance: float = 0.0,
        change: int = 0, effector: int = 0, columns: ArrayLike | None = None,
        ellipsoid: tuple[ArrayLike, ArrayLike] | None = None,
        reach: Sequence[tuple[ArrayLike, float, float]] = (), frames: Frames | None = None,
    ) -> None:  # fmt: skip
        """Draw poses and targets, and what the layers need; see `stage.View.show`."""
        self._now = self.stage.now(
            theta, targets, floor, advance, effector, columns, ellipsoid, reach, frames
        )
        self._trail.pass_through(self._now.effectors, advance)
        self._prints.pass_through(self._now.effectors[:, feet(self.effectors)], advance)
        self._changed()

    def clear(self) -> None:
        """Forget trails and footprints."""
        self._trail.clear()
        self._prints.clear()

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

    def _draw(self, now: Now) -> bytes:
        sheet = Sheet(self._side, self._size, self.stage, self.dark)
        self._draw_floor(sheet, now)
        for f in reversed(range(len(self.stage))):
            self._draw_figure(sheet, now, f)
        self._draw_layers(sheet, now)
        return sheet.png()

    def _draw_floor(self, sheet: Sheet, now: Now) -> None:
        side = SQUARE * self.stage.unit
        ground = self.stage.ground(now.floor, now.advance)
        for i in side * np.arange(-6, 7):
            for ends in (
                [[i, 0, -6 * side], [i, 0, 6 * side]],
                [[-6 * side, 0, i], [6 * side, 0, i]],
            ):
                there = ends @ ground[:, :3].T + ground[:, 3]
                sheet.line(there, sheet.faint, 0.8, BEHIND)

    def _draw_figure(self, sheet: Sheet, now: Now, f: int) -> None:
        stage, unit = self.stage, self.stage.unit
        place = stage.places[f]
        opacity = 0.45 if stage.overlaid and f > 0 else 1.0
        for part in stage.skin:
            j = None if part.joint is None else stage.tree.index(part.joint)
            R = np.eye(3) if j is None else now.orientations[f, j]
            p = place if j is None else now.positions[f, j] + place
            sheet.part(part._replace(colour=self._paint(part, f)), R, p, opacity)
        for i, name in enumerate(stage.effectors.names):
            if stage.overlaid and f > 0:
                continue
            target, s = now.targets[f, i] + place, now.effectors[f, i] + place
            colour = _colour(i)
            sheet.line(np.array([s, target]), "0.5", 1.5, BEFORE)
            sheet.mark(target, name, colour, 0.045 * unit, name if f == 0 else None)
        if stage.names[f]:
            colour = _colour(f)
            sheet.words(place + stage.name_at(f), stage.names[f], colour)

    def _paint(self, part: skin.Part, f: int) -> str:
        several = len(self.stage) > 1 and part.colour == skin.SHIRT
        return _colour(f) if several else part.colour

    def _draw_layers(self, sheet: Sheet, now: Now) -> None:
        stage, trail = self.stage, self._trail.marks - [0.0, 0.0, now.advance]
        prints = self._prints.marks - [0.0, 0.0, now.advance]
        prints[..., 1] += now.floor - prints[..., 1]  # on the floor; where there is none, NaN
        at = now.effectors[:, now.effector] + stage.places
        on, which = self._on, feet(stage.effectors)
        for f, place in enumerate(stage.places):
            if "world axes" in on:
                self._world_axes(sheet, place)
            if "joint axes" in on:
                self._joint_axes(sheet, now, f)
            if "footprints" in on:
                self._dots(sheet, prints[f], which, f, 14)
            if "trails" in on:
                self._dots(sheet, trail[f], range(len(stage.effectors)), f, 3)
            if "columns of J" in on:
                self._columns(sheet, now, f, at[f])
            if "ellipsoid" in on:
                self._ellipsoid(sheet, now, f, at[f])
            if "reach" in on:
                self._reach(sheet, now, place)

    def _world_axes(self, sheet: Sheet, place: Array) -> None:
        unit = self.stage.unit
        colours = (skin.RED, skin.GREEN, skin.BLUE)
        for way, letter, colour in zip(np.eye(3), "xyz", colours, strict=True):
            at = place + self.stage.base
            sheet.line(at + np.outer([0, 0.7 * unit], way), colour, 2.5, BEFORE)
            sheet.words(at + 0.78 * unit * way, letter, colour)

    def _joint_axes(self, sheet: Sheet, now: Now, f: int) -> None:
        axes = np.matvec(now.orientations[f], self.stage.tree.axes)
        for j, (p, axis) in enumerate(zip(now.positions[f], axes, strict=True)):
            ends = p + self.stage.places[f] + 0.16 * self.stage.unit * np.outer([-1, 1], axis)
            sheet.line(ends, _colour(j), 2, BEFORE)

    def _dots(self, sheet: Sheet, marks: Array, which: Iterable[int], f: int, size: float) -> None:
        for i, points in zip(which, marks, strict=True):
            sheet.dots(points + self.stage.places[f], _colour(i), size)

    def _columns(self, sheet: Sheet, now: Now, f: int, at: Array) -> None:
        if now.columns is not None:
            for j, way in enumerate(self.stage.arrows(now.columns[f])):
                sheet.arrow(at, at + way, _colour(j))

    def _ellipsoid(self, sheet: Sheet, now: Now, f: int, at: Array) -> None:
        if now.axes is None or now.lengths is None:
            return
        half = now.axes[f] * (SHOWN_AT * now.lengths[f])
        sheet.ellipsoid(at, half, skin.SKY, 0.4, BEFORE)
        for way in half.T:
            sheet.line(at + np.outer([-1, 1], way), skin.PURPLE, 1.5, BEFORE)

    def _reach(self, sheet: Sheet, now: Now, place: Array) -> None:
        for centre, inner, outer in now.reach:
            sheet.circle(centre + place, outer, skin.PURPLE, "-")
            sheet.circle(centre + place, inner, skin.ORANGE, "--")

    def _words(self, now: Now) -> str:
        far = np.linalg.norm(now.targets - now.effectors, axis=-1)
        length = Lengths.of(self.tree, self.effectors)
        rows = []
        for name, row in zip(self.stage.names, far, strict=True):
            pairs = zip(self.effectors.names, row, strict=True)
            distances = ", ".join(f"{effector} {length(d)}" for effector, d in pairs)
            rows.append(f"{name + ': ' if name else ''}{distances}")
        figure = "human" if self.stage.human else "figure"
        layers = "".join(f", {layer}" for layer, on in self.layers.items() if on)
        return f"A {figure} from {self._side}{layers}. From the target: {'; '.join(rows)}."


def _colour(i: int) -> str:
    return EFFECTOR_COLOURS[i % len(EFFECTOR_COLOURS)]
