"""The layers over the figures: made when first wanted, told arrays, moved by the driver."""

from collections.abc import Callable, Iterable, Sequence
from typing import Any

import numpy as np
import pythreejs as three

from ikteach.arrays import Array
from ikteach.body.rotation import sticks, transforms
from ikteach.view.stage import shapes
from ikteach.view.stage.skin import BLUE, GREEN, ORANGE, PURPLE, RED, SKY
from ikteach.view.stage.stage import LAYERS, SHOWN_AT, Now, Stage, picture_axes
from ikteach.view.stage.trails import MARKS, PRINTS, Prints, Trail, feet
from ikteach.view.webgl import objects as solids
from ikteach.view.webgl.mesh import Piece, Runs, fused
from ikteach.view.webgl.objects import effector_colour

AXIS_COLOURS = (RED, GREEN, BLUE)
HIDDEN: Array = np.c_[1e-6 * np.eye(3), [0, -1e4, 0]]  # tiny, and far outside the picture


class Layer:
    """What one layer adds to the scene.

    rows   how many rows it has in a frame; `place` gives them
    moves  what they move, the layer's first row being 0
    root   what holds it all, to be shown and hidden
    """

    def __init__(self, stage: Stage) -> None:
        self.stage, self.rows = stage, 0
        self.moves: list[tuple[three.Object3D, Runs]] = []
        self.root = three.Group(visible=False)
        self.build()
        self.root.children = [*(thing for thing, _ in self.moves), *self.root.children]

    def build(self) -> None:
        """Make the objects."""
        raise NotImplementedError

    def place(self, now: Now) -> Array:
        """The rows, (rows, 3, 4)."""
        return np.zeros((0, 3, 4))

    def clear(self) -> None:
        """Forget what was before."""

    def add(self, shapes: Iterable[shapes.Shape], colours: Sequence[str], **looks: Any) -> None:
        """Shapes in these colours in turn, each moved by the next row."""
        pieces = [
            Piece(row, shape, colours[row % len(colours)]) for row, shape in enumerate(shapes)
        ]
        self.rows = max(self.rows, len(pieces))
        self.moves.append(fused(pieces, **looks))


class WorldAxes(Layer):
    """x, y and z from where the figure is fixed, each with its letter. Nothing moves them."""

    def build(self) -> None:
        """Three half axes where each figure stands."""
        unit, rod = self.stage.unit, shapes.rod(0.012 * self.stage.unit)
        places = self.stage.places[:1] if self.stage.overlaid else self.stage.places
        places = places + self.stage.base
        ways = list(zip(np.eye(3), "xyz", AXIS_COLOURS, strict=True))
        pieces = [
            Piece(0, rod.at(sticks(place, place + 0.7 * unit * way)), colour)
            for place in places
            for way, _, colour in ways
        ]
        letters = [
            letter
            for way, name, colour in ways
            for letter in solids.labels(name, colour, 0.14 * unit, list(places + 0.78 * unit * way))
        ]
        axes, _ = fused(pieces)
        axes.visible = True
        self.root.children = [axes, *letters]


class JointAxes(Layer):
    """A rod along the axis of every joint."""

    def build(self) -> None:
        """A rod for each joint; an axis is the same in its joint's own frame, at any angle."""
        rod, half = shapes.rod(0.009 * self.stage.unit), 0.16 * self.stage.unit
        axes = [rod.at(sticks(-half * axis, half * axis)) for axis in self.stage.tree.axes]
        colours = [effector_colour(j) for j in range(len(axes))]
        self.add(axes * len(self.stage), colours)

    def place(self, now: Now) -> Array:
        """Where the joints are."""
        places = now.positions + self.stage.places[:, None]
        return transforms(now.orientations, places).reshape(-1, 3, 4)


class Trails(Layer):
    """Where the effectors have been."""

    def build(self) -> None:
        """A ring of marks for each effector of each figure."""
        stage, names = self.stage, self.stage.effectors.names
        self._trail = Trail((len(stage), len(names)), MARKS, 0.05 * stage.unit)
        marks = [shapes.mark(name, 0.013 * stage.unit) for name in names for _ in range(MARKS)]
        colours = [effector_colour(i) for i in range(len(names)) for _ in range(MARKS)]
        self.add(marks * len(stage), colours)

    def place(self, now: Now) -> Array:
        """The marks, with the newest where the effectors are."""
        marks = self._trail.pass_through(now.effectors, now.advance)
        return _at(marks + self.stage.places[:, None, None])

    def clear(self) -> None:
        """Forget the marks."""
        self._trail.clear()


