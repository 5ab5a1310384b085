"""A figure that runs: time passes in its session, and the scene follows."""

import asyncio
from collections.abc import Callable
from functools import partial
from time import monotonic
from typing import Any

from ikteach.arrays import Array
from ikteach.motion.live.session import Session
from ikteach.motion.paths.skeleton import bones_at
from ikteach.view.live.controls import parts_of
from ikteach.view.live.link import StateLink
from ikteach.view.live.panel import Act, Panel, play_button, press
from ikteach.view.live.preset import link_of
from ikteach.view.live.strips import EVERY, Strips
from ikteach.view.webgl.scene import Scene
from ikteach.view.widgets.actor import message_of
from ikteach.view.widgets.cell import Cell
from ikteach.view.widgets.picture import Still

PACES = ("1×", "½×", "¼×")  # how fast time passes: each half as fast as the one before


def recorded_bones(session: Session) -> Array | None:
    """Return the bones of whom a session's motion was recorded from.

    They are (b, 2, 3) [m]; None if it is no recording, or the targets are set by hand.
    """
    if session.by_hand:
        return None
    return bones_at(session.gait, session.phase, session.effectors, session.targets)


class Live(Cell):
    """A session that is played; an abstract class.

    A subclass draws, reports and says it in words.

    session      has `tick()`, `ticks` and `dt`, and holds all state
    scene        follows it
    strips       the curves that run along with it, if there are any
    play_button  plays and pauses

    choosing     the control that chooses the method, if there is one

    The loop runs only while it plays and somebody looks. Without a notebook there is none: nothing
    moves by itself, and `step()` lets a tick pass.
    """

    REPORT_EVERY = 30  # ticks
    SELDOM = 3  # times as rarely come curves and words, where the machine is too slow for all
    choosing: Any = None
    whole: Cell | None = None  # the figure of which it is a part
    _task: asyncio.Task[None] | None = None

    def __init__(
        self, session: Any, scene: Scene, slot: str | None, strips: Strips | None = None
    ) -> None:
        super().__init__(slot)
        self.session, self.strips = session, strips
        self.playing = True
        self.play_button = play_button()
        self.play_button.observe(self._toggled, "value")
        self._changes, self._slow, self._rested = 0, 0, False
        self.watch(scene)

    def watch(self, scene: Scene) -> None:
        """Have this scene follow the session from now on."""
        self.scene, self.note = scene, scene.note
        scene.driver.on_page, scene.driver.on_calm = self._seen, self._rest
        scene.driver.observe(self._split, "panes")
        scene.driver.pace, scene.driver.measures = PACES[self._slow], len(scene.stage) == 1
        scene.offer({key: (words, self.guarded(act)) for key, (words, act) in self.acts().items()})

    def acts(self) -> dict[str, tuple[str, Callable[[], object]]]:
        """Give what keys at the picture do: {key: (words, action)}.

        The actions act as a person does who presses a button.
        """
        methods = [] if self.choosing is None else [str(one) for one in self.choosing.options]
        return {
            " ": ("plays and pauses", lambda: press(self.play_button, not self.play_button.value)),
            ".": ("lets one tick pass", self.step),
            "l": ("makes a link to this state", lambda: (self.whole or self).show_link()),
            "s": ("slows time down to a half, to a quarter, and no more", self.slow_down),
            **{
                str(i): (f"shows {name}", partial(press, self.choosing, name))
                for i, name in enumerate(methods[:9], start=1)
            },
        }

    def begun(self) -> None:
        """Note the values with which its controls begin."""
        for part in parts_of(self):
            if isinstance(part, Panel):
                part.first = part.values

    def make_link(self) -> StateLink:
        """Make the widget that links to its state."""
        return StateLink(lambda: link_of(self), self.guarded)

    def slow_down(self) -> None:
        """Let time pass at the next of `PACES`."""
        self.set_pace((self._slow + 1) % len(PACES))

    def set_pace(self, slow: int) -> None:
        """Let time pass at one of `PACES`."""
        self._slow, self.scene.driver.pace = slow, PACES[slow]

    def draw(self) -> None:
        """Draw the session's state in the scene."""
        raise NotImplementedError

    def report(self) -> None:
        """Bring words and tables up to date."""
        raise NotImplementedError

    @property
    def words(self) -> str:
        """The picture in words, for people who cannot see it."""
        raise NotImplementedError

    @property
    def settled(self) -> bool:
        """Whether nothing would move any more."""
        return False

    def step(self) -> None:
        """Stop the clock, and let one tick pass."""
        self.pause()
        self.session.tick()

    def play(self) -> None:
        """Let time pass."""
        self._set_playing(True)

    def pause(self) -> None:
        """Stop the clock; controls still act."""
        self._set_playing(False)

    def say_playing(self, on: bool) -> None:
        """Have the button say whether it plays."""
        self.play_button.value = on

    def stop(self) -> None:
        """End the loop."""
        self.playing = False
        if self._task is not None:
            self._task.cancel()

    def end(self) -> None:
        """End the loop, for good."""
        self._act.loop = None
        self.stop()

    def still(self) -> Still:
        """Draw it for a place without a kernel."""
        self.draw()
        return Still(self.scene.still().png, self.words)

    def acted(self) -> None:
        """Draw the change that a control has made."""
        self._changes += 1
        self.wake()

    def _acting(self, act: Act) -> Act:
        """Guard an action that changes the session, after which all controls agree with it."""

        def acting(*value: Any) -> None:
            act(*value)
            self._agree()

        return self.guarded(acting)

    def _agree(self) -> None:
        """Set controls to what the session does, without acting."""

    def wake(self) -> None:
        """Have the loop run if there is something to do.

        May be called from any thread.
        """
        if self._act.loop is not None and not self._act.loop.is_closed():
            self._act.loop.call_soon_threadsafe(self._start)

    def _set_playing(self, on: bool) -> None:
        self.playing = on
        self.say_playing(on)
        self.wake()

    def _rest(self) -> None:
        """Stand still at first, for a page whose reader wants nothing to move by itself."""
        if not self._rested:
            self._rested = True
            self._set_playing(False)

    def _split(self, _: Any) -> None:
        """Have controls agree with a key that showed more views, or fewer."""
        self.acted()

    def _toggled(self, change: Any) -> None:
        if change["new"] != self.playing:  # by a person, and not by `say_playing`
            self.guarded(self.play if change["new"] else self.pause)()

    def _seen(self, new: bool) -> None:
        """Go on for a page that is new or has drawn, should the loop have given up on it."""
        if new or self.playing:
            self.wake()

    def _start(self) -> None:
        if self._task is None or self._task.done():
            self._task = asyncio.get_running_loop().create_task(self._run())

    async def _run(self) -> None:
        try:
            self.draw()
            await self._go_on()
            self.draw()
            if self.strips is not None:
                self.strips.send_new()
            self.report()
        except Exception as error:  # a student's own solver, most likely
            self.pause()
            self.status.fail(message_of(error))

    async def _go_on(self) -> None:
        """Let time pass, tick by tick, while it plays and somebody looks."""
        due, session = monotonic(), self.session
        while self.playing and not (self.settled or self.scene.driver.unwatched):
            tick = session.dt * 2**self._slow
            due = max(due + tick, monotonic() - tick)  # late: go on, do not race
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
