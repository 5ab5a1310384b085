"""The layers over the figures, which can be switched on and off."""

import numpy as np

from ikteach.arrays import Array
from ikteach.body.rotation import sticks, transforms
from ikteach.view.stage.colours import BLUE, GREEN, ORANGE, PURPLE, RED, SKY, effector_colour
from ikteach.view.stage.forms import (
    ORIGIN,
    STATIC,
    Arrow,
    Ball,
    Label,
    Mark,
    Mesh,
    Piece,
    Ring,
    Rod,
    Sole,
    Wires,
    boxed,
)
from ikteach.view.stage.layer import Layer, hidden, upright
from ikteach.view.stage.stage import SHOWN_AT, Now, picture_axes
from ikteach.view.stage.trails import MARKS, PRINTS, Prints, Trail, feet

RECORDED_BONES = "recorded skeleton"
BONES = 64  # of a recorded skeleton that are drawn: fingers may be left out


class WorldAxes(Layer):
    """The axes x, y and z where the figure is fixed.

    Each has its letter. Nothing moves them.
    """

    name = "world axes"

    def build(self) -> None:
        """Make three half axes where each figure stands."""
        unit, stage = self.stage.unit, self.stage
        places = stage.places[:1] if stage.overlaid else stage.places
        pieces = []
        for place in places + stage.base:
            for way, letter, colour in zip(np.eye(3), "xyz", (RED, GREEN, BLUE), strict=True):
                rod = Rod(place, place + 0.7 * unit * way, 0.012 * unit)
                pieces.append(Piece(STATIC, rod, colour))
                self.labels.append(Label(place + 0.78 * unit * way, letter, colour, 0.14 * unit))
        self.meshes.append(Mesh(pieces))


class JointAxes(Layer):
    """A rod along the axis of every joint."""

    name = "joint axes"

    def build(self) -> None:
        """Make a rod per joint.

        An axis is the same in its joint's own frame, at any angle.
        """
        radius, half = 0.009 * self.stage.unit, 0.16 * self.stage.unit
        rods = [Rod(-half * axis, half * axis, radius) for axis in self.stage.tree.axes]
        self.add(rods * len(self.stage), [effector_colour(j) for j in range(len(rods))])

    def place(self, now: Now) -> Array:
        """Put the rods where the joints are."""
        places = now.positions + self.stage.places[:, None]
        return transforms(now.orientations, places).reshape(-1, 3, 4)


class Footprints(Layer):
    """Where the feet have come down."""

    name = "footprints"

    def build(self) -> None:
        """Make a number of prints for each foot of each figure."""
        stage, names = self.stage, self.stage.effectors.names
        self._feet = feet(stage.effectors)
        self._prints = Prints((len(stage), len(self._feet)), PRINTS, 1e-4 * stage.unit)
        wide, long = 0.045 * stage.unit, 0.11 * stage.unit
        soles = [Sole(wide, long, boxed(names[i])) for i in self._feet for _ in range(PRINTS)]
        colours = [effector_colour(i) for i in self._feet for _ in range(PRINTS)]
        if soles:
            self.add(soles * len(stage), colours, opacity=0.55)

    def note(self, now: Now) -> None:
        """Leave a print where a foot has come down."""
        self._prints.pass_through(now.effectors[:, self._feet], now.advance)

    def place(self, now: Now) -> Array:
        """Put the prints on the floor."""
        marks = self._prints.seen(now.advance)
        over = now.floor + 0.006 * self.stage.unit
        marks[..., 1] = np.where(np.isnan(marks[..., 1]), np.nan, over)
        return upright(marks + self.stage.places[:, None, None])

    def clear(self) -> None:
        """Forget the prints."""
        self._prints.clear()


class Trails(Layer):
    """Where the effectors have been."""

    name = "trails"

    def build(self) -> None:
        """Make a number of marks for each effector of each figure."""
        stage, names = self.stage, self.stage.effectors.names
        self._trail = Trail((len(stage), len(names)), MARKS, 0.05 * stage.unit)
        marks = [Mark(0.013 * stage.unit, boxed(name)) for name in names for _ in range(MARKS)]
        colours = [effector_colour(i) for i in range(len(names)) for _ in range(MARKS)]
        self.add(marks * len(stage), colours)

    def note(self, now: Now) -> None:
        """Leave a mark where an effector has gone on."""
        self._trail.pass_through(now.effectors, now.advance)

    def place(self, now: Now) -> Array:
        """Put the marks where the effectors were."""
        return upright(self._trail.seen(now.advance) + self.stage.places[:, None, None])

    def clear(self) -> None:
        """Forget the marks."""
        self._trail.clear()


