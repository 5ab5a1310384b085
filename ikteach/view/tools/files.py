"""A panel that saves a session to files and opens saved ones for replay."""

from collections.abc import Callable
from pathlib import Path

import ipywidgets as widgets

from ikteach.checks import function
from ikteach.formats.session import load, save
from ikteach.motion.live.log import Log
from ikteach.motion.live.session import Session
from ikteach.view.tools.replay import Replay
from ikteach.view.widgets import doors
from ikteach.view.widgets.actor import Actor
from ikteach.view.widgets.closing import Living, close_all
from ikteach.view.widgets.status import Status


class Keeper(Living, widgets.VBox):  # type: ignore[misc]
    """Save what happened, and open it again: file name, Save, Open.

    session   what is saved
    open_run  is given the run that was opened; if there is none, a `Replay` of it in this widget
    slot      only one of a slot lives at a time: to run a cell again closes the older one
    """

    def __init__(
        self, session: Session, open_run: Callable[[Log], None] | None = None, *,
        folder: str | Path = ".", slot: str | None = "files",
    ) -> None:  # fmt: skip
        self.session, self.slot = doors.a(Session, "session", session), slot
        self.folder = doors.folder(folder)
        self._open_run = function("open_run", open_run or self._replay)
        self._act = Actor()
        self.name = widgets.Text(value="session", description="File name")
        self.replace = widgets.Checkbox(
            value=False, description="replace files of that name", indent=False
        )
        self.saving = widgets.Button(description="Save the session")
        self.opening = widgets.Button(description="Open and replay")
        self.status, self.place = Status(), widgets.VBox()
        self.saving.on_click(lambda _: self._act(self._save, self.status.fail))
        self.opening.on_click(lambda _: self._act(self._open, self.status.fail))
        buttons = widgets.HBox([self.saving, self.opening])
        super().__init__([self.name, self.replace, buttons, self.status, self.place])

    def _path(self) -> Path:
        if not self.name.value.strip():
            raise ValueError("the session needs a file name")
        return self.folder / self.name.value.strip()

    def _save(self) -> None:
        run = self.session.log()
        try:
            files = save(self._path(), run, overwrite=self.replace.value)
        except FileExistsError as error:
            words = str(error).partition(";")[0]
            raise FileExistsError(f"{words}; tick the box to replace it") from None
        kept = f"{len(run)} ticks and {len(run.events)} events"
        self.status.say(f"{kept} are saved in {files[0]} and {files[1]}. {run.lost()}")

    def _open(self) -> None:
        run = load(self._path())
        self._open_run(run)
        self.status.say(f"{len(run)} ticks and {len(run.events)} events are open. {run.lost()}")

    def _replay(self, run: Log) -> None:
        before, self.place.children = self.place.children, [Replay(run, slot=None)]
        close_all(*before)
