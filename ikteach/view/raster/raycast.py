"""Solid pictures without a graphics card: rays against quadrics, in numpy.

Every solid is a surface XᵀQX = 0 with X = (x, y, z, 1), kept where some coordinates w·X lie within
bounds: an ellipsoid, a cone cut at both ends, the six faces of a box. A frame T takes Q to
T⁻ᵀ Q T⁻¹ and w to w T⁻¹; where a ray t·d from the eye meets the surface is a quadratic equation.
"""

from collections.abc import Sequence
from math import radians, tan
from typing import Any, NamedTuple

import numpy as np

from ikteach.arrays import Array, ArrayLike
from ikteach.body.rotation import sticks
from ikteach.formats.movie import Pixels
from ikteach.view.stage.colours import rgb
from ikteach.view.stage.forms import Arrow, Ball, Box, Form, Limb, Mark, Rod
from ikteach.view.stage.stage import FIELD, picture_axes

AMBIENT, DIFFUSE = 0.5, 0.62
LIGHT = np.array([2.0, 4.0, 3.0]) / np.sqrt(29)  # towards it, in the world
NEAR = 0.05  # [units of the eye]
ANYWHERE = 1e9
FLAT = 30  # how many times as long as short a solid is that single precision can draw
HEAD = 0.78  # where the head of an arrow begins


class Solid(NamedTuple):
    """A quadric in the frame of joint `frame`.

    Q      (4, 4)
    W      (c, 4) coordinates that must lie within ±bounds (c,) of 0
    balls  (2, 4) x, y, z, r of two balls that together hold all of it
    """

    frame: int
    Q: Array
    W: Array
    bounds: Array
    balls: Array
    colour: Array


def solids(form: Form, colour: str, frame: int) -> list[Solid]:
    """Make solids of a form.

    A form that is flat, or made of lines, has none.
    """
    match form:
        case Ball(centre, radii):
            return [solid_ellipsoid(centre, radii, colour, frame)]
        case Limb(start, end, thick, thin):
            tips = [
                solid_ellipsoid(at, (r,) * 3, colour, frame)
                for at, r in ((start, thick), (end, thin))
            ]
            return [solid_rod(start, end, thick, thin, colour, frame), *tips]
        case Rod(start, end, radius):
            return [solid_rod(start, end, radius, radius, colour, frame)]
        case Arrow(radius):
            shaft = solid_rod((0, 0, 0), (0, HEAD, 0), radius, radius, colour, frame)
            return [shaft, solid_rod((0, HEAD, 0), (0, 1, 0), 2.4 * radius, 0, colour, frame)]
        case Box(half):
            return solid_box(half, colour, frame)
        case Mark(radius, boxed):
            if boxed:
                return solid_box(0.78 * radius, colour, frame)
            return [solid_ellipsoid((0, 0, 0), (radius,) * 3, colour, frame)]
        case _:
            return []


def solid_ellipsoid(centre: ArrayLike, radii: ArrayLike, colour: str, frame: int) -> Solid:
    """Make Q of Σ ((x − c)/r)² = 1."""
    c, r = np.asarray(centre, dtype=float), np.asarray(radii, dtype=float)
    to_unit = np.diag([*(1 / r), 1.0])
    to_unit[:3, 3] = -c / r
    Q = to_unit.T @ np.diag([1.0, 1, 1, -1]) @ to_unit
    ball = [*c, r.max()]
    free = np.full(2, ANYWHERE)
    return Solid(frame, Q, np.zeros((2, 4)), free, np.array([ball, ball]), rgb(colour))


