"""Weights of targets, and a pose that is wished for beside them."""

import numpy as np
import pytest
from hypothesis import given
from numpy.testing import assert_allclose, assert_array_equal
from strategies import SEEDS, anybody, bodies, poses

from ikteach import (
    SOLVERS,
    Effectors,
    Joint,
    Tree,
    dls,
    figures,
    forward,
    jacobian,
    locate,
    solve,
    step,
    track,
)
from ikteach.motion.anatomy import anatomy
from ikteach.motion.ccd import ccd
from ikteach.motion.wish import beside

METHODS = [*SOLVERS, ccd]
WALKER = figures.walker().tree
PULLED = Effectors.of(
    WALKER,
    {
        **{
            f"foot.{s}{i}": (f"foot.{s}", at)
            for s in "lr"
            for i, at in enumerate((figures.HEEL, figures.BALL))
        },
        "hand.r": ("elbow.r", figures.HAND),
    },
)
FAR = [-0.23, 1.6, 0.2]  # where the hand cannot come, with the feet on the floor [m]
CAREFUL = {"max_error": 0.05, "max_step": 0.1}


def pulled(weight, count=150):
    """How far the feet are off, and how far the hand, where it wants too much [m]."""
    theta = WALKER.rest
    targets = locate(forward(WALKER, theta), PULLED)
    targets[-1] = FAR
    weights = [weight] * 4 + [1]
    for _ in range(count):
        theta = step(WALKER, theta, PULLED, targets, "dls", weights=weights, **CAREFUL).theta
    off = np.linalg.norm(targets - locate(forward(WALKER, theta), PULLED), axis=-1)
    return off[:4].max(), off[4]


def test_heavier_feet_stay_while_a_hand_wants_too_much():
    (light, _), (heavy, hand) = pulled(1), pulled(10)
    assert heavy < light / 5
    assert heavy < 0.005
    assert hand > 0.1


def test_between_two_targets_a_slide_stops_by_the_squares_of_the_weights():
    tree = Tree.of([Joint("rail", axis=(1, 0, 0), slide=True)])
    both = Effectors.of(tree, {"a": ("rail", (0, 0, 0)), "b": ("rail", (0, 0, 0))})
    for w in (1.0, 2.0, 10.0):
        for method in METHODS:
            theta = np.zeros(1)
            for _ in range(300):
                theta = step(
                    tree, theta, both, [[0, 0, 0], [1, 0, 0]], method, weights=[1, w]
                ).theta
            assert theta[0] == pytest.approx(w**2 / (1 + w**2), abs=0.01), method


@given(anybody(limits=True, directions=True), SEEDS)
def test_weights_of_one_are_no_weights(figure, seed):
    tree, effectors = figure
    rng = np.random.default_rng(seed)
    theta, targets = poses(tree, rng), rng.normal(size=(len(effectors), 3))
    for method in METHODS:
        plain = step(tree, theta, effectors, targets, method)
        weighed = step(tree, theta, effectors, targets, method, weights=np.ones(len(effectors)))
        assert_array_equal(weighed.theta, plain.theta)


@given(anybody(limits=True, directions=True), SEEDS)
def test_what_weighs_nothing_is_as_if_it_were_not_there(figure, seed):
    tree, effectors = figure
    rng = np.random.default_rng(seed)
    theta, targets = poses(tree, rng), rng.normal(size=(len(effectors), 3))
    weights = np.zeros(len(effectors))
    moved = step(tree, theta, effectors, targets, dls, weights=weights)
    assert_allclose(moved.theta, theta, atol=1e-12)
    weights[0] = 1
    other = targets.copy()
    other[1:] += 1
    one, two = (step(tree, theta, effectors, t, "dls", weights=weights) for t in (targets, other))
    assert_allclose(one.theta, two.theta, atol=1e-9)


@given(bodies(limits=False), SEEDS)
def test_a_wish_moves_no_effector_to_first_order(figure, seed):
    tree, effectors = figure
    rng = np.random.default_rng(seed)
    J = jacobian(tree, forward(tree, poses(tree, rng)), effectors)
    gap = rng.normal(size=len(tree))
    turn = beside(J, gap)
    norm = np.linalg.norm(J)
    assert np.linalg.norm(J @ turn) <= 1e-3 * norm * np.linalg.norm(gap)  # λ, where σ is below it
    assert turn @ turn <= gap @ gap * (1 + 1e-9)
    assert_allclose(beside(J, turn), turn, atol=0.3 * np.linalg.norm(gap))


def test_a_wish_is_reached_where_targets_do_not_feel_it():
    """An arm in a plane has one joint to spare; the pose it goes to is the nearest it can."""
    tree, effectors = figures.planar_arm(4)
    target = [[2.0, 1.0, 0.0]]
    ends = {}
    for turn in (0.5, -0.5):
        theta = np.full(4, 0.3)
        for _ in range(200):
            theta = step(tree, theta, effectors, target, "dls", wish=[turn] * 4).theta
        ends[turn] = theta
        frames = forward(tree, theta)
        assert np.linalg.norm(locate(frames, effectors) - target) < 1e-3
        left = beside(jacobian(tree, frames, effectors), turn - theta)
        assert np.linalg.norm(left) < 0.02  # rad: no way along which it would come nearer
    for turn, other in (0.5, -0.5), (-0.5, 0.5):
        assert np.linalg.norm(ends[turn] - turn) < np.linalg.norm(ends[other] - turn)


