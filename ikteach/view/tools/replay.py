"""A finished run to be moved through: play it, scrub it, or point at a row or at the error plot."""

import asyncio
from time import monotonic
from typing import Any, Protocol

import ipywidgets as widgets
import numpy as np

from ikteach.arrays import Array, Index
from ikteach.body import Effectors, Tree
from ikteach.motion.live.log import Log
from ikteach.view.raster.film import Film, Shot
from ikteach.view.stage.lengths import misses
from ikteach.view.tools.runs import error_picture, error_rows, error_words, places, units_of
from ikteach.view.widgets import doors
from ikteach.view.widgets.actor import attempt, message_of
from ikteach.view.widgets.cell import REFRESH, Cell
from ikteach.view.widgets.curve import Curve
from ikteach.view.widgets.picture import Picture, as_png
from ikteach.view.widgets.table import Rows

AS_SHOWN = "as it was shown"


class Shows(Protocol):
    """A drawer of poses: `scene.Scene`, or `Sketch` where there is no WebGL."""

    def show(self, theta: Array, targets: Array, *, floor: float, advance: float = 0.0) -> None:
        """Draw the pose θ (n,) and targets (k, 3)."""


class Sketch:
    """A scene drawn in the kernel; `widget` is to be displayed."""

    def __init__(self, tree: Tree, effectors: Effectors) -> None:
        self._film = Film(tree, effectors, size=(480, 400))
        self.widget = Picture(alt="A figure; the line under it says what it does.")

    def show(self, theta: Array, targets: Array, *, floor: float, advance: float = 0.0) -> None:
        """Draw the pose θ (n,) and targets (k, 3)."""
        self.widget.png = as_png(self._film.picture(Shot(theta, targets, floor, advance, "")))


