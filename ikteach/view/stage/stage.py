"""What both renderers agree on: which figures stand where, and what one moment of them is.

A renderer is a `View`. `scene.Scene` is the live one (WebGL, needs a kernel); `still.StillScene`
draws the same things as a picture, for places without WebGL or without a kernel. Either is told
poses and arrays, and solves nothing.
"""

from collections.abc import Sequence
from math import atan, cos, radians, sin, tan
from typing import Any, NamedTuple, Protocol

import numpy as np

from ikteach.arrays import Array, ArrayLike
from ikteach.body import Effectors, Frames, Tree, forward, locate
from ikteach.body.extent import extent
from ikteach.body.tree import GROUND
from ikteach.names import unknown
from ikteach.view.stage.skin import flesh_of, stick_skin

LAYERS = (
    "world axes", "joint axes", "footprints", "trails", "columns of J", "ellipsoid", "reach",
)  # fmt: skip
SQUARE = 0.5  # side of a square of the floor under a human [m]
SHOWN_AT = 0.5  # length on the screen of 1 m/rad [m]: columns of J, axes of the ellipsoid
REACH = 1.2  # radius of the ball that holds all poses of a body of unit 1, about a human's [m]


CAMERAS = {  # the ways from the figure to the named cameras
    "three-quarter": (1.65, 0.3, 2.3),
    "front": (0.0, 0.0, 1.0),
    "side": (1.0, 0.0, 0.003),
    "top": (0.0, 1.0, 0.017),
}
PLANE = "plane"  # along the normal of its plane: how a planar figure is looked at
FIELD = 45.0  # [degrees] from the lower to the upper edge of the picture
ROOM = 1.08  # radius of the ball that cameras see, as a share of the one that holds all poses
FLAT = 1e-6  # sine of the angle by which a direction in a plane may miss it
TINY = 1e-150  # keeps 0 / 0 away where a link has no length


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

    places  (f, 3)  where each stands [m], from where one alone would
    extent  the ball that holds all poses of one: what cameras look at
    unit    the size of a figure against a human's: thickness of rods, sizes of marks
    base    (3,) where it is fixed to the ground, in the middle [m]
    normal  (3,) of the plane that it lives in, towards the eye; None if it lives in no plane
    skin    its solid parts
    """

    def __init__(
        self, tree: Tree, effectors: Effectors, names: Sequence[str] = ("",),
        apart: float | None = None,
    ) -> None:  # fmt: skip
        if not names:
            raise ValueError("a scene needs at least one figure")
        self.tree, self.effectors, self.names = tree, effectors, list(names)
        flesh = flesh_of(tree)
        self.human = flesh is not None
        if flesh is not None:
            self.extent, self.unit, self.base = flesh.extent, flesh.unit, flesh.base
            self.skin = flesh.parts
        else:
            self.extent = extent(tree, effectors)
            self.unit = self.extent.radius / REACH
            self.base = tree.offsets[tree.parents == GROUND].mean(axis=0)
            self.skin = stick_skin(tree, effectors, 0.03 * self.unit)
        self.normal = plane_of(tree, effectors)
        self.apart = (1.5 if self.human else 2 * REACH) * self.unit if apart is None else apart
        self.places = np.zeros((len(names), 3))
        self.places[:, 0] = self.apart * (np.arange(len(names)) - (len(names) - 1) / 2)
        rest = forward(tree, tree.rest)
        points = np.concatenate([rest.positions, locate(rest, effectors)])
        self.floor = float(points[:, 1].min()) - 0.06 * self.unit
        self._stands = bool(points[:, 1].mean() > self.extent.centre[1])

    def __len__(self) -> int:
        return len(self.names)

    @property
    def planar(self) -> bool:
        """Whether the figure lives in a plane."""
        return self.normal is not None

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
    def free(self) -> Array:
        """1 for each coordinate (3,) in which anything can move, 0 for that across its plane."""
        across = np.zeros(3) if self.normal is None else abs(self.normal)
        return np.where(across > 1 - FLAT, 0.0, 1.0)

    def eye(self, side: str, aspect: float) -> Array:
        """Where a camera stands that sees all poses of all figures from a named side, (3,) [m].

        It looks at the middle of them. aspect: width over height of its picture, of which `FIELD`
        is the height. LookupError for an unknown side.
        """
        axes = picture_axes(self._towards(side))
        tall = radians(FIELD / 2)
        wide = atan(aspect * tan(tall))
        x, y, z = (self.places @ axes).T
        # A ball is between two edges of the picture, each α from its middle, if from the plane of
        # eye and edge it is as far as its radius.
        r = ROOM * self.extent.radius
        far = [(r + abs(across) * cos(a)) / sin(a) + z for across, a in ((x, wide), (y, tall))]
        return self.extent.centre + float(np.max(far)) * axes[:, 2]

    def _towards(self, side: str) -> Array:
        """The way from the figure to a named camera; LookupError for an unknown one."""
        ways = {**CAMERAS, PLANE: CAMERAS["front"] if self.normal is None else self.normal}
        if side not in ways:
            raise LookupError(unknown("camera", side, ways))
        return np.asarray(ways[side])

    def ground(self, floor: float, advance: float) -> Array:
        """[R | p] (3, 4) that lays squares of the plane y = 0 under the figure, or behind it.

        They are a floor in that height [m], over which the figure has advanced [m], or a wall
        behind a figure in a plane.
        """
        if self.normal is None:
            x, _, z = self.extent.centre
            p = [x, floor, z - advance % (SQUARE * self.unit)]
            return np.column_stack([np.eye(3), p])
        right, up, back = picture_axes(self.normal).T
        return np.column_stack([right, back, -up, self.extent.centre - 0.2 * self.unit * back])

    @property
    def words(self) -> str:
        """What can be seen, in words."""
        named = [name for name in self.names if name]
        who = self.crowd + (f" ({', '.join(named)})" if named else "")
        return f"{who} with targets for {', '.join(self.effectors.names)}."

    @property
    def crowd(self) -> str:
        """How many figures of what kind there are, in words."""
        what = "human" if self.human else "planar figure" if self.planar else "figure"
        return f"{len(self)} {what}s" if len(self) > 1 else f"A {what}"

    def name_at(self, f: int) -> Array:
        """Where the name of figure f is, from its place: over it, under it, or in a list."""
        if self.overlaid:
            x, y = -0.75, 0.65 - 0.16 * f
        else:  # where the figure is not, at rest
            x, y = 0.0, 0.8 if self.human else -1.1 if self._stands else 1.1
        return self.extent.centre + self.unit * np.array([x, y, 0.0])

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

    def arrows(self, columns: Array) -> Array:
        """The columns of J (..., 3, n) as arrows (..., n, 3) [m]: `SHOWN_AT` for 1 m/rad.

        The column of a slide has no unit: 1 m/m is as long as 1 m/rad is on a human, in the
        proportions of this body.
        """
        long = np.where(self.tree.slide, SHOWN_AT * self.unit, SHOWN_AT)
        return long[:, None] * columns.swapaxes(-1, -2)

    def _each(self, what: str, values: ArrayLike, shape: tuple[int, ...]) -> Array:
        """The values, one row a figure; one row for all is given to each."""
        array = np.asarray(values, dtype=float)
        if array.shape == shape:
            return array
        if array.shape == shape[1:]:
            return array[None].repeat(shape[0], axis=0)
        raise ValueError(f"{what} must have the shape {shape[1:]} or {shape}, not {array.shape}")


def picture_axes(back: Array) -> Array:
    """The directions right, up and towards the eye, in columns, of an eye that far back."""
    z = back / max(float(np.linalg.norm(back)), 1e-12)
    up = [0.0, 1.0, 0.0] if abs(z[1]) < 1 - 1e-9 else [0.0, 0.0, -1.0]
    x = np.cross(up, z)
    x /= np.linalg.norm(x)
    return np.stack([x, np.cross(z, x), z], axis=-1)


def sides_of(tree: Tree, effectors: Effectors) -> list[str]:
    """The named sides from which a body can be looked at, the usual one first."""
    return [*CAMERAS] if plane_of(tree, effectors) is None else [PLANE, *CAMERAS]


def plane_of(tree: Tree, effectors: Effectors) -> Array | None:
    """The normal (3,) of the plane that a body lives in, towards `CAMERAS`; None if in none.

    Its hinges turn about the normal; its links and slides lie in the plane.
    """
    roots = tree.parents == GROUND
    fixed = tree.offsets[roots]
    links = np.concatenate([tree.offsets[~roots], effectors.offsets, fixed - fixed[0]])
    hinges, slides = tree.axes[~tree.slide], tree.axes[tree.slide]
    lengths = np.linalg.norm(links, axis=-1, keepdims=True)
    within = np.concatenate([slides, links / np.maximum(lengths, TINY)])
    normal = hinges[0] if len(hinges) else np.array([0.0, 0, 1])
    if not len(hinges) and (abs(within @ normal) > FLAT).any():  # slides in some other plane
        normal = np.linalg.svd(within)[2][-1]
    if (abs(within @ normal) > FLAT).any() or (
        np.linalg.norm(np.cross(hinges, normal), axis=-1) > FLAT
    ).any():
        return None
    towards = float(normal @ CAMERAS["three-quarter"])
    return -normal if towards < 0 else normal
