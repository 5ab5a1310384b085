"""The state of a figure as text, for addresses, slides, messages and cells.

It has the form of an address's query: names of the figure's controls, those that `show_me` takes,
and their values. The same text opens a page of the lecture and sets a figure in a notebook:

    http://127.0.0.1:8866/voila/render/gait.ipynb?method=sdls&motion=running&speed=9
    preset(GaitPlayer(), "method=sdls&motion=running&speed=9")

    a choice    one of its options, or a part that only one of them has: figures=side
    a tick box  on or off; so does `playing`
    a slider    a number within its range, in the unit of its label: speed=9
    a target    three numbers within its range [m]: cursor=0.4,-0.2,0.3

A blank is written + or %20. The order does not matter: choices are set first, then boxes, sliders
and targets, and last whether it plays. Buttons are no part of a state: a link presses none.
"""

from collections.abc import Callable
from math import inf
from typing import Any, TypeVar
from urllib.parse import parse_qsl, urlencode

import ipywidgets as widgets
import numpy as np

from ikteach.arrays import Array
from ikteach.checks import shown
from ikteach.names import unknown
from ikteach.view.live.controls import controls, parts_of, targets
from ikteach.view.live.turns import Turns
from ikteach.view.widgets import doors

Figure = TypeVar("Figure")
Value = Any  # of a control; of a target a list of three numbers
LONGEST, MOST = 8000, 200  # letters of a state, and settings in it
LONGEST_NUMBER = 40  # letters
DIGITS = 6  # of a number in a link: a page shows fewer
TOLD = 3  # refusals that a person is told
SWITCH = {"on": True, "off": False, "true": True, "false": False, "1": True, "0": False}
CHOICES = widgets.ToggleButtons, widgets.Dropdown
SLIDERS = widgets.IntSlider, widgets.FloatSlider, widgets.FloatLogSlider
BOXES = widgets.Checkbox, widgets.ToggleButton
LAST = "playing"


def preset(figure: Figure, state: str) -> Figure:
    """Set a live figure to a state, and give it back.

    state  such as "method=sdls&motion=running&speed=9"

    What cannot be set is told in the figure's status, in a sentence that names it and says what is
    allowed; the rest is set.
    """
    wanted, refused = read_state(figure, doors.text("the state of a figure", state))
    _Setting(figure, wanted, refused).go_on()
    return figure


def read_state(figure: Any, state: str) -> tuple[dict[str, Value], list[str]]:
    """Read the values in a state, and the refusals."""
    wanted: dict[str, Value] = {}
    refused: list[str] = []
    if len(state) > LONGEST or state.count("&") >= MOST:
        return {}, [f"a state has at most {MOST} settings in {LONGEST} letters"]
    pairs = parse_qsl(state.removeprefix("?"), keep_blank_values=True)
    of_figure, places = controls(figure), targets(figure)
    for name, text in pairs:
        try:
            if name in places:
                wanted[name] = _place(figure, name, text)
            elif name in of_figure:
                wanted[name] = _value(name, of_figure[name], text)
            else:
                named = [one for one in of_figure if _kind(of_figure[one]) is not None]
                raise ValueError(unknown("control", name, [*named, *places]))
        except ValueError as error:
            refused.append(str(error))
    return {name: wanted[name] for name in sorted(wanted, key=_order(figure))}, refused


def state_of(figure: Any) -> dict[str, Value]:
    """Give what a person has set, {control or target: value}.

    What the figure has set in answer, as the speed that a motion brings, is left out.
    """
    of_figure = controls(figure)
    holders = [part for part in parts_of(figure) if hasattr(part, "first")]
    nobody = Turns()
    asked = {turn for one in holders for turn in getattr(one, "turns", nobody).asked.values()}
    found: dict[str, Value] = {}
    for holder in holders:
        turns, values = getattr(holder, "turns", nobody), holder.values
        for name, first in holder.first.items():
            back = name in turns.asked and name in turns.moved  # a person has put it back
            new = back if values[name] == first else turns.followed.get(name) not in asked
            if new and not of_figure[name].disabled:
                found.setdefault(name, values[name])
    if LAST in of_figure and not of_figure[LAST].value:
        found[LAST] = False
    if getattr(getattr(figure, "session", None), "by_hand", not hasattr(figure, "first")):
        found |= dict(zip(targets(figure), _places(figure).tolist(), strict=True))
    return {name: found[name] for name in sorted(found, key=_order(figure))}


def link_of(figure: Any) -> str:
    """Write the state of a figure as `preset` reads it."""
    pairs = {name: _written(value) for name, value in state_of(figure).items()}
    return urlencode(pairs, safe=",")


