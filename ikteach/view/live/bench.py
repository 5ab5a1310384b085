"""A bench: sliders and buttons over a picture that answers them, for chapters 3, 5 and 6."""

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import ipywidgets as widgets
import numpy as np
from matplotlib.artist import Artist
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from ikteach.checks import function
from ikteach.view.plots import as_png
from ikteach.view.widgets import doors
from ikteach.view.widgets.actor import Actor, in_words
from ikteach.view.widgets.closing import Living
from ikteach.view.widgets.lacking import Note
from ikteach.view.widgets.picture import Picture, Still
from ikteach.view.widgets.prose import Prose
from ikteach.view.widgets.status import Status

WIDE = {"description_width": "190px"}


class Shown(NamedTuple):
    """What a bench shows: a picture, the same in words, and what stands under it."""

    png: bytes
    words: str
    below: str = ""  # Markup, or text that is shown as it is


class Canvas:
    """A figure of which only the `moving` artists are drawn anew; the rest stays as it was."""

    def __init__(self, figure: Figure, moving: list[Artist]) -> None:
        self._moving, self._canvas = moving, FigureCanvasAgg(figure)
        for artist in moving:
            artist.set_animated(True)
        self._canvas.draw()
        self._still = self._canvas.copy_from_bbox(figure.bbox)

    def png(self) -> bytes:
        """The figure as it is now, as PNG."""
        self._canvas.restore_region(self._still)
        for artist in self._moving:
            artist.axes.draw_artist(artist)  # type: ignore[union-attr]
        return as_png(np.asarray(self._canvas.buffer_rgba()))


class Bench(Living, widgets.VBox):  # type: ignore[misc]
    """Controls, and a picture that `show(**values)` makes of their values whenever one moves.

    controls  {name: widget with a value}
    buttons   {label: what it does}; then the picture is made anew
    note      where a still picture stands, if it has a place already
    slot      only one of a slot lives at a time: to run a cell again closes the older one

    What goes wrong in `show` or in a button is told in the bench, in words, and the bench stays.
    """

    def __init__(
        self,
        show: Callable[..., Shown],
        controls: Mapping[str, Any],
        *,
        slot: str | None,
        buttons: Mapping[str, Callable[[], None]] | None = None,
        note: Note | None = None,
    ) -> None:
        self.controls, self.slot = doors.named("controls", controls, _control), slot
        self._show, self._stale = function("show", show), False
        buttons = doors.named("buttons", buttons or {}, function)
        self._waiting: list[Callable[[], None]] = []
        self._act = Actor()
        self.status = Status()
        self._picture, self._below = Picture(), Prose()
        self.note = note or Note()
        self.buttons = {label: widgets.Button(description=label) for label in buttons}
        for label, act in buttons.items():
            self.buttons[label].on_click(lambda _, act=act: self._after(act))
        for control in self.controls.values():
            control.observe(lambda _: self._after(None), "value")
        rows = [*self.controls.values()]
        if self.buttons:
            rows.append(widgets.HBox(list(self.buttons.values())))
        super().__init__([*rows, self.status, self._picture, self.note.widget, self._below])
        self.refresh()

    @property
    def values(self) -> dict[str, Any]:
        """What the controls say now."""
        return {name: control.value for name, control in self.controls.items()}

    @property
    def words(self) -> str:
        """What the picture shows, for those who cannot see it."""
        return str(self._picture.alt)

    def refresh(self) -> None:
        """Do what buttons have asked for, and make the picture anew."""
        waiting, self._waiting, self._stale = self._waiting, [], False
        try:
            for act in waiting:
                act()
            png, words, below = self._show(**self.values)
        except Exception as error:
            self.status.wrong = in_words(error)
            return
        self.status.wrong = ""
        self._picture.png, self._picture.alt, self._below.value = png, words, below

    def _after(self, act: Callable[[], None] | None) -> None:
        """Note what was asked for, and see to it that it is done; from any thread."""
        if act is not None:
            self._waiting.append(act)
        self._stale = True
        self._act(self._catch_up)

    def _catch_up(self) -> None:
        if self._stale:  # of several moves at once, the last one is drawn
            self.refresh()

    def _repr_mimebundle_(self, **kwargs: Any) -> Any:
        """The live widget, and beside it a still for places without a kernel."""
        return self.note.beside(super()._repr_mimebundle_(**kwargs), self._still())

    def _still(self) -> Still:
        return Still(self._picture.png, self.words)


def _control(name: str, value: Any) -> None:
    doors.has(name, value, "a widget with a value", "observe", "value")


def slider(label: str, value: float, low: float, high: float, step: float) -> Any:
    """A slider with room for its label; whole numbers where the step is one."""
    kind = widgets.IntSlider if isinstance(step, int) else widgets.FloatSlider
    return kind(
        value=value, min=low, max=high, step=step, description=label, style=WIDE,
        layout=widgets.Layout(width="560px", max_width="100%"),
    )  # fmt: skip


def log_slider(label: str, value: float, low: float, high: float, step: float = 0.05) -> Any:
    """A slider from 10^low to 10^high."""
    return widgets.FloatLogSlider(
        value=value, min=low, max=high, step=step, description=label, style=WIDE,
        readout_format=".3g", layout=widgets.Layout(width="560px", max_width="100%"),
    )  # fmt: skip


def choice(label: str, options: list[str], value: str | None = None) -> Any:
    """Buttons of which one is pressed."""
    style = {**WIDE, "button_width": "auto"}
    return widgets.ToggleButtons(
        options=options, value=value or options[0], description=label, style=style
    )
