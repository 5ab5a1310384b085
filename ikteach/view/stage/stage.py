"""Which figures stand where, and what one moment of them is.

A renderer is a `View`. `scene.Scene` is the live one (WebGL, needs a kernel); `still.StillScene`
draws the same layers as a picture, for places without WebGL or without a kernel. Either is given
poses and arrays, and solves nothing.
"""

from collections.abc import Sequence
from math import atan, cos, radians, sin, tan
from typing import Any, NamedTuple, Protocol, TypedDict, Unpack

import numpy as np

from ikteach.arrays import TINY, Array, ArrayLike, finite
from ikteach.body import Effectors, Frames, Tree, forward, locate
from ikteach.body.extent import extent
from ikteach.body.tree import GROUND
from ikteach.checks import numbers, shown
from ikteach.names import unknown
from ikteach.view.stage.lengths import units
from ikteach.view.stage.skin import skin_of, stick_skin

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


class About(TypedDict, total=False):
    """Facts about a moment, beside poses and targets.

    `View.show` takes them, and layers may show them.

    floor      height of the floor [m]; None: under the figure at rest
    advance    how far the figures have gone [m]: the floor glides back under them
    change     a number that comes back when this has been drawn (live renderer)
    effector   at which effector the next two are drawn
    columns    (3, n) or (f, 3, n): that effector's rows of J [m/rad], an arrow per column
    ellipsoid  (directions (..., 3, 3) in columns, lengths (..., 3) [m/rad])
    reach      (centre (3,) or (f, 3), inner, outer [m]) of each chain, at most one per effector; a
               radius that is infinite is not drawn. It is about the joint if `effector` is a
               direction
    skeletons  of each figure in turn, bones (b, 2, 3) [m], from end to end, of whom its motion was
               recorded from; or None
    frames     forward(tree, theta), from whoever has it already
    """

    floor: float | None
    advance: float
    change: int
    effector: int
    columns: ArrayLike | None
    ellipsoid: tuple[ArrayLike, ArrayLike] | None
    reach: Sequence[tuple[ArrayLike, float, float]]
    skeletons: Sequence[ArrayLike | None]
    frames: Frames | None


class View(Protocol):
    """The interface of any renderer.

    widget   is to be displayed
    stage    which figures stand where
    layers   {name: whether it is drawn}, for the names in `layers.LAYERS`
    dark     whether the background is dark; may be set at any time
    views    how many views are shown at once, 1, 2 or 4; may be set
    """

    widget: Any
    dark: bool
    views: int
    stage: "Stage"

    @property
    def layers(self) -> dict[str, bool]:
        """Tell which layers are drawn."""

    def show(self, theta: Array, targets: Array, **about: Unpack[About]) -> None:
        """Draw poses and targets, and the facts of `About`.

        Poses θ are (n,) or (f, n), targets (k, 3) or (f, k, 3).
        """

    def switch(self, layer: str, on: bool = True) -> None:
        """Draw a layer, or do not; LookupError for an unknown name."""

    def look_from(self, side: str) -> None:
        """Put the first camera to one of `CAMERAS`, or to "plane"."""

    def clear(self) -> None:
        """Forget trails and footprints."""

    def close(self) -> None:
        """Free its objects in the page and in the kernel."""


class Now(NamedTuple):
    """One moment of f figures, each in its own place's coordinates."""

    positions: Array  # (f, n, 3) [m]
    orientations: Array  # (f, n, 3, 3)
    origins: Array  # (f, k, 3) [m] (1 − w) p_joint: where a direction begins, 0 for a point
    effectors: Array  # (f, k, 3) [m] that of a point, or the tip of a direction
    targets: Array  # (f, k, 3) [m] likewise
    floor: float
    advance: float
    effector: int
    columns: Array | None  # (f, 3, n) [m/rad]
    axes: Array | None  # (f, 3, 3) directions of the ellipsoid in columns
    lengths: Array | None  # (f, 3) [m/rad]
    reach: list[tuple[Array, float, float]]
    skeletons: list[Array]  # of each figure (b, 2, 3) [m]