@given(anybody(limits=True), SEEDS)
def test_limits_and_locks_come_before_a_wish(figure, seed):
    tree, effectors = figure
    rng = np.random.default_rng(seed)
    theta, targets = poses(tree, rng), rng.normal(size=(len(effectors), 3))
    free = (rng.random(len(tree)) > 0.3).astype(float)
    wish = 3 * rng.normal(size=len(tree))
    done = step(tree, theta, effectors, targets, "dls", wish=wish, mobility=free, max_step=0.2)
    assert (done.theta >= tree.lower - 1e-12).all()
    assert (done.theta <= tree.upper + 1e-12).all()
    assert abs(done.dtheta).max() <= 0.2 + 1e-12
    assert_array_equal(done.dtheta[free == 0], 0)


def test_batches_have_weights_and_wishes_of_their_own():
    tree, effectors = figures.human()
    rng = np.random.default_rng(3)
    theta, wish = poses(tree, rng, (3,)), poses(tree, rng, (3,))
    weights = rng.uniform(0.1, 5, (3, 4))
    targets = rng.normal(size=(4, 3))
    for method in METHODS:
        both = step(tree, theta, effectors, targets, method, weights=weights, wish=wish)
        for i in range(3):
            alone = step(
                tree, theta[i], effectors, targets, method, weights=weights[i], wish=wish[i]
            )
            assert_allclose(both.theta[i], alone.theta, atol=1e-9)


def test_a_tick_taken_apart_knows_the_weights():
    tree, effectors = figures.human()
    targets = locate(forward(tree, tree.rest), effectors) + 0.05
    found = anatomy(tree, tree.rest, effectors, targets, "dls", weights=[1, 2, 3, 4])
    answer = found.mobility * (found.Vt.T @ (found.responses["dls"] * found.alpha))
    assert_allclose(answer, found.wanted, atol=1e-9)
    assert_allclose(found.predicted, found.actual, atol=0.05)


def test_a_track_takes_a_wish_for_each_frame():
    tree, effectors = figures.planar_arm(4)
    targets = np.tile([2.0, 1.0, 0.0], (30, 1, 1))
    wish = np.linspace(0.2, 0.9, 30)[:, None] * np.ones(4)
    run = track(tree, effectors, targets, "dls", theta=[0.3] * 4, wish=wish, weights=[2.0])
    theta = np.full(4, 0.3)
    for goal, one in zip(targets, wish, strict=True):
        theta = step(tree, theta, effectors, goal, "dls", wish=one, weights=[2.0]).theta
    assert_array_equal(run.theta[-1], theta)
    with pytest.raises(ValueError, match="30 frames need a wish for each"):
        track(tree, effectors, targets, "dls", wish=wish[:3])


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"weights": [1, 1, 1]}, "weights need a number from 0 up for each effector"),
        ({"weights": [1, 1, 1, -1]}, "from 0 up"),
        ({"weights": [1, 1, 1, np.nan]}, "from 0 up"),
        ({"weights": "heavy"}, "weights must be made of numbers"),
        ({"wish": [0, 0]}, "the wish is no pose"),
        ({"wish": np.full(20, np.nan)}, "the wish is no pose: the angle of 'spine.bend'"),
        ({"weights": np.ones((2, 4)), "wish": np.zeros((3, 20))}, "do not fit together"),
    ],
)
def test_what_is_wrong_is_named(options, words):
    tree, effectors = figures.human()
    with pytest.raises(ValueError, match=words):
        step(tree, tree.rest, effectors, np.zeros((4, 3)), "dls", **options)


def test_solve_goes_by_the_way_of_a_wish():
    """An arm with a joint to spare meets its target in the pose that is nearest to the wish."""
    tree, effectors = figures.planar_arm(4)
    target = [[2.0, 1.0, 0.0]]
    found = {
        turn: solve(tree, effectors, target, theta=[0.1] * 4, wish=[turn] * 4)
        for turn in (0.8, -0.8)
    }
    assert all(one.converged for one in found.values())
    for turn, other in (0.8, -0.8), (-0.8, 0.8):
        near, far = (np.linalg.norm(found[one].theta - turn) for one in (turn, other))
        assert near < far
    with pytest.raises(ValueError, match="one pose is wished for"):
        solve(tree, effectors, target, wish=np.zeros((2, 4)))
    with pytest.raises(ValueError, match="the wish is no pose"):
        solve(tree, effectors, target, wish=[0, 0])


@pytest.mark.parametrize("method", METHODS)
def test_solve_gives_weights_to_every_method(method):
    """Also to one that looks at the body itself, beyond J and e."""
    tree = Tree.of([Joint("rail", axis=(1, 0, 0), slide=True)])
    both = Effectors.of(tree, {"a": ("rail", (0, 0, 0)), "b": ("rail", (0, 0, 0))})
    found = solve(tree, both, [[0, 0, 0], [1, 0, 0]], method, weights=[1, 2])
    assert found.theta[0] == pytest.approx(0.8, abs=0.02)