class Footprints(Layer):
    """Where the feet have come down."""

    def build(self) -> None:
        """A ring of prints for each foot of each figure."""
        stage, names = self.stage, self.stage.effectors.names
        self._feet = feet(stage.effectors)
        self._prints = Prints((len(stage), len(self._feet)), PRINTS, 1e-4 * stage.unit)
        size = 0.045 * stage.unit, 0.11 * stage.unit
        soles = [shapes.sole(names[i], *size) for i in self._feet for _ in range(PRINTS)]
        colours = [effector_colour(i) for i in self._feet for _ in range(PRINTS)]
        if soles:
            self.add(soles * len(stage), colours, opacity=0.55)

    def place(self, now: Now) -> Array:
        """The prints, on the floor."""
        marks = self._prints.pass_through(now.effectors[:, self._feet], now.advance)
        over = now.floor + 0.006 * self.stage.unit
        marks[..., 1] = np.where(np.isnan(marks[..., 1]), np.nan, over)
        return _at(marks + self.stage.places[:, None, None])

    def clear(self) -> None:
        """Forget the prints."""
        self._prints.clear()


class Columns(Layer):
    """The columns of J as arrows at an effector: where each joint would move it."""

    def build(self) -> None:
        """An arrow for each joint of each figure, in the colour of the joint's axis."""
        n = len(self.stage.tree)
        arrow = shapes.arrow(0.013 * self.stage.unit)
        self.add([arrow] * n * len(self.stage), [effector_colour(j) for j in range(n)])

    def place(self, now: Now) -> Array:
        """Arrows as `Stage.arrows` has them; none for a joint that does not move it."""
        if now.columns is None:
            return np.broadcast_to(HIDDEN, (self.rows, 3, 4))
        start = now.effectors[:, now.effector, None] + self.stage.places[:, None]
        along, unit = self.stage.arrows(now.columns), self.stage.unit
        short = np.linalg.norm(along, axis=-1) < 1e-6 * unit
        start = np.broadcast_to(start, along.shape)
        found = sticks(start, np.where(short[..., None], start + [0, unit, 0], start + along))
        return np.where(short[..., None, None], HIDDEN, found).reshape(-1, 3, 4)


class Ellipsoids(Layer):
    """The manipulability ellipsoid at an effector, with its axes."""

    def build(self) -> None:
        """A ball of radius 1 for each figure, to be stretched, and its axes."""
        ball, rod = shapes.globe(20, 6), shapes.rod(0.012)
        axes = [Piece(f, rod.at(sticks(-way, way)), PURPLE)
                for f in range(len(self.stage)) for way in np.eye(3)]  # fmt: skip
        self.moves.append(fused(axes))
        self.add([ball] * len(self.stage), [SKY], opacity=0.4, depthWrite=False)

    def place(self, now: Now) -> Array:
        """Half axes of `SHOWN_AT` metres for 1 m/rad; a lost way has a thin one."""
        if now.axes is None or now.lengths is None:
            return np.broadcast_to(HIDDEN, (self.rows, 3, 4))
        half = np.maximum(SHOWN_AT * now.lengths, 2e-3 * self.stage.unit)
        centre = now.effectors[:, now.effector] + self.stage.places
        return transforms(now.axes * half[:, None, :], centre)


class Reach(Layer):
    """How far, and how near, each chain can stretch: a ball of wires, or a ring in a plane."""

    def build(self) -> None:
        """An outer and an inner surface for each chain of each figure."""
        planar, chains = self.stage.planar, len(self.stage) * len(self.stage.effectors)
        opacity = 1.0 if planar else 0.45
        self.add([shapes.ring(0.008) if planar else shapes.wires()] * 2 * chains,
                 [PURPLE, ORANGE], opacity=opacity)  # fmt: skip

    def place(self, now: Now) -> Array:
        """Outer and inner in turn; hidden where there is no such chain, or no hole."""
        f, k = len(self.stage), len(self.stage.effectors)
        found = np.tile(HIDDEN, (f, k, 2, 1, 1))
        axes = np.eye(3) if self.stage.normal is None else picture_axes(self.stage.normal)
        for i, (centre, inner, outer) in enumerate(now.reach):
            for side, radius in enumerate((outer, inner)):
                if radius > 1e-6 * self.stage.unit:
                    found[:, i, side, :, :3] = radius * axes
                    found[:, i, side, :, 3] = centre + self.stage.places
        return found.reshape(-1, 3, 4)


MAKERS: dict[str, Callable[[Stage], Layer]] = dict(
    zip(
        LAYERS,
        (WorldAxes, JointAxes, Footprints, Trails, Columns, Ellipsoids, Reach),
        strict=True,
    )
)


def _at(points: Array) -> Array:
    """Upright matrices (points, 3, 4) at these points; hidden where they are NaN."""
    flat = points.reshape(-1, 3)
    upright = transforms(np.broadcast_to(np.eye(3), (len(flat), 3, 3)), flat)
    return np.where(np.isnan(flat[:, :1, None]), HIDDEN, upright)
