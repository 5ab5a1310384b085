"""Panels: named controls that carry what they do, and the one factory for each kind of control."""

from collections.abc import Callable, Mapping, Sequence
from math import inf
from typing import Any, NamedTuple

import ipywidgets as widgets

from ikteach.view.live.sliders import LogSlider, Slider, WholeSlider
from ikteach.view.live.turns import Turns
from ikteach.view.widgets import doors

Act = Callable[..., Any]
Row = Any  # {name: control or Does}, or a widget


class Does(NamedTuple):
    """A control and its action.

    `act(value)` for a new value, `act()` for the click of a button.
    """

    control: Any
    act: Act | None  # None: it is only read


class Panel:
    """Controls under a title, which act for a person.

    They act when a person changes them, and not when a program does.

    rows      from top to bottom: {name: control or Does(control, act)}, whose controls stand side
              by side, or any widget
    folded    {title: rows} of an accordion under them
    opened    the place of the part of it that is open, None if none is
    shows     gives the values of controls, by name, that `agree` sets
    guard     wraps each action; of a live figure `Live.guarded`, which reports errors
    layout    of the whole

    controls  {name: widget}
    turns     who set them last
    widget    all of it, to be shown
    """

    def __init__(
        self,
        title: str,
        rows: Sequence[Row],
        *,
        folded: Mapping[str, Sequence[Row]] | None = None,
        opened: int | None = None,
        shows: Callable[[], Mapping[str, Any]] = dict,
        guard: Callable[[Act], Act] = lambda act: act,
        **layout: Any,
    ) -> None:
        self.title, self._shows, self._guard = title, shows, guard
        self.controls: dict[str, Any] = {}
        self._quiet, self.turns = False, Turns()
        self._due: set[str] = set()  # controls that a person has set, and that are yet to act
        boxes = [self._box(row) for row in rows]
        if folded:
            parts = [widgets.VBox([self._box(row) for row in part]) for part in folded.values()]
            boxes.append(widgets.Accordion(parts, titles=list(folded), selected_index=opened))
        self.first = self.values
        self.widget = widgets.VBox(boxes, layout=layout)

    @property
    def values(self) -> dict[str, Any]:
        """The value of each control that has one."""
        return {
            name: control.value
            for name, control in self.controls.items()
            if not isinstance(control, widgets.Button)
        }

    def put(self, **values: Any) -> None:
        """Set controls without acting.

        The range of a slider grows where it must.
        """
        self._quiet = True
        try:
            for name, value in values.items():
                control = self.controls[name]
                self.turns.follow(name, control.value, value)
                if isinstance(control, widgets.FloatSlider | widgets.IntSlider):
                    control.min, control.max = min(control.min, value), max(control.max, value)
                control.value = value
        finally:
            self._quiet = False

    def agree(self) -> None:
        """Set controls to the values of `shows`, without acting.

        What a person has set just now, and has not acted yet, stays.
        """
        self.put(**{name: x for name, x in self._shows().items() if name not in self._due})

    def restore(self) -> None:
        """Set controls to their first values, without acting."""
        self.put(**self.first)

    def disable(self) -> None:
        """Disable all controls: no person changes anything more."""
        for control in self.controls.values():
            control.disabled = True

    def _box(self, row: Row) -> widgets.Widget:
        if not isinstance(row, Mapping):
            return row
        for name, one in row.items():
            control, act = one if isinstance(one, Does) else Does(one, None)
            self.controls[name] = control
            self._listen(name, control, act)
        made = [self.controls[name] for name in row]
        return made[0] if len(made) == 1 else widgets.HBox(made, layout={"flex_flow": "row wrap"})

    def _listen(self, name: str, control: Any, act: Act | None) -> None:
        def acting(*value: Any) -> None:
            self._due.discard(name)
            if act is not None:
                act(*value)

        guarded = acting if act is None else self._guard(acting)  # who only reads ends no error
        if isinstance(control, widgets.Button):
            control.on_click(lambda _: guarded())
            return

        def changed(change: Any) -> None:
            if not self._quiet:
                self.turns.ask(name)
                self._due.add(name)
                guarded(change["new"])

        control.observe(changed, "value")


def slider(label: str, value: float, low: float, high: float, step: float, **look: Any) -> Any:
    """Make a slider from low to high.

    Its range goes on to its value if that is beyond them.

    step  whole numbers only, if it is an int
    look  `width` of the slider with its label, `label_width`, and traits of the slider
    """
    kind = WholeSlider if isinstance(step, int) else Slider
    doors.within(f"the value of {label!r}", value, -inf, inf)
    low, high = min(low, value), max(high, value)
    return kind(value=value, min=low, max=high, step=step, **_look(label, **look))


def log_slider(
    label: str, value: float, low: float, high: float, step: float = 0.05, **look: Any
) -> Any:
    """Make a slider from 10^low to 10^high.

    Its steps are those of the exponent.
    """
    look = {"readout_format": ".3g"} | look
    return LogSlider(value=value, min=low, max=high, step=step, **_look(label, **look))


def choice(
    label: str, options: Sequence[str], value: str | None = None, *, label_width: str = "190px"
) -> Any:
    """Make buttons of which one is pressed.

    It is the first if no value is given.
    """
    style = {"description_width": label_width, "button_width": "auto"}
    value = options[0] if value is None else value
    return widgets.ToggleButtons(options=options, value=value, description=label, style=style)


def dropdown(
    label: str, options: Sequence[str], value: str | None = None, *, label_width: str = "190px"
) -> Any:
    """Make a list of which one is chosen.

    It is the first if no value is given.
    """
    style = {"description_width": label_width}
    value = options[0] if value is None else value
    return widgets.Dropdown(options=options, value=value, description=label, style=style)


def tick_box(label: str, value: bool = False, **layout: Any) -> Any:
    """Make a box to tick."""
    return widgets.Checkbox(value=value, description=label, indent=False, layout=layout)


def button(label: str) -> Any:
    """Make a button as wide as its label."""
    return widgets.Button(description=label, layout={"width": "auto"})


def play_button() -> Any:
    """Make a button that is pressed while the figure plays.

    Its label names the effect of a click.
    """
    made = widgets.ToggleButton(value=True, description="Pause", layout={"width": "5em"})

    def name(change: Any) -> None:
        made.description = "Pause" if change["new"] else "Play"

    made.observe(name, "value")
    return made


def press(control: Any, value: Any) -> None:
    """Set a control as a person does, if it is enabled."""
    if not control.disabled:
        control.value = value


def _look(
    label: str, width: str = "560px", label_width: str = "190px", **traits: Any
) -> dict[str, Any]:
    """Give the traits of a slider of this label: as wide as that, or as the page has room."""
    style = {"description_width": label_width}
    layout = {"width": width, "max_width": "calc(100% - 4px)"}  # but for its margins
    return {"description": label, "style": style, "layout": layout, **traits}
