"""Three walks of one body: whole strides on level ground, and what is measured lately."""

import numpy as np
import pytest

from ikteach import figures
from ikteach.formats.bvh import recorded_walk
from ikteach.motion.live.abreast import Abreast
from ikteach.motion.live.session import Session
from ikteach.motion.paths import quality
from ikteach.study.walks import followed, for_human, lately, limbs, three_walks


@pytest.fixture(scope="module")
def walks():
    return three_walks(recorded_walk())


def test_the_recorded_walk_is_of_whole_strides_on_level_ground(walks):
    walk = walks["recorded"][1]
    leap = abs(walk.at(0.0) - walk.at(2 * np.pi * (1 - 1e-9))).max()
    assert leap < 0.02  # it begins anew nearly where it ends: another stride is never the same
    feet = [i for i, name in enumerate(walk.names) if name.startswith(("heel", "ball"))]
    low = walk.targets[:, feet, 1].min(axis=1) - walk.floor
    slope = np.polyfit(walk.times, low, 1)[0]
    assert abs(slope) < 0.005  # [m/s]; as recorded 0.008
    assert low.min() > -0.02
    share = walk.standing[:, feet].mean(axis=0)
    assert ((share > 0.2) & (share < 0.75)).all()
    assert walk.standing[:, feet].any(axis=1).all()  # a walk: there is always a foot on the ground


def test_the_thesis_has_its_own_targets_and_a_pelvis_that_is_the_ground(walks):
    (tree, effectors), walk = walks["thesis"]
    session = Session(walks["thesis"][0], walk, ["sdls"], iterations=2)
    for _ in range(20):
        session.tick()
    pelvis = [row for row, name in enumerate(tree.names) if name.startswith("pelvis")]
    assert not session.theta["sdls"][pelvis].any()
    assert set(effectors.names) == {"ball.l", "ball.r", "hand.l", "hand.r"}
    feet = [session.error[effectors.names.index(name)] for name in ("ball.l", "ball.r")]
    assert max(feet) < 0.01


def test_a_walk_for_a_human_can_be_met_and_keeps_its_strides(walks):
    figure, natural = walks["natural"]
    walk = for_human(natural, figure, "natural")
    assert walk.period == pytest.approx(natural.period, abs=0.02)
    assert walk.pace == natural.pace
    human = figures.human()
    assert walk.on(*human).floor == pytest.approx(natural.floor, abs=0.02)
    session = Session(human, walk, ["sdls"], iterations=2)
    for _ in range(60):
        session.tick()
    assert session.error.max() < 0.02
    assert quality.cycle(walk, 0.0)[0] == pytest.approx(0, abs=0.02)


def test_four_targets_leave_the_knees_wrong():
    few, all_of_them = followed(recorded_walk(), ("ball", "hand")), followed(recorded_walk())
    assert few.limbs < 0.004
    assert few.knees > 15
    assert all_of_them.knees < 3
    assert all_of_them.limbs > 1.1 * few.limbs


def test_what_is_measured_is_the_walk_as_it_is_set_now():
    session = Session(figures.walker(), methods=["sdls"])
    assert lately(session, 50) is None
    for _ in range(40):
        session.tick()
    session.change(cadence=90.0)
    for _ in range(25):
        session.tick()
    run = lately(session, 60)
    assert len(run) == 25
    rate = session.gait.rate
    assert np.diff(run.times) == pytest.approx(session.dt)
    assert run.theta[-1] == pytest.approx(session.theta["sdls"])
    assert rate * run.times[-1] == pytest.approx(session.phase)
    course = session.gait.on(session.tree, session.effectors)
    assert run.targets[-1] == pytest.approx(course.at(rate * run.times[-1]))


def test_figures_abreast_have_one_clock():
    pair = Abreast({"a": Session(), "b": Session(dt=1 / 30)})
    pair.tick()
    assert [one.ticks for one in pair.sessions.values()] == [1, 1] == [pair.ticks] * 2
    pair.reset()
    assert [one.ticks for one in pair.sessions.values()] == [0, 0]
    with pytest.raises(ValueError, match="one clock, not 2"):
        Abreast({"a": Session(), "b": Session(dt=0.1)})


def test_limbs_are_the_points_that_are_asked_for():
    tree = figures.walker().tree
    assert len(limbs(tree)) == 13
    assert limbs(tree, ["hand.l", "pelvis.up"]).names == ("hand.l", "pelvis.up")
