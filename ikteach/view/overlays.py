"""The layers over the figures: made when first wanted, told arrays, moved by the driver."""

from collections.abc import Callable

import numpy as np
import pythreejs as three

from ikteach.arrays import Array
from ikteach.body.rotation import quaternion_from_y, sticks, transforms
from ikteach.view import solids
from ikteach.view.skin import BLUE, EFFECTOR_COLOURS, GREEN, ORANGE, PURPLE, RED, SKY
from ikteach.view.solids import HIDDEN, mark_shape
from ikteach.view.stage import LAYERS, SHOWN_AT, Now, Stage
from ikteach.view.trails import MARKS, PRINTS, Prints, Trail, feet

AXIS_COLOURS = (RED, GREEN, BLUE)
Joints = list[list[three.Group]]  # the groups of the joints, a list a figure


class Layer:
    """What one layer adds to the scene.

    nodes   what the driver moves; `place` gives a matrix for each, in their order
    things  what is made visible and invisible
    roots   those of them that the scene has to hold
    """

    def __init__(self, stage: Stage, joints: Joints) -> None:
        self.stage = stage
        self.nodes: list[three.Group] = []
        self.things: list[three.Object3D] = []
        self.roots: list[three.Object3D] = []
        self.build(joints)

    def build(self, joints: Joints) -> None:
        """Make the objects."""
        raise NotImplementedError

    def place(self, now: Now) -> Array:
        """Where the nodes are, (len(nodes), 3, 4)."""
        return np.zeros((0, 3, 4))

    def clear(self) -> None:
        """Forget what was before."""

    def hold(self, *objects: three.Object3D) -> None:
        """Put objects into the scene that are shown and hidden together."""
        root = three.Group(children=list(objects))
        self.things, self.roots = [root], [root]


class WorldAxes(Layer):
    """x, y and z through the origin, each with its letter."""

    def build(self, joints: Joints) -> None:
        """Three half axes where each figure stands."""
        unit, parts = self.stage.unit, []
        shaft = solids.rod(0.7 * unit, 0.012 * unit)
        looks = [three.MeshBasicMaterial(color=colour) for colour in AXIS_COLOURS]
        for place in self.stage.places[:1] if self.stage.overlaid else self.stage.places:
            for way, letter, look in zip(np.eye(3), "xyz", looks, strict=True):
                middle, end = place + 0.35 * unit * way, place + 0.78 * unit * way
                parts += [
                    three.Mesh(
                        shaft, look, position=middle.tolist(), quaternion=quaternion_from_y(way)
                    ),
                    solids.label(letter, look.color, 0.14 * unit, end.tolist()),
                ]
        self.hold(*parts)


class JointAxes(Layer):
    """A rod along the axis of every joint. It hangs on the joint, so that nothing moves it."""

    def build(self, joints: Joints) -> None:
        """A rod for each joint; an axis is the same in its joint's own frame, at any angle."""
        unit, looks = self.stage.unit, solids.paints()
        shaft = solids.rod(0.32 * unit, 0.009 * unit)
        ways = [quaternion_from_y(axis) for axis in self.stage.tree.axes]
        for figure in joints:
            for j, (group, way) in enumerate(zip(figure, ways, strict=True)):
                thing = three.Mesh(shaft, looks[j % len(looks)], quaternion=way)
                group.children = [*group.children, thing]
                self.things.append(thing)


class Trails(Layer):
    """Where the effectors have been."""

    def build(self, joints: Joints) -> None:
        """A ring of marks for each effector of each figure."""
        stage = self.stage
        count = (len(stage), len(stage.effectors))
        self._trail = Trail(count, MARKS, 0.05 * stage.unit)
        shapes = []
        for i, name in enumerate(stage.effectors.names):
            shape = mark_shape(name, 0.013 * stage.unit, (6, 4))
            shapes.append((shape, three.MeshBasicMaterial(color=effector_colour(i))))
        for _ in range(len(stage)):
            for shape in shapes:
                self.nodes += [solids.moved(*shape) for _ in range(MARKS)]
        self.hold(*self.nodes)

    def place(self, now: Now) -> Array:
        """The marks, with the newest where the effectors are."""
        marks = self._trail.pass_through(now.effectors, now.advance)
        return _at(marks + self.stage.places[:, None, None])

    def clear(self) -> None:
        """Forget the marks."""
        self._trail.clear()


class Footprints(Layer):
    """Where the feet have come down."""

    def build(self, joints: Joints) -> None:
        """A ring of prints for each foot of each figure."""
        stage = self.stage
        self._feet = feet(stage.effectors)
        self._prints = Prints((len(stage), len(self._feet)), PRINTS)
        for _ in range(len(stage)):
            for i in self._feet:
                shape = mark_shape(stage.effectors.names[i], 1.0)
                look = three.MeshBasicMaterial(
                    color=effector_colour(i), transparent=True, opacity=0.55
                )
                self.nodes += [solids.moved(shape, look) for _ in range(PRINTS)]
        self.hold(*self.nodes)

    def place(self, now: Now) -> Array:
        """The prints, on the floor."""
        marks = self._prints.pass_through(now.effectors[:, self._feet], now.advance)
        marks[..., 1] = np.where(np.isnan(marks[..., 1]), np.nan, now.floor + 0.006)
        sole = self.stage.unit * np.array([0.045, 0.004, 0.11])
        return _at(marks + self.stage.places[:, None, None], sole)

    def clear(self) -> None:
        """Forget the prints."""
        self._prints.clear()


