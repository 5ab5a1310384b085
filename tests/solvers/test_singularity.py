"""Singular values, and what they are called."""

import numpy as np
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