class Stage:
    """Figures of one tree, side by side or overlaid.

    They are named. They stand side by side if `apart` > 0, in one place if `apart` = 0.

    places  (f, 3)  where each stands [m], from where one alone would
    extent  the ball that holds all poses of one: cameras look at it
    unit    the size of a figure against a human's: thickness of rods, sizes of marks
    base    (3,) where it is fixed to the ground, in the middle [m]
    normal  (3,) of the plane that it lives in, towards the eye; None if it lives in no plane
    skin    its solid parts
    """

    def __init__(
        self,
        tree: Tree,
        effectors: Effectors,
        names: Sequence[str] = ("",),
        apart: float | None = None,
    ) -> None:
        if not names:
            raise ValueError("a scene needs at least one figure")
        self.tree, self.effectors, self.names = tree, effectors, list(names)
        skin = skin_of(tree)
        self.human = skin is not None
        if skin is not None:
            self.extent, self.unit, self.base = skin.extent, skin.unit, skin.base
            self.skin = skin.parts
        else:
            self.extent = extent(tree, effectors)
            self.unit = self.extent.radius / REACH
            self.base = tree.offsets[tree.parents == GROUND].mean(axis=0)
            self.skin = stick_skin(tree, effectors, 0.03 * self.unit)
        self.normal = plane_of(tree, effectors)
        self._units = units(tree, effectors)
        self.apart = (1.5 if self.human else 2 * REACH) * self.unit if apart is None else apart
        self.places = np.zeros((len(names), 3))
        self.places[:, 0] = self.apart * (np.arange(len(names)) - (len(names) - 1) / 2)
        rest = forward(tree, tree.rest)
        points = np.concatenate([rest.positions, locate(rest, effectors)[effectors.w == 1]])
        self.floor = float(points[:, 1].min()) - 0.06 * self.unit
        self._stands = bool(points[:, 1].mean() > self.extent.centre[1])

    def __len__(self) -> int:
        return len(self.names)

    @property
    def planar(self) -> bool:
        """Tell whether the figure lives in a plane."""
        return self.normal is not None

    @property
    def overlaid(self) -> bool:
        """Tell whether several figures stand in one place.

        They then share one set of targets.
        """
        return len(self) > 1 and self.apart == 0

    @property
    def side(self) -> str:
        """Name the side one looks from at first."""
        beside = len(self) > 1 and not self.overlaid
        return "plane" if self.planar else "front" if beside else "three-quarter"

    @property
    def free(self) -> Array:
        """The coordinates (3,) in which anything can move.

        1 for each of them, 0 for the one across its plane.
        """
        across = np.zeros(3) if self.normal is None else abs(self.normal)
        return np.where(across > 1 - FLAT, 0.0, 1.0)

    def eye(self, side: str, aspect: float) -> Array:
        """Place a camera (3,) [m] on a named side.

        It sees all poses of all figures, and looks at the middle of them. aspect: width over height
        of its picture, of which `FIELD` is the height. LookupError for an unknown side.
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
        """Point from the figure to a named camera; LookupError for an unknown one."""
        ways = {**CAMERAS, PLANE: CAMERAS["front"] if self.normal is None else self.normal}
        if side not in ways:
            raise LookupError(unknown("camera", side, ways))
        return np.asarray(ways[side])

    def ground(self, floor: float, advance: float) -> Array:
        """Lay squares under the figure, or behind it: [R | p] (3, 4).

        They are those of the plane y = 0, as a floor in that height [m], over which the figure has
        advanced [m], or as a wall behind a figure in a plane.
        """
        if self.normal is None:
            x, _, z = self.extent.centre
            laid = np.eye(3, 4)
            laid[:, 3] = x, floor, z - advance % (SQUARE * self.unit)
            return laid
        right, up, back = picture_axes(self.normal).T
        return np.column_stack([right, back, -up, self.extent.centre - 0.2 * self.unit * back])

    @property
    def words(self) -> str:
        """The scene in a sentence."""
        named = [name for name in self.names if name]
        who = self.crowd + (f" ({', '.join(named)})" if named else "")
        each = list(zip(self.effectors.names, self.effectors.w, strict=True))
        points = ", ".join(name for name, w in each if w)
        ways = ", ".join(name for name, w in each if not w)
        kinds = [f"targets for {points}"] * bool(points) + [f"directions for {ways}"] * bool(ways)
        return f"{who} with {' and '.join(kinds)}."

    @property
    def crowd(self) -> str:
        """Say how many figures of which kind there are."""
        what = "human" if self.human else "planar figure" if self.planar else "figure"
        return f"{len(self)} {what}s" if len(self) > 1 else f"A {what}"

    def name_at(self, f: int) -> Array:
        """Place the name of figure f, relative to its place.

        It is over it, under it, or in a list.
        """
        if self.overlaid:
            x, y = -1.0, 0.85 - 0.16 * f
        else:  # where the figure is not, at rest
            x, y = 0.0, 0.88 if self.human else -1.1 if self._stands else 1.1
        return self.extent.centre + self.unit * np.array([x, y, 0.0])

    def now(self, theta: Array, targets: Array, **about: Unpack[About]) -> Now:
        """Make the moment that `View.show` is given, with a row per figure.

        ValueError for a shape that does not fit, or a value that is no number; TypeError for an
        option that nobody knows.
        """
        for name in about:
            if name not in About.__annotations__:
                raise TypeError(unknown("option of show", name, About.__annotations__))
        f, n, k = len(self), len(self.tree), len(self.effectors)
        frames = about.get("frames")
        if frames is None:
            frames = forward(self.tree, _checked("theta", theta, (f, n)))
        positions = _checked("positions", frames.positions, (f, n, 3))
        w = self.effectors.w[:, None]
        origins = (1 - w) * positions[:, self.effectors.joints]
        columns, ellipsoid = about.get("columns"), about.get("ellipsoid")
        axes, lengths = (None, None) if ellipsoid is None else ellipsoid
        floor, effector = about.get("floor"), about.get("effector", 0)
        if not (isinstance(effector, int | np.integer) and -k <= effector < k):
            raise ValueError(f"effector must be from 0 to {k - 1}, not {shown(effector)}")
        reach = about.get("reach", ())
        if len(reach) > k:
            raise ValueError(f"{k} effectors have at most {k} chains to show, not {len(reach)}")
        skeletons = list(about.get("skeletons", ()))
        if len(skeletons) > f:
            raise ValueError(f"{f} figures have at most {f} skeletons to show")
        return Now(
            positions,
            _per_figure(frames.orientations, (f, n, 3, 3)),
            origins,
            _per_figure(locate(frames, self.effectors), (f, k, 3)) + origins,
            _checked("targets", targets, (f, k, 3)) + origins,
            self.floor if floor is None else _number("floor", floor),
            _number("advance", about.get("advance", 0.0)),
            effector,
            None if columns is None else _checked("columns", columns, (f, 3, n)),
            None if axes is None else _checked("directions of the ellipsoid", axes, (f, 3, 3)),
            None if lengths is None else _checked("lengths of the ellipsoid", lengths, (f, 3)),
            [(numbers("reach", centre), inner, outer) for centre, inner, outer in reach],
            [_bones(one) for one in skeletons],
        )

    def far(self, now: Now) -> list[list[str]]:
        """Say how far each effector is from its target.

        A row per figure. A direction is off by an angle [°].
        """
        gaps = np.linalg.norm(now.targets - now.effectors, axis=-1)
        off = angle(now.effectors - now.origins, now.targets - now.origins)
        rows = np.where(self.effectors.w, gaps, off).tolist()
        return [[unit(far) for unit, far in zip(self._units, row, strict=True)] for row in rows]

    def arrows(self, columns: Array) -> Array:
        """Make arrows (..., n, 3) [m] of columns of J (..., 3, n): `SHOWN_AT` for 1 m/rad.

        The column of a slide has no unit: 1 m/m is as long as 1 m/rad is on a human, in the
        proportions of this body.
        """
        long = np.where(self.tree.slide, SHOWN_AT * self.unit, SHOWN_AT)
        return long[:, None] * columns.swapaxes(-1, -2)


def _per_figure(array: Array, shape: tuple[int, ...]) -> Array:
    """Give each figure a row of its own, where there is one for all."""
    return array if array.shape == shape else array[None].repeat(shape[0], axis=0)


def _checked(name: str, values: ArrayLike, shape: tuple[int, ...]) -> Array:
    """Make finite numbers, a row per figure; ValueError names what is not, or does not fit."""
    array = numbers(name, values)
    if array.shape not in (shape, shape[1:]):
        fits = f"{shape[1:]} or {shape}"
        raise ValueError(f"{name} must have the shape {fits}, not {array.shape}")
    if not finite(array):
        raise ValueError(f"{name} must be finite, not {array[~np.isfinite(array)][0]}")
    return _per_figure(array, shape)


def _bones(skeleton: ArrayLike | None) -> Array:
    """Make bones (b, 2, 3) of finite numbers, of none if there is no skeleton."""
    bones = np.zeros((0, 2, 3)) if skeleton is None else numbers("a skeleton", skeleton)
    if bones.ndim != 3 or bones.shape[1:] != (2, 3):
        raise ValueError(f"a skeleton has the shape (bones, 2, 3), not {bones.shape}")
    if not finite(bones):
        raise ValueError("the bones of a skeleton must be finite")
    return bones


def _number(name: str, value: Any) -> float:
    """Make a float of one finite number; ValueError names what is none."""
    array = numbers(name, value)
    if array.ndim or not np.isfinite(array):
        raise ValueError(f"{name} must be one number, and finite, not {shown(value)}")
    return float(array)


def angle(a: Array, b: Array) -> Array:
    """Return the angles (...) from vectors a to b (..., 3) [rad]."""
    return np.arctan2(np.linalg.norm(np.cross(a, b), axis=-1), np.vecdot(a, b))


def picture_axes(back: Array) -> Array:
    """Return right, up and towards the eye, in columns (3, 3).

    `back` (3,) leads to the eye from the point that it looks at.
    """
    z = back / max(float(np.linalg.norm(back)), 1e-12)
    up = [0.0, 1.0, 0.0] if abs(z[1]) < 1 - 1e-9 else [0.0, 0.0, -1.0]
    x = np.cross(up, z)
    x /= np.linalg.norm(x)
    return np.stack([x, np.cross(z, x), z], axis=-1)


def sides_of(tree: Tree, effectors: Effectors) -> list[str]:
    """List the sides from which to look at a body.

    The usual one comes first.
    """
    return [*CAMERAS] if plane_of(tree, effectors) is None else [PLANE, *CAMERAS]


def plane_of(tree: Tree, effectors: Effectors) -> Array | None:
    """Return the normal (3,) of a body's plane, or None.

    It points towards `CAMERAS`; None if the body lives in no plane. Its hinges turn about the
    normal; its links and slides lie in the plane.
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
