"""A link to the state of a figure, shown when somebody asks for it."""

from collections.abc import Callable
from typing import Any

import anywidget
import traitlets

from ikteach.view.widgets.closing import Living
from ikteach.view.widgets.page import script, style

Guard = Callable[[Callable[..., object]], Callable[..., None]]


class StateLink(Living, anywidget.AnyWidget):
    """A text that leads back to the state of a figure.

    On a page of the lecture it is an address, in a notebook what a cell needs.

    write   gives the state as text
    guard   wraps actions, as `Cell.guarded`
    button  whether it has a button of its own: a figure with a picture has one there
    """

    _esm, _css = script("view/live/link.js"), style("view/live/link.css")
    state = traitlets.Unicode("").tag(sync=True)
    asked = traitlets.Int(0).tag(sync=True)  # how often it was asked for
    button = traitlets.Bool(False).tag(sync=True)

    def __init__(self, write: Callable[[], str], guard: Guard, *, button: bool = False) -> None:
        self._write = write
        super().__init__(button=button)
        show = guard(self.show)
        self.on_msg(lambda *_: show())

    def show(self) -> Any:
        """Show the link to the state of this moment."""
        with self.hold_sync():
            self.state, self.asked = self._write(), self.asked + 1
