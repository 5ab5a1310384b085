"""Measures of a gait: on gaits of which the answer is known."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest
from numpy.testing import assert_allclose

from ikteach import Effectors, figures
from ikteach.motion import gait
from ikteach.motion.paths import quality
from ikteach.motion.paths.perform import imitate, perform
from ikteach.motion.paths.recorded import drawn
from ikteach.motion.paths.walk import Walk
from ikteach.motion.track import Track

TREE, EFFECTORS = figures.walker()
WALK = Walk()


def posed(theta, times):
    """A run through these poses."""
    T, k = len(theta), len(EFFECTORS)
    zero = np.zeros((T, k))
    return Track(
        "mine",
        TREE,
        EFFECTORS,
        times,
        np.zeros((T, k, 3)),
        theta[0],
        theta,
        zero,
        zero[:, 0],
        np.zeros(theta.shape, dtype=bool),
        0.0,
    )


def norm_itself(off=0.0, frames=300):
    """A run whose joints go as the norms do, but for so many degrees."""
    times = np.arange(frames) / 100
    theta = np.tile(TREE.rest, (frames, 1))
    means, marks = quality.norms(), np.arange(51) / 50
    for side, late in ("l", 0.0), ("r", 0.5):
        u = (WALK.rate * times / (2 * pi) - late) % 1
        for curve, name in ("hip", "hip.bend"), ("knee", "knee"), ("ankle", "ankle"):
            angle = np.interp(u, marks, means[curve])
            theta[:, TREE.index(f"{name}.{side}")] = np.radians(angle + off)
    u = WALK.rate * times / (2 * pi) % 1
    theta[:, TREE.index("pelvis.x")] = np.radians(np.interp(u, marks, means["pelvis"]) + off)
    return posed(theta, times)


def test_the_norm_itself_scores_nearly_nothing_and_what_is_off_so_much():
    """Pelvic tilt is one angle for both sides, and the norm's halves differ by some tenths."""
    assert quality.gait_score(norm_itself(), WALK) < 0.3
    assert quality.gait_score(norm_itself(off=5.0), WALK) == pytest.approx(5, abs=0.1)


def test_where_a_foot_is_in_its_cycle():
    phases = np.array([0.0, 1.0, 7.0])
    share = phases / (2 * pi) % 1
    found = quality.cycle(WALK, phases)
    assert_allclose(found, np.stack([share, (share + 0.5) % 1], axis=-1), atol=2e-3)
    assert quality.cycle(WALK, 1.0).shape == (2,)
    # The thesis's feet come down where they are foremost, each half a cycle after the other.
    left, right = quality.cycle(gait.walking, 3 * pi / 2 + 0.01)
    assert left == pytest.approx(0, abs=5e-3)
    assert right == pytest.approx(0.5, abs=5e-3)
    with pytest.raises(ValueError, match="does not say when feet stand"):
        quality.cycle(drawn([[0, 0, 0], [1, 0, 0]], 1, figure=figures.walker()), 0.0)


def test_angles_are_those_of_the_pose_on_both_sides():
    theta = np.zeros((3, len(TREE)))
    theta[:, TREE.index("knee.r")], theta[:, TREE.index("pelvis.x")] = 1, 0.1
    found = quality.sagittal(TREE, theta)
    assert_allclose(found["knee"], np.degrees([[0, 1]] * 3))
    assert_allclose(found["pelvis"], np.degrees(0.1))
    assert_allclose(quality.sagittal(figures.human().tree, np.zeros(20))["pelvis"], [0, 0])


def test_a_score_of_nothing_says_nothing_of_the_feet():
    """Goodhart: joints on the norm itself, and feet that slip and scrape."""
    run = imitate(WALK, figures.walker(), cycles=4)
    natural = perform(WALK, figures.walker(), "dls", cycles=4)
    assert quality.gait_score(run, WALK) < 0.5
    assert quality.slip(run, WALK).min() > 5 * quality.slip(natural, WALK).max()
    assert quality.double_support(run, WALK) < 0.15 < quality.double_support(natural, WALK)


def test_a_score_is_of_curves():
    means = quality.norms()
    assert quality.score_of(means) == 0
    assert quality.score_of({name: curve + 3 for name, curve in means.items()}) == pytest.approx(3)
    assert quality.score_of(means | {"knee": means["knee"] + 4}) == pytest.approx(2)  # √(16 / 4)
    assert quality.score_of(means, "Slow") > 1


def test_norms_are_those_of_the_table():
    free = quality.norms()
    assert {name: len(curve) for name, curve in free.items()} == dict.fromkeys(quality.CURVES, 51)
    assert free["knee"].max() == pytest.approx(58, abs=4)  # degrees, in the swing
    assert (quality.deviations()["hip"] > 3).all()
    with pytest.raises(ValueError, match="Slow, Free, Fast"):
        quality.norms("free")


@pytest.mark.parametrize("slide", [0.0, 0.05])
def test_a_figure_that_stands_slips_as_far_as_the_ground_goes(slide):
    """A pose that stays, on a treadmill: each point slips as far as it goes while it stands."""
    times = np.arange(400) / 100
    walk = WALK.change(speed=slide)
    theta = np.tile(TREE.rest, (400, 1))
    stance = walk.duty * walk.period
    found = quality.slip(posed(theta, times), walk)
    assert (found <= slide * stance + 1e-9).all()
    assert (found >= 0.2 * slide * stance).all()  # a heel stands for a part of the stance


def test_a_foot_that_never_leaves_drags_a_whole_stride():
    times = np.arange(400) / 100
    theta = np.tile(TREE.rest, (400, 1))
    floor = quality.soles(posed(theta, times), WALK).heights.min() + WALK.floor
    walk = WALK.change(height=-floor)
    assert_allclose(quality.drag(posed(theta, times), walk), walk.stride, rtol=0.05)


def test_double_support_is_that_of_the_plan_where_it_is_met():
    for duty in 0.56, 0.66:
        walk = WALK.change(duty=duty, speed=1.0)  # slow enough to be within reach
        run = perform(walk, figures.walker(), "dls", cycles=3, dt=1 / 100)
        assert quality.double_support(run, walk) == pytest.approx(2 * duty - 1, abs=0.06)


def test_what_has_no_feet_or_no_stride_is_refused():
    run = norm_itself()
    with pytest.raises(ValueError, match="no whole stride"):
        quality.gait_score(norm_itself(frames=100), WALK)
    pelvis = Effectors.of(TREE, {"pelvis": ("pelvis.z", (0, 0, 0))})
    path = drawn([[0, 0, 0], [1, 0, 0]], 1, figure=figures.Figure(TREE, pelvis))
    with pytest.raises(ValueError, match="no targets for the feet"):
        quality.slip(replace(run, effectors=pelvis), path)
    with pytest.raises(ValueError, match="one run is measured"):
        quality.soles(replace(run, theta=run.theta[:, None]), WALK)
