"""Players, posers and panels of any figure, by any methods, in its own units."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from metamorphic import BODY, Case, in_units
from numpy.testing import assert_allclose
from strategies import SEEDS, anybody

from ikteach import SOLVERS, Effectors, Joint, Tree, dls, figures, forward, locate
from ikteach.motion.gait import walking
from ikteach.motion.live.session import Session
from ikteach.motion.path import Path
from ikteach.view import Poser, Scene, StillScene
from ikteach.view.chapters.comparison import EQUAL, OWN, Race
from ikteach.view.chapters.gait import GaitPlayer
from ikteach.view.chapters.jacobian import ColumnPoser
from ikteach.view.live.joints import Dial
from ikteach.view.stage.lengths import Lengths, digits_of, round_step
from ikteach.view.tools.replay import Replay
from ikteach.view.tools.session_panels import SLIDERS
from ikteach.view.webgl.targets import Targets


def body(*joints, at=(1, 0, 0)):
    tree = Tree.of(joints)
    return figures.Figure(tree, Effectors.of(tree, {"tool": (tree.names[-1], at)}))


PLOTTER = body(
    Joint("x", axis=(1, 0, 0), slide=True, lower=0, upper=0.5),
    Joint("y", "x", axis=(0, 1, 0), slide=True, lower=0, upper=0.5),
    at=(0, 0, 0),
)
FIGURES = {
    "arm": figures.planar_arm(3),
    "mm": figures.planar_arm([4e-4, 4e-4, 2e-4]),
    "km": figures.planar_arm([400, 400, 200]),
    "y": figures.y_shape(),
    "double y": figures.double_y(),
    "simulator": figures.simulator(),
    "plotter": PLOTTER,
    "rail": body(
        Joint("x", axis=(1, 0, 0), slide=True), Joint("a", "x"), Joint("b", "a", (1, 0, 0))
    ),
}


def mine(J, e):
    return dls(J, e)


@pytest.fixture
def make():
    made = []

    def one(kind, *arguments, **options):
        made.append(kind(*arguments, **options))
        return made[-1]

    yield one
    for widget in made:
        widget.close()


@pytest.mark.parametrize("kind", [GaitPlayer, Race])
@pytest.mark.parametrize("name", FIGURES)
def test_players_take_any_figure(make, kind, name):
    player = make(kind, figure=FIGURES[name])
    for _ in range(3):
        player.step()
    player.draw()
    player.report()
    assert player.status.wrong == ""
    assert f" {Lengths.of(*FIGURES[name]).name}" in player.words
    assert "nan" not in player.words
    assert ("human" in player.words) == (name == "simulator")


@pytest.mark.parametrize("kind", [GaitPlayer, Race])
@pytest.mark.parametrize(
    "methods",
    [
        mine,
        "sdls",
        ["dls", "dls"],
        {"<b>mine</b>": mine, "n" * 40: "dls"},
        [partial(dls, damping=0.1 * i) for i in range(1, 9)],
        SOLVERS,
    ],
)
def test_players_take_any_methods(make, kind, methods):
    player = make(kind, methods)
    for _ in range(2):
        player.step()
    player.draw()
    player.report()
    assert player.status.wrong == ""
    assert len(player.session.theta) == len(player.session.methods)
    assert "<b>mine" not in player._table.value


def test_who_cannot_walk_is_told_so(make):
    for kind in GaitPlayer, Race:
        with pytest.raises(ValueError, match="only a figure with such limbs can walk"):
            kind(figure=figures.y_shape(), gait=walking)
        with pytest.raises(TypeError, match="methods are solvers or their names, not 30"):
            kind(30)


def test_a_player_of_a_path_and_back(make):
    path = Path(lambda phase: [[2 + np.cos(phase) / 2, np.sin(phase) / 2, 0]], "circle", speed=30.0)
    player = make(GaitPlayer, figure=figures.planar_arm(3), gait=path)
    assert player.controls["motion"].options == ("circle",)
    assert set(SLIDERS["Speed"]) <= set(player.controls)
    assert not set(player.controls) & {"forward", "wounded", *SLIDERS["Steps"]}
    assert player.controls["speed"].value == 30.0
    player.controls["speed"].value = 4.0
    assert player.session.gait.speed == 4.0
    race = make(Race, figure=figures.planar_arm(3), gait=path)
    race.controls["speed"].value = 3.0
    assert race.session.gait.speed == 3.0


def test_a_gait_of_ones_own_name_and_size_is_among_the_motions(make):
    own = replace(walking, name="limping", hand_z=2.5)
    player = make(GaitPlayer, gait=own)
    assert player.controls["hand_z"].value == 2.5
    player.controls["motion"].value = "running"
    assert player.session.gait.name == "running"
    player.controls["motion"].value = "limping"
    assert player.session.gait == own


def test_a_race_caps_the_methods_that_it_has(make):
    race = make(Race, {"mine": mine, "dls": "dls"}, degrees=60.0)
    assert race.session.caps == pytest.approx({"mine": np.pi / 3, "dls": np.pi / 3})
    race.controls["caps"].value = OWN
    assert race.session.caps == {"mine": None, "dls": pytest.approx(np.pi / 4)}
    race.controls["caps"].value = EQUAL


@pytest.mark.parametrize("kind", [GaitPlayer, Race])
def test_a_method_that_fails_is_told_and_the_rest_goes_on(make, kind):
    calls = [0]

    def fragile(J, e):
        calls[0] += 1
        if calls[0] > 3:
            raise ZeroDivisionError
        return dls(J, e)

    player = make(kind, {"fragile": fragile, "dls": "dls"})
    step = player.guarded(player.step)
    for _ in range(6):
        step()
    assert "ZeroDivisionError" in player.status.wrong
    before = len(player.session.record)
    player.draw()
    player.report()
    player.session.use("fragile", "dls")
    step()
    assert player.status.wrong == ""
    assert len(player.session.record) == before + 1


# Sliders.


@pytest.mark.parametrize(
    ("joint", "low", "high", "value", "unit"),
    [
        (Joint("a"), -180, 180, 0, "°"),
        (Joint("a", rest=4 * np.pi + 1), -180, 180, np.degrees(1), "°"),
        (Joint("a", rest=-3.5), -180, 180, 360 - np.degrees(3.5), "°"),
        (Joint("a", lower=-0.5), np.degrees(-0.5), 360, 0, "°"),
        (Joint("a", lower=-1e9, upper=1e9), -180, 180, 0, "°"),
        (Joint("a", lower=2 * np.pi, upper=4 * np.pi), 360, 720, 360, "°"),
        (Joint("a", lower=-1e-6, upper=1e-6), np.degrees(-1e-6), np.degrees(1e-6), 0, "°"),
        (Joint("a", lower=1, upper=1), np.degrees(1), np.degrees(1), np.degrees(1), "°"),
        (Joint("a", slide=True, lower=-2, upper=3), -2, 3, 0, " m"),
        (Joint("a", slide=True, lower=0.01, upper=0.02), 0.01, 0.02, 0.01, " m"),
        (Joint("a", slide=True), -1, 1, 0, " m"),
    ],
)  # fmt: skip
def test_a_slider_goes_from_limit_to_limit(joint, low, high, value, unit):
    figure = body(joint)
    dial = Dial.of(figure, 0)
    assert dial.unit == unit
    assert (dial.low, dial.high, dial.value) == pytest.approx((low, high, value), rel=1e-9)
    slider = dial.slider("a")
    assert slider.min <= slider.value <= slider.max
    if dial.high > dial.low:
        assert 50 <= (dial.high - dial.low) / dial.step <= 1000
        assert digits_of(dial.step) <= 9
    slider.close()


@settings(max_examples=20)
@given(anybody(limits=True), SEEDS)
def test_what_sliders_say_is_the_pose(figure, seed):
    poser = Poser(figure, slot=None)
    try:
        rest = figure.tree.rest
        assert_allclose(poser.theta(), rest, atol=1e-9 * max(1, abs(rest).max()))
        rng = np.random.default_rng(seed)
        for name, control in poser.controls.items():
            control.value = rng.uniform(control.min, control.max)
            j = figure.tree.index(name)
            theta = poser.theta()[j]
            assert figure.tree.lower[j] <= theta <= figure.tree.upper[j]
        assert poser.status.wrong == ""
    finally:
        poser.close()


@pytest.mark.parametrize("unit", [1e-6, 1e-3, 1e3, 1e6])
def test_sliders_move_along_with_the_units(unit):
    figure = FIGURES["rail"]
    rest = figure.tree.rest
    case = Case(*figure, rest, locate(forward(figure.tree, rest), figure.effectors))
    _, other, along = in_units(case, None, unit)
    for j in range(len(figure.tree)):
        ours = Dial.of(figure, j)
        theirs = Dial.of(figures.Figure(*other[:2]), j)
        for what in ("low", "high", "value"):
            theta = getattr(ours, what) * ours.each * along.scale[j]
            assert getattr(theirs, what) * theirs.each == pytest.approx(theta, rel=5e-3)


def test_posers_of_any_figure_say_their_places(make):
    for name, unit in {"mm": "mm", "km": "m", "plotter": "m", "rail": "m", "arm": "m"}.items():
        poser = make(ColumnPoser, FIGURES[name], slot=name)
        poser.refresh()
        assert poser.status.wrong == ""
        poser = make(Poser, FIGURES[name], slot=name + "too")
        assert f"in {unit}:" in poser.words
        assert "nan" not in poser.words


# Targets, and what is read.


@settings(max_examples=25)
@given(
    anybody(limits=True),
    SEEDS,
    st.sampled_from(["ground moved", *(c for c in BODY if "units" in c)]),
)
def test_targets_move_along(figure, seed, change):
    rest = figure.tree.rest
    case = Case(*figure, rest, locate(forward(figure.tree, rest), figure.effectors))
    one, other, along = BODY[change](case, np.random.default_rng(seed))
    made = []
    for each in (one, other):
        scene = StillScene(*each[:2])
        made.append(Targets(scene, each.targets, slot=None))
    try:
        ours, theirs = made
        for what in ("low", "high", "values"):
            assert_allclose(
                getattr(theirs, what),
                along.places(getattr(ours, what)),
                atol=5e-3 * along.length * scene.stage.unit,
            )
        for each in made:
            range_ = np.ptp([each.low, each.high], axis=0).max() / each.metres
            assert 100 <= range_ / each.step <= 1000
            assert each.digits <= 6
    finally:
        for each in made:
            each.close()


def test_keys_and_handles_are_of_the_bodys_size(make):
    human = make(Targets, make(Scene, *figures.human(), slot=None), np.zeros((4, 3)), slot=None)
    small = make(Targets, make(Scene, *FIGURES["mm"], slot="small"), np.zeros((1, 3)), slot=None)
    assert human.handles.step == 0.05
    assert small.handles.step == pytest.approx(0.05e-3, rel=0.3)
    assert (human.unit, human.step, human.digits) == ("m", 0.01, 2)
    assert (small.unit, small.digits) == ("mm", 2)


@pytest.mark.parametrize(
    ("reach", "distance", "place"),
    [(1.29, "cm", "m"), (3, "cm", "m"), (1000, "m", "m"), (5e4, "km", "km"), (0.06, "mm", "mm"),
     (1e-3, "µm", "mm"), (3e-6, "nm", "µm"), (5e-8, "nm", "nm"), (1e6, "km", "km")],
)  # fmt: skip
def test_a_unit_suits_the_size(reach, distance, place):
    arm = figures.planar_arm([reach])
    assert Lengths.of(*arm).name == distance
    assert Lengths.of_places(reach).name == place
    assert Lengths.of(*arm)(reach / 100).split()[0] not in ("0.0", "0")


def test_steps_are_round():
    assert [round_step(x) for x in (3, 3.6, 1, 30, 3e-6)] == pytest.approx(
        [0.01, 0.01, 0.005, 0.1, 1e-8], rel=1e-9
    )


def test_a_replay_of_a_tiny_figure_tells_its_distances(make):
    session = Session(FIGURES["mm"], methods="transpose")
    for _ in range(4):
        session.tick()
    replay = make(Replay, session.log())
    assert "hand [µm]" in replay.rows.header
    assert " µm" in replay.curve.alt
