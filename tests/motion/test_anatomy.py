"""One tick taken apart: the pieces, put together again, are the tick."""

from functools import partial

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal
from strategies import SEEDS, anybody, poses

from ikteach import (
    SOLVERS,
    dls,
    dls_following,
    figures,
    forward,
    jacobian,
    locate,
    pseudoinverse,
    sdls,
    step,
    transpose,
)
from ikteach.motion.anatomy import anatomy
from ikteach.motion.mix import Mix
from ikteach.motion.rules import per_chain
from ikteach.solvers.response import directions, response
from ikteach.solvers.sdls import soft

HUMAN = figures.human()
BOUND = [
    partial(transpose, gain=0.5),
    partial(pseudoinverse, cutoff=0.2),
    partial(dls, damping=0.05),
    partial(dls, damping=0.7),
    partial(sdls, max_angle=0.1),
    partial(sdls, clamp=soft),
    dls_following,
]
OUT_OF_REACH = np.array([[0.3, -1.4, 0.6], [-0.3, -1.3, -0.5], [-1.5, 0, 1], [1.4, 0.2, -1]])


def scene(body, seed):
    rng = np.random.default_rng(seed)
    theta = poses(body.tree, rng)
    s = locate(forward(body.tree, theta), body.effectors)
    J = jacobian(body.tree, forward(body.tree, theta), body.effectors)
    return theta, s + rng.normal(size=s.shape) * rng.choice([1e-3, 0.3, 3]), J


@given(anybody(), SEEDS)
def test_the_directions_are_those_of_j(body, seed):
    theta, targets, J = scene(body, seed)
    done = anatomy(body.tree, theta, body.effectors, targets, "dls")
    scale = max(1, abs(J).max())
    assert_allclose((done.U * done.sigma) @ done.Vt, J * body.tree.mobility, atol=1e-12 * scale)
    assert_allclose(done.alpha, done.U.T @ done.e, atol=1e-12 * scale)
    assert (np.diff(done.sigma) <= 0).all()


@given(anybody(), SEEDS, st.sampled_from([*SOLVERS.values(), *BOUND]))
def test_responses_times_alpha_are_the_answer(body, seed, solver):
    theta, targets, J = scene(body, seed)
    e = (targets - locate(forward(body.tree, theta), body.effectors)).ravel()
    d, answer = directions(J, e), solver(J, e)
    if len(set(np.round(d.sigma / d.sigma[0], 6))) < len(d.sigma):
        return  # directions of equal σ are not unique, nor is what SDLS bounds
    again = (response(solver, J, e) * d.alpha) @ d.Vt
    assert_allclose(again, answer, rtol=1e-10, atol=1e-10 * max(1, abs(answer).max()))


def test_what_each_method_does_to_the_strong_and_the_weak():
    J, e = np.diag([2.0, 0.5, 0.001]), np.array([0.3, 0.2, 0.1])
    assert_allclose(response(pseudoinverse, J, e), [0.5, 2, 0])
    assert_allclose(response(dls, J, e), [2 / 4.01, 0.5 / 0.26, 0.001 / 0.010001])
    assert_allclose(response(partial(dls, damping=0), J, e), [0.5, 2, 1000])
    f = response(transpose, J, e)
    assert_allclose(f / f[0], [1, 0.25, 0.0005])
    assert response(sdls, J, e)[2] * 0.1 <= np.pi / 4 + 1e-12


def test_any_other_solver_is_answered_from_what_it_does():
    def doubled(J, e):
        return 2 * pseudoinverse(J, e, cutoff=0)

    J, e = np.diag([2.0, 0.5]), np.array([0.3, 0.0])
    assert_allclose(response(doubled, J, e), [1, 0])
    done = anatomy(HUMAN.tree, HUMAN.tree.rest, HUMAN.effectors,
                   OUT_OF_REACH, doubled)  # fmt: skip
    assert list(done.responses) == [*SOLVERS, "doubled"]
    assert done.method == "doubled"


@given(anybody(limits=True), SEEDS, st.sampled_from(list(SOLVERS)))
def test_the_stages_are_those_of_the_step(body, seed, method):
    theta, targets, _ = scene(body, seed)
    options = {"max_step": 0.1, "max_error": 0.5, "mobility": np.full(len(body.tree), 0.5)}
    done = anatomy(body.tree, theta, body.effectors, targets, method, **options)
    tick = step(body.tree, theta, body.effectors, targets, method, **options)
    for name in ("theta", "wanted", "dtheta", "held"):
        assert_array_equal(getattr(done, name), getattr(tick, name))
    assert abs(done.capped).max() <= 0.1 + 1e-12
    if not done.held.any():
        assert_allclose(done.dtheta, done.capped, atol=1e-12)
    f = done.responses[method]
    if len(set(np.round(done.sigma / done.sigma[0], 6))) == len(done.sigma):
        again = 0.5 * (f * done.alpha) @ done.Vt
        assert_allclose(again, done.wanted, rtol=1e-9, atol=1e-10 * max(1, abs(done.wanted).max()))


def test_the_cap_is_the_one_that_is_handed_in():
    options = {"max_step": 0.05, "cap": per_chain}
    done = anatomy(HUMAN.tree, HUMAN.tree.rest, HUMAN.effectors, OUT_OF_REACH, "dls", **options)
    assert_array_equal(done.capped, per_chain(done.wanted, 0.05, HUMAN.effectors.chains))
    assert done.method == "dls"


@pytest.mark.parametrize("method", SOLVERS)
def test_the_prediction_errs_by_the_square_of_the_step(method):
    rng = np.random.default_rng(1)
    theta = poses(HUMAN.tree, rng) * 0.3
    misses = []
    for cap in (0.02, 0.01, 0.005):
        done = anatomy(
            HUMAN.tree, theta, HUMAN.effectors, OUT_OF_REACH, method,
            max_step=cap, limits=lambda tree, theta, dtheta, again: (theta + dtheta, theta < -9),
        )  # fmt: skip
        misses.append(np.linalg.norm(done.actual - done.predicted))
    assert_allclose([misses[0] / misses[1], misses[1] / misses[2]], 4, rtol=0.05)


def test_filters_say_what_is_taken_away():
    done = anatomy(HUMAN.tree, HUMAN.tree.rest, HUMAN.effectors, OUT_OF_REACH, "pseudoinverse")
    kept = done.sigma > 0.01 * done.sigma[0]
    assert_allclose(done.filters["pseudoinverse"], kept, atol=1e-12)
    assert (done.filters["dls"] < 1).all()


def test_a_mix_can_be_taken_apart():
    mix = Mix.of(HUMAN.effectors, dict.fromkeys(HUMAN.effectors.names, "dls"))
    done = anatomy(HUMAN.tree, HUMAN.tree.rest, HUMAN.effectors, OUT_OF_REACH, mix)
    assert done.method == "mix"
    known = abs(done.alpha) > 1e-9
    assert_allclose(done.responses["mix"][known], done.responses["dls"][known], atol=1e-9)


def test_one_pose_at_a_time():
    with pytest.raises(ValueError, match="one pose"):
        anatomy(HUMAN.tree, [HUMAN.tree.rest] * 2, HUMAN.effectors, OUT_OF_REACH, "dls")
    with pytest.raises(LookupError, match="did you mean 'dls'"):
        anatomy(HUMAN.tree, HUMAN.tree.rest, HUMAN.effectors, OUT_OF_REACH, "dlss")
