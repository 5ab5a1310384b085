"""A live figure's state: time, changes that can be taken back, and a log with an end."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal

from ikteach import SOLVERS, dls, figures, forward, locate, step
from ikteach.motion import clip, gait
from ikteach.motion.live import history
from ikteach.motion.live.session import Session
from ikteach.motion.live.settings import in_words
from ikteach.motion.mix import Mix
from ikteach.study import angles, events, ticks

HAND = [0.1, 0.2, 0.3]


@pytest.fixture
def session():
    return Session()


def run(session, count):
    for _ in range(count):
        session.tick()
    return session


def kinds(session):
    return [event.kind for event in session.events]


def test_a_tick_is_a_step_of_every_method(session):
    run(session, 3)
    before, targets = dict(session.theta), session.gait.at(session.gait.speed * 4 / 30)
    session.tick()
    assert_allclose(session.targets, targets, atol=1e-12)
    for name, solver in SOLVERS.items():
        wanted = step(session.tree, before[name], session.effectors, session.targets, solver)
        assert_array_equal(session.theta[name], wanted.theta)
    assert session.time == pytest.approx(4 / 30)
    s = locate(forward(session.tree, session.theta["dls"]), session.effectors)
    assert_allclose(session.error, np.linalg.norm(session.targets - s, axis=-1))


def test_frames_are_those_of_the_poses(session):
    for count in (0, 2):
        run(session, count)
        for name, theta in session.theta.items():
            for part, wanted in zip(
                session.frames_of(name), forward(session.tree, theta), strict=True
            ):
                assert_array_equal(part, wanted)
        s = locate(forward(session.tree, session.theta["dls"]), session.effectors)
        assert_allclose(session.error, np.linalg.norm(session.targets - s, axis=-1))
    with pytest.raises(LookupError, match="no method 'dsl'"):
        session.frames_of("dsl")
    with pytest.raises(TypeError, match="does not support item assignment"):
        session.theta["dls"] = session.tree.rest
    with pytest.raises(ValueError, match="read-only"):
        session.theta["dls"][0] = 1


def test_ahead_is_where_the_next_tick_goes(session):
    session.change(slowdown=3, forward=True)
    run(session, 4)
    ahead = session.ahead()
    run(session, 2)
    for said, done in zip(
        ahead, (session.time, session.phase, session.advance, session.targets), strict=True
    ):
        assert_array_equal(said, done)


def test_slowdown_waits_and_makes_up(session):
    session.change(slowdown=4)
    run(session, 11)
    assert session.ticks == 11
    assert session.time == pytest.approx(8 / 30)
    assert [moment.tick for moment in session.record] == [4, 8]
    assert_allclose(session.log().clock, [4 / 30, 8 / 30])


def test_the_record_is_what_happened(session):
    run(session, 5).show("sdls")
    run(session, 2)
    tracks = session.tracks()
    log = session.log()
    assert list(tracks) == list(SOLVERS) == list(log.methods)
    assert_array_equal(tracks["dls"].theta[-1], session.theta["dls"])
    assert_array_equal(log.theta[-1, 3], session.theta["sdls"])
    assert_array_equal(log.error[-1, 3], session.error)
    assert_array_equal(log.targets[-1], session.targets)
    assert list(log.shown) == [2] * 5 + [3] * 2
    assert_array_equal(log.floor, [session.floor] * 7)
    assert len(session.tracks(last=3)["dls"]) == len(session.log(last=3)) == 3
    assert Session().tracks() == {}
    assert len(Session().log()) == 0


def test_the_log_does_not_change_afterwards(session):
    log = run(session, 3).log()
    before = log.theta.copy(), len(log.events)
    run(session, 3).change(speed=1)
    assert_array_equal(log.theta, before[0])
    assert len(log.events) == before[1]


def test_what_is_bounded_says_what_it_dropped():
    session = run(Session(keep=5, keep_events=2), 8)
    for speed in (1, 2, 3):
        session.change(speed=speed)
        session.note("pause")
    log = session.log()
    assert len(log) == 5
    assert log.tick[0] == 4
    assert session.dropped == 3
    assert session.events_dropped == 4
    assert log.lost() == (
        "The log is bounded: the 3 earliest ticks and the 4 earliest events were dropped."
    )
    assert Session().log().lost() == ""


def test_changes_are_events_with_their_time(session):
    run(session, 2).show("sdls")
    session.change(speed=3.0)
    session.gait = replace(gait.running, forward=True)
    session.aim("hand.l", HAND)
    session.by_hand = False
    session.adjust(max_step=0.2, limits=clip)
    session.use("dls", partial(dls, damping=0.4))
    session.note("pause")
    assert [str(event) for event in session.events] == [
        "method: shown sdls",
        "gait: speed 3.0",
        "gait: motion running",
        "target: effector hand.l, position (0.1, 0.2, 0.3)",
        "by hand: by_hand False",
        "options: max_step 0.2, limits clip",
        "solver: method dls, solver (function dls, damping 0.4)",
        "pause",
    ]
    assert {(event.run, event.tick) for event in session.events} == {(0, 2)}
    assert session.events[0].time == session.time
    run(session, 1)
    assert session.methods["dls"].keywords == {"damping": 0.4}


def test_what_changes_nothing_is_no_event(session):
    session.show("dls")
    session.change(speed=session.gait.speed)
    session.by_hand = False
    assert kinds(session) == []


def test_a_slider_on_its_way_is_one_change(session, monkeypatch):
    now = 100.0
    monkeypatch.setattr(history, "monotonic", lambda: now)
    for speed in (6.0, 6.5, 7.0):
        session.change(speed=speed)
        now += 0.3
    session.change(slowdown=2)
    now += 5
    session.change(slowdown=3)
    assert [str(event) for event in session.events] == [
        "gait: speed 7.0", "gait: slowdown 2", "gait: slowdown 3",
    ]  # fmt: skip
    session.undo()
    session.undo()
    assert session.gait == replace(gait.walking, speed=7.0)
    session.undo()
    assert session.gait == gait.walking


def test_targets_by_hand_stay_where_they_are_put(session):
    run(session, 3)
    at = session.targets.copy()
    session.aim("hand.l", HAND)
    session.aim(0, [0.3, -0.8, 0.1])
    run(session, 5)
    assert session.by_hand
    assert_array_equal(session.targets[3], HAND)
    assert_array_equal(session.targets[0], [0.3, -0.8, 0.1])
    assert_array_equal(session.targets[1:3], at[1:3])
    assert session.time == pytest.approx(8 / 30)
    phase = session.phase
    session.by_hand = False
    assert_array_equal(session.targets, session.gait.at(phase))


def test_a_drag_is_one_change_and_undone_as_one(session):
    for i in range(5):
        session.aim("hand.l", [0.1 * i, 0, 0], going_on=i > 0)
    session.aim("hand.r", HAND, going_on=True)  # another target is another move
    assert kinds(session) == ["target", "target"]
    assert session.events[0].what["position"] == [0.4, 0, 0]
    assert session.undo().what["effector"] == "hand.r"
    assert_array_equal(session.targets[3], [0.4, 0, 0])
    session.undo()
    assert not session.by_hand
    assert_array_equal(session.targets, session.gait.at(0.0))


CHANGES = {
    "show": lambda s: s.show("sdls" if s.method == "dls" else "dls"),
    "gait": lambda s: setattr(s, "gait", gait.running if s.gait.speed < 9 else gait.walking),
    "speed": lambda s: s.change(speed=s.gait.speed + 0.5),
    "wound": lambda s: s.change(wound={} if s.gait.wound else gait.WOUND),
    "aim": lambda s: s.aim("hand.r", s.targets[2] + 0.01),
    "hand": lambda s: setattr(s, "by_hand", not s.by_hand),
    "adjust": lambda s: s.adjust(max_step=(s.options.get("max_step") or 0.1) * 2),
    "use": lambda s: s.use("dls", partial(dls, damping=0.1 * len(s.events) + 0.2)),
}


@settings(max_examples=30)
@given(st.lists(st.sampled_from(list(CHANGES)), max_size=6))
def test_undo_takes_back_one_change_after_the_other(changes):
    session = run(Session(methods={name: SOLVERS[name] for name in ("dls", "sdls")}), 2)
    states = []
    for change in changes:
        session.history.settle()  # each is a move of its own
        states.append(session.settings())
        CHANGES[change](session)
    for state in reversed(states):
        assert session.settings() != state
        session.undo()
        assert session.settings() == state
    with pytest.raises(LookupError, match="nothing to undo"):
        session.undo()
    assert kinds(session).count("undo") == len(changes)


def test_reset_keeps_settings_and_events(session):
    run(session, 4).change(speed=2.0)
    session.aim("hand.l", HAND)
    session.reset()
    assert [session.time, session.ticks, session.phase, len(session.record)] == [0, 0, 0, 0]
    for pose in session.theta.values():
        assert_array_equal(pose, session.tree.rest)
    assert session.gait.speed == 2.0
    assert_array_equal(session.targets[3], HAND)
    assert kinds(session) == ["gait", "target", "reset"]
    assert session.events[-1].what == {"ticks": 4}
    session.undo()  # of the target
    assert_array_equal(session.targets, session.gait.at(0.0))
    assert session.events[-1].run == 1


def test_jitter_is_that_of_the_tracks_after_any_number_of_ticks(session):
    assert [list(one) for one in session.jitter(3).values()] == [[]] * len(session.methods)
    for count in range(1, 7):
        session.tick()
        tracks = session.tracks()
        for last in range(1, 8):
            for name, jitter in session.jitter(last).items():
                assert len(jitter) == min(last, count)
                assert_allclose(jitter, tracks[name].jitter[-last:], atol=1e-14)


def test_an_error_is_logged_once_and_changes_no_pose(session):
    run(session, 2)
    session.methods["sdls"] = lambda J, e: J[0] * np.nan
    before = dict(session.theta)
    for _ in range(3):
        with pytest.raises(FloatingPointError, match="not finite"):
            session.tick()
    for name, pose in session.theta.items():
        assert_array_equal(pose, before[name])
    assert kinds(session) == ["error"]
    assert "not finite" in session.events[0].what["words"]
    assert len(session.record) == 2


@pytest.mark.parametrize(
    ("change", "error", "sentence"),
    [
        (lambda s: s.show("dsl"), LookupError, "no method 'dsl'; did you mean 'dls'"),
        (lambda s: s.change(sped=1), LookupError, "no gait parameter 'sped'; did you mean 'speed'"),
        (lambda s: s.change(speed="fast"), ValueError, "speed of 'walking' is 'fast'"),
        (lambda s: s.aim("hand", HAND), LookupError, "no effector 'hand'; did you mean 'hand"),
        (lambda s: s.aim(4, HAND), LookupError, "numbered 0 to 3, not 4"),
        (lambda s: s.aim(0, [1, 2]), ValueError, r"a target is a point \(3,\), not \(2,\)"),
        (lambda s: s.aim(2, [0, np.nan, 0]), ValueError, "target of 'hand.r' is not finite"),
        (lambda s: s.aim(2, "there"), ValueError, "position must be made of numbers"),
        (lambda s: s.adjust(max_stp=1), LookupError, "no option 'max_stp'; did you mean 'max_step"),
        (lambda s: s.adjust(max_step=-1), ValueError, "max_step must be 0 or more"),
        (lambda s: s.adjust(mobility=[1]), LookupError, "no option 'mobility'"),
        (lambda s: s.use("dsl", "dls"), LookupError, "no method 'dsl'"),
        (lambda s: s.use("dls", partial(dls, damping=-1)), ValueError, "damping must be 0 or"),
        (lambda s: s.use("dls", 7), TypeError, "a solver is a function"),
    ],
)
def test_what_cannot_be_is_refused_and_changes_nothing(session, change, error, sentence):
    run(session, 1)
    before = session.settings()
    with pytest.raises(error, match=sentence):
        change(session)
    assert session.settings() == before
    assert kinds(session) == []
    session.tick()


def test_a_mix_among_the_methods():
    body = figures.human()
    methods = {**SOLVERS, "mix": Mix.of(body.effectors, dict.fromkeys(body.effectors.names, "dls"))}
    session = run(Session(body, methods=methods, method="mix"), 6)
    assert_array_equal(session.theta["mix"], session.theta["dls"])
    names = {"foot.l": "dls", "foot.r": "dls", "hand.l": "sdls", "hand.r": "transpose"}
    session.use("mix", Mix.of(body.effectors, names))
    assert session.settings()["methods"]["mix"] == {
        "function": "mix", "foot.l": "dls", "foot.r": "dls", "hand.r": "transpose",
        "hand.l": "sdls",
    }  # fmt: skip
    run(session, 2)


def test_words_for_a_file():
    told = in_words({"a": np.float64(0.5), "b": np.arange(2), "c": (clip, None), 4: True})
    assert told == {"a": 0.5, "b": [0, 1], "c": ["clip", None], "4": True}


def test_the_log_as_tables(session):
    run(session, 3).show("sdls")
    log = run(session, 2).log()
    table = ticks(log)
    assert len(table) == 5 * 4 * 4
    row = table[(table.tick == 4) & (table.method == "sdls") & (table.effector == "hand.r")].iloc[0]
    assert row["error"] == log.error[3, 3, 2]
    assert row["target.z"] == log.targets[3, 2, 2]
    assert row["shown"]
    assert row["held"] == (log.held[3, 3] & session.effectors.carried[2]).sum()
    assert table.groupby("tick", observed=True)["shown"].sum().eq(4).all()
    assert angles(log).loc[(5, "sdls"), "knee.l"] == log.theta[4, 3, session.tree.index("knee.l")]
    said = events(log)
    assert said["words"].tolist() == ["method: shown sdls"]
    assert said["tick"].tolist() == [3]


REFUSED = [
    ({"max_stp": 1}, LookupError, "no option 'max_stp'; did you mean 'max_step'"),
    ({"figur": 1}, LookupError, "no option 'figur'; did you mean 'figure'"),
    ({"damping": 1}, LookupError, "no option 'damping'"),
    ({"mobility": [1]}, LookupError, "no option 'mobility'"),
    ({"max_step": np.nan}, ValueError, "max_step must be 0 or more, not nan"),
    ({"limits": "hold"}, TypeError, "limits must be a function, not 'hold'"),
    ({"dt": 0}, ValueError, "dt must be more than 0, not 0"),
    ({"dt": np.nan}, ValueError, "dt must be 0 or more, and finite, not nan"),
    ({"dt": -1}, ValueError, "dt must be 0 or more, and finite, not -1"),
    ({"keep": "x"}, ValueError, "keep must be 1 or more, and whole, not 'x'"),
    ({"keep_events": 0}, ValueError, "keep_events must be 1 or more, and whole, not 0"),
    ({"gait": "walking"}, TypeError, "a motion is a Gait or a Path, such as gait.walking, not"),
    ({"figure": figures.human().tree}, TypeError, "a figure is its tree and its effectors"),
    ({"figure": (figures.human().tree, None)}, TypeError, "must be Effectors, not None"),
    ({"method": "dsl"}, LookupError, "no method 'dsl'; did you mean 'dls'"),
]


@pytest.mark.parametrize(("options", "error", "sentence"), REFUSED)
def test_no_session_begins_as_it_could_not_go_on(options, error, sentence):
    with pytest.raises(error, match=sentence):
        Session(**options)


def test_several_solvers_are_one_change(session):
    before = dict(session.methods)
    for damping in (0.2, 0.3):
        session.use({"dls": partial(dls, damping=damping), "sdls": "dls"})
    assert [str(event) for event in session.events] == [
        "solver: dls (function dls, damping 0.3), sdls dls"
    ]
    session.undo()
    assert session.methods == before


@settings(max_examples=30)
@given(st.lists(st.tuples(st.sampled_from(["hand.l", "hand.r"]), st.integers(1, 60)), max_size=5))
def test_each_drag_is_one_event_and_one_undo(drags):
    """Also while the figure plays, with remarks and errors in between."""
    session, at = Session(methods="dls"), []
    for name, moves in drags:
        at.append((session.by_hand, session.targets.copy() if session.by_hand else None))
        for i in range(moves):
            session.aim(name, np.add(HAND, [0.01 * i, 0.1 * len(at), 0]), going_on=i > 0)
            if i % 20 == 1:
                session.tick()
                session.note("pause")
    assert kinds(session).count("target") == len(drags)
    for by_hand, targets in reversed(at):
        session.undo()
        assert session.by_hand == by_hand
        if by_hand:
            assert_array_equal(session.targets, targets)


def test_a_drag_does_not_go_on_with_what_was_undone(session):
    session.aim("hand.l", HAND)
    session.aim("hand.l", [0.2, 0.2, 0.2])
    session.undo()
    session.aim("hand.l", [0.3, 0.3, 0.3], going_on=True)  # its beginning was undone
    session.undo()
    assert_array_equal(session.targets[3], HAND)


def test_a_drag_that_has_not_moved_yet_begins_another_event(session):
    session.aim("hand.l", HAND)
    session.aim("hand.l", HAND)  # taken hold of again, where it stands
    session.aim("hand.l", [0.3, 0.3, 0.3], going_on=True)
    assert kinds(session) == ["target", "target"]
    session.undo()
    assert_array_equal(session.targets[3], HAND)


def test_to_begin_again_is_one_change_back_to_the_first_settings(session):
    first = session.settings()
    session.show("sdls")
    session.adjust(max_step=0.1)
    session.aim("hand.l", [0.3, 0.2, 0.1])
    session.tick()
    session.begin_again()
    assert session.ticks == 0
    assert session.settings() == first
    session.undo()
    assert (session.method, session.by_hand, session.options["max_step"]) == ("sdls", True, 0.1)


def test_an_event_says_its_numbers_as_a_person_reads_them(session):
    session.aim("hand.l", [1 / 3, 0.9589900732055506, -1.0])
    assert str(session.events[-1]) == "target: effector hand.l, position (0.3333, 0.959, -1.0)"
    session.by_hand = False
    assert str(session.events[-1]) == "by hand: by_hand False"


def test_the_steps_of_a_tick_can_be_changed_undone_and_begun_again():
    session = Session()
    session.tick()
    session.iterations = 3
    assert session.settings()["iterations"] == session.iterations == 3
    assert str(session.events[-1]) == "iterations: iterations 3"
    one, three = Session(), Session(iterations=3)
    for lone in (one, three):
        for _ in range(20):
            lone.tick()
    assert three.error.mean() < one.error.mean()
    session.undo()
    assert session.iterations == 1
    session.iterations = 2
    session.begin_again()
    assert session.iterations == 1
    with pytest.raises(ValueError, match="iterations must be 1 or more"):
        session.iterations = 0
    with pytest.raises((ValueError, TypeError), match="iterations"):
        session.iterations = "many"
