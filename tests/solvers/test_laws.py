"""The laws that the methods obey, on Jacobians of real bodies and on any matrix."""

from functools import partial
from math import inf, nan, pi

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal
from strategies import SEEDS, SHAPES, anybody, poses

from ikteach import SOLVERS, dls, dls_following, forward, jacobian, pseudoinverse, sdls, transpose
from ikteach.solvers import name_of
from ikteach.solvers.sdls import hard, soft

EVERY = {
    **SOLVERS,
    "following": dls_following,
    "half": partial(transpose, gain=0.5),
    "undamped": partial(dls, damping=0),
    "uncut": partial(pseudoinverse, cutoff=0),
    "soft": partial(sdls, clamp=soft),
}
every = pytest.mark.parametrize("solver", EVERY.values(), ids=EVERY)


@st.composite
def problems(draw, scale=1.0):
    """J of a body at some pose, and an error: (..., 3k, n) and (..., 3k)."""
    tree, effectors = draw(anybody())
    rng, shape = np.random.default_rng(draw(SEEDS)), draw(SHAPES)
    theta = poses(tree, rng, shape)
    J = jacobian(tree, forward(tree, theta), effectors)
    return J, scale * rng.normal(size=J.shape[:-1])


def wide(seed, m=6, n=9):
    """A J with singular values from 1 to 2, and an e."""
    rng = np.random.default_rng(seed)
    U, V = (np.linalg.qr(rng.normal(size=(d, d)))[0] for d in (m, n))
    return U * rng.uniform(1, 2, m) @ V[:m], rng.normal(size=m)


@every
@given(problem=problems())
def test_a_batch_equals_a_loop(solver, problem):
    J, e = problem
    together = solver(J, e)
    assert together.shape == (*J.shape[:-2], J.shape[-1])
    for i in np.ndindex(J.shape[:-2]):
        alone = solver(J[i], e[i])
        if solver is EVERY["undamped"]:  # at a singular pose rounding, times 1e13, is the answer
            assert_allclose(J[i] @ together[i], J[i] @ alone, atol=1e-4)
        elif np.diff(np.linalg.svdvals(J[i])).max(initial=-1) < -1e-6:  # else SDLS is not unique
            assert_allclose(together[i], alone, rtol=1e-6, atol=1e-9)


@every
@given(problem=problems())
def test_no_error_no_step(solver, problem):
    J, e = problem
    assert_array_equal(solver(J, 0 * e), 0)


@every
@pytest.mark.parametrize("scale", [1e-160, 1e-30, 1e-9, 1.0, 1e9, 1e30])
@pytest.mark.parametrize("size", [0.0, 1e-9, 1.0, 1e9])
def test_finite_at_every_scale_and_rank(solver, scale, size):
    rng = np.random.default_rng(1)
    for rank in range(7):
        J = scale * rng.normal(size=(6, rank)) @ rng.normal(size=(rank, 9))
        J[:, 2] = 0
        with np.errstate(all="raise", under="ignore"):
            assert np.isfinite(solver(J, size * rng.normal(size=6))).all()


@every
def test_a_body_stretched_out_with_its_target_in_line(solver):
    J = np.array([[0.0, 0, 0], [3, 2, 1], [0, 0, 0]])
    for e in ([1.0, 0, 0], [-1.0, 0, 0], [1e9, 0, 0]):
        assert_allclose(solver(J, np.array(e)), 0, atol=1e-12)
    assert_array_equal(solver(np.zeros((3, 2)), np.ones(3)), 0)