class Replay(Cell):
    """A scrubber over a run.

    It has play and pause, a slider by tick, an error plot and a table.

    run    a `Log`: of a session (`session.log()`), or loaded from its files
    scene  draws the poses; if there is none, a `Sketch` in this widget does

    Everything is reached with the keyboard: the slider, the plot (left and right) and the rows of
    the table (up and down) all mean the same tick, `at`.
    """

    _task: asyncio.Task[None] | None = None

    def __init__(
        self, run: Log, scene: Shows | None = None, *, slot: str | None = "replay"
    ) -> None:
        doors.a(Log, "run", run)
        if scene is not None:
            doors.has("scene", scene, "a Scene, or something else with `show`", "show")
        if not len(run):
            raise ValueError("there is nothing to replay: no tick is in the log yet")
        super().__init__(slot)
        self.run, self.at, self._wanted = run, 0, 0
        sketch = Sketch(run.tree, run.effectors) if scene is None else None
        self.scene: Any = sketch or scene
        wide = widgets.Layout(width="100%", max_width="720px")
        self.playing = widgets.ToggleButton(value=False, description="Play")
        self.slider = widgets.IntSlider(
            value=0, min=0, max=len(run) - 1, description="Tick", readout=False, layout=wide
        )
        self.method = widgets.Dropdown(options=[AS_SHOWN, *run.methods], description="Method")
        self.curve, self.rows = Curve(), Rows()
        for one, trait in (self.slider, "value"), (self.curve, "chosen"), (self.rows, "chosen"):
            one.observe(lambda change: self._asked(change["new"]), trait)
        self.playing.observe(self.guarded(lambda _: self._toggle()), "value")
        self.method.observe(self.guarded(lambda _: self._method_changed()), "value")
        self.children = [
            *([] if sketch is None else [sketch.widget]),
            widgets.HBox([self.playing, self.slider], layout=wide),
            self.status,
            self.method,
            self.curve,
            self.rows,
        ]
        self._method_changed()

    def go(self, tick: int) -> None:
        """Show the pose of that row of the log.

        Rows are 0 to T − 1; IndexError if there is none.
        """
        if not 0 <= tick < len(self.run):
            raise IndexError(f"the log has rows 0 to {len(self.run) - 1}, not {tick}")
        if tick != self.at or tick != self._wanted:
            self._wanted = tick
            self.guarded(self._arrive)()

    def end(self) -> None:
        """Stop playing."""
        if self._task is not None:
            self._task.cancel()

    def _asked(self, tick: int) -> None:
        """Slider, plot or table were moved, by a person or by `_agree`."""
        attempt(lambda: self.go(tick), self.status.fail)

    def _arrive(self) -> None:
        if self.at != self._wanted:
            self.at = self._wanted
            self._draw()
            self._agree()

    def _method_changed(self) -> None:
        run, method = self.run, None if self.method.value == AS_SHOWN else self.method.value
        columns = run.shown.astype(np.intp)
        if method is not None:
            columns = np.full(len(run), run.methods.index(method))
        self._columns: Index = columns
        error = run.error[np.arange(len(run)), columns]  # (T, k)
        with self.curve.hold_sync():
            self.curve.png, self.curve.span = error_picture(run, error)
            self.curve.alt = error_words(run, error)
            self.curve.places = places(run.clock)
            self.curve.labels = [
                f"tick {tick}, {at:.2f} s" for tick, at in zip(run.tick, run.clock, strict=True)
            ]
        with self.rows.hold_sync():
            each = zip(run.effectors.names, units_of(run), strict=True)
            far = [f"{name} [{unit.name}]" for name, unit in each]
            self.rows.header = ["tick", "clock [s]", "method", *far, "what changed"]
            self.rows.rows = error_rows(run, columns, error)
        self._draw()
        self._agree()

    def _toggle(self) -> None:
        self.playing.description = "Pause" if self.playing.value else "Play"
        if not self.playing.value:
            self._agree()
        elif self._act.loop is None:
            self.status.fail("It plays in a notebook only; the slider moves it everywhere.")
        elif self._task is None or self._task.done():
            self._task = self._act.loop.create_task(self._play())

    async def _play(self) -> None:
        try:
            await self._go_on()
        except Exception as error:  # of whoever draws
            words = message_of(error)
            self.playing.value = False
            self._act(lambda: self.status.fail(words))  # after what the button says about itself

    async def _go_on(self) -> None:
        run, last = self.run, monotonic()
        if self.at == len(run) - 1:
            self._wanted = self.at = 0
        came = -1  # the tick that we came to last; another one means that somebody has moved it
        while self.playing.value and self.at < len(run) - 1:
            if self.at != came:
                began = monotonic() - run.clock[self.at]
            due = int(np.searchsorted(run.clock, monotonic() - began, side="right")) - 1
            if due > self.at or came != self.at:
                self._wanted = self.at = came = max(due, self.at)
                if getattr(getattr(self.scene, "driver", None), "ready", True):
                    self._draw()
            if monotonic() - last > REFRESH:
                self._agree(aloud=False)
                last = monotonic()
            await asyncio.sleep(run.dt / 2)
        self._draw()
        self.playing.value = False
        self._agree()

    def _draw(self) -> None:
        run, t = self.run, self.at
        self.scene.show(
            run.theta[t, self._columns[t]],
            run.targets[t],
            floor=float(run.floor[t]),
            advance=float(run.advance[t]),
        )

    def _agree(self, *, aloud: bool = True) -> None:
        """Have slider, plot and table say the same; words are for when it stands still."""
        self.slider.value = self.curve.chosen = self.rows.chosen = self.at
        if aloud:
            run, t, i = self.run, self.at, self._columns[self.at]
            error = misses(run.effectors, run.error[t, i])
            each = zip(run.effectors.names, units_of(run), error, strict=True)
            far = ", ".join(f"{name} {unit(d)}" for name, unit, d in each)
            self.status.say(
                f"Tick {run.tick[t]}, {run.clock[t]:.2f} s, by {run.methods[i]}. "
                f"From its target: {far}."
            )
