"""Forms as surfaces of triangles, or as wires."""

import numpy as np

from ikteach.arrays import Array
from ikteach.body.rotation import sticks
from ikteach.view.stage import shapes
from ikteach.view.stage.forms import Arrow, Ball, Box, Form, Limb, Mark, Ring, Rod, Sole, Wires
from ikteach.view.stage.shapes import Shape


def surface(form: Form, cut: tuple[int, int]) -> Shape:
    """Make the surface of a form.

    cut  slices of a ball in it, and rings of each half
    """
    match form:
        case Ball():
            return _ball(form, shapes.globe(*cut))
        case Limb():
            return _limb(form, shapes.globe(*cut))
        case Rod(start, end, radius):
            return shapes.rod(radius).at(sticks(np.array(start), np.array(end)))
        case Arrow(radius):
            return shapes.arrow(radius)
        case Box(half):
            return shapes.mark(half / 0.78, True)
        case Mark(radius, boxed):
            return shapes.mark(radius, boxed)
        case Sole():
            return shapes.sole(*form)
        case Ring(thick):
            return shapes.ring(thick)
        case Wires():
            return shapes.segments(form)
        case _:
            raise TypeError(f"no surface is known of {form}")


def _ball(ball: Ball, globe: Shape) -> Shape:
    """Stretch a globe to an ellipsoid."""
    radii = np.asarray(ball.radii, dtype=float)
    normals = globe.points / radii
    normals /= np.linalg.norm(normals, axis=-1, keepdims=True)
    return Shape(ball.centre + globe.points * radii, globe.joined, normals)


def _limb(limb: Limb, globe: Shape) -> Shape:
    """Put half a ball, a cone and half a ball together."""
    start, end = np.asarray(limb.start, dtype=float), np.asarray(limb.end, dtype=float)
    R = sticks(start, end)[:, :3]
    length = np.linalg.norm(end - start)
    R[:, 1] /= length  # the stick is stretched; a surface is only turned
    far = globe.points[:, 1] > 0
    points: Array = globe.points * np.where(far, limb.thin, limb.thick)[:, None]
    points[far, 1] += length
    return Shape(start + points @ R.T, globe.joined, globe.points @ R.T)
