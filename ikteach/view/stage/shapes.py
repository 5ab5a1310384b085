"""Surfaces and wires as points and what joins them. Metres; nothing here knows of a screen."""

from collections.abc import Sequence
from functools import cache
from typing import NamedTuple

import numpy as np

from ikteach.arrays import Array, ArrayLike, Index, frozen
from ikteach.view.stage.forms import Ring, Sole, Wires


class Shape(NamedTuple):
    """Triangles, or segments of wires.

    points   (v, 3) [m]
    joined   (t, 3) the points of each triangle, anticlockwise from outside; or (t, 2) of a segment
    normals  (v, 3) of length 1; None where nothing shades it
    """

    points: Array
    joined: Index
    normals: Array | None = None

    def at(self, place: Array) -> "Shape":
        """Carry it by [R | p] (3, 4); the normals are lost."""
        return Shape(self.points @ place[:, :3].T + place[:, 3], self.joined)


def revolved(outline: ArrayLike, around: int) -> Shape:
    """Turn an outline (p, 2) around the y axis.

    The outline is of radii and heights, from the top down.
    """
    radius, height = np.transpose(np.asarray(outline, dtype=float))[..., None]
    turn = (2 * np.arange(around + 1) + 1) * np.pi / around  # of 4, a box along the axes
    y = np.broadcast_to(height, (len(height), around + 1))
    points = np.stack([radius * np.cos(turn), y, radius * np.sin(turn)], axis=-1)
    a = np.arange(points[..., 0].size).reshape(y.shape)[:-1, :-1].ravel()
    b = a + around + 1
    above, below = np.stack([a, a + 1, b], -1), np.stack([a + 1, b + 1, b], -1)
    on_axis = radius[:, 0] <= 1e-8 * radius.max()
    at_pole = np.repeat(on_axis, around)  # there, one is a line
    corners = [above[~at_pole[:-around]], below[~at_pole[around:]]]
    return Shape(points.reshape(-1, 3), np.concatenate(corners))


@cache
def globe(around: int, half: int) -> Shape:
    """Make a ball of radius 1, in slices and rings.

    It has `around` slices, and `half` rings in each half. The equator is there twice, a hair above
    and below, so that a limb can be drawn apart there.
    """
    north = np.linspace(0, np.pi / 2, half + 1) - 1e-9
    down = np.concatenate([north, np.pi - north[::-1]])
    points, corners, _ = revolved(np.c_[np.sin(down), np.cos(down)], around)
    return Shape(frozen(points), frozen(corners, np.intp), frozen(points))


def rod(radius: float, around: int = 6) -> Shape:
    """Make a rod one metre along y from the origin."""
    return revolved([(0, 1), (radius, 1), (radius, 0), (0, 0)], around)


def arrow(radius: float) -> Shape:
    """Make an arrow one metre along y from the origin."""
    return revolved([(0, 1), (2.4 * radius, 0.78), (radius, 0.78), (radius, 0), (0, 0)], 7)


def mark(radius: float, boxed: bool) -> Shape:
    """Make a box, or a ball as rough as possible.

    Such a ball has eight triangles.
    """
    if boxed:
        side = 0.78 * radius
        wide = side * np.sqrt(2)
        return revolved([(0, side), (wide, side), (wide, -side), (0, -side)], 4)
    return revolved([(0, radius), (radius, 0), (0, -radius)], 4)


def sole(wide: float, long: float, boxed: bool) -> Shape:
    """Make a flat print: a rectangle, or an ellipse."""
    disc = revolved([(0, 0), (1.1, 0)], 4) if boxed else revolved([(0, 0), (1, 0)], 16)
    return Shape(disc.points * [wide, 1, long], disc.joined)


def ring(thick: float) -> Shape:
    """Make a ring of radius 1 around the z axis."""
    turn = np.linspace(0, -2 * np.pi, 7)
    points, corners, _ = revolved(np.c_[1 + thick * np.cos(turn), thick * np.sin(turn)], 96)
    return Shape(points[:, [0, 2, 1]] * [1, 1, -1], corners)


def wires(heights: Sequence[float], meridians: int) -> Shape:
    """Make a ball of radius 1 of wires.

    They are parallels at these heights, and meridians.
    """
    turn = np.linspace(0, 2 * np.pi, 37)
    c, s, o = np.cos(turn), np.sin(turn), np.zeros_like(turn)
    rings = [np.c_[np.sqrt(1 - y * y) * c, o + y, np.sqrt(1 - y * y) * s] for y in heights]
    for a in np.arange(meridians) * np.pi / meridians:
        rings.append(np.c_[np.cos(a) * c, s, np.sin(a) * c])
    first = np.arange(len(rings) * len(turn)).reshape(len(rings), -1)[:, :-1].ravel()
    return Shape(np.concatenate(rings), np.stack([first, first + 1], axis=-1))


@cache
def segments(form: Ring | Wires) -> Shape:
    """Make segments of a form that is drawn with a pen."""
    return wires(*form) if isinstance(form, Wires) else _circle()


def _circle(around: int = 96) -> Shape:
    """Make a circle of radius 1 around the z axis."""
    turn = np.linspace(0, 2 * np.pi, around + 1)
    first = np.arange(around)
    points = np.c_[np.cos(turn), np.sin(turn), 0 * turn]
    return Shape(points, np.stack([first, first + 1], axis=-1))


@cache
def flat(form: Sole) -> Array:
    """Give the outline (p, 3) of a print."""
    points = sole(*form).points
    return points[len(points) // 2 :]  # after those in its middle