@every
@given(problem=problems(scale=1e-3), turn=SEEDS)
def test_the_world_may_be_turned(solver, problem, turn):
    """Every method gives the same step in every frame of reference."""
    J, e = problem
    sigma = np.linalg.svdvals(J)
    if solver is EVERY["undamped"] or np.diff(sigma, axis=-1).max(initial=-1) > -1e-3:
        return
    if (abs(sigma / sigma[..., :1] - 0.01) < 1e-6).any() or (sigma < 1e-4).any():
        return  # at a cutoff a hair decides
    Q = np.linalg.qr(np.random.default_rng(turn).normal(size=(3, 3)))[0]
    Q = np.kron(np.eye(J.shape[-2] // 3), Q)
    assert_allclose(solver(Q @ J, np.matvec(Q, e)), solver(J, e), rtol=1e-6, atol=1e-9)


@given(problem=problems())
def test_transpose_goes_downhill_by_the_best_length(problem):
    J, e = problem
    dtheta, JTe = transpose(J, e), np.vecmat(e, J)
    assert (np.vecdot(dtheta, JTe) >= 0).all()
    best = np.linalg.norm(e - np.matvec(J, dtheta), axis=-1)
    for factor in (0, 0.5, 0.99, 1.01, 2):
        other = np.linalg.norm(e - np.matvec(J, factor * dtheta), axis=-1)
        assert (best <= other + 1e-12).all()
    assert_allclose(transpose(J, e, gain=0.5), dtheta / 2)


@given(problem=problems(), scale=st.sampled_from([1e-3, 100.0]))
def test_lengths_may_be_in_any_unit(problem, scale):
    """Metres made centimetres change no step, if the damping is made so too."""
    J, e = problem
    assert_allclose(transpose(scale * J, scale * e), transpose(J, e), rtol=1e-9, atol=1e-12)
    damped = dls(scale * J, scale * e, damping=scale * 0.1)
    assert_allclose(damped, dls(J, e, damping=0.1), rtol=1e-9, atol=1e-12)
    J, e = wide(0)
    for solver in (pseudoinverse, sdls, partial(sdls, clamp=soft)):
        assert_allclose(solver(scale * J, scale * e), solver(J, e), rtol=1e-10)
    assert abs(dls(scale * J, scale * e) - dls(J, e)).max() > 1e-4


@given(SEEDS)
def test_pseudoinverse_is_numpys_and_the_shortest(seed):
    J, e = wide(seed)
    dtheta = pseudoinverse(J, e, cutoff=0)
    assert_allclose(dtheta, np.linalg.pinv(J) @ e, atol=1e-13)
    assert_allclose(dtheta, J.T @ np.linalg.solve(J @ J.T, e), atol=1e-13)
    assert_allclose(J @ dtheta, e, atol=1e-13)
    nullspace = np.linalg.svd(J)[2][6:]
    assert_allclose(nullspace @ dtheta, 0, atol=1e-13)
    tall = J.T
    wanted = np.linalg.lstsq(tall, np.arange(9.0))[0]
    assert_allclose(pseudoinverse(tall, np.arange(9.0)), wanted, atol=1e-12)


def test_pseudoinverse_leaves_weak_directions_out():
    J, e = np.diag([1.0, 0.02, 0.005]), np.ones(3)
    assert_allclose(pseudoinverse(J, e), [1, 50, 0])
    assert_allclose(pseudoinverse(J, e, cutoff=0.05), [1, 0, 0])
    assert_allclose(pseudoinverse(J, e, cutoff=0), [1, 50, 200])


@given(problem=problems(), damping=st.floats(0.01, 10))
def test_dls_is_its_svd_form_and_bounded(problem, damping):
    J, e = problem
    dtheta = dls(J, e, damping=damping)
    U, sigma, Vt = np.linalg.svd(J, full_matrices=False)
    wanted = np.vecmat(np.vecmat(e, U) * sigma / (sigma**2 + damping**2), Vt)
    assert_allclose(dtheta, wanted, rtol=1e-9, atol=1e-9)
    length, error = np.linalg.norm(dtheta, axis=-1), np.linalg.norm(e, axis=-1)
    assert (length <= error / (2 * damping) * (1 + 1e-12)).all()


@given(problem=problems(), damping=st.floats(0.01, 10))
def test_dls_is_the_least_of_its_sum(problem, damping):
    J, e = problem

    def total(dtheta):
        miss = e - np.matvec(J, dtheta)
        return np.vecdot(miss, miss) + damping**2 * np.vecdot(dtheta, dtheta)

    dtheta = dls(J, e, damping=damping)
    rng = np.random.default_rng(0)
    for _ in range(5):
        other = dtheta + 1e-3 * rng.normal(size=dtheta.shape)
        assert (total(dtheta) <= total(other)).all()


def test_dls_goes_to_the_pseudoinverse_and_to_the_gradient():
    J, e = wide(3)
    assert_allclose(dls(J, e, damping=0), np.linalg.pinv(J) @ e, atol=1e-11)
    assert_allclose(dls(J, e, damping=1e4) * 1e8, J.T @ e, rtol=1e-7)


def test_dls_has_a_damping_for_each_of_a_batch():
    J, e = wide(0)
    dampings = np.array([[0.0], [0.1], [5.0]])
    together = dls(np.stack([J, 2 * J]), e, damping=dampings)
    assert together.shape == (3, 2, 9)
    for i, damping in enumerate(dampings[:, 0]):
        assert_allclose(together[i, 1], dls(2 * J, e, damping=damping))
    assert_allclose(dls(J, e, damping=dampings[:, 0]), together[:, 0])


@pytest.mark.parametrize("damping", [-1, -1e-12, nan, inf, [0.1, -1], [0.1, nan], None])
def test_dls_refuses_a_damping_that_is_none(damping):
    with pytest.raises(ValueError, match=r"damping must be 0 or more.* not .*(-1|nan|inf|None)"):
        dls(*wide(0), damping=damping)


def test_following_is_dls_with_a_damping_of_half_the_error():
    J, e = wide(1)
    damping = np.hypot(0.5 * np.linalg.norm(e), 4e-4 * np.linalg.norm(J))
    assert_allclose(dls_following(J, e), dls(J, e, damping=damping), rtol=1e-12)
    assert_allclose(dls_following(J, 0 * e), 0)


@given(problem=problems(), max_angle=st.floats(0.01, 4))
def test_sdls_turns_no_joint_further_than_its_bound(problem, max_angle):
    J, e = problem
    for clamp in (hard, soft):
        dtheta = sdls(J, 100 * e, max_angle=max_angle, clamp=clamp)
        assert (abs(dtheta) <= max_angle * (1 + 1e-12)).all()


@given(SEEDS)
def test_sdls_is_the_pseudoinverse_for_small_errors(seed):
    J, e = wide(seed)
    dtheta = sdls(J, 1e-4 * e)
    assert_allclose(dtheta, pseudoinverse(J, 1e-4 * e, cutoff=0), atol=1e-12)


def test_sdls_needs_three_rows_an_effector():
    with pytest.raises(ValueError, match="three rows per effector, not 4 rows"):
        sdls(np.ones((4, 5)), np.ones(4))


@pytest.mark.parametrize("bound", [0.0, 1e-9, 0.5, 2.0, inf])
def test_hard_and_soft_clamps(bound):
    phi = np.array([[0.5, -1, 0.25], [0, 0, 0]])
    shortened = hard(phi, bound)
    assert_allclose(shortened, phi * min(1, bound))
    assert_array_equal(hard(phi, np.array([bound, 1.0]))[0], shortened[0])
    if bound < inf:
        assert_allclose(soft(phi, bound), phi * bound / (bound + 1))


@every
def test_a_solver_changes_nothing_that_it_is_given(solver):
    J, e = wide(5)
    J.setflags(write=False)
    e.setflags(write=False)
    assert_array_equal(solver(J, e), solver(J, e))


def test_solvers_have_names():
    assert list(SOLVERS) == ["transpose", "pseudoinverse", "dls", "sdls"]
    assert [name_of(solver) for solver in SOLVERS.values()] == list(SOLVERS)
    assert name_of(partial(partial(dls, damping=1), damping=2)) == "dls"
    with pytest.raises(LookupError, match="no method 'dsl'; did you mean 'dls'"):
        SOLVERS["dsl"]
    with pytest.raises(LookupError, match="no method 'newton'; there are 'transpose', "):
        SOLVERS["newton"]


def test_clamps_near_pi_over_4():
    """One joint and one effector: the step is the bound itself."""
    J, e = np.array([[0.0], [1], [0]]), np.array([0.0, 9, 0])
    assert_allclose(sdls(J, e), pi / 4)
    assert_allclose(sdls(J, e, max_angle=4 / pi), 4 / pi)