def solid_rod(
    start: ArrayLike, end: ArrayLike, thick: float, thin: float, colour: str, frame: int
) -> Solid:
    """Make Q of x² + z² = (thick + (thin − thick) y)², y from 0 to 1 along start → end."""
    start, end = np.asarray(start, dtype=float), np.asarray(end, dtype=float)
    to_rod = np.linalg.inv(homogeneous(sticks(start, end)))
    local = np.zeros((4, 4))
    local[0, 0] = local[2, 2] = 1
    slope = np.array([0, thin - thick, 0, thick])
    Q = to_rod.T @ (local - np.outer(slope, slope)) @ to_rod
    W = np.zeros((2, 4))
    W[0] = [0, 1, 0, -0.5] @ to_rod
    balls = np.array([[*start, thick], [*end, thin]])
    return Solid(frame, Q, W, np.array([0.5, ANYWHERE]), balls, rgb(colour))


def solid_box(half: float, colour: str, frame: int) -> list[Solid]:
    """Make three pairs of faces, x² = half².

    Each is cut by the other two.
    """
    faces = []
    for axis in range(3):
        Q = np.diag([0.0, 0, 0, -half * half])
        Q[axis, axis] = 1
        W = np.eye(4)[[other for other in range(3) if other != axis]]
        ball = [0, 0, 0, half * np.sqrt(3)]
        faces.append(Solid(frame, Q, W, np.full(2, half), np.array([ball, ball]), rgb(colour)))
    return faces


class Eye:
    """A camera at `position` (3,) that looks at `at` (3,), with y upwards in the picture.

    size   (width, height) [pixels]
    field  the angle that the shorter side of the picture covers [degrees]
    unit   in which it measures [m]: about the size of the thing that it looks at
    """

    def __init__(
        self,
        position: ArrayLike,
        at: ArrayLike,
        size: tuple[int, int],
        field: float = FIELD,
        unit: float = 1.0,
    ) -> None:
        eye = np.asarray(position, dtype=float)
        self.axes = picture_axes(np.subtract(eye, at)).T  # x right, y up, z towards the eye
        self.view = np.eye(4)  # from the world to these, in units from the eye
        self.view[:3, :3] = self.axes / unit
        self.view[:3, 3] = -self.view[:3, :3] @ eye
        self.size = width, height = size
        self.pixel = 2 * tan(radians(field / 2)) / min(height, width)  # at a distance of 1
        self.x = ((np.arange(width) + 0.5 - width / 2) * self.pixel).astype("f4")
        self.y = ((height / 2 - 0.5 - np.arange(height)) * self.pixel).astype("f4")

    def seen(self, points: ArrayLike) -> Array:
        """Give points (..., 3) in the axes of the eye.

        They are in units from it.
        """
        return np.asarray(points, dtype=float) @ self.view[:3, :3].T + self.view[:3, 3]

    def project(self, points: ArrayLike) -> tuple[Array, Array]:
        """Give pixels (..., 2) and distances of points (..., 3).

        A distance is how far in front of the eye a point is [units].
        """
        seen = self.seen(points)
        return self.flat(seen), -seen[..., 2]

    def flat(self, seen: Array) -> Array:
        """Give pixels (..., 2) of points (..., 3) in the axes of the eye."""
        across = seen[..., :2] / np.maximum(-seen[..., 2], NEAR)[..., None] / self.pixel
        return across * [1, -1] + np.array(self.size) / 2


def draw(
    pixels: Pixels, eye: Eye, parts: Sequence[Solid], frames: Array, nearness: Any = None
) -> Any:
    """Draw the solids into pixels (height, width, 3), each in its frame (4, 4) of `frames`.

    nearness  1/t of the picture so far, (height, width), so that 0 is infinitely far; it is written
              to, and given back
    """
    if nearness is None:
        nearness = np.zeros(pixels.shape[:2], dtype="f4")
    if not parts:
        return nearness
    T = eye.view @ frames[[part.frame for part in parts]]
    inverse = np.linalg.inv(T)
    Q = inverse.mT @ np.array([part.Q for part in parts]) @ inverse
    W = np.array([part.W for part in parts]) @ inverse
    balls = np.array([part.balls for part in parts])
    centres = np.einsum("nij,nbj->nbi", T[:, :3, :3], balls[..., :3]) + T[:, None, :3, 3]
    stretch = np.linalg.norm(T[:, :3, :3], axis=1)
    most = stretch.max(axis=-1)
    windows = _windows(eye, centres, balls[..., 3] * most[:, None])
    light = (eye.axes @ LIGHT).astype("f4")
    plain = most < FLAT * stretch.min(axis=-1)  # what is flatter needs all digits
    for i, part in enumerate(parts):
        digits = "f4" if plain[i] else "f8"
        _trace(
            pixels, nearness, eye, windows[i], Q[i].astype(digits), W[i].astype(digits), part, light
        )
    return nearness


