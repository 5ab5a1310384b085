"""Runs as glTF; three's own loader reads them in tests/page/gltf.test.js."""

import sys

import numpy as np
import pygltflib
import pytest
from numpy.testing import assert_allclose

from ikteach import figures
from ikteach.formats.bvh import Recording
from ikteach.formats.gltf import octahedron, quaternions, write_glb


def run(frames=2):
    tree, effectors = figures.human()
    return Recording(tree, effectors, np.zeros((frames, len(tree))), 0.1)


def test_rows_and_effectors_are_nodes_by_their_names():
    gltf = pygltflib.GLTF2.load_from_bytes(write_glb(run(), name="rest"))
    names = [node.name for node in gltf.nodes if node.name]
    assert names == [*run().tree.names, "ground", *run().effectors.names]
    assert gltf.animations[0].name == "rest"
    assert len(gltf.animations[0].channels) == 21  # the ground moves too
    assert len(gltf.meshes) == 15  # bones: 3 from the ground, 8 from joint to joint, 4 to effectors


def test_a_bone_is_closed_and_looks_outwards():
    triangles = octahedron(np.array([0.3, -0.4, 0.1]))
    a, b, c = np.moveaxis(triangles, 1, 0)
    middle, normal = (a + b + c) / 3 - triangles.mean(axis=(0, 1)), np.cross(b - a, c - a)
    assert (np.vecdot(middle, normal) > 0).all()
    assert_allclose(normal.sum(axis=0), 0, atol=1e-12)


def test_quaternions_have_length_one():
    axis = np.array([0.6, 0, 0.8])
    q = quaternions(axis, np.array([0, np.pi, -8.0]))
    assert_allclose(np.linalg.norm(q, axis=1), 1)
    assert_allclose(q[1], [0.6, 0, 0.8, 0], atol=1e-15)


def test_what_cannot_be_written_is_refused():
    with pytest.raises(ValueError, match="no frame"):
        write_glb(run(0))
    with pytest.raises(ValueError, match="way needs finite numbers"):
        write_glb(run(), way=[[0, 0, 0]])
    with pytest.raises(ValueError, match="dt must be"):
        write_glb(run(), dt=-1)
    with pytest.raises(ValueError, match="one run"):
        write_glb(run()._replace(theta=np.zeros((2, 2, 20))))


def test_without_the_library_one_is_told_which(monkeypatch):
    monkeypatch.setitem(sys.modules, "pygltflib", None)
    with pytest.raises(ImportError, match=r"ikteach\[gltf\]"):
        write_glb(run())
