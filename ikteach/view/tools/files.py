"""A panel that saves a session to files and opens saved ones for replay."""

from collections.abc import Callable
from pathlib import Path

import ipywidgets as widgets

from ikteach.checks import function
from ikteach.formats.session import load, save
from ikteach.motion.live.log import Log
from ikteach.motion.live.session import Session
from ikteach.view.live.panel import tick_box
from ikteach.view.tools.replay import Replay
from ikteach.view.widgets import doors
from ikteach.view.widgets.cell import Cell
from ikteach.view.widgets.closing import close_all


class Keeper(Cell):
    """A panel to save a session and to open runs.

    It has a file name, Save and Open.

    session   the one that is saved
    open_run  is given the run that was opened; if there is none, a `Replay` of it in this widget
    """

    def __init__(
        self,
        session: Session,
        open_run: Callable[[Log], None] | None = None,
        *,
        folder: str | Path = ".",
        slot: str | None = "files",
    ) -> None:
        session, folder = doors.a(Session, "session", session), doors.folder(folder)
        open_run = function("open_run", open_run or self._replay)
        super().__init__(slot)
        self.session, self.folder, self._open_run = session, folder, open_run
        self.name = widgets.Text(value="session", description="Session file")
        self.replace = tick_box("replace files of that name")
        self.saving = self.button("Save the session", self._save)
        self.opening = self.button("Open and replay", self._open)
        self.place = widgets.VBox()
        buttons = widgets.HBox([self.saving, self.opening])
        self.children = [self.name, self.replace, buttons, self.status, self.place]

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
        replay = Replay(run, slot=None)
        before, self.place.children = self.place.children, [replay]
        close_all(*before)
        replay.status.come()
