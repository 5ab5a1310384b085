"""Runs made to be compared."""

from functools import partial

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from metamorphic import BODY, Case
from numpy.testing import assert_allclose, assert_array_equal
from strategies import SEEDS, bodies

from ikteach import (
    SOLVERS,
    Joint,
    Tree,
    dls,
    figures,
    forward,
    gait,
    locate,
    sdls,
    step,
    track,
    transpose,
)
from ikteach.motion import per_chain
from ikteach.study.experiment import (
    Round,
    arrivals,
    capped,
    circle,
    downhill,
    iterations,
    nearby,
    reversals,
    starts,
    step_times,
    turns,
)

ARM, HUMAN = figures.planar_arm(3), figures.human()


def test_starts_are_within_limits_and_begin_at_rest():
    tree = HUMAN.tree
    poses = starts(tree, 50, spread=1.0)
    assert poses.shape == (50, len(tree))
    assert_array_equal(poses[0], tree.rest)
    assert ((poses >= tree.lower - 1e-12) & (poses <= tree.upper + 1e-12)).all()
    assert_array_equal(poses, starts(tree, 50, spread=1.0))
    assert abs(poses - starts(tree, 50, spread=1.0, seed=1))[1:].max() > 0.1
    assert abs(starts(tree, 50, spread=0.1) - tree.rest).max() < 0.1 * np.pi


@given(bodies(limits=True), SEEDS, st.sampled_from(list(BODY)))
def test_starts_move_along_with_the_body(figure, seed, change):
    targets = np.zeros((len(figure.effectors), 3))
    rng = np.random.default_rng(seed)
    one, two, along = BODY[change](Case(*figure, figure.tree.rest, targets), rng)
    poses = starts(two.tree, 20, spread=1.0, seed=seed)
    assert ((poses >= two.tree.lower) & (poses <= two.tree.upper)).all()
    if change != "renamed and reordered":  # which joint is drawn first matters
        assert_allclose(
            poses, along.pose(starts(one.tree, 20, spread=1.0, seed=seed)), rtol=1e-9, atol=1e-9
        )


@pytest.mark.parametrize("unit", [1e-6, 1.0, 1e6])
def test_slides_start_anywhere_in_their_travel(unit):
    lift = Joint("lift", slide=True, lower=0, upper=20 * unit)
    free = Joint("free", "lift", (2 * unit, 0, 0), slide=True, lower=unit)
    poses = starts(Tree.of([lift, free]), 200, spread=1.0) / unit
    assert poses[:, 0].max() > 19
    assert 2.9 < poses[:, 1].max() <= 3  # as far from rest as the links are long
    assert poses[:, 1].min() == 1


def test_nearby_poses_hardly_differ():
    rest = HUMAN.tree.rest
    poses = nearby(rest, 30)
    assert poses.shape == (30, len(rest))
    assert_array_equal(poses[0], rest)
    assert_array_equal(poses, nearby(rest, 30))
    assert abs(nearby(rest, 30, seed=1) - poses).max() > 0
    assert len(np.unique(poses, axis=0)) == 30
    assert 0.5e-12 < abs(poses - rest).max() <= 1.001e-12
    assert abs(nearby(rest, 30, apart=0.1) - rest).max() > 0.05


def test_reversals_count_turns_against_the_turn_before():
    tree, hand = figures.planar_arm(1)

    def run(angles):
        theta = np.array(angles, dtype=float)[:, None]
        made = track(tree, hand, np.ones((len(theta), 1, 3)), "dls", dt=0.5)
        return type(made)(**{**vars_of(made), "theta": theta, "start": np.zeros(1)})

    def vars_of(made):
        return {name: getattr(made, name) for name in made.__dataclass_fields__}

    assert reversals(run([0.1, 0.2, 0.3, 0.4])) == 0
    assert reversals(run([0.1, 0.0, 0.1, 0.0])) == pytest.approx(3 / 1.5)
    assert reversals(run([0.1, 0.1, 0.0, 0.0])) == 0  # it stood in between
    assert reversals(run([1e-4, 0, 1e-4, 0])) == 0  # too small to see


def test_a_sine_reverses_twice_a_cycle():
    times = np.arange(1, 121) / 30
    run = track(*HUMAN, gait.walking(times), partial(dls, damping=0.5), times=times)
    swing = run.theta[:, HUMAN.tree.index("hip.bend.l")]
    turn = np.diff(swing)
    assert 2 * 4 / gait.walking.period == pytest.approx((turn[1:] * turn[:-1] < 0).sum(), abs=2)
    batch = track(
        *HUMAN, gait.walking(times)[:, None], partial(dls, damping=0.5), times=times,
        theta=np.stack([HUMAN.tree.rest] * 2),
    )  # fmt: skip
    assert_allclose(reversals(batch), [reversals(run)] * 2)


