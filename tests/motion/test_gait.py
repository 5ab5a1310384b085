"""The gait: its parameters, its clock, and that the thesis's statement about reach is true.

The proof comes from outside: scipy's bounded least squares, from several starts.
"""

from dataclasses import fields, replace
from math import inf, nan, pi

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.optimize import least_squares

from ikteach import Effectors, figures, forward, gait, jacobian, locate, reachable
from ikteach.motion.gait import WOUND, displayed, running, walking
from ikteach.motion.reachable import nearest

TREE, EFFECTORS = figures.human()
CYCLE = 12  # times over one cycle


def by_least_squares(i, target, starts=4):
    """How near effector i can come to a target with the limits on [m]: scipy's answer."""
    name = EFFECTORS.names[i]
    joint = TREE.names[EFFECTORS.joints[i]]
    alone = Effectors.of(TREE, {name: (joint, EFFECTORS.offsets[i])})
    limb = np.flatnonzero(alone.carried[0])
    rng = np.random.default_rng(0)

    def pose(x):
        theta = TREE.rest.copy()
        theta[limb] = x
        return theta

    def miss(x):
        return (locate(forward(TREE, pose(x)), alone) - target)[0]

    def slope(x):
        return jacobian(TREE, forward(TREE, pose(x)), alone)[:, limb]

    lower, upper = TREE.lower[limb], TREE.upper[limb]
    best = inf
    for start in range(starts):
        x = rng.uniform(lower, upper) if start else (lower + upper) / 2
        found = least_squares(miss, x, slope, bounds=(lower, upper), xtol=1e-10, ftol=1e-10)
        best = min(best, np.linalg.norm(found.fun))
        if best < 1e-6:
            break
    return best


@pytest.fixture(scope="module", params=["walking", "running"])
def cycle(request):
    """A motion, its targets over one cycle (T, 4, 3), and the oracle's nearest distances (T, 4)."""
    motion = gait.MOTIONS[request.param]
    targets = motion(np.linspace(0, motion.period, CYCLE, endpoint=False))
    oracle = [[by_least_squares(i, t) for i, t in enumerate(row)] for row in targets]
    return motion.name, targets, np.array(oracle)


def test_walking_feet_reach_and_hands_never_and_running_none(cycle):
    name, _, oracle = cycle
    feet, hands = oracle[:, :2], oracle[:, 2:]
    if name == "walking":
        assert feet.max() < 1e-6
        assert hands.min() > 0.15
    else:
        assert oracle.min() > 0.02


def test_our_own_search_finds_what_the_oracle_finds(cycle):
    _, targets, oracle = cycle
    assert_array_equal(reachable(TREE, EFFECTORS, targets), oracle < 1e-3)
    ours = nearest(TREE, EFFECTORS, targets)
    assert (ours >= oracle - 1e-6).all()
    assert_allclose(ours, oracle, atol=1e-2)


@pytest.mark.parametrize("motion", gait.MOTIONS.values(), ids=gait.MOTIONS)
def test_the_targets_are_the_thesiss(motion):
    T = np.linspace(0, 2, 7)
    left_foot, right_foot, right_hand, left_hand = np.moveaxis(motion(T), 1, 0)
    swing = np.sin(motion.speed * T)
    assert_array_equal(left_foot[:, 0], 0.35)
    assert_array_equal(right_foot[:, 0], -0.35)
    assert_array_equal(right_hand[:, 0], -0.8)
    assert_array_equal(left_hand[:, 0], 0.8)
    assert_allclose(left_foot[:, 2], motion.back_z_leg * swing)
    assert_allclose(right_foot[:, 2], motion.front_z_leg * swing)
    reach = {"walking": 0.3, "running": 1.0}[motion.name]
    assert_allclose(right_hand[:, 2], -reach * swing)
    assert_allclose(left_hand[:, 2], reach * swing)
    assert_allclose(left_foot[:, 1], motion.back_y_leg)
    assert_allclose(right_foot[:, 1], motion.front_y_leg)
    assert_allclose(right_hand[:, 1], motion.back_y_hand)
    assert_allclose(left_hand[:, 1], motion.front_y_hand)
    assert_allclose(motion(T + motion.period), motion(T), atol=1e-12)
    assert motion(T[0]).shape == (4, 3)
    assert motion(T.reshape(7, 1)).shape == (7, 1, 4, 3)


