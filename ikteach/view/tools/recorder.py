"""A panel that makes a movie of a session while the notebook goes on."""

import asyncio
from collections.abc import AsyncIterator
from concurrent.futures import ThreadPoolExecutor
from math import ceil, inf, isfinite
from pathlib import Path
from time import monotonic

import ipywidgets as widgets

from ikteach.formats import movie
from ikteach.motion.live.session import Session
from ikteach.view.raster.film import Film, Shot, shot
from ikteach.view.stage.stage import sides_of
from ikteach.view.widgets import doors
from ikteach.view.widgets.actor import Actor
from ikteach.view.widgets.closing import Living
from ikteach.view.widgets.status import Status

NOW, PAST = "from now on", "what has been"
OFTEN = 0.2  # [s] between two moves of the progress bar
PARTS = 4  # how often the words follow it
LABEL = {"description_width": "90px"}


class Stopped(Exception):
    """Stop was pressed."""


class Recorder(Living, widgets.VBox):  # type: ignore[misc]
    """Film a session to an MP4, AVI or GIF: name, size, rate and seconds, Start and Stop.

    Display it in a notebook. The pictures are drawn and encoded by a thread of their own, so that
    cells and figures go on; the movie has its name only once it is complete. Only one recorder of a
    `slot` lives at a time: to run a cell again closes the one that it made before.
    """

    def __init__(
        self, session: Session, *, folder: str | Path = ".", slot: str | None = "movie"
    ) -> None:
        self.session, self.slot = doors.a(Session, "session", session), slot
        self.folder = doors.folder(folder)
        self._task: asyncio.Task[None] | None = None
        self._stop = False
        self._act = Actor()
        self.name = widgets.Text(value="walk", description="File name", style=LABEL)
        self.kind = widgets.ToggleButtons(
            options=[(ending[1:].upper(), ending) for ending in movie.KINDS], description="Format",
            style={"button_width": "auto", **LABEL},
        )  # fmt: skip
        self.width = widgets.IntText(value=640, description="Width [pixels]", style=LABEL)
        self.height = widgets.IntText(value=480, description="Height", style=LABEL)
        self.rate = widgets.FloatText(value=30, description="Frames a s", style=LABEL)
        self.seconds = widgets.FloatText(value=5, description="Seconds", style=LABEL)
        self.which = widgets.Dropdown(options=[NOW, PAST], description="Film", style=LABEL)
        sides = sides_of(session.tree, session.effectors)
        self.side = widgets.Dropdown(options=sides, description="View", style=LABEL)
        self.replace = widgets.Checkbox(
            value=False, description="replace a file of that name", indent=False
        )
        self.start = widgets.Button(description="Start recording", button_style="primary")
        self.stop = widgets.Button(description="Stop recording", disabled=True)
        self.progress = widgets.IntProgress(
            value=0, max=1, description="Movie", style={"bar_color": "#0072b2", **LABEL}
        )
        self.status = Status()
        self.start.on_click(lambda _: self._act(self.begin, self.status.fail))
        self.stop.on_click(lambda _: self.halt())
        for one in (self.width, self.height, self.rate, self.seconds, self.which, self.side):
            one.layout.width = "210px"
        super().__init__(
            [
                self.name,
                widgets.HBox([self.kind]),
                widgets.HBox([self.width, self.height]),
                widgets.HBox([self.rate, self.seconds]),
                widgets.HBox([self.which, self.side]),
                self.replace,
                widgets.HBox([self.start, self.stop, self.progress]),
                self.status,
            ]
        )
        self.status.say("Nothing is recorded yet.")
        try:
            movie.library()
        except ImportError as error:
            self.start.disabled = True
            self.status.fail(f"No movie can be made here: {error}.")

    @property
    def path(self) -> Path:
        """The file that the name and the format make."""
        name = Path(self.name.value.strip())
        stem = name.with_suffix("") if name.suffix.lower() in movie.KINDS else name
        return self.folder / f"{stem}{self.kind.value}"

    def begin(self) -> None:
        """Start the movie; what cannot be is said in the panel."""
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
        except Exception as error:  # told to the person, and the notebook goes on
            self.status.fail(_sentence(error))
        else:
            self.progress.value = self.progress.max
            self.status.say(f"{path} is complete: {frames} frames.")
        finally:
            self.start.disabled, self.stop.disabled = False, True

    async def _film(self) -> tuple[Path, int]:
        path, rate, session = self.path, self.rate.value, self.session
        if not self.name.value.strip():
            raise ValueError("the movie needs a file name")
        asked = {
            "size": (self.width.value, self.height.value), "rate": rate,
            "overwrite": self.replace.value,
        }  # fmt: skip
        try:
            movie.kind_of(path, **asked)
        except FileExistsError:
            raise FileExistsError(
                f"there is a file {str(path)!r} already; tick the box to replace it"
            ) from None
        seconds, most = self.seconds.value, session.dt * (session.record.maxlen or inf)
        if not (isfinite(seconds) and 0 < seconds <= most):
            raise ValueError(f"the seconds must be more than 0 and at most {most:g}, not {seconds}")
        begin, past = session.ticks * session.dt, self.which.value == PAST
        if past:
            if not session.record:
                raise ValueError("there is nothing to film yet: let the figure move first")
            first = (session.record[0].tick - 1) * session.dt
            begin, seconds = max(first, begin - seconds), min(seconds, begin - first)
        frames = max(1, round(seconds * rate))
        camera = Film(
            session.tree, session.effectors, size=asked["size"], side=self.side.value,
            finer=2 if max(asked["size"]) <= 1000 else 1,
        )  # fmt: skip
        self.progress.max, self.progress.value = frames, 0
        self.status.say(f"Recording: 0 of {frames} frames.")
        done, told = 0, monotonic()
        with movie.writing(path, **asked) as add, ThreadPoolExecutor(1, "ikteach-movie") as pool:
            async for one in self._shots(begin, frames, rate, past):

                def work(one: Shot = one) -> None:
                    add(camera.picture(one))

                await asyncio.get_running_loop().run_in_executor(pool, work)
                done += 1
                if monotonic() - told > OFTEN:
                    self.progress.value, told = done, monotonic()
                if done * PARTS // frames > (done - 1) * PARTS // frames:
                    self.status.say(f"Recording: {done} of {frames} frames.")
        return path, frames

    async def _shots(
        self, begin: float, frames: int, rate: float, past: bool
    ) -> AsyncIterator[Shot]:
        """The shots, each as soon as its time has come."""
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


def _sentence(error: Exception) -> str:
    words = str(error) or type(error).__name__
    return f"No movie was made: {words}."