def test_iterations_are_those_of_a_loop():
    tree, hand = ARM
    poses = starts(tree, 4, spread=0.3)
    goals = locate(forward(tree, starts(tree, 4, spread=0.3, seed=1)), hand)
    counts = iterations(tree, hand, goals, "dls", theta=poses, most=60)
    for pose, goal, count in zip(poses, goals, counts, strict=True):
        met = []
        for _ in range(61):
            met.append(np.linalg.norm(goal - locate(forward(tree, pose), hand)) <= 0.01)
            pose = step(tree, pose, hand, goal, "dls").theta
        assert count == (met.index(True) if any(met) else np.inf)
    assert np.isfinite(counts).any()
    assert iterations(tree, hand, [[9.0, 0, 0]], "dls", most=5) == np.inf
    assert iterations(tree, hand, [[3.0, 0, 0]], "dls") == 0


def test_arrivals_take_targets_that_can_be_met():
    counts = arrivals(*ARM, "dls", poses=20)
    assert (counts > 0).all()
    assert np.isfinite(counts).mean() > 0.8  # the others are stuck at a limit
    assert_array_equal(arrivals(*ARM, "dls", poses=5), arrivals(*ARM, dls, poses=5))


def test_downhill_promises_the_parabola_and_tells_the_truth():
    tree, hand = ARM
    theta, goal = [0.9, -0.7, -0.6], [[0.5, 2.2, 0.0]]
    gains = np.array([0.0, 0.5, 1.0, 1.5, 2.0])
    promised, actual = downhill(tree, hand, theta, goal, gains)
    assert_allclose(np.diff(promised, n=3), 0, atol=1e-12)  # a parabola
    assert promised.argmin() == 2
    assert promised[0] == pytest.approx(promised[4])  # symmetric about the best
    for gain, left in zip(gains, actual, strict=True):
        pose = step(tree, theta, hand, goal, partial(transpose, gain=gain)).theta
        assert np.square(goal - locate(forward(tree, pose), hand)).sum() == pytest.approx(left)


def test_capped_is_a_step_with_that_cap():
    tree, effectors = HUMAN
    goal, bound = gait.running(0.1), 0.05
    for name, solver in SOLVERS.items():
        shortened = capped(solver, bound, effectors.chains, per_chain)
        assert shortened.__name__ == name
        ours = step(tree, tree.rest, effectors, goal, shortened).theta
        theirs = step(tree, tree.rest, effectors, goal, name, max_step=bound, cap=per_chain).theta
        assert_allclose(ours, theirs)
    free = capped(sdls, None, effectors.chains)
    assert_allclose(step(tree, tree.rest, effectors, goal, free).theta,
                    step(tree, tree.rest, effectors, goal, sdls).theta)  # fmt: skip


def test_a_quarter_of_the_circle_is_out_of_the_arms_reach():
    goal = circle(np.linspace(0, 2, 400, endpoint=False))
    assert goal.shape == (400, 1, 3)
    assert (np.linalg.norm(goal, axis=-1) > 3).mean() == pytest.approx(0.25, abs=0.02)
    assert_allclose(circle([0.3]), circle([2.3]))


def test_calls_take_turns():
    called = []
    seconds = turns({name: partial(called.append, name) for name in "ab"}, rounds=3)
    assert called == [*"ababab"]
    assert {name: times.shape for name, times in seconds.items()} == {"a": (3,), "b": (3,)}
    assert min(times.min() for times in seconds.values()) >= 0


def test_a_round_is_a_circle_by_time_and_by_phase():
    motion = Round(centre=(0.0, 1.0, 2.0), radius=0.5, turn=4.0)
    times = np.linspace(0, 4, 9)
    assert_allclose(motion(times), circle(times, centre=(0, 1, 2), radius=0.5, turn=4), atol=1e-12)
    assert_allclose(motion.at(2 * np.pi * times / 4), motion(times), atol=1e-12)


def test_step_times_are_of_every_method():
    times = step_times(*ARM, circle(np.arange(1, 4) / 30), rounds=2)
    assert list(times) == list(SOLVERS)
    assert min(times.values()) > 0
