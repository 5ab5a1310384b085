"""A panel acts when a person changes a control, and only then."""

import pytest

from ikteach.view.live.panel import (
    Does,
    Panel,
    button,
    choice,
    dropdown,
    log_slider,
    play_button,
    slider,
    tick_box,
)  # fmt: skip


@pytest.fixture
def heard():
    return []


def panel_of(control, heard, **options):
    return Panel("One", [{"one": Does(control, lambda *value: heard.append(value))}], **options)


@pytest.mark.parametrize(
    ("make", "value"),
    [
        (lambda: slider("a", 0.5, 0.0, 1.0, 0.1), 0.6),
        (lambda: slider("a", 1, 1, 10, 1), 2),
        (lambda: log_slider("a", 0.1, -3, 0), 0.2),
        (lambda: choice("a", ["x", "y"]), "y"),
        (lambda: dropdown("a", ["x", "y"], "y"), "x"),
        (lambda: tick_box("a"), True),
        (play_button, False),
    ],
)
def test_a_control_acts_for_a_person_and_not_for_a_program(make, value, heard):
    control = make()
    panel, before = panel_of(control, heard), control.value
    panel.put(one=value)
    panel.put(one=before)
    assert heard == []
    control.value = value
    assert heard == [(value,)]
    assert panel.values == {"one": value}


def test_a_button_acts_and_has_no_value(heard):
    panel = panel_of(button("Go"), heard)
    panel.controls["one"].click()
    assert heard == [()]
    assert panel.values == {}


def test_the_range_grows_where_it_must(heard):
    assert slider("a", 5.0, 0.0, 1.0, 0.1).max == 5
    assert slider("a", -5.0, 0.0, 1.0, 0.1).min == -5
    panel = panel_of(slider("a", 0.5, 0.0, 1.0, 0.1), heard)
    panel.put(one=7.0)
    assert panel.controls["one"].value == 7
    assert heard == []


def test_a_guard_stands_around_every_action(heard):
    def guard(act):
        return lambda *value: act(*value, "guarded")

    panel = panel_of(tick_box("a"), heard, guard=guard)
    panel.controls["one"].value = True
    assert heard == [(True, "guarded")]


def test_what_is_set_and_waits_to_act_stays_when_controls_agree():
    waiting, done = [], []

    def guard(act):
        return lambda *value: waiting.append(lambda: act(*value))

    row = {"motion": Does(choice("Motion", ["walking", "running"]), done.append)}
    panel = Panel("One", [row], shows=lambda: {"motion": [*done, "walking"][0]}, guard=guard)
    panel.controls["motion"].value = "running"
    panel.agree()  # with a session that still walks
    assert panel.values == {"motion": "running"}
    waiting.pop()()
    panel.agree()
    assert (panel.values, done) == ({"motion": "running"}, ["running"])
    done[:] = ["walking"]
    panel.agree()
    assert panel.values == {"motion": "walking"}


def test_a_control_that_is_only_read_has_no_guard():
    """Around an action, a guard says that all is well again, even of what else went wrong."""
    guards = []
    panel = Panel("One", [{"read": tick_box("a")}], guard=guards.append)
    panel.controls["read"].value = True
    assert (panel.values, guards) == ({"read": True}, [])


def test_rows_and_folded_parts_are_one_panel():
    panel = Panel(
        "All",
        [{"a": tick_box("a"), "b": tick_box("b")}, {"c": tick_box("c")}],
        folded={"More": [{"d": button("d")}]},
        opened=0,
        width="440px",
    )
    assert list(panel.controls) == ["a", "b", "c", "d"]
    assert panel.widget.layout.width == "440px"
    assert panel.widget.children[-1].selected_index == 0
    panel.disable()
    assert all(control.disabled for control in panel.controls.values())


def test_the_button_says_what_a_click_does():
    made = play_button()
    assert made.description == "Pause"
    made.value = False
    assert made.description == "Play"
