"""The singular directions, and what each method makes of them."""

from functools import partial

import numpy as np
import pytest
from numpy.testing import assert_allclose

from ikteach import dls, figures, forward, jacobian, pseudoinverse, sdls, transpose
from ikteach.solvers.dls import filtered
from ikteach.solvers.response import directions, factors
from ikteach.solvers.sdls import hard
from ikteach.study.experiment import starts

TREE, EFFECTORS = figures.human()
POSES = starts(TREE, 5, spread=0.4)[1:]
J = jacobian(TREE, forward(TREE, POSES), EFFECTORS)
E = np.random.default_rng(1).normal(size=(4, 12)) * 0.3


def test_the_directions_take_j_and_e_apart():
    found = directions(J, E)
    assert_allclose((found.U * found.sigma[:, None, :]) @ found.Vt, J, atol=1e-12)
    assert_allclose(np.matvec(found.U, found.alpha), E, atol=1e-12)
    assert (np.diff(found.sigma) <= 0).all()
    assert (found.alpha >= 0).all()  # the signs that SVD leaves open are chosen


def test_the_directions_are_those_of_any_processor():
    found = directions(J, E)
    J4, E4 = np.concatenate([J, J])[:, None], np.stack([E, -E]).reshape(8, 1, 12)
    again = directions(J4, E4)  # another SVD, and the opposite error
    assert_allclose(again.alpha[:4, 0], found.alpha, atol=1e-12)
    assert_allclose(again.U[4:, 0], -found.U, atol=1e-12)


@pytest.mark.parametrize("max_angle", [np.pi / 4, 0.05])
def test_sdls_is_the_sum_of_what_they_allow(max_angle):
    found = directions(J, E, max_angle=max_angle)
    phi = hard((found.alpha / found.sigma)[..., None] * found.Vt, found.gamma)
    assert (abs(phi).max(axis=-1) <= found.gamma + 1e-12).all()
    wanted = hard(phi.sum(axis=-2), np.full(4, max_angle))
    assert_allclose(sdls(J, E, max_angle=max_angle), wanted, atol=1e-12)


def test_bounds_are_angles_and_know_no_unit():
    found, larger = directions(J, E), directions(100 * J, 100 * E)
    assert_allclose(larger.gamma, found.gamma)
    assert ((found.gamma > 0) & (found.gamma <= np.pi / 4)).all()
    assert (found.N > 1 - 1e-12).all()
    assert (np.sqrt(4) + 1e-12 > found.N).all()  # of k 3-vectors with ‖u‖ = 1, at most √k


def test_a_lost_direction_has_no_bound_to_speak_of():
    tree, hand = figures.planar_arm(3)
    found = directions(jacobian(tree, forward(tree, tree.rest), hand), np.array([-1.0, 0, 0]))
    assert np.isinf(found.M[1:]).all()
    assert (found.gamma[1:] == 0).all()


@pytest.mark.parametrize(
    ("solver", "wanted"),
    [
        (partial(pseudoinverse, cutoff=0), lambda sigma: 1 / sigma),
        (partial(dls, damping=0.2), lambda sigma: sigma / (sigma**2 + 0.04)),
    ],
)
def test_factors_of_linear_methods_are_their_formulas(solver, wanted):
    sigma = directions(J, E).sigma
    assert_allclose(factors(J, E, solver(J, E)), wanted(sigma), rtol=1e-6)


def test_the_transpose_has_factors_in_proportion_to_sigma():
    f, sigma = factors(J, E, transpose(J, E)), directions(J, E).sigma
    assert_allclose(f / sigma, np.broadcast_to((f / sigma)[:, :1], f.shape), rtol=1e-6)


def test_where_nothing_is_asked_there_is_no_factor():
    u = directions(J[0], E[0]).U[:, 2]
    f = factors(J[0], u, sdls(J[0], u))
    assert np.isfinite(f[2])
    assert np.isnan(np.delete(f, 2)).all()
    assert np.isnan(factors(J[0], 0 * u, 0 * POSES[0])).all()


def test_filtered():
    sigma = np.array([2.0, 0.1, 0.0])
    assert_allclose(filtered(sigma), [0.5, 10, 0])
    assert_allclose(filtered(sigma, 0.1), [2 / 4.01, 5, 0])
    assert (filtered(np.geomspace(1e-6, 1e3, 99), 0.3) <= 1 / 0.6 + 1e-12).all()
