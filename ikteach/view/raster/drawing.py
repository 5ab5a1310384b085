"""Layers as a picture: solids by rays, then lines and words with a pen."""

from collections.abc import Iterable, Iterator, Sequence
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import matplotlib
import numpy as np
from PIL import Image, ImageDraw, ImageFont  # comes with matplotlib

from ikteach.arrays import Array
from ikteach.formats.movie import Pixels
from ikteach.markup import brief, visible
from ikteach.view.raster.raycast import Eye, Solid, draw, homogeneous, solids
from ikteach.view.stage import shapes
from ikteach.view.stage.colours import Paper, paper, rgb
from ikteach.view.stage.forms import Form, Grid, Label, Mesh, Ring, Sole, Wires
from ikteach.view.stage.layer import Layer
from ikteach.view.stage.stage import Now, Stage

CLOSE = 0.3  # nearer than that no line is drawn [units of the eye]
SOLID = 0.8  # from this opacity on a mesh is drawn as if nothing shone through it
FLAT = (Grid, Sole)  # what lies on the ground: drawn first, under all else
LINES = (Ring, Wires)
LARGE = 1_000_000  # pixels: more are not worth two rays at a side
LETTER = 0.7  # height of a letter, as a share of its label's
HAIR = 0.99  # a line on a surface is seen: it must be so much farther to be hidden


class Drawing:
    """A camera and its pictures of a stage.

    It keeps the solids of the layers that it knows.

    size   (width, height) of the picture [pixels]
    side   one of `stage.CAMERAS`, or "plane"; None: as a live scene looks at first
    finer  how many rays a pixel's side is made of: 1 is fast, 2 has smooth edges; None: 2 where
           the picture is of the usual size
    """

    def __init__(
        self, stage: Stage, size: tuple[int, int], side: str | None = None, finer: int | None = None
    ) -> None:
        self.stage, self.size = stage, size
        self.finer = finer or (2 if size[0] * size[1] <= LARGE else 1)
        self._solids: dict[Layer, list[list[Solid]]] = {}
        self.look_from(side or stage.side)

    def look_from(self, side: str) -> None:
        """Put the camera to a named side.

        LookupError for an unknown one.
        """
        (width, height), finer, stage = self.size, self.finer, self.stage
        position = stage.eye(side, max(width / height, 1))
        size = width * finer, height * finer
        self.eye = Eye(position, stage.extent.centre, size, unit=stage.unit)

    def picture(self, layers: Sequence[Layer], now: Now, dark: bool = False) -> Image.Image:
        """Draw one moment of these layers."""
        looks, placed = paper(dark), [_Placed(layer, _rows(layer, now)) for layer in layers]
        image = Image.new("RGB", self.eye.size, looks.back)
        pen = ImageDraw.Draw(image, "RGBA")
        if not self.stage.planar:
            self._shadow(pen, now.floor, looks)
        for form, row, colour, opacity in _pieces(placed, FLAT):
            if isinstance(form, Grid):
                self._grid(pen, form, row, looks)
            else:
                self._sole(pen, form, row, _ink(colour, opacity))
        pixels = np.array(image)
        nearness = self._bodies(pixels, placed)
        image = Image.fromarray(pixels)
        pen = ImageDraw.Draw(image, "RGBA")
        for form, row, colour, opacity in _pieces(placed, LINES):
            self._wires(pen, form, row, _ink(colour, opacity), nearness)
        if self.finer > 1:
            image = image.reduce(self.finer)
        for label in (label for layer in layers for label in layer.labels):
            self._label(image, label)
        return image

    def _bodies(self, pixels: Pixels, placed: "list[_Placed]") -> Any:
        """Draw the solids, what can be looked through after all else; how near they are."""
        nearness, through = (np.zeros(pixels.shape[:2], dtype="f4") for _ in range(2))
        clear, last = [], []
        for layer, rows in placed:
            known = self._solids.get(layer)
            if known is None:
                known = self._solids[layer] = [_solids(mesh) for mesh in layer.meshes]
            there = ~np.isnan(rows[:, 0, 3])
            for mesh, parts in zip(layer.meshes, known, strict=True):
                seen = [part for part in parts if there[part.frame]]
                if mesh.through:
                    last.append((seen, rows))
                elif mesh.opacity >= SOLID:
                    draw(pixels, self.eye, seen, rows, nearness)
                elif seen:
                    clear.append((mesh, seen, rows))
        for mesh, seen, rows in clear:
            over, near = pixels.copy(), nearness.copy()
            draw(over, self.eye, seen, rows, near)
            at = near != nearness
            mixed = pixels[at] * (1 - mesh.opacity) + over[at] * mesh.opacity
            pixels[at] = mixed.astype(np.uint8)
            if mesh.hides:
                nearness = near
        for seen, rows in last:
            draw(pixels, self.eye, seen, rows, through)
        return nearness

    def _shadow(self, pen: Any, height: float, looks: Paper) -> None:
        """Draw a soft spot under each figure, or under the one place of all."""
        turn = np.linspace(0, 2 * np.pi, 49)
        circle = np.stack([0.42 * np.cos(turn), 0 * turn, 0.34 * np.sin(turn)], axis=-1)
        x, _, z = self.stage.base
        for place in self.stage.places[:1] if self.stage.overlaid else self.stage.places:
            flat, away = self.eye.project(self.stage.unit * circle + place + [x, height, z])
            if (away > 0.1).all():
                pen.polygon([tuple(point) for point in flat], fill=looks.shadow)

    def _grid(self, pen: Any, grid: Grid, row: Array, looks: Paper) -> None:
        """Draw the lines of a floor, as far as they are in front of the eye."""
        half = grid.side / 2
        across = np.linspace(-half, half, grid.squares + 1)
        for i, x in enumerate(across):
            middle = 2 * i == grid.squares
            for ends in ((x, 0, -half), (x, 0, half)), ((-half, 0, x), (half, 0, x)):
                start, end = self.eye.seen(_carried(row, np.array(ends)))
                if min(start[2], end[2]) < -CLOSE:
                    flat = self.eye.flat(np.array([_cut(start, end), _cut(end, start)]))
                    colour = looks.middle if middle else looks.line
                    pen.line([tuple(point) for point in flat], fill=colour, width=self.finer)

    def _sole(self, pen: Any, sole: Form, row: Array, ink: Any) -> None:
        """Draw the outline of a print, filled."""
        points = shapes.flat(sole)
        outline, away = self.eye.project(_carried(row, points))
        if (away > CLOSE).all():
            pen.polygon([tuple(point) for point in outline], fill=ink)

    def _wires(self, pen: Any, form: Form, row: Array, ink: Any, nearness: Any) -> None:
        """Draw lines, but where something is before them."""
        points, joined, _ = shapes.segments(form)
        flat, away = self.eye.project(_carried(row, points))
        ends, middle = flat[joined], flat[joined].mean(axis=1).astype(int)
        width, height = self.eye.size
        x, y = middle[:, 0].clip(0, width - 1), middle[:, 1].clip(0, height - 1)
        far = away[joined].mean(axis=1)
        seen = (far > CLOSE) & (1 / np.maximum(far, CLOSE) > HAIR * nearness[y, x])
        for a, b in ends[seen]:
            pen.line([tuple(a), tuple(b)], fill=ink, width=self.finer)

    def _label(self, image: Image.Image, label: Label) -> None:
        """Write words, as large as they are there, and large enough to be read."""
        (at,), (away,) = self.eye.project(np.array([label.at]))
        if away > CLOSE:
            high = LETTER * label.height / self.stage.unit / away / self.eye.pixel / self.finer
            face, place = font(round(max(11, high))), tuple(at / self.finer)
            pen, words = ImageDraw.Draw(image), brief(label.text)
            pen.text(place, words, fill=label.colour, font=face, anchor="mm")


