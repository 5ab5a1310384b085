"""Cramer's rule against linear algebra's own, and what it does where there is no inverse."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal
from strategies import SEEDS, SHAPES

from ikteach import SOLVERS, cramer
from ikteach.solvers import adjugate, determinant, independence

SCALES = st.sampled_from([1e-120, 1e-9, 1.0, 1e9, 1e120])


@st.composite
def matrices(draw, least=0.0):
    """(..., 3, 3) with condition numbers below 1e4 or so where `least` asks for it."""
    rng = np.random.default_rng(draw(SEEDS))
    A = rng.normal(size=(*draw(SHAPES), 3, 3))
    assume((np.linalg.svdvals(A) > least).all())
    return A, rng


@given(matrices())
def test_determinant_and_adjugate(drawn):
    A, _ = drawn
    assert_allclose(determinant(A), np.linalg.det(A), rtol=1e-9, atol=1e-12)
    det = determinant(A)[..., None, None] * np.eye(3)
    assert_allclose(adjugate(A) @ A, det, atol=1e-12)
    assert_allclose(A @ adjugate(A), det, atol=1e-12)


@given(matrices(least=1e-3), SCALES)
def test_equals_solve_to_rounding(drawn, scale):
    A, rng = drawn
    e = rng.normal(size=A.shape[:-1])
    theirs = np.linalg.solve(A, e[..., None])[..., 0]
    bound = 1e-15 * np.linalg.cond(A)[..., None] ** 2 * np.linalg.norm(theirs, axis=-1)[..., None]
    assert (abs(cramer(A, e) - theirs) <= 50 * bound).all()
    assert_allclose(scale * cramer(scale * A, e), cramer(A, e), rtol=1e-9)


@given(matrices(least=1e-3), st.tuples(SCALES, SCALES, SCALES))
def test_independence_has_no_unit(drawn, units):
    """Each joint in a unit of its own, such as degrees beside metres of a slide."""
    A, _ = drawn
    assert_allclose(independence(A * np.array(units)), independence(A), rtol=1e-9)
    assert ((independence(A) >= 0) & (independence(A) <= 1 + 1e-12)).all()
    assert_allclose(independence(np.linalg.qr(A)[0]), 1)


@given(SEEDS, st.sampled_from([0, 1e-12, 1e-8, 1e-7]), SCALES)
def test_refuses_three_ways_in_a_plane(seed, off, scale):
    rng = np.random.default_rng(seed)
    A = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    A[:, 2] = A[:, 0] + A[:, 1] + off * A[:, 2]  # `off` is how far the third leaves the plane
    assert_array_equal(cramer(scale * A, rng.normal(size=3)), 0)
    stays = cramer(A, A[:, 0], least=0)  # and the threshold is the caller's to set
    assert off < 1e-8 or abs(stays).max() > 0.5


@pytest.mark.parametrize("scale", [0, 5e-324, 1e-200, 1e200])
@pytest.mark.parametrize("dead", [[], [0], [1, 2], [0, 1, 2]])
def test_never_nan(scale, dead):
    A = np.random.default_rng(1).normal(size=(20, 3, 3)) * scale
    A[:, :, dead] = 0
    with np.errstate(invalid="raise", divide="raise", over="raise"):
        dtheta = cramer(A, np.ones((20, 3)))
    assert np.isfinite(dtheta).all()
    if dead or scale < 1e-150:
        assert_array_equal(dtheta, 0)


def test_one_singular_matrix_spoils_no_other():
    A = np.stack([np.eye(3), np.zeros((3, 3)), 2 * np.eye(3)])
    assert_array_equal(cramer(A, np.ones(3)), [[1, 1, 1], [0, 0, 0], [0.5, 0.5, 0.5]])


@pytest.mark.parametrize("shape", [(2, 3), (3, 2), (6, 3), (3,), (2, 3, 4)])
def test_wants_three_by_three(shape):
    with pytest.raises(ValueError, match=r"J of shape \(\.\.\., 3, 3\)"):
        cramer(np.ones(shape), np.ones(3))


def test_is_none_of_the_four_general_methods():
    assert "cramer" not in SOLVERS