class Columns(Layer):
    """The columns of J as arrows at an effector.

    They show where each joint would move it.
    """

    name = "columns of J"

    def build(self) -> None:
        """Make an arrow per joint of each figure.

        It has the colour of the joint's axis.
        """
        n = len(self.stage.tree)
        arrow = Arrow(0.013 * self.stage.unit)
        self.add([arrow] * n * len(self.stage), [effector_colour(j) for j in range(n)])

    def place(self, now: Now) -> Array:
        """Draw arrows as `Stage.arrows` has them.

        A joint that does not move the effector has none.
        """
        if now.columns is None:
            return np.full((self.rows, 3, 4), np.nan)
        along = self.stage.arrows(now.columns)
        start = now.effectors[:, now.effector, None] + self.stage.places[:, None]
        short = np.linalg.norm(along, axis=-1) < 1e-6 * self.stage.unit
        start = np.broadcast_to(start, along.shape)
        return hidden(sticks(start, start + along), short).reshape(-1, 3, 4)


class Ellipsoids(Layer):
    """The manipulability ellipsoid at an effector, with its axes."""

    name = "ellipsoid"

    def build(self) -> None:
        """Make a ball of radius 1 per figure, with axes.

        `place` stretches them.
        """
        f = len(self.stage)
        axes = [Piece(i, Rod(-way, way, 0.012), PURPLE) for i in range(f) for way in np.eye(3)]
        self.meshes.append(Mesh(axes))
        ball = Ball(ORIGIN, (1, 1, 1))
        balls = [Piece(i, ball, SKY) for i in range(f)]
        self.meshes.append(Mesh(balls, opacity=0.4, hides=False, cut=(20, 6)))
        self.rows = f

    def place(self, now: Now) -> Array:
        """Stretch half axes to `SHOWN_AT` metres for 1 m/rad.

        Along a lost direction the half axis is thin.
        """
        if now.axes is None or now.lengths is None:
            return np.full((self.rows, 3, 4), np.nan)
        half = np.maximum(SHOWN_AT * now.lengths, 2e-3 * self.stage.unit)
        centre = now.effectors[:, now.effector] + self.stage.places
        return transforms(now.axes * half[:, None, :], centre)


class WorkspaceBounds(Layer):
    """The outer and inner bounds of each chain's reach.

    How far, and how near, it can stretch: a ball of wires, or a ring in a plane.
    """

    name = "reach"

    def build(self) -> None:
        """Make an outer and an inner surface per chain.

        Each figure has its own.
        """
        planar, chains = self.stage.planar, len(self.stage) * len(self.stage.effectors)
        surface = Ring(0.008) if planar else Wires()
        self.add([surface] * 2 * chains, [PURPLE, ORANGE], opacity=1.0 if planar else 0.45)

    def place(self, now: Now) -> Array:
        """Draw the outer and the inner surface in turn.

        There is no outer one if a chain is without end, no inner one if it has no hole.
        """
        f, k, places = len(self.stage), len(self.stage.effectors), self.stage.places
        found = np.full((f, k, 2, 3, 4), np.nan)
        axes = np.eye(3) if self.stage.normal is None else picture_axes(self.stage.normal)
        for i, (centre, inner, outer) in enumerate(now.reach):
            for side, radius in enumerate((outer, inner)):
                if 1e-6 * self.stage.unit < radius < np.inf:
                    found[:, i, side, :, :3] = radius * axes
                    found[:, i, side, :, 3] = centre + now.origins[:, now.effector] + places
        return found.reshape(-1, 3, 4)


class RecordedBones(Layer):
    """The bones of whom a motion was recorded from.

    They are seen through the figure that follows it, and are pale and thin.
    """

    name = RECORDED_BONES

    def build(self) -> None:
        """Make `BONES` rods for each figure."""
        rod = Rod(ORIGIN, (0, 1, 0), 0.011 * self.stage.unit)
        rods = [rod] * BONES * len(self.stage)
        self.add(rods, [PURPLE], opacity=0.75, through=True)

    def place(self, now: Now) -> Array:
        """Stretch rods along the longest bones."""
        rows = np.full((len(self.stage), BONES, 3, 4), np.nan)
        for i, bones in enumerate(now.skeletons):
            length = np.linalg.norm(bones[:, 1] - bones[:, 0], axis=-1)
            longest = np.argsort(-length, kind="stable")[:BONES]
            longest = longest[length[longest] > 1e-6 * self.stage.unit]
            start, end = (bones[longest, j] + self.stage.places[i] for j in (0, 1))
            rows[i, : len(longest)] = sticks(start, end)
        return rows.reshape(-1, 3, 4)


LAYERS: dict[str, type[Layer]] = {
    layer.name: layer
    for layer in (
        *(WorldAxes, JointAxes, Footprints, Trails, Columns, Ellipsoids, WorkspaceBounds),
        RecordedBones,
    )
}
