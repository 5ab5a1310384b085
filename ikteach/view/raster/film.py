"""A recorded run as pictures, drawn in the kernel: figure, targets, floor and a caption."""

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from ikteach.arrays import Array
from ikteach.body import Effectors, Tree
from ikteach.formats.movie import Pixels
from ikteach.motion.live.log import Log
from ikteach.names import unknown
from ikteach.view.raster.drawing import Drawing, caption
from ikteach.view.stage.basics import BASICS
from ikteach.view.stage.colours import LIGHT
from ikteach.view.stage.stage import CAMERAS, PLANE, Stage


class Shot(NamedTuple):
    """The content of one picture.

    Pose θ (n,), targets (k, 3) [m], floor and advance [m], caption.
    """

    theta: Array
    targets: Array
    floor: float
    advance: float
    caption: str


class Film:
    """A camera on one figure: `picture` makes one frame of size (width, height).

    side   one of `stage.CAMERAS`, or "plane"; None: as a live scene looks at first
    finer  how many rays a pixel's side is made of: 1 is fast, 2 has smooth edges
    """

    def __init__(
        self,
        tree: Tree,
        effectors: Effectors,
        *,
        size: tuple[int, int] = (640, 480),
        side: str | None = None,
        finer: int = 2,
    ) -> None:
        if side not in (None, *CAMERAS, PLANE):
            raise LookupError(unknown("view", side, (*CAMERAS, PLANE)))
        self.stage = Stage(tree, effectors)
        self.drawing = Drawing(self.stage, size, side, finer)
        self._layers = [layer(self.stage) for layer in BASICS]

    def picture(self, shot: Shot) -> Pixels:
        """Draw the frame (height, width, 3) of one shot."""
        theta, targets, floor, advance, words = shot
        now = self.stage.now(theta, targets, floor=floor, advance=advance)
        image = self.drawing.picture(self._layers, now)
        caption(image, words, LIGHT.ink)
        return np.asarray(image)


def shots(
    run: Log,
    *,
    rate: float = 30,
    start: float | None = None,
    seconds: float | None = None,
    method: str | None = None,
    title: str = "",
) -> Iterator[Shot]:
    """Pick the moments of a run that a film shows.

    rate            frames per second, by the clock
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
    """Return the shot at that time [s].

    It shows the last tick before then, or the first.
    """
    t = max(0, int(np.searchsorted(run.clock, clock + 1e-9, side="right")) - 1)
    i = int(run.shown[t]) if method is None else run.methods.index(method)
    name = run.methods[i]
    by = f"{title} by {name}" if title else name
    return Shot(
        run.theta[t, i],
        run.targets[t],
        float(run.floor[t]),
        float(run.advance[t]),
        f"{by}   {run.clock[t]:.2f} s",
    )


def film(
    run: Log,
    *,
    rate: float = 30,
    size: tuple[int, int] = (640, 480),
    side: str | None = None,
    finer: int = 2,
    **which: Any,
) -> Iterator[Pixels]:
    """Draw the pictures of a run, for `formats.movie.write`; `which` as in `shots`."""
    camera = Film(run.tree, run.effectors, size=size, side=side, finer=finer)
    for one in shots(run, rate=rate, **which):
        yield camera.picture(one)
