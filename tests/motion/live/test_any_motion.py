"""A session of any motion: natural, recorded, drawn; steps a tick; where it starts."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from ikteach import SOLVERS, figures, step
from ikteach.formats.session import load, save
from ikteach.motion import gait
from ikteach.motion.live.session import Session
from ikteach.motion.live.settings import DAMPING, usual_methods
from ikteach.motion.path import Motion, Path
from ikteach.motion.paths.recorded import Recorded, drawn
from ikteach.motion.paths.walk import Walk

WALKER = figures.walker()
ARM = figures.planar_arm(3)
CURVE = [[1, 1, 0], [2, 1, 0], [2, 2, 0]]


def run(session, count):
    for _ in range(count):
        session.tick()
    return session


def motions():
    arm = drawn(CURVE, 3, figure=ARM)
    table = Recorded(np.arange(4.0), np.ones((4, 1, 3)), ("hand",), tempo=0.5)
    return {
        "natural": (WALKER, Walk()),
        "drawn": (ARM, arm),
        "recorded": (ARM, table),
        "gait": (figures.human(), gait.walking),
        "path": (ARM, Path.through(np.ones((2, 1, 3)))),
    }


@pytest.mark.parametrize("name", motions())
def test_a_session_goes_by_any_motion(name, tmp_path):
    figure, motion = motions()[name]
    assert isinstance(motion, Motion)
    session = run(Session(figure, motion, iterations=2), 3)
    course = motion.on(*figure)
    assert_allclose(session.targets, course.at(motion.rate * 3 / 30))
    session.change(slowdown=2)
    assert session.gait.slowdown == 2
    session.undo()
    assert session.gait is motion
    save(tmp_path / "run", session)
    back = load(tmp_path / "run")
    assert back.settings["gait"]["name"] == motion.name
    assert back.settings["iterations"] == 2
    assert_array_equal(back.tracks()["dls"].theta, session.tracks()["dls"].theta)


@pytest.mark.parametrize("name", motions())
def test_what_a_motion_has_not_cannot_be_changed(name):
    figure, motion = motions()[name]
    with pytest.raises(LookupError, match="gait parameter 'slowdwon'; did you mean 'slowdown'"):
        Session(figure, motion).change(slowdwon=2)


def test_a_walker_walks_by_itself_and_can_go_forward():
    session = Session(WALKER, iterations=2)
    assert isinstance(session.gait, Walk)
    session.change(forward=True)
    run(session, 30)
    assert session.advance == pytest.approx(session.gait.speed)  # m, after a second
    assert session.floor == -session.gait.height


def test_a_wish_reaches_what_no_target_moves():
    session = run(Session(WALKER, Walk(), iterations=2), 20)
    wish = session.gait.wish(WALKER.tree, session.phase)
    for name in ("elbow.l", "shoulder.bend.r", "toes.l"):
        j = WALKER.tree.index(name)
        assert_allclose(session.theta["dls"][j], wish[j], atol=0.02)


def test_steps_of_a_tick_are_steps():
    options = {"methods": ["dls"], "gait": gait.walking}
    session = run(Session(iterations=3, **options), 1)
    tree, effectors = figures.human()
    theta = tree.rest
    for _ in range(3):
        theta = step(tree, theta, effectors, session.targets, "dls").theta
    assert_array_equal(session.theta["dls"], theta)


def test_a_start_is_where_it_begins_and_begins_anew():
    tree = figures.human().tree
    start = np.clip(tree.rest + 0.2, tree.lower, tree.upper)
    session = Session(start=start)
    assert_array_equal(session.theta["dls"], start)
    run(session, 2).reset()
    assert_array_equal(session.theta["sdls"], start)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"start": [0, 0]}, "20 joints need theta"),
        ({"start": np.full(20, 9.0)}, "the start has 'spine.bend' beyond its limits"),
        ({"start": np.zeros((2, 20))}, "the start is one pose"),
        ({"iterations": 0}, "iterations must be 1 or more"),
        ({"weights": [1, 2]}, "weights need a number from 0 up for each effector"),
    ],
)
def test_what_cannot_be_is_refused(options, words):
    with pytest.raises(ValueError, match=words):
        Session(**options)


def test_weights_are_an_option_of_all_methods():
    session = run(Session(gait=gait.running, weights=[1, 1, 0, 0]), 5)
    assert set(session.methods) == set(SOLVERS)
    session.adjust(weights=[1, 1, 1, 2])
    run(session, 1)


def test_other_data_are_another_motion_though_all_else_is_the_same():
    one, two = (drawn([[1, y, 0], [2, 1, 0]], 3, figure=ARM) for y in (1, 2))
    session = Session(ARM, one)
    session.gait = two
    assert session.events[-1].what == {"motion": "drawn"}
    assert_allclose(session.targets, two.at(0.0))


def test_a_free_pelvis_makes_a_human_no_larger():
    """The λ of dls goes with the body's size, and slides without limits have none."""
    human = figures.human()
    for figure in figures.floating(human), WALKER:
        damping = usual_methods(*figure)["dls"].keywords["damping"]
        assert damping == pytest.approx(DAMPING, rel=0.2)
