"""Forms that a scene is made of. Metres; each renderer draws them in its own way."""

from collections.abc import Iterable, Sequence
from typing import NamedTuple

from ikteach.arrays import Array

Vector = Sequence[float] | Array

ORIGIN = (0, 0, 0)


class Ball(NamedTuple):
    """An ellipsoid with these half axes."""

    centre: Vector
    radii: Vector


class Limb(NamedTuple):
    """A rod with round ends.

    Its radius is `thick` at the start and `thin` at the end.
    """

    start: Vector
    end: Vector
    thick: float
    thin: float


class Rod(NamedTuple):
    """A thin rod with flat ends."""

    start: Vector
    end: Vector
    radius: float


class Arrow(NamedTuple):
    """An arrow one metre along y from the origin."""

    radius: float


class Box(NamedTuple):
    """A cube around the origin."""

    half: float


class Mark(NamedTuple):
    """A dot of a trail: a ball or a box.

    It is as rough as may be.
    """

    radius: float
    boxed: bool


class Sole(NamedTuple):
    """A flat print on the plane y = 0: an ellipse, or a rectangle."""

    wide: float
    long: float
    boxed: bool


class Ring(NamedTuple):
    """A ring of radius 1 around the z axis."""

    thick: float


class Wires(NamedTuple):
    """A ball of radius 1, made of wires.

    They are parallels at these heights, and circles through the poles.
    """

    heights: tuple[float, ...] = (-0.71, 0.0, 0.71)
    meridians: int = 3


class Grid(NamedTuple):
    """Squares of the plane y = 0 around the origin.

    They have the colours of the paper.
    """

    side: float
    squares: int


Form = Ball | Limb | Rod | Arrow | Box | Mark | Sole | Ring | Wires | Grid

STATIC = -1  # the row of a piece that nothing moves


class Piece(NamedTuple):
    """A form in one colour, moved by a row [R | p] of its layer."""

    row: int
    form: Form
    colour: str


class Mesh(NamedTuple):
    """Pieces that are drawn together, all solid or all lines.

    opacity  1 where nothing shines through
    hides    whether it hides what is behind it
    cut      slices of a ball, and rings of each half, where it is made of triangles
    single   whether each piece is a thing of its own, to be taken hold of
    through  whether it is seen through whatever stands before it
    """

    pieces: Sequence[Piece]
    opacity: float = 1.0
    hides: bool = True
    cut: tuple[int, int] = (10, 3)
    single: bool = False
    through: bool = False


class Label(NamedTuple):
    """Words at a point of the world.

    They always face the eye. `height` is in metres.
    """

    at: Vector
    text: str
    colour: str
    height: float


def kinds(names: Sequence[str], w: Iterable[float]) -> list[str]:
    """Tell the shapes of targets with these names and w.

    "ball" or "box", and "arrow" of a direction (w = 0).
    """
    each = zip(names, w, strict=True)
    return [("box" if boxed(name) else "ball") if point else "arrow" for name, point in each]


def boxed(name: str) -> bool:
    """Tell whether marks of this name are boxes.

    Marks on the right are, so that colour is not the only sign.
    """
    return name.endswith(".r")
