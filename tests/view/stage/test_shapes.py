"""Surfaces: closed, seen from outside, and put together without loss."""

import numpy as np
import pytest

from ikteach.view.stage import shapes
from ikteach.view.stage.colours import BLUE, RED, rgb
from ikteach.view.stage.forms import Ball, Box, Mesh, Piece, Rod, Wires
from ikteach.view.stage.shapes import arrow, globe, mark, ring, rod, sole, wires
from ikteach.view.webgl.mesh import fused, shifted

SOLIDS = {
    "globe": (globe(24, 8), 4 / 3 * np.pi),
    "rod": (rod(0.1, 40), 0.01 * np.pi),
    "arrow": (arrow(0.05), 0.0025 * np.pi * (0.78 + 2.4**2 * 0.22 / 3)),
    "box": (mark(1.0, boxed=True), 1.56**3),
    "ball": (mark(1.0, boxed=False), 4 / 3),  # an octahedron
    "ring": (ring(0.02), 2 * np.pi * np.pi * 0.0004),
}


@pytest.mark.parametrize("name", SOLIDS)
def test_a_solid_holds_its_volume_and_shows_its_outside(name):
    shape, volume = SOLIDS[name]
    a, b, c = np.moveaxis(shape.points[shape.joined], 1, 0)
    found = np.vecdot(np.cross(b - a, c - a), a).sum() / 6
    assert found == pytest.approx(volume, rel=0.2)  # few flat faces; inside out it would be < 0
    assert (np.linalg.norm(np.cross(b - a, c - a), axis=-1) > 0).all()


def test_a_print_lies_flat_and_looks_up():
    for boxed in (False, True):
        shape = sole(0.05, 0.1, boxed)
        a, b, c = np.moveaxis(shape.points[shape.joined], 1, 0)
        assert (np.cross(b - a, c - a)[:, 1] > 0).all()
        assert np.ptp(shape.points, axis=0)[2] > 1.5 * np.ptp(shape.points, axis=0)[0]


def test_wires_lie_on_the_ball():
    shape = wires(*Wires())
    assert np.linalg.norm(shape.points, axis=-1) == pytest.approx(1)
    lengths = np.linalg.norm(np.diff(shape.points[shape.joined], axis=1), axis=-1)
    assert lengths.max() < 0.2


def test_pieces_keep_their_points_and_rows():
    rod, ball = Rod((0, 0, 0), (0, 2, 0), 1.0), Ball((0, 5, 0), (1, 2, 1))
    mesh = Mesh([Piece(4, Box(0.78), RED), Piece(4, Box(0.78), RED), Piece(1, rod, BLUE)])
    thing, runs = fused(mesh)
    box = mark(1.0, boxed=True)
    n, m = len(box.points), len(shapes.rod(1.0).points)
    assert runs == [[4, 2 * n], [1, m]]
    assert shifted(runs, 10) == [[14, 2 * n], [11, m]]
    points = thing.geometry.attributes["position"].array
    assert points[n : 2 * n] == pytest.approx(box.points)
    assert np.ptp(points[2 * n :, 1]) == pytest.approx(2)
    joined = thing.geometry.index.array.reshape(-1, 3)
    more = len(box.joined)
    assert (joined[:more] + n == joined[more : 2 * more]).all()
    assert thing.geometry.attributes["color"].array[-1] == pytest.approx(rgb(BLUE) / 255)
    shaded, _ = fused(Mesh([Piece(0, ball, RED)]))
    assert "normal" in shaded.geometry.attributes
    assert shaded.geometry.attributes["position"].array[:, 1].max() == pytest.approx(7)
