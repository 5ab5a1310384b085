"""What every live figure has: a loop that lets time pass, a picture that follows, and a way to say
what went wrong. State is in the session; the loop runs only while it plays and somebody looks.
"""

import asyncio
from collections.abc import Callable
from time import monotonic
from typing import Any

import ipywidgets as widgets

from ikteach.view.live.strips import EVERY, Strips
from ikteach.view.webgl.scene import Scene
from ikteach.view.widgets.actor import Actor, in_words
from ikteach.view.widgets.closing import Living
from ikteach.view.widgets.picture import Still
from ikteach.view.widgets.status import Status


class Live(Living, widgets.VBox):  # type: ignore[misc]
    """A session that is played. Only one of a `slot` lives at a time: to run a cell again closes
    the one that it made before.

    session  has `tick()`, `ticks` and `dt`, and holds all state
    strips   the curves that run along with it, if there are any

    A subclass says how to `draw`, what to `report` now and then, and puts `children` in place.
    """

    REPORT_EVERY = 30  # ticks
    SELDOM = 3  # times as rarely come curves and words, where the machine is too slow for all

    def __init__(
        self, session: Any, scene: Scene, slot: str | None, strips: Strips | None = None
    ) -> None:
        self.slot = slot
        self.session, self.scene, self.strips = session, scene, strips
        self.playing = True
        self.status = Status()
        self._changes = 0
        self._act = Actor()  # without a notebook nothing moves by itself; `session.tick()` does
        self._task: asyncio.Task[None] | None = None
        scene.driver.on_page = self._seen
        super().__init__()

    def draw(self) -> None:
        """Have the scene show what the session says."""
        raise NotImplementedError

    def report(self) -> None:
        """Bring words and tables up to date."""
        raise NotImplementedError

    def play_button(self) -> widgets.ToggleButton:
        """A button that plays and pauses; for a subclass that has no other way."""
        self._play = widgets.ToggleButton(value=True, description="Pause")

        def toggled(change: Any) -> None:
            if change["new"] != self.playing:  # by a person, and not by `say_playing`
                self.guarded(self.play if change["new"] else self.pause)()

        self._play.observe(toggled, "value")
        return self._play

    def say_playing(self, on: bool) -> None:
        """Have the button say whether it plays."""
        self._play.value, self._play.description = on, "Pause" if on else "Play"

    def step(self) -> None:
        """Stop the clock, and let one tick pass."""
        self.pause()
        self.session.tick()

    @property
    def words(self) -> str:
        """What the picture shows, for those who cannot see it."""
        raise NotImplementedError

    @property
    def settled(self) -> bool:
        """Whether nothing would move any more."""
        return False

    def play(self) -> None:
        """Let time pass."""
        self._set_playing(True)

    def pause(self) -> None:
        """Stop the clock; controls still act."""
        self._set_playing(False)

    def _set_playing(self, on: bool) -> None:
        self.playing = on
        self.say_playing(on)
        self.wake()

    def end(self) -> None:
        """End the loop, for good."""
        self._act.loop = None
        self.stop()

    def stop(self) -> None:
        """End the loop."""
        self.playing = False
        if self._task is not None:
            self._task.cancel()

    def _repr_mimebundle_(self, **kwargs: Any) -> Any:
        """The live widget, and beside it a still for places without a kernel."""
        bundle = super()._repr_mimebundle_(**kwargs)
        self.draw()
        return self.scene.note.beside(bundle, Still(self.scene.still().png, self.words))

    # Callbacks may come on another thread: they are handed over, and the loop's thread acts.

    def guarded(self, action: Callable[..., None]) -> Callable[..., None]:
        """`action`, with what goes wrong in it told to the person, once, and the session kept."""

        def act(*arguments: Any) -> None:
            try:
                action(*arguments)
            except Exception as error:
                self.tell(error)
            else:
                self.status.wrong = ""
            self._changes += 1
            self.wake()

        return lambda *arguments: self._act(lambda: act(*arguments))

    def tell(self, error: Exception) -> None:
        """Say what went wrong where the person looks."""
        self.status.wrong = in_words(error)

    def wake(self) -> None:
        """See to it that the loop runs if there is something to do; from any thread."""
        if self._act.loop is not None and not self._act.loop.is_closed():
            self._act.loop.call_soon_threadsafe(self._start)

    def _seen(self, new: bool) -> None:
        """A page is new, or has drawn: then the loop goes on, should it have given up on it."""
        if new or self.playing:
            self.wake()

    def _start(self) -> None:
        if self._task is None or self._task.done():
            self._task = asyncio.get_running_loop().create_task(self._run())

    async def _run(self) -> None:
        due, session = monotonic(), self.session
        try:
            self.draw()
            while self.playing and not (self.settled or self.scene.driver.unwatched):
                due = max(due + session.dt, monotonic() - session.dt)  # late: go on, do not race
                await asyncio.sleep(max(due - monotonic(), 0.001))
                if not self.playing:
                    break
                often = 1 if monotonic() - due < session.dt else self.SELDOM
                session.tick()
                if self.scene.driver.ready:
                    self.draw()
                if self.strips is not None and session.ticks % (often * EVERY) == 0:
                    self.strips.send_new()
                if session.ticks % (often * self.REPORT_EVERY) == 0:
                    self.report()
            self.draw()
            if self.strips is not None:
                self.strips.send_new()
            self.report()
        except Exception as error:  # a student's own solver, most likely
            self.pause()
            self.tell(error)
