"""Sliders that keep what a program sets, though a page rounds it to their steps."""

import time
from collections import deque
from collections.abc import Iterator
from contextlib import contextmanager
from math import log10
from typing import Any

import ipywidgets as widgets

LATE = 2.0  # [s] after which a page says nothing more of what it was shown
MOST = 64  # values that a page may be behind: two seconds of a figure that plays


class Exact(widgets.DOMWidget):  # type: ignore[misc]
    """What tells the rounding of a page from a move.

    A page that is shown a value between two steps brings it to the nearest, and sends that as if a
    person had moved the slider; when a program sets one value after the other, it does so late.
    """

    def __init__(self, **traits: Any) -> None:
        self._from_page = False
        self._shown: deque[tuple[float, float]] = deque(maxlen=MOST)  # when, and which value
        super().__init__(**traits)
        self._note(self.value)
        self.observe(lambda change: self._note(change["new"]), "value")

    def set_state(self, sync_data: dict[str, Any]) -> None:
        """Take what a page sends, but for its rounding."""
        if "value" in sync_data and self._rounds(sync_data["value"]):
            sync_data = {name: x for name, x in sync_data.items() if name != "value"}
        with self._person():
            super().set_state(sync_data)

    def nearest(self, value: float) -> float:
        """Give the step or end to which a page rounds a value."""
        steps = round((value - self.min) / self.step)
        return self.max if value >= self.max else min(self.min + steps * self.step, self.max)

    @contextmanager
    def _person(self) -> Iterator[None]:
        self._from_page = True
        try:
            yield
        finally:
            self._from_page = False

    def _note(self, value: float) -> None:
        if self._from_page:  # from here on a page speaks of this value
            self._shown.clear()
        if not self._same(value, self.nearest(value)):
            self._shown.append((time.monotonic(), value))

    def _rounds(self, sent: Any) -> bool:
        """Whether a page has only rounded the value that it has, or one that it had just now."""
        if not isinstance(sent, int | float):
            return False
        since = time.monotonic() - LATE
        known = [self.value, *(value for when, value in self._shown if when > since)]
        return any(self._same(sent, self.nearest(value)) for value in known)

    def _same(self, a: float, b: float) -> bool:
        return abs(a - b) < 1e-6 * self.step


class Slider(Exact, widgets.FloatSlider):  # type: ignore[misc]
    """A slider of numbers with a fraction."""


class WholeSlider(Exact, widgets.IntSlider):  # type: ignore[misc]
    """A slider of whole numbers."""


class LogSlider(Exact, widgets.FloatLogSlider):  # type: ignore[misc]
    """A slider of powers, whose steps are those of the exponent."""

    def nearest(self, value: float) -> float:
        """Give the power whose exponent is on a step."""
        exponent = log10(value) / log10(self.base)
        return float(self.base ** super().nearest(exponent))

    def _same(self, a: float, b: float) -> bool:
        return a > 0 and abs(log10(a / b) / log10(self.base)) < 1e-6 * self.step
