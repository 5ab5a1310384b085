"""A panel that makes a movie of a session while the notebook goes on."""

import asyncio
from collections.abc import AsyncIterator
from concurrent.futures import ThreadPoolExecutor
from math import ceil, inf, isfinite
from pathlib import Path
from time import monotonic
from typing import Any

import ipywidgets as widgets

from ikteach.formats import movie
from ikteach.motion.live.session import Session
from ikteach.view.live.panel import tick_box
from ikteach.view.raster.film import Film, Shot, shot
from ikteach.view.stage.stage import sides_of
from ikteach.view.widgets import doors
from ikteach.view.widgets.cell import REFRESH, Cell

NOW, PAST = "from now on", "what has been"
PARTS = 4  # how often the words follow it
LABEL = {"description_width": "90px"}


class Stopped(Exception):
    """Stop was pressed."""


class Recorder(Cell):
    """A panel that films a session to MP4, AVI or GIF.

    It has a name, size, rate and seconds, Start and Stop. Display it in a notebook. The pictures
    are drawn and encoded by a thread of their own, so that cells and figures go on; the movie has
    its name only once it is complete.
    """

    def __init__(
        self, session: Session, *, folder: str | Path = ".", slot: str | None = "movie"
    ) -> None:
        session, folder = doors.a(Session, "session", session), doors.folder(folder)
        super().__init__(slot)
        self.session, self.folder = session, folder
        self._task: asyncio.Task[None] | None = None
        self._stop = False
        self.name = widgets.Text(value="walk", description="Movie file", style=LABEL)
        kinds = [(ending[1:].upper(), ending) for ending in movie.KINDS]
        look = {"button_width": "auto", **LABEL}
        self.kind = widgets.ToggleButtons(options=kinds, description="Format", style=look)
        self.width = _box(widgets.IntText, "Width [pixels]", value=640)
        self.height = _box(widgets.IntText, "Height", value=480)
        self.rate = _box(widgets.FloatText, "Frames per s", value=30)
        self.seconds = _box(widgets.FloatText, "Seconds", value=5)
        self.which = _box(widgets.Dropdown, "Film", options=[NOW, PAST])
        sides = sides_of(session.tree, session.effectors)
        self.side = _box(widgets.Dropdown, "View", options=sides)
        self.replace = tick_box("replace a file of that name")
        self.start = self.button("Start recording", self.begin, button_style="primary")
        self.stop = self.button("Stop recording", self.halt, disabled=True)
        bar = {"bar_color": "#0072b2", **LABEL}
        self.progress = widgets.IntProgress(value=0, max=1, description="Movie", style=bar)
        self.children = [
            self.name,
            widgets.HBox([self.kind]),
            widgets.HBox([self.width, self.height]),
            widgets.HBox([self.rate, self.seconds]),
            widgets.HBox([self.which, self.side]),
            self.replace,
            widgets.HBox([self.start, self.stop, self.progress]),
            self.status,
        ]
        self.status.say("Nothing is recorded yet.")
        try:
            movie.library()
        except ImportError as error:
            self.start.disabled = True
            self.status.fail(f"No movie can be made here: {error}.")

    @property
    def path(self) -> Path:
        """Join the name and the format to a file."""
        name = Path(self.name.value.strip())
        stem = name.with_suffix("") if name.suffix.lower() in movie.KINDS else name
        return self.folder / f"{stem}{self.kind.value}"

    def begin(self) -> None:
        """Start the movie.

        The panel says why, if none can be made.
        """
        if self._act.loop is None:
            self.status.fail(
                "A movie is made in the background of a notebook, and none runs here. "
                "ikteach.view.raster.film.film and ikteach.formats.movie.write make one at once."
            )
        elif self._task is None or self._task.done():
            self._stop = False
            self._task = self._act.loop.create_task(self._record())

    def halt(self) -> None:
        """Stop: there will be no file."""
        self._stop = True

    def end(self) -> None:
        """Stop, as `halt` does."""
        self.halt()

    async def _record(self) -> None:
        self.start.disabled, self.stop.disabled = True, False
        self.progress.value = 0
        try:
            path, frames = await self._film()
        except Stopped:
            self.status.say("Stopped: no file was written.")
        except Exception as error:  # the notebook goes on
            self.status.fail(_sentence(error))
        else:
            self.progress.value = self.progress.max
            self.status.say(f"{path.resolve()} is complete: {frames} frames.")
        finally:
            self.start.disabled, self.stop.disabled = False, True

    async def _film(self) -> tuple[Path, int]:
        """Make the movie; its file, and how many frames it has."""
        path, rate = self.path, self.rate.value
        options = self._options(path)
        begin, seconds, past = self._span()
        frames, size = max(1, round(seconds * rate)), options["size"]
        camera = Film(
            *(self.session.tree, self.session.effectors),
            size=size,
            side=self.side.value,
            finer=2 if max(size) <= 1000 else 1,
        )
        self.progress.max, self.progress.value = frames, 0
        self.status.say(f"Recording: 0 of {frames} frames.")
        loop, done, last = asyncio.get_running_loop(), 0, monotonic()
        with movie.writing(path, **options) as add, ThreadPoolExecutor(1, "ikteach-movie") as pool:
            async for one in self._shots(begin, frames, rate, past):
                await loop.run_in_executor(pool, lambda: add(camera.picture(one)))  # noqa: B023
                done += 1
                if monotonic() - last > REFRESH:
                    self.progress.value, last = done, monotonic()
                if done * PARTS // frames > (done - 1) * PARTS // frames:
                    self.status.say(f"Recording: {done} of {frames} frames.")
        return path, frames

    def _options(self, path: Path) -> dict[str, Any]:
        """Check what is asked for, but for the seconds, and give it as `movie` takes it."""
        if not self.name.value.strip():
            raise ValueError("the movie needs a file name")
        size = self.width.value, self.height.value
        options = {"size": size, "rate": self.rate.value, "overwrite": self.replace.value}
        try:
            movie.kind_of(path, **options)
        except FileExistsError:
            raise FileExistsError(
                f"there is a file {str(path)!r} already; tick the box to replace it"
            ) from None
        return options

    def _span(self) -> tuple[float, float, bool]:
        """When the movie begins and how long it is [s], and whether it is of what has been."""
        session, seconds, past = self.session, self.seconds.value, self.which.value == PAST
        most = session.dt * (session.record.maxlen or inf)
        if not (isfinite(seconds) and 0 < seconds <= most):
            raise ValueError(f"the seconds must be more than 0 and at most {most:g}, not {seconds}")
        begin = session.ticks * session.dt
        if past:
            if not session.record:
                raise ValueError("there is nothing to film yet: let the figure move first")
            first = (session.record[0].tick - 1) * session.dt
            begin, seconds = max(first, begin - seconds), min(seconds, begin - first)
        return begin, seconds, past

    async def _shots(
        self, begin: float, frames: int, rate: float, past: bool
    ) -> AsyncIterator[Shot]:
        """Give the shots, each as soon as its time has come."""
        session, runs, i = self.session, self.session.runs, 0
        while i < frames:
            if self._stop:
                raise Stopped
            if session.runs != runs:
                raise ValueError("the session was reset while it was recorded; no file was written")
            wanted, now = begin + i / rate, session.ticks * session.dt
            if not session.record or (wanted > now + 1e-9 and not past):
                self.status.say(
                    f"Recording: {i} of {frames} frames; the figure must move for more."
                )
                await asyncio.sleep(0.1)
                continue
            run = session.log(last=ceil((now - wanted) / session.dt) + 2)
            title = session.gait.name if not session.by_hand else "by hand"
            while i < frames and (past or begin + i / rate <= now + 1e-9):
                if self._stop:
                    raise Stopped
                yield shot(run, begin + i / rate, title=title)
                i += 1


def _box(kind: Any, label: str, **traits: Any) -> Any:
    """Make a control that fits beside another."""
    return kind(description=label, style=LABEL, layout={"width": "210px"}, **traits)


def _sentence(error: Exception) -> str:
    words = str(error) or type(error).__name__
    return f"No movie was made: {words}."