MOVED = {
    "speed": 7.0, "back_z_leg": 0.1, "front_z_leg": 0.1, "back_y_leg": -0.7, "front_y_leg": -0.7,
    "hand_z": 0.1, "back_y_hand": 0.1, "front_y_hand": 0.1, "step_frequency": 0.5, "slowdown": 4,
    "x_leg": 0.2, "x_hand": 0.5, "forward": True, "wound": WOUND,
}  # fmt: skip


@pytest.mark.parametrize("parameter", [f.name for f in fields(gait.Gait) if f.name != "name"])
def test_every_parameter_does_something(parameter):
    changed = replace(walking, **{parameter: MOVED[parameter]})

    def all_there_is(motion):
        T = motion.clock(10)
        parts = (motion(T), T, motion.advance(T), motion.mobility(TREE))
        return np.concatenate([np.ravel(part) for part in parts])

    assert (all_there_is(changed) != all_there_is(walking)).any()


def test_the_clock_leaps_and_makes_up_for_it():
    dt = 0.1
    smooth = walking.clock(8, dt)
    assert_allclose(smooth, dt * np.arange(1, 9))
    leaping = replace(walking, slowdown=4).clock(8, dt)
    assert_allclose(leaping, [0, 0, 0, 0.4, 0.4, 0.4, 0.4, 0.8])
    assert_allclose(replace(walking, step_frequency=0.5).clock(8, dt), smooth / 2)


def test_period_and_pace():
    assert walking.period == pytest.approx(2 * pi / 5.6)
    assert replace(walking, speed=-5.6).period == walking.period
    assert replace(walking, speed=0.0).period == inf
    # Both feet swing 2 × 0.25 m forward in a cycle, one after the other.
    assert walking.pace * walking.period == pytest.approx(4 * 0.25)


def test_forward_goes_forward():
    T = np.array([0.0, 1, 2])
    assert_array_equal(walking.advance(T), np.zeros((3, 3)))
    there = replace(walking, forward=True).advance(T)
    assert_allclose(there[:, 2], walking.pace * T)
    assert not there[:, :2].any()
    assert replace(walking, forward=True).advance(T.reshape(3, 1)).shape == (3, 1, 3)


def test_a_wound_is_a_mobility():
    assert_array_equal(walking.mobility(TREE), TREE.mobility)
    s = replace(walking, wound=WOUND).mobility(TREE)
    for joint, value in WOUND.items():
        assert s[TREE.index(joint)] == value
    assert (s != 1).sum() == len(WOUND)
    assert_array_equal(TREE.mobility, 1)
    wounded = replace(walking, wound={"kne.r": 0.1})
    with pytest.raises(LookupError, match=r"no joint 'kne.r'; did you mean 'knee.r'"):
        wounded.mobility(TREE)


def test_what_the_thesis_draws_of_a_wound():
    theta = np.array([1.0, 2.0])
    assert_array_equal(displayed(theta), theta)
    assert_array_equal(displayed(theta, times=[0.5, 1], plus=[0, 1]), [0.5, 3])


@pytest.mark.parametrize(
    ("wrong", "match"),
    [
        ({"speed": nan}, "speed of 'walking' is nan; it must be a finite number"),
        ({"x_leg": inf}, "x_leg of 'walking' is inf"),
        ({"hand_z": "far"}, "hand_z of 'walking' is 'far'; it must be a finite number"),
        ({"back_y_leg": None}, "back_y_leg of 'walking' is None; it must be a finite number"),
        ({"slowdown": 0}, "slowdown counts ticks, from 1 up; it is 0"),
        ({"slowdown": 1.5}, "slowdown counts ticks"),
        ({"wound": {"knee.r": 2}}, "mobility of 'knee.r' must be from 0 to 1, not 2"),
        ({"wound": {"knee.r": nan}}, "mobility of 'knee.r' must be from 0 to 1, not nan"),
    ],
)
def test_what_is_wrong_is_named(wrong, match):
    with pytest.raises(ValueError, match=match):
        replace(walking, **wrong)


def test_an_unknown_motion():
    assert gait.MOTIONS["running"] is running
    with pytest.raises(LookupError, match="no motion 'wlaking'; did you mean 'walking'"):
        gait.MOTIONS["wlaking"]
    with pytest.raises(LookupError, match="no motion 'x'; there are 'walking', 'running'"):
        gait.MOTIONS["x"]
