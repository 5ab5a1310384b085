"""What both renderers agree on: which figures stand where, and what one moment of them is.

A renderer is a `View`. `scene.Scene` is the live one (WebGL, needs a kernel); `still.StillScene`
draws the same things as a picture, for places without WebGL or without a kernel. Either is told
poses and arrays, and solves nothing.
"""

from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple, Protocol

import numpy as np

from ikteach.arrays import Array, ArrayLike
from ikteach.body import Effectors, Frames, Tree, forward, locate
from ikteach.names import unknown
from ikteach.view.skin import has_human_skin

LAYERS = (
    "world axes", "joint axes", "footprints", "trails", "columns of J", "ellipsoid", "reach",
)  # fmt: skip
SQUARE = 0.5  # side of a square of the floor under a human [m]
SHOWN_AT = 0.5  # length on the screen of 1 m/rad [m]: columns of J, axes of the ellipsoid


CAMERAS = {  # where from, seen from the pelvis of a human
    "three-quarter": (1.65, 0.3, 2.3),
    "front": (0.0, 0.0, 2.9),
    "side": (2.9, 0.0, 0.01),
    "top": (0.0, 2.9, 0.05),
}
PLANE = {"plane": (0.0, 0.0, 3.1)}  # along −z: how a planar figure is looked at
FIELD = 45.0  # [degrees] from the lower to the upper edge of the picture


class View(Protocol):
    """What can be asked of any renderer.

    widget   what to display
    stage    which figures stand where
    layers   {name: whether it is drawn}, for the names in `LAYERS`
    dark     whether the background is dark; may be set at any time
    """

    widget: Any
    dark: bool
    stage: "Stage"

    @property
    def layers(self) -> dict[str, bool]:
        """Which layers are drawn."""

    def show(
        self, theta: Array, targets: Array, *, floor: float | None = None, advance: float = 0.0,
        change: int = 0, effector: int = 0, columns: ArrayLike | None = None,
        ellipsoid: tuple[ArrayLike, ArrayLike] | None = None,
        reach: Sequence[tuple[ArrayLike, float, float]] = (), frames: Frames | None = None,
    ) -> None:  # fmt: skip
        """Draw poses θ (n,) or (f, n) and targets (k, 3) or (f, k, 3).

        floor      height of the floor [m]; None: under the figure at rest
        advance    how far the figures have gone [m]: the floor glides back under them
        change     a number that comes back when this has been drawn (live renderer)
        effector   at which effector the next two are drawn
        columns    (3, n) or (f, 3, n): that effector's rows of J [m/rad], a column an arrow
        ellipsoid  (directions (..., 3, 3) in columns, lengths (..., 3) [m/rad])
        reach      (centre (3,), inner, outer [m]) of each chain, at most one an effector
        frames     forward(tree, theta), from whoever has it already
        """

    def switch(self, layer: str, on: bool = True) -> None:
        """Draw a layer, or do not; LookupError for an unknown name."""

    def look_from(self, side: str) -> None:
        """Put the camera to one of `CAMERAS`, or to "plane"."""

    def clear(self) -> None:
        """Forget trails and footprints."""

    def close(self) -> None:
        """Free what the page and the kernel hold of it."""


class Now(NamedTuple):
    """One moment of f figures, each in its own place's coordinates."""

    positions: Array  # (f, n, 3) [m]
    orientations: Array  # (f, n, 3, 3)
    effectors: Array  # (f, k, 3) [m]
    targets: Array  # (f, k, 3) [m]
    floor: float
    advance: float
    effector: int
    columns: Array | None  # (f, 3, n) [m/rad]
    axes: Array | None  # (f, 3, 3) directions of the ellipsoid in columns
    lengths: Array | None  # (f, 3) [m/rad]
    reach: list[tuple[Array, float, float]]


