"""Every slider of every figure can stand where it stands: a page that shows it changes nothing."""

from collections.abc import Iterator
from math import log
from typing import Any

import ipywidgets as widgets
import pytest

from ikteach.view.widgets.closing import living, making
from tests.view.test_closing import FIGURES

CAMERA = {"turn [°]", "tilt [°]"}  # it stands where it was turned to; `Exact` forgives the page
SLIDERS = widgets.FloatSlider | widgets.IntSlider | widgets.FloatLogSlider


def between(slider: Any) -> float:
    """How far a slider is from the nearest of its steps, as a share of one."""
    logarithmic = isinstance(slider, widgets.FloatLogSlider)
    value = log(slider.value, slider.base) if logarithmic else slider.value
    steps = (value - slider.min) / slider.step
    return abs(steps - round(steps))


@pytest.fixture(params=FIGURES, ids=lambda kind: kind.__name__)
def sliders(request: pytest.FixtureRequest) -> Iterator[list[Any]]:
    before = set(living)
    with making() as made:
        FIGURES[request.param]()
    yield [one for one in made if isinstance(one, SLIDERS) and one.model_id not in before]
    for one in made:
        one.close()


def test_each_stands_on_one_of_its_steps(sliders: list[Any]) -> None:
    off = {one.description for one in sliders if between(one) > 1e-6}
    assert off <= CAMERA


def test_there_are_sliders_to_look_at() -> None:
    with making() as made:
        FIGURES[next(kind for kind in FIGURES if kind.__name__ == "Workbench")]()
    assert sum(isinstance(one, SLIDERS) for one in made) > 20
    for one in made:
        one.close()