def _windows(eye: Eye, centres: Array, radii: Array) -> Any:
    """Find the pixels (n, 4) left, right, top, bottom that balls (n, 2) can cover."""
    x, y, away = centres[..., 0], centres[..., 1], -centres[..., 2]
    near = np.maximum(away - radii, NEAR)
    far = away + radii

    def bound(at: Array, side: int) -> Array:
        edge = at + side * radii
        ends = edge / near, edge / far
        return np.maximum(*ends) if side > 0 else np.minimum(*ends)

    width, height = eye.size
    left = (bound(x, -1).min(axis=-1) / eye.pixel + width / 2).clip(0, width)
    right = (bound(x, 1).max(axis=-1) / eye.pixel + width / 2 + 1).clip(0, width)
    top = (height / 2 - bound(y, 1).max(axis=-1) / eye.pixel).clip(0, height)
    bottom = (height / 2 - bound(y, -1).min(axis=-1) / eye.pixel + 1).clip(0, height)
    return np.stack([left, right, top, bottom], axis=-1).astype(int)


def _trace(
    pixels: Pixels, nearness: Any, eye: Eye, window: Any, Q: Any, W: Any, part: Solid, light: Any
) -> None:
    """Follow the rays of a window to one solid, and draw it where it is nearer."""
    left, right, top, bottom = window
    if left >= right or top >= bottom:
        return
    x, y = eye.x[left:right], eye.y[top:bottom, None]
    # At the point t (x, y, −1): A t² + 2 B t + C = 0.
    A = (Q[0, 0] * x - 2 * Q[0, 2]) * x + ((Q[1, 1] * y - 2 * Q[1, 2]) * y + Q[2, 2])
    A += (2 * Q[0, 1] * x) * y
    B = (Q[0, 3] * x) + (Q[1, 3] * y - Q[2, 3])
    D = B * B - A * Q[3, 3]
    rows, columns = np.nonzero(D > 0)
    if not len(rows):
        return
    A, B, D = A[rows, columns], B[rows, columns], D[rows, columns]
    t = Q[3, 3] / (np.sqrt(D) - B)  # the nearer of the two; no division by A, which may be 0
    x, y = x[columns], y[rows, 0]
    seen = t > NEAR
    for w, bound in zip(W, part.bounds, strict=True):
        if bound < ANYWHERE:
            seen &= abs((w[0] * x + w[1] * y - w[2]) * t + w[3]) <= bound
    rows, columns = rows + top, columns + left
    seen &= 1 / t > nearness[rows, columns]
    rows, columns, t, x, y = rows[seen], columns[seen], t[seen], x[seen], y[seen]
    nearness[rows, columns] = 1 / t
    point = np.stack([x * t, y * t, -t, np.ones_like(t)])
    normal = Q[:3] @ point
    facing = (light @ normal) / np.sqrt((normal * normal).sum(axis=0))
    shade = AMBIENT + DIFFUSE * np.maximum(facing, 0)
    pixels[rows, columns] = np.minimum(part.colour * shade[:, None], 255)


def homogeneous(matrices: Array) -> Array:
    """Put the row 0 0 0 1 under [R | p] (..., 3, 4)."""
    last = np.broadcast_to([0.0, 0, 0, 1], (*matrices.shape[:-2], 1, 4))
    return np.concatenate([matrices, last], axis=-2)