class _Setting:
    """Sets one control after the other, each when the figure has answered the one before.

    What a figure sets in answer may undo what was set before: that is set once more.
    """

    def __init__(self, figure: Any, wanted: dict[str, Value], refused: list[str]) -> None:
        self.figure, self.wanted, self.refused = figure, wanted, refused
        self.left, self.again = [*wanted], True

    def go_on(self) -> None:
        """Set the next control; go on when it has acted."""
        while self.left:
            try:
                if self._set(self.left.pop(0)):
                    return self.figure._act(self.go_on)
            except Exception as error:  # of a trait, or of whoever follows a target
                self.refused.append(str(error))
        if self.again:
            self.left, self.again = [*self.wanted], False
            return self.go_on()
        if self.refused:
            more = len(self.refused) - TOLD
            others = f"; and {more} more" if more > 0 else ""
            said = f"Not set: {'; '.join(self.refused[:TOLD])}{others}. The rest is set."
            said = said.replace("?;", "? And").replace("?.", "?")
            self.figure.status.fail(said)

    def _set(self, name: str) -> bool:
        """Set a control or target; say whether that was to be done."""
        figure, value = self.figure, self.wanted[name]
        places = targets(figure)
        if name in places:
            if _places(figure)[places.index(name)].tolist() == value:
                return False
            figure.targets.move(places.index(name), value)
            return True
        control = controls(figure)[name]
        if control.value == value:
            return False
        if control.disabled:
            if not self.again:
                self.refused.append(f"{name} is switched off in this state")
            return False
        control.value = value
        return True


def _order(figure: Any) -> Callable[[str], tuple[int, int]]:
    """Sort names: choices first, for they set others."""
    of_figure = controls(figure)
    names = [*of_figure, *targets(figure)]

    def key(name: str) -> tuple[int, int]:
        kind = _kind(of_figure.get(name))
        return (9 if name == LAST else 3 if kind is None else kind), names.index(name)

    return key


def _kind(control: Any) -> int | None:
    """Return the place of a control in the order of setting; None if it has no state."""
    kinds = CHOICES, BOXES, SLIDERS
    return next((i for i, kind in enumerate(kinds) if isinstance(control, kind)), None)


def _value(name: str, control: Any, text: str) -> Value:
    """Read the value of a control; ValueError says what is allowed."""
    kind = _kind(control)
    if kind is None:
        raise ValueError(f"{shown(name)} is a button, and a state presses none")
    if isinstance(control, CHOICES):
        return _option(name, list(control.options), text)
    if isinstance(control, BOXES):
        if text.lower() not in SWITCH:
            raise ValueError(f"{name} must be on or off, not {shown(text)}")
        return SWITCH[text.lower()]
    low, high = control.min, control.max
    if isinstance(control, widgets.FloatLogSlider):
        low, high = control.base**low, control.base**high
    return _number(name, text, low, high, whole=isinstance(control, widgets.IntSlider))


def _option(name: str, options: list[str], text: str) -> str:
    """Find the option that is meant."""
    if text in options:
        return text
    meant = [one for one in options if text and text.lower() in one.lower()]
    if len(meant) != 1:
        raise ValueError(f"{name} must be one of {', '.join(options)}, not {shown(text)}")
    return meant[0]


def _number(name: str, text: str, low: float, high: float, *, whole: bool = False) -> float:
    try:
        number = float(text) if len(text) < LONGEST_NUMBER and text.isascii() else inf
    except ValueError:
        number = inf
    edge = 10.0**-DIGITS * max(abs(low), abs(high))  # what was rounded may be so much beyond
    if not low - edge <= number <= high + edge or (whole and number % 1):
        what = "a whole number" if whole else "a number"
        raise ValueError(f"{name} must be {what} from {low:.6g} to {high:.6g}, not {shown(text)}")
    return int(number) if whole else min(max(number, low), high)


def _place(figure: Any, name: str, text: str) -> list[float]:
    """Read where a target goes."""
    numbers = text.split(",")
    if len(numbers) != 3:
        raise ValueError(f"{name} must be three numbers with commas, not {shown(text)}")
    i, model = targets(figure).index(name), figure.targets
    spans = zip("xyz", numbers, model.low[i], model.high[i], strict=True)
    return [_number(f"{axis} of {name}", one, low, high) for axis, one, low, high in spans]


def _places(figure: Any) -> Array:
    return figure.targets.positions if targets(figure) else np.zeros((0, 3))


def _written(value: Value) -> str:
    """Write a value in as few letters as tell it."""
    if isinstance(value, bool):
        return "on" if value else "off"
    if isinstance(value, list):
        return ",".join(map(_written, value))
    if isinstance(value, float):
        return f"{value or 0.0:.{DIGITS}g}"  # no −0
    return str(value)
