"""A slider keeps what a program has set, though the page that shows it rounds it to a step."""

import math

import pytest

from ikteach.view.live.panel import log_slider, slider

MADE = [
    (lambda: slider("γ max", math.pi / 4, 0.05, math.pi, 0.01), 0.79),
    (lambda: slider("near the end", 0.999, 0.0, 1.0, 0.3), 0.9),
    (lambda: slider("whole numbers", 7, 0, 20, 5), 5),
    (lambda: log_slider("λ", 0.11, -3, 0, 0.02), 10**-0.96),
]


def end(control):
    return 10.0**control.max if hasattr(control, "base") else control.max


def sends(control, value):
    """What the widget's comm gives it when a page has a new value."""
    control.set_state({"value": value})


@pytest.mark.parametrize(("make", "rounded"), MADE)
def test_what_the_page_rounds_is_no_change(make, rounded):
    control = make()
    exact = control.value
    sends(control, rounded)
    assert control.value == exact


@pytest.mark.parametrize(("make", "rounded"), MADE)
def test_a_rounding_that_comes_late_is_no_change(make, rounded):
    """A point is dragged: the page still speaks of where it was, and it is on already."""
    control = make()
    control.value = end(control)
    sends(control, rounded)
    assert control.value == end(control)


@pytest.mark.parametrize(("make", "rounded"), MADE)
def test_after_a_person_has_moved_it_each_value_counts(make, rounded):
    control = make()
    sends(control, end(control))
    assert control.value == end(control)
    sends(control, rounded)
    assert control.value == rounded


def test_a_value_on_a_step_is_never_taken_for_a_rounding():
    """Undo goes from 5 to 4, and a person at once to 5 again."""
    control = slider("a", 5, 0, 10, 1)
    control.value = 4
    sends(control, 5)
    assert control.value == 5


def test_the_last_bits_of_the_page_are_no_change():
    control = slider("y", -0.88, -1.3, -0.4, 0.01)
    sends(control, -0.8799999999999999)
    assert control.value == -0.88


def test_what_else_the_page_sends_is_kept():
    control = slider("a", 0.123, 0.0, 1.0, 0.1)
    control.set_state({"value": 0.1, "description": "b"})
    assert (control.value, control.description) == (0.123, "b")
