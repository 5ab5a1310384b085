"""Sliders for the joints of a figure, from limit to limit."""

from collections.abc import Mapping
from typing import Any, NamedTuple

import ipywidgets as widgets
import numpy as np

from ikteach.arrays import Array
from ikteach.body.extent import extent
from ikteach.body.figures import TOGETHER, Figure
from ikteach.markup import minus, plain
from ikteach.view.live.panel import slider
from ikteach.view.stage.lengths import Lengths, digits_of, round_step


class Joints:
    """Sliders of the joints, grouped by effectors.

    There is one per joint, and joints stand together that move the same effectors. Two rows that
    one angle turns (`figures.TOGETHER`) have one slider.

    controls  {name: slider}
    widget    all of them, to be shown
    """

    def __init__(self, figure: Figure) -> None:
        self.figure = figure
        self._lead = {b: a for a, b in TOGETHER if {a, b} <= set(figure.tree.names)}
        dials = [Dial.of(figure, j) for j in range(len(figure.tree))]
        self._each = np.array([dial.each for dial in dials])
        self.controls = {
            name: dial.slider(name)
            for name, dial in zip(figure.tree.names, dials, strict=True)
            if name not in self._lead
        }
        groups: dict[str, list[Any]] = {}
        for name, control in self.controls.items():
            groups.setdefault(_moves(figure, name), []).append(control)
        boxes = [widgets.VBox(group) for group in groups.values()]
        self.widget = widgets.Accordion(boxes, titles=list(groups), selected_index=0)

    def theta(self, values: Mapping[str, Any]) -> Array:
        """Give the pose of these values of the sliders, (n,) [rad or m]."""
        tree = self.figure.tree
        of_rows = [values[self._lead.get(name, name)] for name in tree.names]
        return np.clip(self._each * of_rows, tree.lower, tree.upper)

    def put(self, theta: Array) -> None:
        """Set the sliders to a pose (n,) [rad or m]."""
        values = dict(zip(self.figure.tree.names, theta / self._each, strict=True))
        for name, control in self.controls.items():
            control.value = min(max(float(values[name]), control.min), control.max)


class Dial(NamedTuple):
    """A joint, as a person sets it.

    Degrees of a hinge, a length of a slide.

    each        one unit, in those of θ [rad or m]
    unit        its name
    low, high   ends of the range
    value       the rest
    step        of the slider
    """

    each: float
    unit: str
    low: float
    high: float
    value: float
    step: float

    @classmethod
    def of(cls, figure: Figure, j: int) -> "Dial":
        """Make the dial of joint j, from limit to limit.

        A hinge that can turn for ever is set within ±180°, one with one limit through a whole turn
        from it; a slide goes on by the size of the body.
        """
        tree, slide = figure.tree, bool(figure.tree.slide[j])
        size = extent(*figure).radius
        lengths = Lengths.of_places(size)
        each, unit = (lengths.metres, f" {lengths.name}") if slide else (np.radians(1), "°")
        lower, rest, upper = (float(x[j]) / each for x in (tree.lower, tree.rest, tree.upper))
        far = size / each if slide else 180.0
        if not slide and 3600 < upper - lower < np.inf:  # limits in name only
            lower, upper = -np.inf, np.inf
        if np.isinf(lower) and np.isinf(upper):
            middle = rest if slide else 0.0
            rest = rest if slide else (rest + 180) % 360 - 180
            lower, upper = middle - far, middle + far
        elif np.isinf(lower):
            lower = min(rest, upper) - 2 * far
        elif np.isinf(upper):
            upper = max(rest, lower) + 2 * far
        step = round_step(upper - lower) if upper > lower else 1.0
        if not slide and upper - lower >= 30:
            step = 1.0
        low, value, high = (float(f"{x:.12g}") for x in (lower, rest, upper))
        return cls(float(each), unit, low, high, min(max(value, low), high), step)

    def slider(self, name: str) -> Any:
        """Make a slider for it, with its ends in its label."""
        ends = minus(f"{self.low:.4g}…{self.high:.4g}")  # as the slider writes it
        label = plain(f"{name} ({ends}{self.unit})")
        digits = f".{digits_of(self.step)}f"
        look = {"width": "auto", "label_width": "175px", "readout_format": digits}
        return slider(label, self.value, self.low, self.high, self.step, **look)


def _moves(figure: Figure, joint: str) -> str:
    """Say which effectors a joint moves."""
    effectors = figure.effectors
    carried = effectors.carried[:, figure.tree.index(joint)]
    names = [name for name, moves in zip(effectors.names, carried, strict=True) if moves]
    return plain(f"moves {' and '.join(names)}") if names else "moves no effector"
