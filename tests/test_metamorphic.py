"""The same body told otherwise gives the same answer, moved along."""

from functools import partial

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from metamorphic import BODY, OTHER, SAME, Case
from numpy.testing import assert_allclose, assert_array_equal
from strategies import SEEDS, SHAPES, bodies, poses

from ikteach import (
    SOLVERS,
    conditioning,
    dls,
    dls_following,
    figures,
    forward,
    jacobian,
    locate,
    manipulability,
    step,
    track,
)
from ikteach.motion import clip, hold, per_chain, whole
from ikteach.motion.rank import full_rank, smallest_sigma
from ikteach.solvers.response import directions

COURSE = st.sampled_from(
    [
        figures.human(),
        figures.simulator(),
        figures.double_y(),
        figures.y_shape(),
        figures.planar_arm(1),
        figures.planar_arm(3),
        figures.planar_arm([1.0, 0.5, 0.2, 2.0]),
        figures.planar_model(3),
    ]
)
CHANGE = st.sampled_from(list(SAME))
METHODS = [*SOLVERS, "following"]
every = pytest.mark.parametrize("method", METHODS)


@st.composite
def cases(draw, shapes=SHAPES, hinges=False):
    """A body of any kind, a pose and targets that other poses meet, and a generator."""
    body = draw(st.one_of(bodies(limits=True, slides=not hinges), COURSE))
    rng, shape = np.random.default_rng(draw(SEEDS)), draw(shapes)
    theta, other = (poses(body.tree, rng, shape) for _ in range(2))
    case = Case(*body, theta, locate(forward(body.tree, other), body.effectors))
    make = draw(st.sampled_from([None, *([] if hinges else OTHER)]))
    return (OTHER[make](case, rng) if make else case), rng


def solver_of(method, damping=1.0):
    """The method; the fixed λ is 0.1 in the first case's unit."""
    if method == "following":
        return dls_following
    return partial(dls, damping=0.1 * damping) if method == "dls" else SOLVERS[method]


def J_of(case):
    return jacobian(case.tree, forward(case.tree, case.theta), case.effectors)


def clear(J, least=1e-6):
    """Whether no σ is at a threshold of any method, and no two are one: the answer is unique."""
    sigma = np.linalg.svdvals(J)
    share = sigma / np.maximum(sigma[..., :1], 1e-99)
    used = share > 1e-9
    apart = np.diff(share, axis=-1) < -least
    return bool(
        (abs(share - 0.01) > least).all()
        and ((share > least) | ~used).all()
        and (apart | ~used[..., 1:]).all()
    )


@given(cases(), CHANGE)
def test_forward_locate_and_jacobian(drawn, change):
    case, rng = drawn
    one, other, along = SAME[change](case, rng)
    s, moved = (locate(forward(c.tree, c.theta), c.effectors) for c in (one, other))
    size = along.length * (1 + abs(s).max(initial=0)) + abs(along.shift).max()
    assert_allclose(moved, along.places(s), rtol=0, atol=1e-12 * size)
    J = along.jacobian(J_of(one))
    column = max(size, 1.0) if one.tree.slide.any() else size  # that of a slide has no unit
    assert_allclose(J_of(other), J, rtol=0, atol=1e-11 * column)


@every
@given(drawn=cases(), change=CHANGE)
def test_solvers(method, drawn, change):
    case, rng = drawn
    one, other, along = SAME[change](case, rng)
    # A body with slides and hinges has σ of two units, and all methods but the transpose ask for σ.
    assume(along.damping is not None and clear(J_of(one)))
    if case.tree.slide.any() and along.length != 1:
        assume(method not in ("following", "sdls"))  # share and max_angle have the unit of θ
    steps = []
    for c, damping in ((one, 1.0), (other, along.damping)):
        e = (c.targets - locate(forward(c.tree, c.theta), c.effectors)).reshape(
            *np.shape(c.theta)[:-1], -1
        )
        steps.append(solver_of(method, damping)(J_of(c), e))
    wanted = along.step(steps[0])
    near = 1e-5 * np.maximum(1, abs(wanted).max(initial=0))
    assert_allclose(steps[1], wanted, rtol=1e-5, atol=near)