class _Placed(NamedTuple):
    layer: Layer
    rows: Array  # (rows + 1, 4, 4); the last one is for what nothing moves


def _rows(layer: Layer, now: Now) -> Array:
    return homogeneous(np.concatenate([layer.place(now), np.eye(3, 4)[None]]))


def _solids(mesh: Mesh) -> list[Solid]:
    return [part for row, form, colour in mesh.pieces for part in solids(form, colour, row)]


def _pieces(
    placed: Iterable[_Placed], kinds: tuple[type, ...]
) -> Iterator[tuple[Any, Array, str, float]]:
    """List the pieces of these forms that are to be seen: form, row, colour, opacity."""
    for layer, rows in placed:
        for mesh in layer.meshes:
            for row, form, colour in mesh.pieces:
                if isinstance(form, kinds) and not np.isnan(rows[row, 0, 3]):
                    yield form, rows[row], colour, mesh.opacity


def _carried(row: Array, points: Array) -> Array:
    return points @ row[:3, :3].T + row[:3, 3]


def _cut(start: Array, end: Array) -> Array:
    """Move `start` along the line to `end` until it is in front of the eye, both as it sees."""
    if -start[2] >= CLOSE:
        return start
    return start + (end - start) * (CLOSE + start[2]) / (start[2] - end[2])


def _ink(colour: str, opacity: float) -> tuple[int, ...]:
    return (*rgb(colour).astype(int), round(255 * opacity))


@cache
def font(high: int) -> Any:
    """Open the font of the plots.

    Every matplotlib brings it along.
    """
    face = Path(matplotlib.get_data_path()) / "fonts" / "ttf" / "DejaVuSans.ttf"
    return ImageFont.truetype(str(face), high)


def caption(image: Image.Image, words: str, ink: str) -> None:
    """Write words into the lower left corner."""
    high = max(10, round(image.height / 26))
    place = 0.8 * high, image.height - 1.9 * high
    ImageDraw.Draw(image).text(place, visible(words), fill=ink, font=font(high))


def legend(image: Image.Image, title: str, rows: Sequence[tuple[str, str, str]], ink: str) -> None:
    """Write names and marks into the upper right corner.

    The marks have the colours of the names, and a shape of `forms.kinds`.
    """
    pen, small, high = ImageDraw.Draw(image), font(11), 15
    names = [brief(name, 24) for name, _, _ in rows]
    wide = max(pen.textlength(name, font=small) for name in [title, *names])
    left = image.width - wide - 40
    pen.text((left + (wide + 24) / 2, 12), title, fill=ink, font=small, anchor="mm")
    for i, (name, (_, colour, kind)) in enumerate(zip(names, rows, strict=True)):
        y = 12 + high * (i + 1)
        if kind == "arrow":
            pen.line((left, y, left + 8, y), fill=colour, width=3)
            pen.polygon([(left + 7, y - 5), (left + 16, y), (left + 7, y + 5)], fill=colour)
        else:
            draw = pen.rectangle if kind == "box" else pen.ellipse
            draw((left + 2, y - 5, left + 12, y + 5), fill=colour)
        pen.text((left + 24, y), name, fill=ink, font=small, anchor="lm")
