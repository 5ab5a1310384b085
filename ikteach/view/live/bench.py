"""A picture that answers its controls."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

import ipywidgets as widgets

from ikteach.checks import function
from ikteach.view.live.link import StateLink
from ikteach.view.live.preset import link_of
from ikteach.view.webgl.scene import Scene
from ikteach.view.widgets import doors
from ikteach.view.widgets.cell import Cell
from ikteach.view.widgets.lacking import Note
from ikteach.view.widgets.layout import Arranged
from ikteach.view.widgets.picture import Picture, Still
from ikteach.view.widgets.prose import Prose


class Shown(NamedTuple):
    """A picture (PNG), its words, and the text under it."""

    png: bytes
    words: str
    below: str = ""  # Markup, or text that is shown as it is


class Bench(Cell):
    """Controls, and a picture of their values.

    `show(**values)` makes the picture whenever a control moves.

    controls  {name: widget with a value}
    first     the values with which it begins
    buttons   {label: its action}; then the picture is made anew
    scene     a live scene that `show` moves; the picture is then a chart beside it
    panel     the controls as they are laid out; one under the other, if not given
    planes    what stands side by side in place of the picture, and shrinks with its place

    The status tells of errors in `show` or in a button, and the bench stays. A subclass gives its
    parts, and overrides nothing.
    """

    def __init__(
        self,
        show: Callable[..., Shown],
        controls: Mapping[str, Any],
        *,
        slot: str | None,
        buttons: Mapping[str, Callable[[], None]] | None = None,
        scene: Scene | None = None,
        panel: Sequence[widgets.Widget] | None = None,
        planes: Sequence[widgets.Widget] = (),
    ) -> None:
        controls = doors.named("controls", controls, _control)
        show, buttons = function("show", show), doors.named("buttons", buttons or {}, function)
        super().__init__(slot, Note() if scene is None else scene.note)
        self.controls, self.scene = controls, scene
        self.first = self.values
        self._show, self._stale = show, False
        self._waiting: list[Callable[[], None]] = []
        self._picture, self._below = Picture(), Prose()
        self._picture.add_class("ikteach-chart")
        self._below.add_class("ikteach-below")
        self.buttons = {label: widgets.Button(description=label) for label in buttons}
        for label, act in buttons.items():
            self.buttons[label].on_click(lambda _, act=act: self._after(act))
        for control in controls.values():
            control.observe(lambda _: self._after(None), "value")
        rows = [*(controls.values() if panel is None else panel)]
        if buttons:
            rows.append(widgets.HBox(list(self.buttons.values())))
        self.refresh()
        self.children = self._laid_out(rows, planes)

    @property
    def values(self) -> dict[str, Any]:
        """The values of the controls, by name."""
        return {name: control.value for name, control in self.controls.items()}

    @property
    def words(self) -> str:
        """The picture in words, for people who cannot see it."""
        return str(self._picture.alt)

    def refresh(self) -> None:
        """Act on buttons, and make the picture anew."""
        self.attempt(self._draw)

    def still(self) -> Still:
        """Draw it for a place without a kernel."""
        png = self._picture.png if self.scene is None else self.scene.still().png
        return Still(png, self.words)

    def make_link(self) -> StateLink:
        """Make the widget that links to its state."""
        return StateLink(lambda: link_of(self), self.guarded, button=self.scene is None)

    def _draw(self) -> None:
        waiting, self._waiting, self._stale = self._waiting, [], False
        for act in waiting:
            act()
        shown = self._show(**self.values)
        self._picture.png, self._picture.alt, self._below.value = shown
        if self.scene is not None and self.scene.driver.description != shown.words:
            self.scene.driver.description = shown.words

    def _after(self, act: Callable[[], None] | None) -> None:
        """Note what was asked for, and see to it that it is done; from any thread."""
        if act is not None:
            self._waiting.append(act)
        self._stale = True
        self._act(self._catch_up)

    def _catch_up(self) -> None:
        if self._stale:  # of several moves at once, the last one is drawn
            self.refresh()

    def _seen(self, new: bool) -> None:
        if new:  # a page that has just opened knows no pose
            self._after(None)

    def _laid_out(
        self, rows: list[widgets.Widget], planes: Sequence[widgets.Widget]
    ) -> list[widgets.Widget]:
        """All parts: the picture or the scene first, a chart beside the scene."""
        scene, below = self.scene, self._below
        chart = [self._picture] if self._picture.png else []
        if scene is None:
            assert self.note is not None
            if planes:
                side_by_side = widgets.HBox([*planes])
                side_by_side.add_class("ikteach-planes")
                seen = [side_by_side, self.note.widget]
                return [Arranged(seen, [*rows, below], wide=True), self.status]
            return [Arranged([*chart, self.note.widget], [*rows, below], chart=True), self.status]
        scene.driver.on_page = self._seen
        scene.offer({"l": ("makes a link to this state", self.guarded(self.show_link))})
        scene.widget.add_class("ikteach-told")  # what its words say, `below` shows
        return [Arranged([scene.widget], [*rows, *chart, below]), self.status]


def _control(name: str, value: Any) -> None:
    doors.has(name, value, "a widget with a value", "observe", "value")
