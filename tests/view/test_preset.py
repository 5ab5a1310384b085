"""States as text: what is read, what is refused, and that a link leads back to its state."""

import random
from collections.abc import Callable
from typing import Any

import ipywidgets as widgets
import pytest

from ikteach import figures
from ikteach.serve.lecture import addressed
from ikteach.view import (
    BendBench,
    ColumnPoser,
    GaitPlayer,
    Poser,
    Simulator,
    SvdBench,
    WalksPlayer,
    Workbench,
    preset,
)
from ikteach.view.chapters.comparison import Race
from ikteach.view.chapters.dls import tradeoff_bench
from ikteach.view.chapters.pseudoinverse import CapPlayer
from ikteach.view.chapters.robots import robot_player, standing_player
from ikteach.view.chapters.sdls import spectrum_bench
from ikteach.view.chapters.transpose import slope_bench
from ikteach.view.live.controls import controls, targets
from ikteach.view.live.preset import BOXES, CHOICES, SLIDERS, link_of

FIGURES: dict[str, Callable[[], Any]] = {
    "Poser": lambda: Poser(figures.human()),
    "ColumnPoser": lambda: ColumnPoser(figures.human()),
    "BendBench": BendBench,
    "SvdBench": SvdBench,
    "SvdBench of methods": lambda: SvdBench(["dls"]),
    "slope": slope_bench,
    "CapPlayer": CapPlayer,
    "tradeoff": tradeoff_bench,
    "spectrum": spectrum_bench,
    "GaitPlayer": GaitPlayer,
    "Race": Race,
    "Workbench": Workbench,
    "Simulator": Simulator,
    "WalksPlayer": WalksPlayer,
    "robot": robot_player,
    "standing": standing_player,
}


def whole(figure: Any) -> dict[str, Any]:
    """All that the controls of a figure say, and where targets are that nothing else moves."""
    values = {n: c.value for n, c in controls(figure).items() if hasattr(c, "value")}
    by_hand = getattr(getattr(figure, "session", None), "by_hand", isinstance(figure, Simulator))
    at = figure.targets.positions.ravel().tolist() if by_hand and targets(figure) else []
    return values | {f"target {i}": x for i, x in enumerate(at)}


def near(value: Any) -> Any:
    """A value as a link of six digits keeps it."""
    if isinstance(value, bool | str):
        return value
    return pytest.approx(value, rel=1e-5, abs=1e-5)


def push(figure: Any, draw: random.Random) -> None:
    """Set a control or a target as a person might."""
    name = draw.choice([*controls(figure), *targets(figure)])
    control = controls(figure).get(name)
    if control is None:
        i = targets(figure).index(name)
        low, high = figure.targets.low[i], figure.targets.high[i]
        figure.targets.move(i, [draw.uniform(a, b) for a, b in zip(low, high, strict=True)])
    elif isinstance(control, CHOICES):
        control.value = draw.choice(control.options)
    elif isinstance(control, BOXES):
        control.value = not control.value
    elif isinstance(control, SLIDERS) and not control.disabled:
        log = isinstance(control, widgets.FloatLogSlider)
        steps = round((control.max - control.min) / control.step)
        value = control.min + draw.randint(0, steps) * control.step
        control.value = control.base**value if log else min(value, control.max)


@pytest.mark.parametrize("name", FIGURES)
def test_a_link_leads_back_to_the_state_in_which_it_was_made(name: str) -> None:
    draw = random.Random(name)
    made = FIGURES[name]()
    assert name == "Simulator" or link_of(made) == ""
    for _ in range(8):
        push(made, draw)
    link, state = link_of(made), whole(made)
    made.close()
    again = preset(FIGURES[name](), link)
    assert again.status.wrong == "", link
    assert whole(again) == {k: near(v) for k, v in state.items()}, link
    again.close()


def test_a_figure_turned_by_its_ball_is_linked_so() -> None:
    bench = Workbench()
    bench.object.ball.azimuth = 50.0
    assert link_of(bench) == "azimuth=50"
    bench.close()


