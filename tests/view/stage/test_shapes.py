"""Surfaces: closed, seen from outside, and put together without loss."""

import numpy as np
import pytest

from ikteach.view.stage.shapes import arrow, globe, mark, ring, rod, sole, wires
from ikteach.view.webgl.mesh import Piece, fused, shifted

SOLIDS = {
    "globe": (globe(24, 8), 4 / 3 * np.pi),
    "rod": (rod(0.1, 40), 0.01 * np.pi),
    "arrow": (arrow(0.05), 0.0025 * np.pi * (0.78 + 2.4**2 * 0.22 / 3)),
    "box": (mark("hand.r", 1.0), 1.56**3),
    "ball": (mark("hand.l", 1.0), 4 / 3),  # an octahedron
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
    for name in ("foot.l", "foot.r"):
        shape = sole(name, 0.05, 0.1)
        a, b, c = np.moveaxis(shape.points[shape.joined], 1, 0)
        assert (np.cross(b - a, c - a)[:, 1] > 0).all()
        assert np.ptp(shape.points, axis=0)[2] > 1.5 * np.ptp(shape.points, axis=0)[0]


def test_wires_lie_on_the_ball():
    shape = wires()
    assert np.linalg.norm(shape.points, axis=-1) == pytest.approx(1)
    lengths = np.linalg.norm(np.diff(shape.points[shape.joined], axis=1), axis=-1)
    assert lengths.max() < 0.2


def test_pieces_keep_their_points_and_rows():
    box, ball = mark("a.r", 1.0), globe(8, 2)
    stretched = box.at(np.array([[1.0, 0, 0, 0], [0, 2, 0, 5], [0, 0, 1, 0]]))
    pieces = [Piece(4, box, "red"), Piece(4, box, "red"), Piece(1, stretched, "blue")]
    thing, runs = fused(pieces)
    n = len(box.points)
    assert runs == [[4, 2 * n], [1, n]]
    assert shifted(runs, 10) == [[14, 2 * n], [11, n]]
    points = thing.geometry.attributes["position"].array
    assert points[2 * n :] == pytest.approx(box.points * [1, 2, 1] + [0, 5, 0])
    joined = thing.geometry.index.array.reshape(-1, 3)
    assert (joined[: len(box.joined)] + 2 * n == joined[2 * len(box.joined) :]).all()
    assert thing.geometry.attributes["color"].array[-1] == pytest.approx([0, 0, 1])
    shaded, _ = fused([Piece(0, ball, "red")])
    assert "normal" in shaded.geometry.attributes
