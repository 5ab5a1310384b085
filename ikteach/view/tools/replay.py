"""A finished run to be moved through: play it, scrub it, or point at a row or at the error plot."""

import asyncio
import io
from collections.abc import Mapping
from time import monotonic
from typing import Any, Protocol

import ipywidgets as widgets
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from PIL import Image

from ikteach.arrays import Array, Index
from ikteach.body import Effectors, Tree
from ikteach.markup import as_label
from ikteach.motion.live.log import Log
from ikteach.view.plots import LEAST, STYLES
from ikteach.view.raster.film import Film, Shot
from ikteach.view.stage.colours import effector_colour
from ikteach.view.stage.lengths import Lengths, decade
from ikteach.view.widgets import doors
from ikteach.view.widgets.actor import Actor, in_words
from ikteach.view.widgets.closing import Living
from ikteach.view.widgets.picture import Picture
from ikteach.view.widgets.pointing import Curve, Rows
from ikteach.view.widgets.status import Status

AS_SHOWN = "as it was shown"
OFTEN = 0.2  # [s] between two moves of slider, plot and table while it plays


class Shows(Protocol):
    """What draws poses: `scene.Scene`, or `Sketch` where there is no WebGL."""

    def show(self, theta: Array, targets: Array, *, floor: float, advance: float = 0.0) -> None:
        """Draw the pose θ (n,) and targets (k, 3)."""


class Sketch:
    """A scene drawn in the kernel; `widget` is what to display."""

    def __init__(
        self, tree: Tree, effectors: Effectors, *, size: tuple[int, int] = (480, 400),
        side: str | None = None,
    ) -> None:  # fmt: skip
        self._film = Film(tree, effectors, size=size, side=side)
        self.widget = Picture(alt="A figure; the line under it says what it does.")

    def show(self, theta: Array, targets: Array, *, floor: float, advance: float = 0.0) -> None:
        """Draw the pose θ (n,) and targets (k, 3)."""
        pixels = self._film.picture(Shot(theta, targets, floor, advance, ""))
        out = io.BytesIO()
        Image.fromarray(pixels).save(out, "PNG", compress_level=1)
        self.widget.png = out.getvalue()


class Replay(Living, widgets.VBox):  # type: ignore[misc]
    """A scrubber over a run: play and pause, a slider by tick, an error plot and a table.

    run    a `Log`: of a session (`session.log()`), or loaded from its files
    scene  what is told the poses; if there is none, a `Sketch` in this widget is
    slot   only one of a slot lives at a time: to run a cell again closes the older one

    Everything is reached with the keyboard: the slider, the plot (left and right) and the rows of
    the table (up and down) all mean the same tick, `at`.
    """

    def __init__(
        self, run: Log, scene: Shows | None = None, *, slot: str | None = "replay"
    ) -> None:
        doors.a(Log, "run", run)
        if scene is not None:
            doors.has("scene", scene, "a Scene, or something else with `show`", "show")
        if not len(run):
            raise ValueError("there is nothing to replay: no tick is in the log yet")
        self.run, self.at, self.slot = run, 0, slot
        self._sketch = Sketch(run.tree, run.effectors) if scene is None else None
        self.scene: Any = self._sketch or scene
        self._wanted = 0
        self._task: asyncio.Task[None] | None = None
        self._act = Actor()
        wide = widgets.Layout(width="100%", max_width="720px")
        self.playing = widgets.ToggleButton(value=False, description="Play")
        self.slider = widgets.IntSlider(
            value=0, min=0, max=len(run) - 1, description="Tick", readout=False, layout=wide
        )
        self.method = widgets.Dropdown(options=[AS_SHOWN, *run.methods], description="Method")
        self.curve, self.rows = Curve(), Rows()
        self.words = Status()
        for one, trait in (self.slider, "value"), (self.curve, "chosen"), (self.rows, "chosen"):
            one.observe(lambda change: self._asked(change["new"]), trait)
        self.playing.observe(lambda _: self._act(self._toggle, self.words.fail), "value")
        self.method.observe(lambda _: self._act(self._method_changed, self.words.fail), "value")
        pictures = [] if self._sketch is None else [self._sketch.widget]
        super().__init__(
            [
                *pictures,
                widgets.HBox([self.playing, self.slider], layout=wide),
                self.words,
                self.method,
                self.curve,
                self.rows,
            ]
        )
        self._method_changed()

    def go(self, tick: int) -> None:
        """Show the pose of that row of the log, 0 to T − 1; IndexError if there is none."""
        if not 0 <= tick < len(self.run):
            raise IndexError(f"the log has rows 0 to {len(self.run) - 1}, not {tick}")
        if tick != self.at or tick != self._wanted:
            self._wanted = tick
            self._act(self._arrive, self.words.fail)

    def end(self) -> None:
        """Stop playing."""
        if self._task is not None:
            self._task.cancel()

    def _asked(self, tick: int) -> None:
        """Slider, plot or table were moved, by a person or by `_agree`."""
        try:
            self.go(tick)
        except IndexError as error:
            self.words.fail(in_words(error))

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
            self.curve.places = _places(run.clock)
            self.curve.labels = [
                f"tick {tick}, {at:.2f} s" for tick, at in zip(run.tick, run.clock, strict=True)
            ]
        with self.rows.hold_sync():
            far = [f"{name} [{_length(run).name}]" for name in run.effectors.names]
            self.rows.header = ["tick", "clock [s]", "method", *far, "what changed"]
            self.rows.rows = _table(run, columns, error)
        self._draw()
        self._agree()

    def _toggle(self) -> None:
        self.playing.description = "Pause" if self.playing.value else "Play"
        if not self.playing.value:
            self._agree()
        elif self._act.loop is None:
            self.words.fail("It plays in a notebook only; the slider moves it everywhere.")
        elif self._task is None or self._task.done():
            self._task = self._act.loop.create_task(self._play())

    async def _play(self) -> None:
        try:
            await self._go_on()
        except Exception as error:  # of whoever draws
            told = in_words(error)
            self.playing.value = False
            self._act(lambda: self.words.fail(told))  # after what the button says about itself

    async def _go_on(self) -> None:
        run, told = self.run, monotonic()
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
            if monotonic() - told > OFTEN:
                self._agree(aloud=False)
                told = monotonic()
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
            length = _length(run)
            far = ", ".join(
                f"{name} {length(d)}"
                for name, d in zip(run.effectors.names, run.error[t, i], strict=True)
            )
            self.words.say(
                f"Tick {run.tick[t]}, {run.clock[t]:.2f} s, by {run.methods[i]}. "
                f"From its target: {far}."
            )