@every
@given(
    drawn=cases(),
    change=CHANGE,
    limits=st.sampled_from([hold, clip]),
    cap=st.sampled_from([whole, per_chain]),
)
def test_step(method, drawn, change, limits, cap):
    case, rng = drawn
    one, other, along = SAME[change](case, rng)
    assume(along.damping is not None and clear(J_of(one)))
    slides = bool(case.tree.slide.any())
    assume(not (slides and along.length != 1 and method in ("following", "sdls")))
    mobility = rng.choice([0.0, 0.5, 1.0], len(case.tree))
    assume(clear(J_of(one) * mobility))
    max_step, scale = 0.2, along.length if slides else 1.0
    tell = {"limits": limits, "cap": cap}
    done = step(
        *order(one), solver_of(method), max_step=max_step, max_error=0.7, mobility=mobility, **tell
    )
    moved = step(
        *order(other),
        solver_of(method, along.damping),
        max_step=max_step * scale,
        max_error=0.7 * along.length,
        mobility=along.marks(mobility),
        **tell,
    )
    assume(abs(done.dtheta[done.held]).min(initial=1) > 1e-6 or limits is clip)  # a hair decides
    tolerance = 1e-5 * scale
    assert_allclose(moved.theta, along.pose(done.theta), rtol=0, atol=tolerance)
    assert_allclose(moved.dtheta, along.step(done.dtheta), rtol=0, atol=tolerance)
    size = along.length * (1 + abs(case.targets).max()) + abs(along.shift).max()
    assert_allclose(moved.e, along.error(done.e), rtol=0, atol=1e-11 * size)


def order(case):
    """The case as `step` takes it."""
    return case.tree, case.theta, case.effectors, case.targets


@settings(max_examples=30)
@given(drawn=cases(shapes=st.just(()), hinges=True), change=CHANGE)
def test_track(drawn, change):
    case, rng = drawn
    assume(clear(J_of(case), 1e-3))
    one, other, along = SAME[change](case, rng)
    runs = [
        track(
            c.tree, c.effectors, np.stack([c.targets] * 4), solver_of("dls", damping),
            theta=c.theta, max_step=0.1, iterations=2,
        )
        for c, damping in ((one, 1.0), (other, along.damping))
    ]  # fmt: skip
    assert_allclose(runs[1].theta, along.pose(runs[0].theta), rtol=0, atol=1e-6)
    assert_allclose(runs[1].error, along.distances(runs[0].error), rtol=1e-5,
                    atol=1e-6 * along.length)  # fmt: skip
    assert_allclose(runs[1].jitter, runs[0].jitter, rtol=0, atol=1e-5)
    assert_allclose(
        runs[1].smallest_sigma, along.damping * runs[0].smallest_sigma, rtol=1e-4,
        atol=1e-6 * along.damping,
    )  # fmt: skip


@given(drawn=cases(), change=st.sampled_from(list(BODY)))
def test_what_is_singular(drawn, change):
    case, rng = drawn
    one, other, along = SAME[change](case, rng)
    rank = full_rank(*one[:2])
    assert full_rank(*other[:2]) == rank
    assume(along.damping is not None and rank)
    sigma, moved = (smallest_sigma(*c[:2], c.theta) for c in (one, other))
    largest = np.linalg.svdvals(J_of(one))[..., 0]
    assert_allclose(moved, along.damping * sigma, rtol=1e-6, atol=1e-8 * along.damping)
    there = sigma > 1e-6 * largest
    for function, unit in ((conditioning, 1.0), (manipulability, along.damping**rank)):
        before, after = (np.asarray(function(J_of(c), rank=rank)) for c in (one, other))
        assert_allclose(after[there], before[there] * unit, rtol=1e-6)


@given(drawn=cases(hinges=True), change=st.sampled_from(list(BODY)))
def test_what_sdls_allows(drawn, change):
    case, rng = drawn
    assume(clear(J_of(case)))
    one, other, along = SAME[change](case, rng)
    e = rng.normal(size=J_of(one).shape[:-1])
    before, after = directions(J_of(one), e), directions(J_of(other), along.error(e))
    used = before.gamma > 0
    assert_allclose(after.gamma[used], before.gamma[used], rtol=1e-5)
    assert_allclose(after.sigma, along.damping * before.sigma, rtol=1e-8,
                    atol=1e-8 * along.damping)  # fmt: skip
    assert_array_equal(after.gamma > 0, used)
