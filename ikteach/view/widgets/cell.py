"""The base of every figure and tool in a cell, whatever it shows."""

from collections.abc import Callable
from typing import Any

import ipywidgets as widgets

from ikteach.view.widgets.actor import Actor, attempt
from ikteach.view.widgets.closing import Living
from ikteach.view.widgets.lacking import Note
from ikteach.view.widgets.picture import Still
from ikteach.view.widgets.status import Status

REFRESH = 0.2  # [s] between two updates of a figure that plays or works, fast enough for the eye


class Cell(Living, widgets.VBox):  # type: ignore[misc]
    """A column of widgets with a status line.

    Its callbacks are guarded, and a still picture stands beside it.

    slot    only one of a slot lives at a time: to run a cell again closes the older one
    note    where the still picture stands, among the `children`; None: there is no such picture
    status  tells of progress and of errors

    link    to its state, once it is shown; None: it has no controls to set

    A subclass makes its parts after `super().__init__`, and last puts them in place as `children`.
    """

    children: Any

    def __init__(self, slot: str | None, note: Note | None = None) -> None:
        self._act = Actor()  # first, so that one that fails half made can be ended
        super().__init__()
        self.add_class("ikteach-figure")
        self.slot, self.note, self.status = slot, note, Status()
        self.link: Any = None

    def still(self) -> Still | None:
        """Draw it for a place without a kernel.

        None if there is nothing to see.
        """
        return None

    def make_link(self) -> Any:
        """Make the widget that links to its state, if any."""
        return None

    def show_link(self) -> None:
        """Show a link to the state of this moment."""
        self._have_link()
        if self.link is not None:
            self.link.show()

    def acted(self) -> None:
        """Go on after a guarded callback, whether it failed or not."""

    def guarded(self, action: Callable[..., object]) -> Callable[..., None]:
        """Wrap a callback, to run in the notebook's loop.

        The status tells of an error; the session, and all else, stays as it was. Callbacks may come
        on another thread.
        """

        def act(*arguments: Any) -> None:
            self.attempt(lambda: action(*arguments))
            self.acted()

        return lambda *arguments: self._act(lambda: act(*arguments))

    def attempt(self, action: Callable[[], object]) -> None:
        """Do it now, and tell of an error in `status`.

        An error of before is over.
        """
        with self.status.hold_sync():
            self.status.wrong = ""
            attempt(action, self.status.fail)

    def button(self, label: str, action: Callable[[], object], **look: Any) -> widgets.Button:
        """Make a button for this action, guarded."""
        made, act = widgets.Button(description=label, **look), self.guarded(action)
        made.on_click(lambda _: act())
        return made

    def _repr_mimebundle_(self, **kwargs: Any) -> Any:
        """Show the live widget, and beside it the still picture."""
        self._have_link()
        bundle = super()._repr_mimebundle_(**kwargs)
        still = self.still()
        return bundle if still is None or self.note is None else self.note.beside(bundle, still)

    def _have_link(self) -> None:
        if self.link is None and (link := self.make_link()) is not None:
            self.link = link
            at = self.children.index(self.status) + 1 if self.status in self.children else 0
            self.children = [*self.children[:at], link, *self.children[at:]]
