"""The natural walk: what its plan promises, and what a body makes of it."""

from math import pi

import numpy as np
import pytest
from numpy.testing import assert_allclose

from ikteach import dls_following, figures
from ikteach.motion import gait
from ikteach.motion.paths import quality
from ikteach.motion.paths.perform import perform
from ikteach.motion.paths.walk import NAMES, WALK_RATIO, WALKS, Walk, at_speed, natural

WALKER = figures.walker()
PHASES = np.linspace(0, 2 * pi, 400, endpoint=False)
FEET = [NAMES.index(name) for name in ("heel.l", "ball.l", "heel.r", "ball.r")]
VARIANTS = [*WALKS.values(), Walk(duty=0.7), Walk(strike=0, push_off=-40)]
NORMS = {"slow": "Slow", "natural": "Free", "fast": "Fast"}


@pytest.mark.parametrize("walk", VARIANTS)
def test_a_point_that_stands_does_not_move_over_the_ground(walk):
    places, stands = walk.at(PHASES), walk.stands(PHASES)
    places[..., 2] += (walk.pace * PHASES / walk.rate)[:, None]
    for i in FEET:
        for a, b in quality.spans(stands[:, i]):
            stood = places[a:b, i]
            assert abs(stood - stood[0]).max() < 2e-3  # within half a degree both lie flat
            assert abs(stood[:, 1] - walk.floor).max() < 2e-3


@pytest.mark.parametrize("walk", VARIANTS)
def test_no_sole_goes_under_the_ground(walk):
    assert walk.at(PHASES)[:, FEET, 1].min() > walk.floor - 1e-3


def test_a_foot_stands_for_its_duty_and_both_for_the_rest():
    walk = Walk(duty=0.65)
    stands = walk.stands(PHASES)[:, FEET].reshape(-1, 2, 2).any(axis=-1)
    assert_allclose(stands.mean(axis=0), 0.65, atol=0.005)
    assert stands.all(axis=1).mean() == pytest.approx(0.3, abs=0.01)


def test_the_walk_comes_round_without_a_jump():
    walk = Walk()
    around = walk.at(np.linspace(0, 2 * pi, 4001))
    assert_allclose(around[-1], around[0], atol=1e-9)
    assert np.linalg.norm(np.diff(around, axis=0), axis=-1).max() < 0.01


def test_the_right_side_mirrors_the_left_half_a_cycle_later():
    left, right = Walk().at(PHASES)[:, FEET[:2]], Walk().at(PHASES + pi)[:, FEET[2:]]
    assert_allclose(right, left * [-1, 1, 1], atol=1e-9)


def test_the_pelvis_keeps_its_frame():
    up, ahead = np.moveaxis(Walk().at(PHASES)[:, -2:], 1, 0)
    assert_allclose(np.linalg.norm([up, ahead], axis=-1), figures.GAZE, rtol=1e-5)
    assert_allclose(np.vecdot(up, ahead), 0, atol=1e-6)


def test_what_is_read_is_what_was_worked_out():
    walk = Walk()
    q = np.linspace(-1.3, 2.7, 777)
    assert_allclose(walk.at(2 * pi * q), walk.plan(q), atol=1e-4)
    wish = walk.wish(WALKER.tree, 2 * pi * q)
    assert_allclose(wish, walk.posture(WALKER.tree, q), atol=1e-3)
    assert walk.at(1.0).shape == (7, 3)


@pytest.mark.parametrize("solver", ["sdls", dls_following], ids=["sdls", "following"])
@pytest.mark.parametrize("name", WALKS)
def test_a_walker_walks_nearly_as_the_norm(solver, name):
    """The numbers that are promised, at 30 Hz with two steps a frame."""
    walk = WALKS[name]
    run = perform(walk, WALKER, solver, cycles=4)
    feet = run.error[:, [run.effectors.names.index(NAMES[i]) for i in FEET]]
    assert quality.gait_score(run, walk, speed=NORMS[name]) <= 6.5  # degrees
    assert quality.slip(run, walk).max() <= 0.005  # m
    assert quality.clearance(run, walk).min() >= 0.015
    assert feet.mean() <= 0.002
    assert quality.drag(run, walk).max() <= 0.10
    assert 0.20 <= quality.double_support(run, walk) <= (0.30 if name == "slow" else 0.26)
    assert quality.arm_swing(run, walk).max() <= -0.8
    assert quality.soles(run, walk).heights.min() >= -0.003


def test_the_gait_of_the_thesis_is_far_from_it():
    """Its targets are met by the feet, and say nothing of the ground."""
    run = perform(gait.walking, figures.human(), "dls", cycles=4)
    assert run.error[:, :2].mean() < 0.005
    assert quality.gait_score(run, gait.walking) >= 12
    assert quality.drag(run, gait.walking).min() >= 0.15


@pytest.mark.parametrize(
    ("parameter", "value", "words"),
    [
        ("duty", 0.3, "duty of 'natural' goes from 0.51 to 0.9"),
        ("speed", np.nan, "speed of 'natural' must be a finite number"),
        ("lift_at", 0.0, "lift_at of 'natural' goes from 0.05"),
        ("cadence", 0, "cadence of 'natural' goes from 1"),
        ("name", "", "name has 1 to"),
        ("slowdown", 0, "slowdown counts ticks"),
        ("wound", {"knee.l": 2}, "mobility of 'knee.l' must be from 0 to 1"),
    ],
)
def test_a_parameter_that_cannot_be_is_named(parameter, value, words):
    with pytest.raises(ValueError, match=words):
        Walk().change(**{parameter: value})


def test_a_parameter_that_is_none_is_named():
    with pytest.raises(LookupError, match="did you mean 'cadence'"):
        Walk().change(cadenz=3)


def test_only_who_has_such_limbs_can_walk():
    with pytest.raises(ValueError, match="none for 'hand'"):
        Walk().on(*figures.planar_arm(3))


@pytest.mark.parametrize("speed", [0.6, 0.95, 1.3, 1.6])
def test_a_walk_of_any_speed_has_a_stride_that_the_legs_allow(speed):
    walk = at_speed(speed)
    assert walk.speed == pytest.approx(speed)
    assert walk.stride / 2 / walk.cadence == pytest.approx(WALK_RATIO)
    assert 0.85 < walk.height < 0.95
    assert walk.spare > 0
    run = perform(walk, figures.walker(), "sdls", cycles=3)
    assert run.error.mean() < 0.005
    assert quality.slip(run, walk).max() < 0.01


def test_a_stride_that_is_too_long_is_known_before_it_is_walked():
    assert abs(natural.spare) < 0.005
    spares = [natural.change(speed=speed).spare for speed in (1.3, 1.45, 1.6)]
    assert spares == sorted(spares, reverse=True)
    assert spares[-1] < -0.03
    assert natural.change(speed=1.6, cadence=140).spare > -0.005
    assert natural.change(speed=1.45, height=0.89).spare > 0


@pytest.mark.parametrize("speed", [0.1, 3, float("nan"), -1])
def test_a_speed_at_which_nobody_walks_is_refused(speed):
    with pytest.raises(ValueError, match=r"speed|people walk"):
        at_speed(speed)
