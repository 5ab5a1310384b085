"""What every live figure has: a loop that lets time pass, a picture that follows, and a way to say
what went wrong. State is in the session; the loop runs only while it plays and somebody looks.
"""

import asyncio
from collections.abc import Callable
from time import monotonic
from typing import Any, ClassVar

import ipywidgets as widgets

from ikteach.motion.session import Session
from ikteach.view.acting import Actor
from ikteach.view.plots import portrait
from ikteach.view.scene import Scene
from ikteach.view.status import Status
from ikteach.view.strips import EVERY, Strips

WORDS_EVERY = 30  # ticks between two tables, and two descriptions of the picture


class Live(widgets.VBox):  # type: ignore[misc]
    """A session that is played: base of `player.GaitPlayer` and `workbench.Workbench`.

    Only one of a `slot` lives at a time: to run a cell again closes the one that it made before.
    A subclass says how to `draw`, and what to `report` now and then.
    """

    _living: ClassVar[dict[str, "Live"]] = {}

    def __init__(self, session: Session, scene: Scene, slot: str) -> None:
        if slot in self._living:
            self._living.pop(slot).close()
        self._living[slot] = self
        self._slot = slot
        self.session, self.scene = session, scene
        self.playing = True
        self.status = Status()
        self.strips = Strips(session)
        self._changes = 0
        self._task: asyncio.Task[None] | None = None
        self._act = Actor()  # without a notebook nothing moves by itself; `session.tick()` does
        scene.driver.on_sign = self._seen
        super().__init__()

    def draw(self) -> None:
        """Have the scene show what the session says."""
        raise NotImplementedError

    def report(self) -> None:
        """Bring words and tables up to date."""
        raise NotImplementedError

    def play(self) -> None:
        """Let time pass."""
        self.playing = True
        self.wake()

    def pause(self) -> None:
        """Stop the clock; controls still act."""
        self.playing = False
        self.wake()

    def close(self) -> None:
        """Stop the loop and free all that the page and the kernel hold of it."""
        self.stop()
        if self._living.get(self._slot) is self:
            del self._living[self._slot]
        if getattr(self, "comm", None) is None:
            return
        self.scene.close()
        self.strips.close()
        self.status.close()
        super().close()

    def stop(self) -> None:
        """End the loop."""
        self.playing = False
        if self._task is not None:
            self._task.cancel()

    def _repr_mimebundle_(self, **kwargs: Any) -> Any:
        """The live widget, and beside it a still for places without a kernel."""
        session = self.session
        bundle = super()._repr_mimebundle_(**kwargs)
        still = portrait(
            session.tree, session.effectors, session.theta[session.method], session.targets
        )
        return {**bundle, "image/png": still, "text/plain": self.words()}

    def words(self) -> str:
        """What the picture shows, for those who cannot see it."""
        session = self.session
        far = ", ".join(
            f"{name} {100 * d:.1f} cm"
            for name, d in zip(session.effectors.names, session.error, strict=True)
        )
        motion = "by hand" if session.by_hand else session.gait.name
        wounded = "wounded, " if session.gait.wound else ""
        return f"A human, {wounded}{motion} by {session.method}. From its target: {far}."

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
        self.status.wrong = f"That did not work: {error or type(error).__name__}"

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
            while self.playing and not self.scene.driver.alone:
                due = max(due + session.dt, monotonic() - session.dt)  # late: go on, do not race
                await asyncio.sleep(max(due - monotonic(), 0.001))
                if not self.playing:
                    break
                session.tick()
                if self.scene.driver.ready:
                    self.draw()
                if session.ticks % EVERY == 0:
                    self.strips.send_new()
                if session.ticks % WORDS_EVERY == 0:
                    self.report()
            self.strips.send_new()
            self.report()
        except Exception as error:  # a student's own solver, most likely
            self.pause()
            self.tell(error)
