"""The surface of a body: balls and limbs as triangles, all parts of a joint in one mesh.

What is slow to draw is not triangles but meshes, for each is a call of its own. A human has 70
parts; as 13 meshes it is drawn about twice as often (`tests/bench/live.py`).
"""

from collections.abc import Sequence

import numpy as np
import pythreejs as three
from matplotlib.colors import to_rgb

from ikteach.arrays import Array, Index
from ikteach.body.rotation import sticks
from ikteach.view.skin import Ball, Limb, Part

AROUND, HALF = 12, 4  # a ball is cut into so many slices, and each half of it into so many rings


def mesh(parts: Sequence[Part], opacity: float = 1.0) -> three.Mesh:
    """The parts of one joint, each in its colour."""
    surfaces = [_ball(part) if isinstance(part, Ball) else _limb(part) for part in parts]
    points = np.concatenate([surface[0] for surface in surfaces])
    normals = np.concatenate([surface[1] for surface in surfaces])
    colours = np.repeat([to_rgb(part.colour) for part in parts], len(GLOBE), axis=0)
    firsts = len(GLOBE) * np.arange(len(parts), dtype=np.intp)
    corners = firsts[:, None, None] + TRIANGLES
    shape = three.BufferGeometry(
        attributes={
            "position": three.BufferAttribute(points.astype(np.float32)),
            "normal": three.BufferAttribute(normals.astype(np.float32)),
            "color": three.BufferAttribute(colours.astype(np.float32)),
        },
        index=three.BufferAttribute(corners.astype(np.uint16).ravel()),
    )
    see_through = {"transparent": True, "opacity": opacity} if opacity < 1 else {}
    return three.Mesh(shape, three.MeshLambertMaterial(vertexColors="VertexColors", **see_through))


def _ball(ball: Ball) -> tuple[Array, Array]:
    """Points and unit normals of an ellipsoid."""
    radii = np.asarray(ball.radii, dtype=float)
    normals = GLOBE / radii
    normals /= np.linalg.norm(normals, axis=-1, keepdims=True)
    return ball.centre + GLOBE * radii, normals


def _limb(limb: Limb) -> tuple[Array, Array]:
    """Points and unit normals of a rod with round ends: half a ball, a cone, half a ball."""
    start, end = np.asarray(limb.start, dtype=float), np.asarray(limb.end, dtype=float)
    R = sticks(start, end)[:, :3]
    length = np.linalg.norm(end - start)
    R[:, 1] /= length  # the stick is stretched; a surface is only turned
    far = GLOBE[:, 1] > 0
    surface = GLOBE * np.where(far, limb.thin, limb.thick)[:, None]
    surface[far, 1] += length
    return start + surface @ R.T, GLOBE @ R.T


def _globe() -> tuple[Array, Index]:
    """Unit vectors (v, 3) from pole to pole, and the corners (t, 3) of the triangles between them.

    The equator is there twice, a hair above and below, so that a limb can be drawn apart there.
    """
    north = np.linspace(0, np.pi / 2, HALF + 1) - 1e-9
    down = np.concatenate([north, np.pi - north[::-1]])[:, None]
    turn = np.linspace(0, 2 * np.pi, AROUND + 1)
    y = np.broadcast_to(np.cos(down), (len(down), len(turn)))
    vectors = np.stack([np.sin(down) * np.cos(turn), y, np.sin(down) * np.sin(turn)], axis=-1)
    a = np.arange((len(down) - 1) * len(turn)).reshape(len(down) - 1, -1)[:, :-1].ravel()
    b = a + len(turn)
    corners = np.concatenate([np.stack([a, a + 1, b], -1), np.stack([a + 1, b + 1, b], -1)])
    return vectors.reshape(-1, 3), corners


GLOBE, TRIANGLES = _globe()
