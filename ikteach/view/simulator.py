"""The human motion simulator of chapter 10: a cursor to move, and a figure that reaches for it."""

import asyncio
import html
from collections import deque
from collections.abc import Callable
from dataclasses import replace
from math import degrees, radians
from time import monotonic
from typing import Any, ClassVar

import ipywidgets as widgets
import numpy as np
import pandas as pd

from ikteach.arrays import Array
from ikteach.body import Effectors
from ikteach.motion.planar import PlanarReach
from ikteach.motion.reach import Reach
from ikteach.study import standings
from ikteach.view import solids
from ikteach.view.bench import alert, choice, running_loop, slider
from ikteach.view.scene import CAMERAS, Scene
from ikteach.view.skin import RED
from ikteach.view.targets import Targets

TABLE_EVERY = 10  # ticks
WHITE = "#ffffff"


class CursorScene(Scene):
    """A scene with one target, the cursor: white with a word over it, or red with another."""

    def __init__(self, session: Reach | PlanarReach, **options: Any) -> None:
        super().__init__(session.tree, _cursor(session), dark=True, **options)
        unit = self.stage.unit
        self._words = [
            solids.label(words, colour, 0.08 * unit, [0, 0.12 * unit, 0])
            for words, colour in (("within reach", WHITE), ("out of reach", RED))
        ]
        (self._ball,) = self.targets[0].children
        self.targets[0].children = [self._ball, *self._words]
        self._within: bool | None = None

    def point(self, session: Reach | PlanarReach, change: int) -> None:
        """Draw the session: the pose, the cursor, and the rod from the hand that reaches for it."""
        self.effectors = self.stage.effectors = _cursor(session)
        if session.within != self._within:  # few messages: only when the colour changes
            self._within = session.within
            self._ball.material.color = WHITE if self._within else RED
            for sprite, shown in zip(self._words, (self._within, not self._within), strict=True):
                sprite.visible = shown
        self.show(session.theta, session.cursor[None], change=change)


def _cursor(session: Reach | PlanarReach) -> Effectors:
    """The hand that reaches, under the name that its target is to have."""
    return replace(session.effectors, names=("cursor",))


