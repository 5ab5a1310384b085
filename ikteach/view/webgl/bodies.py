"""The surface of a body: balls and limbs as triangles."""

from collections.abc import Mapping, Sequence

import numpy as np

from ikteach.arrays import Array
from ikteach.body.rotation import sticks
from ikteach.view.stage.shapes import Shape, globe
from ikteach.view.stage.skin import Ball, Limb, Part
from ikteach.view.webgl.mesh import Piece

FINE, PLAIN = (10, 3), (8, 2)  # slices of a ball, rings of each half: of one figure, of several


def pieces(
    parts: Sequence[Part], rows: Mapping[str | None, int], cut: tuple[int, int] = FINE
) -> list[Piece]:
    """The parts, each moved by the row of its joint."""
    ball = globe(*cut)
    return [
        Piece(
            rows[part.joint],
            _ball(part, ball) if isinstance(part, Ball) else _limb(part, ball),
            part.colour,
        )
        for part in sorted(parts, key=lambda part: rows[part.joint])
    ]


def _ball(part: Ball, globe: Shape) -> Shape:
    """An ellipsoid."""
    radii = np.asarray(part.radii, dtype=float)
    normals = globe.points / radii
    normals /= np.linalg.norm(normals, axis=-1, keepdims=True)
    return Shape(part.centre + globe.points * radii, globe.joined, normals)


def _limb(part: Limb, globe: Shape) -> Shape:
    """A rod with round ends: half a ball, a cone, half a ball."""
    start, end = np.asarray(part.start, dtype=float), np.asarray(part.end, dtype=float)
    R = sticks(start, end)[:, :3]
    length = np.linalg.norm(end - start)
    R[:, 1] /= length  # the stick is stretched; a surface is only turned
    far = globe.points[:, 1] > 0
    surface: Array = globe.points * np.where(far, part.thin, part.thick)[:, None]
    surface[far, 1] += length
    return Shape(start + surface @ R.T, globe.joined, globe.points @ R.T)
