"""States as text: what is read, what is refused, and that a link leads back to its state."""

import random
from collections.abc import Callable
from typing import Any

import ipywidgets as widgets
import pytest

from ikteach import figures
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
    for pushes in (0, 1, 2, 4, 12):
        made = FIGURES[name]()
        for _ in range(pushes):
            push(made, draw)
        link, state = link_of(made), whole(made)
        made.close()
        again = preset(FIGURES[name](), link)
        assert again.status.wrong == "", link
        assert whole(again) == {k: near(v) for k, v in state.items()}, link
        again.close()
