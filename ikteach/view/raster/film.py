"""A recorded run as pictures, drawn in the kernel: figure, targets, floor and a caption."""

from collections.abc import Iterator
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

import matplotlib
import numpy as np
from PIL import Image, ImageDraw, ImageFont  # comes with matplotlib

from ikteach.arrays import Array
from ikteach.body import Effectors, Tree, forward, locate
from ikteach.body.rotation import sticks, transforms
from ikteach.formats.movie import Pixels
from ikteach.markup import visible
from ikteach.motion.live.log import Log
from ikteach.names import unknown
from ikteach.view.raster.raycast import Eye, Solid, box, draw, ellipsoid, rod, solids, square
from ikteach.view.stage.skin import EFFECTOR_COLOURS, GREY
from ikteach.view.stage.stage import CAMERAS, PLANE, SQUARE, Stage

TILES = 6  # squares of the floor on each side of the middle
PAPER, INK = (244, 246, 248), (45, 51, 64)
LINE, MIDLINE, SHADOW = (203, 210, 217), (154, 165, 177), (221, 226, 231)


class Shot(NamedTuple):
    """What one picture shows: pose θ (n,), targets (k, 3) [m], floor and advance [m], caption."""

    theta: Array
    targets: Array
    floor: float
    advance: float
    caption: str


class Film:
    """A camera and what it films: `picture` makes one frame of size (width, height).

    side   one of `stage.CAMERAS`, or "plane"; None: as a live scene looks at first
    finer  how many rays a pixel's side is made of: 1 is fast, 2 has smooth edges
    """

    def __init__(
        self, tree: Tree, effectors: Effectors, *, size: tuple[int, int] = (640, 480),
        side: str | None = None, finer: int = 2,
    ) -> None:  # fmt: skip
        if side not in (None, *CAMERAS, PLANE):
            raise LookupError(unknown("view", side, (*CAMERAS, PLANE)))
        self.tree, self.effectors, self.size, self._finer = tree, effectors, size, finer
        self.stage = stage = Stage(tree, effectors)
        unit, (width, height) = stage.unit, size
        self._eye = Eye(
            stage.eye(side or stage.side, max(width / height, 1)), stage.extent.centre,
            (width * finer, height * finer), unit=unit,
        )  # fmt: skip
        self._ground: tuple[bytes, Pixels] | None = None
        k, place = len(effectors), {name: j for j, name in enumerate(tree.names)}
        here = len(tree)  # frames: the joints, then the ground, the targets, the gaps
        self._solids: list[Solid] = []
        for part in stage.skin:
            frame = here if part.joint is None else place[part.joint]
            self._solids += solids(part, frame)
        for i, name in enumerate(effectors.names):
            colour, at = EFFECTOR_COLOURS[i % len(EFFECTOR_COLOURS)], here + 1 + i
            boxed = name.endswith(".r")
            ball = ellipsoid((0, 0, 0), (0.045 * unit,) * 3, colour, at)
            self._solids += box(0.036 * unit, colour, at) if boxed else [ball]
        thick = 0.007 * unit
        self._gaps = [
            rod(np.zeros(3), np.array([0.0, 1, 0]), thick, thick, GREY, here + 1 + k + i)
            for i in range(k)
        ]

    def picture(self, shot: Shot) -> Pixels:
        """The frame (height, width, 3) of one shot."""
        frames = forward(self.tree, shot.theta)
        s = locate(frames, self.effectors)
        k = len(self.effectors)
        everything = np.concatenate(
            [
                transforms(frames.orientations, frames.positions),
                np.eye(3, 4)[None],
                transforms(np.broadcast_to(np.eye(3), (k, 3, 3)), shot.targets),
                sticks(s, shot.targets),
            ]
        )
        far = np.linalg.norm(shot.targets - s, axis=-1) > 1e-3 * self.stage.unit  # to be seen
        everything[-k:][~far] = np.eye(3, 4)
        parts = self._solids + [gap for gap, wide in zip(self._gaps, far, strict=True) if wide]
        pixels = self._floor(shot.floor, shot.advance).copy()
        draw(pixels, self._eye, parts, square(everything))
        image = Image.fromarray(pixels)
        if self._finer > 1:
            image = image.reduce(self._finer)
        self._write(image, shot.caption)
        return np.asarray(image)

    def _floor(self, height: float, advance: float) -> Pixels:
        """Paper, the squares of the floor gliding back, and a soft spot under the figure.

        Of a figure in a plane, the squares of the wall behind it.
        """
        stage = self.stage
        ground = stage.ground(height, advance)
        key = ground.tobytes()
        if self._ground is None or self._ground[0] != key:
            image = Image.new("RGB", self._eye.size, PAPER)
            pen = ImageDraw.Draw(image)
            if not stage.planar:
                self._spot(pen, height)
            tile = SQUARE * stage.unit
            along = tile * np.linspace(-TILES, TILES, 25)
            for i in range(-TILES, TILES + 1):
                across = np.full(25, i * tile)
                for x, z in (across, along), (along, across):
                    points = np.stack([x, 0 * x, z], axis=-1) @ ground[:, :3].T + ground[:, 3]
                    self._line(pen, points, LINE if i else MIDLINE)
            self._ground = key, np.asarray(image)
        return self._ground[1]

    def _spot(self, pen: Any, height: float) -> None:
        turn = np.linspace(0, 2 * np.pi, 49)
        circle = np.stack([0.42 * np.cos(turn), 0 * turn, 0.34 * np.sin(turn)], axis=-1)
        x, _, z = self.stage.base
        flat, away = self._eye.project(self.stage.unit * circle + [x, height, z])
        if (away > 0.1).all():
            pen.polygon([tuple(point) for point in flat], fill=SHADOW)

    def _line(self, pen: Any, points: Array, colour: Any) -> None:
        """A line of the floor in pieces, as far as it is seen."""
        flat, away = self._eye.project(points)
        for (start, end), near in zip(pairwise(flat), away[:-1], strict=True):
            if near > 0.3:
                pen.line([tuple(start), tuple(end)], fill=colour, width=self._finer)

    def _write(self, image: Image.Image, caption: str) -> None:
        high = max(10, round(self.size[1] / 26))
        pen = ImageDraw.Draw(image)
        left = high * 0.8
        pen.text((left, self.size[1] - 1.9 * high), visible(caption), fill=INK, font=_font(high))