class Columns(Layer):
    """The columns of J as arrows at an effector: where each joint would move it."""

    def build(self, joints: Joints) -> None:
        """An arrow for each joint of each figure, in the colour of the joint's axis."""
        shape, looks = (
            solids.arrow(0.013 * self.stage.unit),
            solids.paints(three.MeshLambertMaterial),
        )
        for _ in range(len(self.stage)):
            self.nodes += [
                solids.moved(shape, looks[j % len(looks)]) for j in range(len(self.stage.tree))
            ]
        self.hold(*self.nodes)

    def place(self, now: Now) -> Array:
        """Arrows of `SHOWN_AT` metres for 1 m/rad; none for a joint that does not move it."""
        if now.columns is None:
            return np.broadcast_to(HIDDEN, (len(self.nodes), 3, 4))
        start = now.effectors[:, now.effector, None] + self.stage.places[:, None]
        along = SHOWN_AT * now.columns.swapaxes(-1, -2)
        short = np.linalg.norm(along, axis=-1) < 1e-6
        start = np.broadcast_to(start, along.shape)
        found = sticks(start, np.where(short[..., None], start + [0, 1, 0], start + along))
        return np.where(short[..., None, None], HIDDEN, found).reshape(-1, 3, 4)


class Ellipsoids(Layer):
    """The manipulability ellipsoid at an effector, with its axes."""

    def build(self, joints: Joints) -> None:
        """A ball of radius 1 for each figure, to be stretched."""
        ball, shaft = three.SphereBufferGeometry(1, 28, 20), solids.rod(2.0, 0.012)
        line = three.MeshBasicMaterial(color=PURPLE)
        look = three.MeshLambertMaterial(color=SKY, transparent=True, opacity=0.4, depthWrite=False)
        for _ in range(len(self.stage)):
            axes = [three.Mesh(shaft, line, quaternion=quaternion_from_y(w)) for w in np.eye(3)]
            self.nodes.append(solids.node([*axes, three.Mesh(ball, look)]))
        self.hold(*self.nodes)

    def place(self, now: Now) -> Array:
        """Half axes of `SHOWN_AT` metres for 1 m/rad; a lost way has a thin one."""
        if now.axes is None or now.lengths is None:
            return np.broadcast_to(HIDDEN, (len(self.nodes), 3, 4))
        half = np.maximum(SHOWN_AT * now.lengths, 2e-3 * self.stage.unit)
        centre = now.effectors[:, now.effector] + self.stage.places
        return transforms(now.axes * half[:, None, :], centre)


class Reach(Layer):
    """How far, and how near, each chain can stretch: a ball, or a ring for a planar figure."""

    def build(self, joints: Joints) -> None:
        """An outer and an inner surface for each chain of each figure."""
        if self.stage.planar:
            round_as = three.TorusBufferGeometry(1, 0.008, 6, 96)
            looks = [three.MeshBasicMaterial(color=colour) for colour in (PURPLE, ORANGE)]
        else:
            round_as = three.SphereBufferGeometry(1, 28, 18)
            looks = [
                three.MeshBasicMaterial(
                    color=colour, wireframe=True, transparent=True, opacity=opacity
                )
                for colour, opacity in ((PURPLE, 0.16), (ORANGE, 0.5))
            ]
        for _ in range(len(self.stage) * len(self.stage.effectors)):
            self.nodes += [solids.moved(round_as, look) for look in looks]
        self.hold(*self.nodes)

    def place(self, now: Now) -> Array:
        """Outer and inner in turn; hidden where there is no such chain, or no hole."""
        f, k = len(self.stage), len(self.stage.effectors)
        found = np.tile(HIDDEN, (f, k, 2, 1, 1))
        for i, (centre, inner, outer) in enumerate(now.reach):
            for side, radius in enumerate((outer, inner)):
                if radius > 1e-6:
                    found[:, i, side, :, :3] = radius * np.eye(3)
                    found[:, i, side, :, 3] = centre + self.stage.places
        return found.reshape(-1, 3, 4)


MAKERS: dict[str, Callable[[Stage, Joints], Layer]] = dict(
    zip(
        LAYERS,
        (WorldAxes, JointAxes, Footprints, Trails, Columns, Ellipsoids, Reach),
        strict=True,
    )
)


def effector_colour(i: int) -> str:
    """The colour of effector i and its target."""
    return EFFECTOR_COLOURS[i % len(EFFECTOR_COLOURS)]


def _at(points: Array, size: Array | float = 1.0) -> Array:
    """Upright matrices (points, 3, 4) at these points, so large; hidden where they are NaN."""
    flat = points.reshape(-1, 3)
    upright = transforms(np.broadcast_to(np.eye(3) * size, (len(flat), 3, 3)), flat)
    return np.where(np.isnan(flat[:, :1, None]), HIDDEN, upright)
