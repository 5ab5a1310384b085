"""A session of any figure, by any methods: what it does by itself, and what it says it needs."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from metamorphic import BODY, Case, in_units, rows
from numpy.testing import assert_allclose, assert_array_equal
from strategies import SEEDS, anybody

from ikteach import SOLVERS, Effectors, Joint, Tree, dls, figures, forward, locate
from ikteach.body.extent import extent
from ikteach.motion import clip, gait
from ikteach.motion.live.session import Session
from ikteach.motion.methods import LONG, methods_of
from ikteach.motion.mix import Mix
from ikteach.motion.path import Path, swinging

ARM = figures.planar_arm(3)


def mine(J, e):
    return 0.1 * np.vecmat(e, J)


class Fancy:
    def __call__(self, J, e):
        return mine(J, e)


def run(session, count):
    for _ in range(count):
        session.tick()
    return session


@pytest.mark.parametrize(
    ("methods", "names"),
    [
        (SOLVERS, list(SOLVERS)),
        ({"mine": mine, "theirs": "dls"}, ["mine", "theirs"]),
        (["dls", "sdls"], ["dls", "sdls"]),
        ((name for name in ("sdls", "dls")), ["sdls", "dls"]),
        ("dls", ["dls"]),
        (mine, ["mine"]),
        (Fancy(), ["Fancy"]),
        (lambda J, e: mine(J, e), ["<lambda>"]),
        (partial(dls, damping=0.2), ["dls"]),
        ([dls, partial(dls, damping=0.2), mine, mine], ["dls", "dls 2", "mine", "mine 2"]),
        ([partial(dls, damping=d) for d in range(1, 9)],
         ["dls", *(f"dls {i}" for i in range(2, 9))]),
        (Mix.of(ARM.effectors, {"hand": "dls"}), ["mix"]),
    ],
)  # fmt: skip
def test_methods_however_they_are_told(methods, names):
    session = run(Session(ARM, methods=methods), 2)
    assert list(session.methods) == list(session.theta) == names
    assert session.method == ("dls" if "dls" in names else names[0])


@pytest.mark.parametrize(
    ("methods", "error", "sentence"),
    [
        ({}, ValueError, "at least one method is needed"),
        ([], ValueError, "at least one method is needed"),
        (7, TypeError, "methods are solvers or their names, not 7"),
        ("dsl", LookupError, "no method 'dsl'; did you mean 'dls'"),
        (["dls", 5], TypeError, "a solver is a function"),
        ({"a": 5}, TypeError, "a solver is a function"),
        ({7: dls}, ValueError, "a method's name has 1 to 40 letters; 7 is none"),
        ({" ": dls}, ValueError, "a method's name has 1 to 40 letters"),
        ({"a" * 100_000: dls}, ValueError, "a method's name has 1 to 40 letters"),
    ],
)
def test_what_are_no_methods(methods, error, sentence):
    with pytest.raises(error, match=sentence) as told:
        Session(ARM, methods=methods)
    assert len(str(told.value)) < 300


def test_names_of_functions_are_bounded():
    long = lambda J, e: mine(J, e)  # noqa: E731
    long.__name__ = "a" * 1000
    names = list(methods_of([long, long]))
    assert len(set(names)) == 2
    assert max(map(len, names)) <= LONG


@given(anybody(limits=True))
def test_the_targets_of_any_figure_are_within_its_reach(figure):
    session = Session(figure)
    rest = locate(forward(figure.tree, figure.tree.rest), figure.effectors)
    if not isinstance(session.gait, gait.Gait):
        assert_allclose(session.targets, rest, atol=1e-12)  # it begins where it stands
    centre, radius = extent(*figure)
    for _ in range(40):
        session.tick()
        if not isinstance(session.gait, gait.Gait):
            away = np.linalg.norm(session.targets - centre, axis=-1)
            assert (away <= radius * (1 + 1e-9)).all()
    assert np.isfinite(session.error).all()


@given(anybody(limits=True), st.floats(-20, 20))
def test_a_swing_is_a_pose_within_limits(figure, phase):
    """So that some pose meets all targets at once: found again by its own joints."""
    tree, effectors = figure
    path = swinging(tree, effectors)
    assert_allclose(path.at(0), locate(forward(tree, tree.rest), effectors), atol=1e-12)
    often = np.array([2 - len(tree.above(j)) % 2 for j in range(len(tree))])
    swing = np.sin(often * phase)
    wide = np.where(tree.slide, extent(tree, effectors).radius / 4, 0.5)
    theta = np.clip(tree.rest + wide * swing, tree.lower, tree.upper)
    inside = (tree.upper - tree.rest >= wide) & (tree.rest - tree.lower >= wide)
    if inside.all():
        assert_allclose(path.at(phase), locate(forward(tree, theta), effectors), atol=1e-9)


@settings(max_examples=40)
@given(anybody(limits=True, slides=False), SEEDS, st.sampled_from(list(BODY)))
def test_a_run_moves_along_with_the_body(figure, seed, change):
    """The methods that the session has by itself, the damped one too."""
    rest = figure.tree.rest
    case = Case(*figure, rest, locate(forward(figure.tree, rest), figure.effectors))
    one, other, along = BODY[change](case, np.random.default_rng(seed))
    renamed = change in ("ground turned", "renamed and reordered")  # who then is no human
    paths = [swinging(*each[:2]) if renamed else None for each in (one, other)]
    sessions = [
        Session(each[:2], path, max_step=0.1)
        for each, path in zip((one, other), paths, strict=True)
    ]
    hair = 1e-9 * (extent(*other[:2]).radius + abs(along.shift).max())
    for _ in range(12):
        for session in sessions:
            session.tick()
        first, second = (session.theta["dls"] for session in sessions)
        assert_allclose(second, along.pose(first), atol=1e-6)
        assert_allclose(sessions[1].targets, along.places(sessions[0].targets), atol=hair)


@pytest.mark.parametrize("unit", [1e-6, 1e-3, 1e3, 1e6])
@pytest.mark.parametrize("figure", [figures.human(), figures.simulator()])
def test_a_human_of_any_size_walks(figure, unit):
    case = Case(*figure, figure.tree.rest, np.zeros((4, 3)))
    _, other, _ = in_units(case, None, unit)
    ours, theirs = Session(figure, methods="transpose"), Session(other[:2], methods="transpose")
    assert theirs.gait is gait.walking
    for session in (ours, theirs):
        session.change(forward=True)
        run(session, 5)
    assert_allclose(theirs.targets, unit * ours.targets, rtol=1e-9)
    assert theirs.floor == pytest.approx(unit * ours.floor)
    assert theirs.advance == pytest.approx(unit * ours.advance)
    assert_allclose(theirs.theta["transpose"], ours.theta["transpose"], atol=1e-7)


def test_a_human_in_another_place_with_its_limbs_in_another_order():
    tree, effectors = figures.human()
    away = np.array([3.0, 1, -2])
    joints = [
        replace(row, offset=row.offset + away) if row.parent is None else row for row in rows(tree)
    ]
    moved = Tree.of(joints)
    ends = {
        name: (moved.names[effectors.joints[i]], effectors.offsets[i])
        for i, name in reversed(list(enumerate(effectors.names)))
    }
    ours, theirs = run(Session(), 3), run(Session((moved, Effectors.of(moved, ends))), 3)
    assert_allclose(theirs.targets[::-1], ours.targets + away)
    assert theirs.floor == pytest.approx(ours.floor + 1)
    hands = {name: ends[name] for name in ("hand.l",)}
    lone = Session((moved, Effectors.of(moved, hands)))
    assert_allclose(lone.targets, Session((moved, Effectors.of(moved, ends))).targets[:1])


def test_who_cannot_walk_is_told_so():
    with pytest.raises(ValueError, match=r"'walking' moves targets for foot.l, .* none for 'hand'"):
        Session(ARM, gait.walking)
    session = Session(ARM)
    with pytest.raises(ValueError, match="only a figure with such limbs can walk"):
        session.gait = gait.running
    assert session.gait.name == "swinging"
    with pytest.raises(ValueError, match="'path' gives 2 targets, and this figure has 1 effectors"):
        Session(ARM, Path(lambda phase: np.zeros((2, 3))))


def square(phase):
    return [[2 + 0.3 * np.cos(phase), 0.3 * np.sin(phase), 0]]


def test_a_path_of_ones_own():
    session = Session(ARM, Path(square, "circle", speed=2.0))
    assert_allclose(session.targets, [[2.3, 0, 0]])
    run(session, 30)
    assert_allclose(session.targets, square(2.0), atol=1e-9)
    assert session.error.max() < 0.3
    session.change(speed=0.5)
    assert session.gait.speed == 0.5
    assert session.undo().what == {"speed": 0.5}
    assert session.settings()["gait"]["curve"] == "square"
    session.gait = replace(session.gait, name="faster", speed=3.0)
    assert session.undo().what == {"motion": "faster"}


def test_a_path_through_points():
    points = np.array([[[0.0, 0, 0]], [[1, 0, 0]], [[1, 1, 0]], [[0, 1, 0]]])
    path = Path.through(points, "square", speed=1.5)
    assert path.speed == 1.5
    for i in range(9):
        assert_allclose(path.at(i * np.pi / 2), points[i % 4], atol=1e-9)
    assert_allclose(path.at(np.pi / 4), [[0.5, 0, 0]], atol=1e-9)
    assert_allclose(path.at(-np.pi / 4), [[0, 0.5, 0]], atol=1e-9)


@pytest.mark.parametrize(
    ("make", "error", "sentence"),
    [
        (lambda: Path(5), TypeError, "the curve of a path must be a function, not 5"),
        (lambda: Path(square, name=""), ValueError, "a path's name has 1 to"),
        (lambda: Path(square, speed=np.nan), ValueError, "speed of a path must be a finite number"),
        (lambda: Path(square, slowdown=0), ValueError, "slowdown counts ticks"),
        (lambda: Path(square, wound={"a": 2}), ValueError, "the mobility of 'a' must be"),
        (lambda: Path.through([[1, 2, 3]]), ValueError, r"goes through points \(T, k, 3\)"),
        (lambda: Path.through(np.full((2, 1, 3), np.nan)), ValueError, "must be finite numbers"),
        (lambda: Path.through("there"), ValueError, "points of a path must be made of numbers"),
        (lambda: Path(lambda phase: None).at(0), ValueError, "must be made of numbers"),
        (lambda: Path(lambda phase: [1, 2, 3]).at(0), ValueError, r"must give targets \(k, 3\)"),
    ],
)
def test_what_is_no_path(make, error, sentence):
    with pytest.raises(error, match=sentence):
        make()


def later(what, after):
    """A solver that does something else after so many calls."""
    calls = [0]

    def solver(J, e):
        calls[0] += 1
        return mine(J, e) if calls[0] <= after else what(J, e)

    return solver


def raises(J, e):
    raise ZeroDivisionError("of my own")


@pytest.mark.parametrize("what", [raises, lambda J, e: np.full(J.shape[-1], np.nan)])
@pytest.mark.parametrize("slowdown", [1, 4])
def test_a_solver_that_fails_leaves_no_half_of_a_tick(what, slowdown):
    path = Path(square, slowdown=slowdown)
    session = Session(ARM, path, {"good": "dls", "bad": later(what, 5)})
    run(session, 5 * slowdown)
    session.change(speed=2.0)

    def state():
        poses = {name: pose.tolist() for name, pose in session.theta.items()}
        return session.time, session.phase, len(session.record), session.targets.tolist(), poses

    before, failures = state(), 0
    for _ in range(3 * slowdown):
        try:
            session.tick()
        except (ZeroDivisionError, FloatingPointError):
            failures += 1
            assert state() == before
    assert failures > 2
    assert [event.kind for event in session.events] == ["gait", "error"]  # told once
    assert str(session.undo()) == "gait: speed 2.0"
    session.use("bad", "dls")
    run(session, slowdown)
    assert len(session.record) == 6
    ticks = session.log().tick
    assert_array_equal(ticks, slowdown * np.arange(1, 7))  # and no tick is lost or counted twice


def test_a_path_that_fails_leaves_the_targets_where_they_were():
    calls = [0]

    def curve(phase):
        calls[0] += 1
        return square(phase) if calls[0] < 6 else [[np.inf, 0, 0]]

    session = Session(ARM, Path(curve), "dls")
    with pytest.raises(ValueError, match="target of 'hand' is not finite"):
        run(session, 20)
    assert np.isfinite(session.targets).all()
    assert len(session.record) == session.ticks


def test_caps_limits_and_wounds_are_kept_by_every_method():
    links = Joint("b", "a", (1, 0, 0)), Joint("c", "b", (1, 0, 0))
    tree = Tree.of([Joint("a", lower=-1, upper=1), *links])
    figure = tree, Effectors.of(tree, {"hand": ("c", (1, 0, 0))})
    path = Path(lambda phase: [[-2 * np.cos(phase), 2, 0]], speed=3.0, wound={"b": 0.0})
    session = Session(figure, path, max_step=0.2, limits=clip)
    session.bound({"sdls": 0.05, "pseudoinverse": None})
    before = dict(session.theta)
    capped = dict.fromkeys(session.methods, 0)
    for _ in range(60):
        session.tick()
        row = session.record[-1]
        for i, (name, theta) in enumerate(session.theta.items()):
            moved = abs(theta - before[name])
            assert moved[1] == 0  # mobility 0 does not move at all
            cap = {"sdls": 0.05, "pseudoinverse": np.inf}.get(name, 0.2)
            assert moved.max() <= cap + 1e-12
            assert -1 <= theta[0] <= 1
            capped[name] += row.capped[i]
        before = dict(session.theta)
    assert capped["pseudoinverse"] == 0
    assert capped["sdls"] > 0
    session.change(wound={})
    run(session, 5)
    assert (session.theta["dls"] != before["dls"])[1]
