"""Singular values, and what they are called."""

import numpy as np
import pytest
from hypothesis import given
from numpy.testing import assert_allclose
from strategies import SEEDS, SHAPES, anybody, poses

from ikteach import conditioning, ellipsoid, figures, forward, jacobian, manipulability


@given(anybody(), SHAPES, SEEDS)
def test_the_ellipsoid_is_where_unit_steps_go(figure, shape, seed):
    tree, effectors = figure
    rng = np.random.default_rng(seed)
    J = jacobian(tree, forward(tree, poses(tree, rng, shape)), effectors)
    directions, lengths = ellipsoid(J)
    m = J.shape[-2]
    assert directions.shape == (*shape, m, m)
    assert lengths.shape == (*shape, m)
    assert (np.diff(lengths, axis=-1) <= 0).all()
    assert_allclose(directions * lengths[..., None, :] ** 2 @ directions.mT, J @ J.mT, atol=1e-10)
    dtheta = rng.normal(size=(*shape, len(tree)))
    dtheta /= np.linalg.norm(dtheta, axis=-1, keepdims=True)
    along = np.vecmat(np.matvec(J, dtheta), directions)
    assert (abs(along) <= lengths + 1e-12).all()


def test_manipulability_is_the_root_of_the_determinant():
    J = np.random.default_rng(0).normal(size=(5, 3, 7))
    assert_allclose(manipulability(J), np.sqrt(np.linalg.det(J @ J.mT)))
    sigma = np.linalg.svdvals(J)
    assert_allclose(manipulability(J.mT), sigma.prod(axis=-1))  # 3 joints move 3 ways of 7


def test_a_stretched_arm_is_singular():
    tree, effectors = figures.planar_arm(2)
    J = jacobian(tree, forward(tree, [[0, 0], [0, 0.5]]), effectors)[:, :2]
    assert_allclose(manipulability(J), [0, np.sin(0.5)], atol=1e-15)
    assert conditioning(J)[0] == np.inf
    assert_allclose(conditioning(np.eye(3)), 1)
    assert conditioning(np.zeros((3, 2))) == np.inf
    assert conditioning(np.diag([1.0, 0])) == np.inf


def test_the_third_coordinate_of_a_plane_does_not_count():
    tree, effectors = figures.planar_arm(3)
    J = jacobian(tree, forward(tree, [[0.3, 0.5, 0.7], [0.0, 1.2, 1.2], [0, 0, 0]]), effectors)
    for function in (manipulability, conditioning):
        assert_allclose(function(J), function(J[:, :2]))
        assert_allclose(function(J), function(J, rank=2))
    assert manipulability(J)[2] == 0
    assert conditioning(J)[2] == np.inf
    assert (manipulability(J, rank=3) == 0).all()  # a body that could leave its plane


@given(SEEDS)
def test_a_tilted_plane_is_told_its_rank(seed):
    """Of J alone nobody can tell it from a body in space that is singular."""
    Q = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))[0]
    tree, effectors = figures.planar_arm(3)
    J = jacobian(tree, forward(tree, [[0.3, 0.5, 0.7], [0, 0, 0]]), effectors)
    for function in (manipulability, conditioning):
        assert_allclose(function(Q @ J, rank=2), function(J[:, :2]))
    assert manipulability(Q @ J).max() == 0


def test_a_body_in_space_at_rest_is_singular_all_the_same():
    """The hands hang straight down: one coordinate of theirs is still, but not of the feet."""
    tree, effectors = figures.human()
    J = jacobian(tree, forward(tree, tree.rest), effectors)
    assert manipulability(J) == 0
    assert conditioning(J) == np.inf


@pytest.mark.parametrize("rank", [0, 4, 2.5, "2", True, np.nan])
def test_a_rank_that_is_none(rank):
    for function in (manipulability, conditioning):
        with pytest.raises(ValueError, match="rank must be from 1 to 3, and whole, not"):
            function(np.eye(3), rank=rank)