class Simulator(widgets.VBox):  # type: ignore[misc]
    """A figure that reaches for the cursor by every way at once; one of them is shown.

    Display it in a notebook. `session`, a `Reach` or a `PlanarReach`, holds all state and may be
    changed from cells while the figure moves. The cursor is moved in the picture with mouse or
    keys, or with sliders. Only one simulator of a `slot` lives at a time. The loop that moves it
    runs while it plays, something still moves and somebody looks.
    """

    _living: ClassVar[dict[str, "Simulator"]] = {}

    def __init__(
        self, session: Reach | PlanarReach | None = None, *, slot: str = "reach", **options: Any
    ) -> None:
        if slot in self._living:
            self._living.pop(slot).close()
        self.session = session if session is not None else Reach(**options)
        self.playing, self._quiet = True, False
        self._changes, self._slot = 0, slot
        self._known = self.session.cursor  # the one that the handles and sliders know of
        self._asked: deque[Callable[[], None]] = deque()
        self._task: asyncio.Task[None] | None = None
        self._loop = running_loop()
        self.scene = CursorScene(self.session)
        self.targets = Targets(
            self.scene, self.session.cursor[None],
            low=self.session.room[:1], high=self.session.room[1:],
        )  # fmt: skip
        self.targets.on_change(lambda _, place: self._ask(lambda: self._put(place)))
        self.scene.driver.on_sign = self._seen
        self._status, self._table, self._alert = widgets.HTML(), widgets.HTML(), widgets.HTML()
        self.controls = self._make_controls()
        panel = widgets.VBox(
            [
                self._status,
                widgets.HBox([self.controls[name] for name in ("playing", "step", "reset")]),
                self.controls["method"],
                *(self.controls[name] for name in ("parts", "max_step", "view")),
            ],
            layout=widgets.Layout(flex="1 1 400px", min_width="360px"),
        )
        self.scene.widget.layout = widgets.Layout(flex="0 0 auto", width="552px")
        beside = widgets.HBox(
            [self.scene.widget, panel], layout=widgets.Layout(flex_flow="row wrap")
        )
        super().__init__([beside, self.targets, self._alert, self._table])
        self._living[slot] = self
        self._report()

    def play(self) -> None:
        """Let time pass."""
        self.controls["playing"].value = True

    def pause(self) -> None:
        """Stop the clock; controls still act."""
        self.controls["playing"].value = False

    def close(self) -> None:
        """Stop the loop and free all that the page and the kernel hold of it."""
        self.playing = False
        if self._task is not None:
            self._task.cancel()
        if self._living.get(self._slot) is self:
            del self._living[self._slot]
        if getattr(self, "comm", None) is None:
            return
        self.targets.close()
        self.scene.close()
        for widget in (*self.controls.values(), self._status, self._table, self._alert):
            widget.close()
        super().close()

    def _repr_mimebundle_(self, **kwargs: Any) -> Any:
        """The live widget, and beside it a still for places without a kernel."""
        bundle = super()._repr_mimebundle_(**kwargs)
        self.scene.point(self.session, self._changes)
        return {**bundle, "image/png": self.scene.still().png, "text/plain": self.words}

    @property
    def words(self) -> str:
        """What is to be seen, for those who cannot see it."""
        session = self.session
        x, y, z = session.cursor
        return (
            f"A figure reaches for a cursor at x {x:.2f}, y {y:.2f}, z {z:.2f} m by "
            f"{session.method}. The cursor is {self._colour}: {session.words}. "
            f"The hand: {session.standing[session.method].words}."
        )

    @property
    def _colour(self) -> str:
        return "white" if self.session.within else "red"

    def _make_controls(self) -> dict[str, Any]:
        session = self.session
        cap = degrees(session.max_step) if session.max_step is not None else 45.0
        made = {
            "playing": widgets.ToggleButton(value=True, description="Pause"),
            "step": widgets.Button(description="Step"),
            "reset": widgets.Button(description="Reset"),
            "method": choice("Method", list(session.ways), session.method),
            "parts": _narrow("n, parts of the error", session.parts, 1, 30, 1),
            "max_step": _narrow("largest step [° a tick]", cap, 1.0, 45.0, 1.0),
            "view": widgets.Dropdown(options=self._sides(), description="View"),
        }
        made["method"].style.description_width = "60px"
        acts: dict[str, Callable[[Any], None]] = {
            "playing": self._play,
            "method": session.show,
            "parts": lambda n: setattr(session, "parts", n),
            "max_step": lambda d: setattr(session, "max_step", radians(d)),
            "view": self.scene.look_from,
        }
        for name, act in acts.items():
            made[name].observe(
                lambda change, act=act: self._ask(lambda: act(change["new"])), "value"
            )
        made["step"].on_click(lambda _: self._ask(self._step))
        made["reset"].on_click(lambda _: self._ask(session.reset))
        return made

    def _sides(self) -> list[str]:
        return ["plane"] if self.scene.stage.planar else list(CAMERAS)

    # What was asked for. Callbacks may come on another thread: they store, and the loop acts.

    def _ask(self, act: Callable[[], None]) -> None:
        if self._quiet:
            return
        self._asked.append(act)
        if self._loop is None or self._loop.is_closed():
            self._answer()
        else:
            self._wake()

    def _answer(self) -> None:
        """Do what was asked for; what goes wrong is told, once, and the session goes on."""
        while self._asked:
            try:
                self._asked.popleft()()
            except Exception as error:
                self._say(alert(error))
            else:
                self._say("")
            self._changes += 1

    def _play(self, on: bool) -> None:
        self.playing = on
        self.controls["playing"].description = "Pause" if on else "Play"

    def _put(self, place: Array) -> None:
        if not np.allclose(place, self.session.cursor, atol=1e-9):
            self.session.put(place)
        self._known = self.session.cursor

    def _stop(self) -> None:
        """Pause, and have the button show it without its asking for anything."""
        self._quiet = True
        self.pause()
        self._quiet = False
        self._play(False)

    def _step(self) -> None:
        self._stop()
        self.session.tick()

    def _say(self, words: str) -> None:
        if self._alert.value != words:
            self._alert.value = words

    # The loop.

    def _wake(self) -> None:
        """See to it that the loop runs if there is something to do; from any thread."""
        if self._loop is not None and not self._loop.is_closed():
            self._loop.call_soon_threadsafe(self._start)

    def _seen(self, new: bool) -> None:
        """A page is new, or has drawn: then the loop goes on, should it have given up on it."""
        if new or self.playing:
            self._wake()

    def _start(self) -> None:
        if self._task is None or self._task.done():
            self._task = asyncio.get_running_loop().create_task(self._run())

    async def _run(self) -> None:
        due, session = monotonic(), self.session
        try:
            self._answer()
            self._draw()
            self._report()
            while self._busy:
                due = max(due + session.dt, monotonic() - session.dt)  # late: go on, do not race
                await asyncio.sleep(max(due - monotonic(), 0.001))
                self._answer()
                if self.playing:
                    session.tick()
                if self.scene.driver.ready:
                    self._draw()
                if session.ticks % TABLE_EVERY == 0:
                    self._report()
            self._draw()
            self._report()
        except Exception as error:  # a student's own solver, most likely
            self._stop()
            self._say(alert(error))

    @property
    def _busy(self) -> bool:
        moving = self.playing and not self.session.settled and not self.scene.driver.alone
        return bool(self._asked) or moving

    def _draw(self) -> None:
        session = self.session
        if session.cursor is not self._known:  # it was put there by a cell, or by a reset
            self._known = session.cursor
            self.targets.move(0, session.cursor)
        self.scene.point(session, self._changes)

    def _report(self) -> None:
        words, session = self.words, self.session
        if self.scene.driver.description != words:
            self.scene.driver.description = words
        mark = "○ white" if session.within else "● red"
        style = f"background:{WHITE if session.within else RED};color:#000;padding:1px 8px;"
        status = (
            '<div role="status" class="ikteach-cursor">cursor '
            f'<b style="{style}border:1px solid #444;border-radius:8px">{mark}</b> '
            f"{html.escape(session.words)}</div>"
        )
        table = _table(session)
        if self._status.value != status:
            self._status.value = status
        if self._table.value != table:
            self._table.value = table


def _narrow(label: str, value: float, low: float, high: float, step: float) -> Any:
    """A slider that fits beside the scene."""
    made = slider(label, value, low, high, step)
    made.layout.width, made.style.description_width = "400px", "150px"
    return made


def _table(session: Reach | PlanarReach) -> str:
    table = standings(session).rename(index={session.method: f"{session.method} (shown)"})
    table["ticks"] = ["–" if pd.isna(ticks) else ticks for ticks in table["ticks"]]
    return table.to_html(
        float_format="{:.3g}".format, na_rep="–", border=0, classes="ikteach-table"
    )