def error_picture(run: Log, error: Array) -> tuple[bytes, list[float]]:
    """The distances (T, k) over the clock as PNG, and where its axis lies: left and right, 0..1."""
    figure = Figure(figsize=(9, 2.5), dpi=100, layout="constrained")
    canvas = FigureCanvasAgg(figure)
    axes = figure.subplots()
    least = LEAST * decade(run.tree, run.effectors)
    for i, name in enumerate(run.effectors.names):
        colour, style = effector_colour(i), STYLES[i % len(STYLES)]
        axes.semilogy(
            run.clock,
            np.maximum(error[:, i], least),
            style,
            color=colour,
            label=as_label(name),
            lw=1.6,
        )
    changes = [e.tick * run.dt for e in run.events if e.run == _last_run(run)]
    changes = [at for at in changes if run.clock[0] <= at <= run.clock[-1]]
    if changes:
        top = axes.get_xaxis_transform()
        axes.plot(
            changes, np.ones(len(changes)), "v", color="0.25", transform=top, clip_on=False,
            label="change",
        )  # fmt: skip
    last = run.clock[-1] if len(run) > 1 else run.clock[0] + run.dt
    axes.set(xlim=(run.clock[0], last), xlabel="clock [s]", ylabel="distance to target [m]")
    axes.grid(alpha=0.3)
    figure.legend(loc="outside upper center", ncols=6, fontsize=8, handlelength=2.6, frameon=False)
    canvas.draw()
    box = axes.get_position()
    out = io.BytesIO()
    figure.savefig(out, format="png")
    return out.getvalue(), [float(box.x0), float(box.x1)]


def error_words(run: Log, error: Array) -> str:
    """The plot in words."""
    length = _length(run)
    each = "; ".join(
        f"{name} {length(one.mean())} on average, at most {length(one.max())} at "
        f"{run.clock[one.argmax()]:.2f} s"
        for name, one in zip(run.effectors.names, error.T, strict=True)
    )
    return f"Distance to target from {run.clock[0]:.2f} to {run.clock[-1]:.2f} s: {each}."


def _length(run: Log) -> Lengths:
    """The unit in which distances of the run are read."""
    return Lengths.of(run.tree, run.effectors)


def _last_run(run: Log) -> int:
    """The run that the ticks of this log are of: no reset came after it."""
    return max((event.run + (event.kind == "reset") for event in run.events), default=0)


def _places(clock: Array) -> list[float]:
    """Where each tick lies on the axis, 0..1."""
    span = max(clock[-1] - clock[0], 1e-9)
    return ((clock - clock[0]) / span).tolist()


def _table(run: Log, columns: Index, error: Array) -> list[list[str]]:
    changed: dict[int, list[str]] = {}
    for event in run.events:
        if event.run == _last_run(run):
            changed.setdefault(event.tick, []).append(str(event))
    notes, length = _at_rows(run, changed), _length(run)
    return [
        [
            str(run.tick[t]), f"{run.clock[t]:.2f}", run.methods[columns[t]],
            *(length.number(d, 2) for d in error[t]), "; ".join(notes.get(t, [])),
        ]
        for t in range(len(run))
    ]  # fmt: skip


def _at_rows(run: Log, changed: Mapping[int, list[str]]) -> dict[int, list[str]]:
    """The changes by the row in which they first act: that of the next tick in the log."""
    notes: dict[int, list[str]] = {}
    for tick, words in changed.items():
        row = int(np.searchsorted(run.tick, tick, side="right"))
        notes.setdefault(min(row, len(run) - 1), []).extend(words)
    return notes