@cache
def _font(high: int) -> Any:
    """The font of the plots, which every matplotlib brings with it."""
    face = Path(matplotlib.get_data_path()) / "fonts" / "ttf" / "DejaVuSans.ttf"
    return ImageFont.truetype(str(face), high)


def shots(
    run: Log, *, rate: float = 30, start: float | None = None, seconds: float | None = None,
    method: str | None = None, title: str = "",
) -> Iterator[Shot]:  # fmt: skip
    """The moments of a run that a movie of `rate` frames a second shows, by the clock.

    start, seconds  from when and for how long [s]; all of it if not given
    method          whose pose; the one that was shown at the time if not given
    title           how the caption begins
    """
    if not len(run):
        raise ValueError("there is nothing to film: no tick is in the log yet")
    if method is not None and method not in run.methods:
        raise LookupError(unknown("method", method, run.methods))
    begin = run.clock[0] if start is None else start
    span = run.clock[-1] - begin + run.dt if seconds is None else seconds
    for i in range(max(1, round(span * rate))):
        yield shot(run, begin + i / rate, method=method, title=title)


def shot(run: Log, clock: float, *, method: str | None = None, title: str = "") -> Shot:
    """What was seen at that time [s]: the last tick before it, or the first there is."""
    t = max(0, int(np.searchsorted(run.clock, clock + 1e-9, side="right")) - 1)
    i = int(run.shown[t]) if method is None else run.methods.index(method)
    name = run.methods[i]
    by = f"{title} by {name}" if title else name
    return Shot(
        run.theta[t, i], run.targets[t], float(run.floor[t]), float(run.advance[t]),
        f"{by}   {run.clock[t]:.2f} s",
    )  # fmt: skip


def film(
    run: Log, *, rate: float = 30, size: tuple[int, int] = (640, 480),
    side: str | None = None, finer: int = 2, **which: Any,
) -> Iterator[Pixels]:  # fmt: skip
    """The pictures of a run, for `formats.movie.write`; `which` as in `shots`."""
    camera = Film(run.tree, run.effectors, size=size, side=side, finer=finer)
    for one in shots(run, rate=rate, **which):
        yield camera.picture(one)