class Stage:
    """Figures of one tree, named, side by side (`apart` > 0) or in one place (`apart` = 0).

    places  (f, 3)  where each stands [m]
    unit    the size of the figure against a human's: thickness of rods, sizes of marks
    planar  whether it lives in the plane z = const
    """

    def __init__(
        self, tree: Tree, effectors: Effectors, names: Sequence[str] = ("",),
        apart: float | None = None,
    ) -> None:  # fmt: skip
        if not names:
            raise ValueError("a scene needs at least one figure")
        self.tree, self.effectors, self.names = tree, effectors, list(names)
        self.human = has_human_skin(tree)
        self.planar = _planar(tree, effectors)
        self.unit = 1.0 if self.human else longest(tree, effectors) / 1.2
        self.apart = (1.5 if self.human else 2.4) * self.unit if apart is None else float(apart)
        self.places = np.zeros((len(names), 3))
        self.places[:, 0] = self.apart * (np.arange(len(names)) - (len(names) - 1) / 2)
        rest = forward(tree, tree.rest)
        points = np.concatenate([rest.positions, locate(rest, effectors)])
        self.floor = float(points[:, 1].min()) - 0.06 * self.unit

    def __len__(self) -> int:
        return len(self.names)

    @property
    def overlaid(self) -> bool:
        """Whether several figures stand in one place; they share one set of targets."""
        return len(self) > 1 and self.apart == 0

    @property
    def side(self) -> str:
        """Where one looks from at first."""
        beside = len(self) > 1 and not self.overlaid
        return "plane" if self.planar else "front" if beside else "three-quarter"

    @property
    def spread(self) -> float:
        """Half the width that all figures need [m]."""
        return float(self.places[-1, 0]) + 1.2 * self.unit

    @property
    def words(self) -> str:
        """What can be seen, in words."""
        what = "human" if self.human else "planar figure" if self.planar else "figure"
        named = [name for name in self.names if name]
        who = f"{len(self)} {what}s" if len(self) > 1 else f"A {what}"
        who += f" ({', '.join(named)})" if named else ""
        return f"{who} with targets for {', '.join(self.effectors.names)}."

    def name_at(self, f: int) -> list[float]:
        """Where the name of figure f is, from its place: over its head, or in a list beside it."""
        x, y = (-0.75, 0.75 - 0.16 * f) if self.overlaid else (0.0, 0.9 if self.human else 1.3)
        return [self.unit * x, self.unit * y, 0.0]

    def now(
        self, theta: Array, targets: Array, floor: float | None, advance: float, effector: int,
        columns: ArrayLike | None, ellipsoid: tuple[ArrayLike, ArrayLike] | None,
        reach: Sequence[tuple[ArrayLike, float, float]], frames: Frames | None = None,
    ) -> Now:  # fmt: skip
        """The moment that `View.show` was told of, with a row for each figure."""
        f, n, k = len(self), len(self.tree), len(self.effectors)
        if frames is None:
            frames = forward(self.tree, self._each("theta", theta, (f, n)))
        axes = lengths = None
        if ellipsoid is not None:
            axes = self._each("directions of the ellipsoid", ellipsoid[0], (f, 3, 3))
            lengths = self._each("lengths of the ellipsoid", ellipsoid[1], (f, 3))
        if not -k <= effector < k:
            raise ValueError(f"effector must be from 0 to {k - 1}, not {effector}")
        if len(reach) > k:
            raise ValueError(f"{k} effectors have at most {k} chains to show, not {len(reach)}")
        return Now(
            self._each("positions", frames.positions, (f, n, 3)),
            self._each("orientations", frames.orientations, (f, n, 3, 3)),
            self._each("effectors", locate(frames, self.effectors), (f, k, 3)),
            self._each("targets", targets, (f, k, 3)),
            self.floor if floor is None else floor,
            advance,
            effector,
            None if columns is None else self._each("columns", columns, (f, 3, n)),
            axes,
            lengths,
            [(np.asarray(c, dtype=float), inner, outer) for c, inner, outer in reach],
        )

    def _each(self, what: str, values: ArrayLike, shape: tuple[int, ...]) -> Array:
        """The values, one row a figure; one row for all is given to each."""
        array = np.asarray(values, dtype=float)
        if array.shape == shape:
            return array
        if array.shape == shape[1:]:
            return array[None].repeat(shape[0], axis=0)
        raise ValueError(f"{what} must have the shape {shape[1:]} or {shape}, not {array.shape}")


def side_of(name: str) -> Array:
    """Where a named camera stands, seen from the pelvis; LookupError for an unknown one."""
    places = CAMERAS | PLANE
    if name not in places:
        raise LookupError(unknown("camera", name, places))
    return np.array(places[name])


def picture_axes(back: Array) -> Array:
    """The directions right, up and towards the eye, in columns, of an eye that far back."""
    z = back / max(float(np.linalg.norm(back)), 1e-12)
    up = [0.0, 1.0, 0.0] if abs(z[1]) < 1 - 1e-9 else [0.0, 0.0, -1.0]
    x = np.cross(up, z)
    x /= np.linalg.norm(x)
    return np.stack([x, np.cross(z, x), z], axis=-1)


def chains(tree: Tree, effectors: Effectors) -> Iterator[Array]:
    """The links (links, 3) from the ground to each effector, at θ = 0 [m]."""
    for joint, offset in zip(effectors.joints, effectors.offsets, strict=True):
        yield np.array([tree.offsets[j] for j in tree.above(int(joint))][::-1] + [offset])


def longest(tree: Tree, effectors: Effectors) -> float:
    """The length of the longest chain [m]."""
    lengths = [np.linalg.norm(links, axis=1).sum() for links in chains(tree, effectors)]
    return float(max(*lengths, 1e-3))


def _planar(tree: Tree, effectors: Effectors) -> bool:
    in_plane = np.where(tree.slide, tree.axes[:, 2] == 0, abs(tree.axes[:, 2]) == 1)
    flat = not (tree.offsets[:, 2].any() or effectors.offsets[:, 2].any())
    return bool(in_plane.all()) and flat
