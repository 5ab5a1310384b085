"""The renderer without WebGL: the same figures, targets and layers as a PNG, in parallel view."""

from collections.abc import Sequence

import numpy as np

from ikteach.arrays import Array, ArrayLike
from ikteach.body import Effectors, Tree
from ikteach.names import unknown
from ikteach.view import skin
from ikteach.view.picture import Picture
from ikteach.view.sheet import BEFORE, BEHIND, DPI, Sheet
from ikteach.view.skin import EFFECTOR_COLOURS
from ikteach.view.stage import LAYERS, SHOWN_AT, SQUARE, Now, Stage, side_of
from ikteach.view.trails import MARKS, PRINTS, Prints, Trail, feet


class StillScene:
    """One or several figures with k targets each, drawn by matplotlib; a `stage.View`.

    It takes what `scene.Scene` takes. `widget` is a picture with words for those who cannot see
    it; `png` and `alt` are the two themselves.
    """

    def __init__(
        self, tree: Tree, effectors: Effectors, *, names: Sequence[str] = ("",),
        apart: float | None = None, width: int = 540, height: int = 480, dark: bool = False,
    ) -> None:  # fmt: skip
        self.tree, self.effectors = tree, effectors
        self.stage = Stage(tree, effectors, names, apart)
        self.dark = dark
        self.widget = Picture()
        self._size = (width / DPI, height / DPI)
        self._skin = skin.skin_of(tree, effectors, 0.03 * self.stage.unit)
        self._on: set[str] = set()
        self._side = self.stage.side
        count = (len(self.stage), len(effectors))
        self._trail = Trail(count, MARKS, 0.05 * self.stage.unit)
        self._prints = Prints((len(self.stage), len(feet(effectors))), PRINTS)
        self._now: Now | None = None

    @property
    def layers(self) -> dict[str, bool]:
        """Which layers are drawn."""
        return {name: name in self._on for name in LAYERS}

    @property
    def png(self) -> bytes:
        """What was shown last; empty before."""
        return bytes(self.widget.png)

    @property
    def alt(self) -> str:
        """What it shows, in words."""
        return str(self.widget.alt)

    def switch(self, layer: str, on: bool = True) -> None:
        """Draw a layer, or do not; LookupError for an unknown name."""
        if layer not in LAYERS:
            raise LookupError(unknown("layer", layer, LAYERS))
        self._on = self._on | {layer} if on else self._on - {layer}
        self._draw()

    def look_from(self, side: str) -> None:
        """Put the camera to one of `CAMERAS`, or to "plane": along −z."""
        side_of(side)
        self._side = side
        self._draw()

    def show(
        self, theta: Array, targets: Array, *, floor: float | None = None, advance: float = 0.0,
        change: int = 0, effector: int = 0, columns: ArrayLike | None = None,
        ellipsoid: tuple[ArrayLike, ArrayLike] | None = None,
        reach: Sequence[tuple[ArrayLike, float, float]] = (),
    ) -> None:  # fmt: skip
        """Draw poses and targets, and what the layers need; see `stage.View.show`."""
        self._now = self.stage.now(
            theta, targets, floor, advance, effector, columns, ellipsoid, reach
        )
        self._draw()

    def clear(self) -> None:
        """Forget trails and footprints."""
        self._trail.clear()
        self._prints.clear()

    def close(self) -> None:
        """Free the picture."""
        self.widget.close()

    def _repr_mimebundle_(self, **kwargs: object) -> dict[str, object]:
        return {"image/png": self.png, "text/plain": self.alt}

    def _draw(self) -> None:
        if self._now is None:
            return
        sheet = Sheet(self._side, self._size, self.stage, self.dark)
        self._draw_floor(sheet, self._now)
        for f in reversed(range(len(self.stage))):
            self._draw_figure(sheet, self._now, f)
        self._draw_layers(sheet, self._now)
        self.widget.png = sheet.png()
        self.widget.alt = self._words(self._now)

    def _draw_floor(self, sheet: "Sheet", now: Now) -> None:
        side = SQUARE * self.stage.unit
        marks = side * np.arange(-6, 7)
        glide = -(now.advance % side)
        for i in marks:
            for a, b in (
                ([i, 0, -6 * side], [i, 0, 6 * side]),
                ([-6 * side, 0, i], [6 * side, 0, i]),
            ):
                ends = np.array([a, b]) + [0, now.floor, glide]
                if self.stage.planar:
                    ends = np.array([a, b])[:, [0, 2, 1]] - [0, 0, 0.2 * self.stage.unit]
                sheet.line(ends, sheet.faint, 0.8, BEHIND)

    def _draw_figure(self, sheet: "Sheet", now: Now, f: int) -> None:
        stage, unit = self.stage, self.stage.unit
        place = stage.places[f]
        opacity = 0.45 if stage.overlaid and f > 0 else 1.0
        for part in self._skin:
            j = None if part.joint is None else stage.tree.index(part.joint)
            R = np.eye(3) if j is None else now.orientations[f, j]
            p = place if j is None else now.positions[f, j] + place
            sheet.part(part._replace(colour=self._colour(part, f)), R, p, opacity)
        for i, name in enumerate(stage.effectors.names):
            if stage.overlaid and f > 0:
                continue
            target, s = now.targets[f, i] + place, now.effectors[f, i] + place
            colour = EFFECTOR_COLOURS[i % len(EFFECTOR_COLOURS)]
            sheet.line(np.array([s, target]), "0.5", 1.5, BEFORE)
            sheet.mark(target, name, colour, 0.045 * unit, name if f == 0 else None)
        if stage.names[f]:
            colour = EFFECTOR_COLOURS[f % len(EFFECTOR_COLOURS)]
            sheet.words(place + stage.name_at(f), stage.names[f], colour)

    def _colour(self, part: skin.Part, f: int) -> str:
        several = len(self.stage) > 1 and part.colour == skin.SHIRT
        return EFFECTOR_COLOURS[f % len(EFFECTOR_COLOURS)] if several else part.colour

    def _draw_layers(self, sheet: "Sheet", now: Now) -> None:
        stage, unit, on = self.stage, self.stage.unit, self._on
        places = stage.places[:, None]
        at = (now.effectors + places)[:, now.effector]
        trail = self._trail.pass_through(now.effectors, now.advance) + places[:, None]
        prints = self._prints.pass_through(now.effectors[:, feet(stage.effectors)], now.advance)
        prints[..., 1] += now.floor - prints[..., 1]
        if "world axes" in on:
            for place in stage.places[:1] if stage.overlaid else stage.places:
                for way, letter, colour in zip(
                    np.eye(3), "xyz", (skin.RED, skin.GREEN, skin.BLUE), strict=True
                ):
                    sheet.line(place + np.outer([0, 0.7 * unit], way), colour, 2.5, BEFORE)
                    sheet.words(place + 0.78 * unit * way, letter, colour)
        if "joint axes" in on:
            axes = np.matvec(now.orientations, stage.tree.axes)
            for f, j in np.ndindex(axes.shape[:2]):
                ends = now.positions[f, j] + places[f] + 0.16 * unit * np.outer([-1, 1], axes[f, j])
                sheet.line(ends, EFFECTOR_COLOURS[j % len(EFFECTOR_COLOURS)], 2, BEFORE)
        for layer, marks in (("trails", trail), ("footprints", prints + places[:, None])):
            for f, i in np.ndindex(marks.shape[:2]) if layer in on else ():
                which = i if layer == "trails" else feet(stage.effectors)[i]
                sheet.dots(marks[f, i], EFFECTOR_COLOURS[which % len(EFFECTOR_COLOURS)],
                           3 if layer == "trails" else 9)  # fmt: skip
        if "columns of J" in on and now.columns is not None:
            for f, j in np.ndindex(now.columns.shape[0], now.columns.shape[2]):
                colour = EFFECTOR_COLOURS[j % len(EFFECTOR_COLOURS)]
                sheet.arrow(at[f], at[f] + SHOWN_AT * now.columns[f, :, j], colour)
        if "ellipsoid" in on and now.axes is not None and now.lengths is not None:
            for f, centre in enumerate(at):
                half = now.axes[f] * (SHOWN_AT * now.lengths[f])
                sheet.ellipsoid(centre, half, skin.SKY, 0.4, BEFORE)
                for way in half.T:
                    sheet.line(centre + np.outer([-1, 1], way), skin.PURPLE, 1.5, BEFORE)
        if "reach" in on:
            for place in stage.places:
                for centre, inner, outer in now.reach:
                    sheet.circle(centre + place, outer, skin.PURPLE, "-")
                    sheet.circle(centre + place, inner, skin.ORANGE, "--")

    def _words(self, now: Now) -> str:
        far = 100 * np.linalg.norm(now.targets - now.effectors, axis=-1)
        rows = []
        for name, row in zip(self.stage.names, far, strict=True):
            pairs = zip(self.effectors.names, row, strict=True)
            distances = ", ".join(f"{effector} {d:.1f} cm" for effector, d in pairs)
            rows.append(f"{name + ': ' if name else ''}{distances}")
        figure = "human" if self.stage.human else "figure"
        layers = "".join(f", {layer}" for layer, on in self.layers.items() if on)
        return f"A {figure} from {self._side}{layers}. From the target: {'; '.join(rows)}."