def test_a_link_tells_what_was_chosen_and_not_what_follows_from_it() -> None:
    bench = preset(Workbench(), "speed=9.5&motion=running&figures=side&method=sdls&dark=on")
    wanted = "method=sdls&motion=running&figures=all,+side+by+side&dark=on&speed=9.5"
    assert link_of(bench) == wanted
    controls(bench)["motion"].value = "walking"
    assert link_of(bench) == wanted.replace("&motion=running", "").replace("&speed=9.5", "")
    bench.close()


@pytest.mark.parametrize(
    ("state", "why"),
    [
        ("meth=dls", "no control 'meth'; did you mean 'method'?"),
        ("method", "method must be one of transpose, pseudoinverse, dls, sdls, not ''"),
        ("method=s", "method must be one of transpose, pseudoinverse, dls, sdls, not 's'"),
        ("method=<img src=x>", "not '<img src=x>'"),
        ("speed=99", "speed must be a number from 0 to 20, not '99'"),
        ("speed=nan", "not 'nan'"),
        ("speed=1e999", "not '1e999'"),
        ("speed=-inf", "not '-inf'"),
        ("speed=" + "9" * 5000, "…"),
        ("speed=٣", "speed must be a number from 0 to 20"),
        ("slowdown=2.5", "slowdown must be a whole number from 1 to 10, not '2.5'"),
        ("wounded=perhaps", "wounded must be on or off, not 'perhaps'"),
        ("reset=1", "'reset' is a button, and a state presses none"),
        ("__class__=1", "no control '__class__'"),
        ("speed=%ff%00", "speed must be a number"),
        ("&".join(["view=back"] * 300), "at most 200 settings"),
        ("view=" + "x" * 9000, "in 8000 letters"),
    ],
)
def test_what_cannot_be_set_is_named_with_what_is_allowed(state: str, why: str) -> None:
    player = preset(GaitPlayer(), state)
    assert why in player.status.wrong
    assert player.status.wrong.endswith("The rest is set.")
    assert len(player.status.wrong) < 500
    assert link_of(player) == ""
    player.close()


def test_the_rest_of_a_state_is_set_whatever_its_order() -> None:
    player = preset(GaitPlayer(), "?speed=8&wounded=ON&foo=1&motion=Walk&bar=2&slowdown=3.0&x&y")
    assert "and 1 more. The rest is set." in player.status.wrong
    session = player.session
    gait = session.gait
    assert (gait.speed, gait.name, gait.slowdown) == (8, "walking", 3)
    assert gait.wound
    assert type(controls(player)["slowdown"].value) is int
    player.close()
    with pytest.raises(TypeError, match="the state of a figure must be text"):
        preset(player, {"speed": 9})  # type: ignore[arg-type]


def test_targets_are_set_within_their_range() -> None:
    simulator = preset(Simulator(), "cursor=0.4,-0.2,0.3")
    assert simulator.session.cursor.tolist() == [0.4, -0.2, 0.3]
    for state, why in {
        "cursor=0.4,-0.2": "cursor must be three numbers with commas, not '0.4,-0.2'",
        "cursor=0.4,9,0": "y of cursor must be a number from",
    }.items():
        assert why in preset(simulator, state).status.wrong
    simulator.close()


def test_what_is_switched_off_in_a_state_is_told() -> None:
    bench = preset(Workbench(), "motion=natural&speed=9")
    assert "speed is switched off in this state" in bench.status.wrong
    assert link_of(bench) == "motion=natural"
    bench.close()


def test_a_figure_has_one_link_that_goes_with_it() -> None:
    player = CapPlayer()
    player._repr_mimebundle_()
    controls(player)["cap"].value = 12.0
    player.player.scene._acts["l"]()  # the key at its picture
    assert (player.link.state, player.link.asked) == ("cap=12", 1)
    assert player.player.link is None
    assert [*player.children].count(player.link) == 1
    player.close()
    assert player.link.comm is None


def test_a_page_takes_its_state_from_its_address(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("QUERY_STRING", "token=secret&method=sdls&voila-theme=dark&speed=9")
    player = addressed(GaitPlayer())
    assert link_of(player) == "method=sdls&speed=9"
    assert player.status.wrong == ""
    player.close()
