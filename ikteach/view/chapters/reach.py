"""The human motion simulator of chapter 10: a cursor to move, and a figure that reaches for it."""

from dataclasses import replace
from math import degrees, inf, radians
from typing import Any

import numpy as np
import pandas as pd

from ikteach.arrays import Array
from ikteach.body import Effectors
from ikteach.checks import count
from ikteach.markup import Markup
from ikteach.motion.reach.reaching import Reach, Reaching
from ikteach.study import standings
from ikteach.view.live.live import Live
from ikteach.view.live.panel import Does, Panel, button, choice, dropdown, slider
from ikteach.view.stage.colours import RED
from ikteach.view.stage.forms import Label
from ikteach.view.stage.stage import CAMERAS
from ikteach.view.webgl import objects
from ikteach.view.webgl.scene import Scene
from ikteach.view.webgl.targets import Targets
from ikteach.view.widgets import doors
from ikteach.view.widgets.layout import Arranged
from ikteach.view.widgets.prose import Prose, table

WHITE = "#ffffff"


class CursorScene(Scene):
    """A scene with one target, the cursor.

    It is white with a word over it, or red with another.
    """

    def __init__(self, session: Reaching, **options: Any) -> None:
        super().__init__(session.tree, _cursor(session), dark=True, slot=None, **options)
        unit = self.stage.unit
        self._words = [
            word
            for words, colour in (("within reach", WHITE), ("out of reach", RED))
            for word in objects.labels([Label((0, 0.12 * unit, 0), words, colour, 0.08 * unit)])
        ]
        (self._ball,) = self.targets
        self._ball.children = self._words
        self._within: bool | None = None

    def point(self, session: Reaching, change: int) -> None:
        """Draw the session: the pose, the cursor and the rod.

        The rod comes from the hand that reaches for the cursor.
        """
        self.effectors = self.stage.effectors = _cursor(session)
        if session.within != self._within:  # few messages: only when the colour changes
            self._within = session.within
            self._ball.material.color = WHITE if self._within else RED
            for sprite, shown in zip(self._words, (self._within, not self._within), strict=True):
                sprite.visible = shown
        self.show(session.theta, session.cursor[None], change=change)


def _cursor(session: Reaching) -> Effectors:
    """Give the hand that reaches the name of its target."""
    return replace(session.effectors, names=("cursor",))


class Simulator(Live):
    """A figure that reaches for the cursor by every way.

    All do so at once; one of them is shown.

    Display it in a notebook. `session`, a `Reach` or a `PlanarReach`, holds all state and may be
    changed from cells while the figure moves. The cursor is moved in the picture with mouse or
    keys, or with sliders. The loop rests while nothing would move.
    """

    REPORT_EVERY = 10
    scene: CursorScene

    def __init__(
        self, session: Reaching | None = None, *, slot: str | None = "reach", **options: Any
    ) -> None:
        if session is None:
            session = Reach(**options)
        elif options:
            raise TypeError(f"{', '.join(options)}: options are for a session that is made here")
        doors.has("session", session, "a Reach or a PlanarReach", "cursor", "standing", "room")
        count("parts", session.parts)
        if session.max_step is not None:
            doors.within("max_step", session.max_step, 0, inf)
        super().__init__(session, CursorScene(session), slot)
        self._known = session.cursor  # the one that the handles and sliders know of
        low, high = session.room[:1], session.room[1:]
        self.targets = Targets(self.scene, session.cursor[None], low=low, high=high, slot=None)
        self.targets.on_change(self.guarded(lambda _, place: self._put(place)))
        self._cursor, self._table = Prose(), Prose()
        self.panel = self._panel()
        self.controls = self.panel.controls
        self.choosing = self.controls["method"]
        self.watch(self.scene)
        beside = [self.panel.widget, self.targets]
        self.children = [Arranged([self.scene.widget], beside), self._table, self.status]
        self.report()

    @property
    def settled(self) -> bool:
        """Whether nothing would move any more."""
        return bool(self.session.settled)

    @property
    def words(self) -> str:
        """The picture in words, for people who cannot see it."""
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

    def _panel(self) -> Panel:
        session, narrow = self.session, {"width": "400px", "label_width": "150px"}
        cap = degrees(session.max_step) if session.max_step is not None else 45.0
        methods = choice("Method", list(session.ways), session.method, label_width="60px")
        parts = slider("parts of the error", session.parts, 1, 30, 1, **narrow)
        caps = slider("largest step [° per tick]", cap, 1.0, 45.0, 1.0, **narrow)
        sides = ["plane"] if self.scene.stage.planar else list(CAMERAS)
        clock = {
            "playing": self.play_button,
            "step": Does(button("Step"), self.step),
            "reset": Does(button("Reset"), session.reset),
        }
        return Panel(
            "Simulator",
            [
                self._cursor,
                clock,
                {"method": Does(methods, session.show)},
                {"parts": Does(parts, lambda n: setattr(session, "parts", n))},
                {"max_step": Does(caps, lambda d: setattr(session, "max_step", radians(d)))},
                {"view": Does(dropdown("View", sides), self.scene.look_from)},
            ],
            guard=self.guarded,
        )

    def _put(self, place: Array) -> None:
        if not np.allclose(place, self.session.cursor, atol=1e-9):
            self.session.put(place)
        self._known = self.session.cursor

    def draw(self) -> None:
        """Draw the session's state in the scene."""
        session = self.session
        if session.cursor is not self._known:  # it was put there by a cell, or by a reset
            self._known = session.cursor
            self.targets.follow(session.cursor[None])
        self.scene.point(session, self._changes)

    def report(self) -> None:
        """Bring words and table up to date."""
        session = self.session
        mark = "○ white" if session.within else "● red"
        colour = WHITE if session.within else RED
        self.scene.driver.description = self.words
        self._cursor.value = Markup(
            '<div role="status" class="ikteach-cursor">cursor <b style="background:{};color:#000;'
            'padding:1px 8px;border:1px solid #444;border-radius:8px">{}</b> {}</div>'
        ).format(colour, mark, session.words)
        self._table.value = _table(session)


def _table(session: Reaching) -> Markup:
    frame = standings(session).rename(index={session.method: f"{session.method} (shown)"})
    frame["ticks"] = ["–" if pd.isna(ticks) else ticks for ticks in frame["ticks"]]
    return table(frame, "{:.3g}")
