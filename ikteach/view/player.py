"""The walking human of chapter 7: scene, controls, error plot and table, alive."""

import asyncio
import html
import traceback
from collections.abc import Callable, Mapping
from time import monotonic
from typing import Any, ClassVar

import ipywidgets as widgets

from ikteach.motion.gait import MOTIONS, WOUND
from ikteach.motion.session import Session
from ikteach.solvers import SOLVERS, Solver
from ikteach.study import distances
from ikteach.view.controls import Controls
from ikteach.view.picture import Picture
from ikteach.view.plots import SECONDS, ErrorPlot, portrait
from ikteach.view.scene import Scene

PLOT_EVERY, TABLE_EVERY = 15, 30  # ticks


class GaitPlayer(widgets.VBox):  # type: ignore[misc]
    """A human that follows the targets of a gait, by every method at once; one of them is shown.

    Display it in a notebook. `session` holds all state and may be changed from cells while the
    figure moves. Only one player of a `slot` lives at a time: to run a cell again closes the one
    that it made before. The loop that moves it runs only while it plays and somebody looks.
    """

    _living: ClassVar[dict[str, "GaitPlayer"]] = {}

    def __init__(
        self, methods: Mapping[str, Solver] = SOLVERS, *, slot: str = "gait", **options: Any
    ) -> None:
        if slot in self._living:
            self._living.pop(slot).close()
        self.session = Session(methods=methods, **options)
        self.scene = Scene(self.session.tree, self.session.effectors)
        self.playing = True
        self._changes = 0
        self._slot = slot
        self._task: asyncio.Task[None] | None = None
        self._loop = _running_loop()
        self._plot = ErrorPlot(self.session.effectors, list(methods))
        self._chart, self._table = Picture(), widgets.HTML()
        self._alert = widgets.HTML()
        self.controls = Controls(list(methods), self.session)
        self.controls.on_change(self._guarded(self._obey))
        self.scene.driver.on_sign = self._seen
        super().__init__(
            [
                widgets.HBox([self.scene.widget, self.controls.widget]),
                self._alert,
                self._chart,
                self._table,
            ]
        )
        self._living[slot] = self
        self._report()

    def play(self) -> None:
        """Let time pass."""
        self.playing = self.controls.playing.value = True
        self._wake()

    def pause(self) -> None:
        """Stop the clock; controls still act."""
        self.playing = self.controls.playing.value = False
        self._wake()

    def close(self) -> None:
        """Stop the loop and free all that the page and the kernel hold of it."""
        self.playing = False
        if self._task is not None:
            self._task.cancel()
        if self._living.get(self._slot) is self:
            del self._living[self._slot]
        if getattr(self, "comm", None) is None:
            return
        self.scene.close()
        for widget in (self.controls, self._chart, self._table, self._alert):
            widget.close()
        super().close()

    def _repr_mimebundle_(self, **kwargs: Any) -> Any:
        """The live widget, and beside it a still for places without a kernel."""
        session = self.session
        bundle = super()._repr_mimebundle_(**kwargs)
        still = portrait(
            session.tree, session.effectors, session.theta[session.method], session.targets
        )
        return {**bundle, "image/png": still, "text/plain": self._words()}

    # What a control does. Callbacks may come on another thread: they store, and the loop acts.

    def _obey(self, name: str, value: Any) -> None:
        session = self.session
        if name == "method":
            session.show(value)
        elif name == "motion":
            keep = {"forward": session.gait.forward, "wound": session.gait.wound}
            session.gait = MOTIONS[value]
            session.change(**keep)
            self.controls.agree(session.gait)
        elif name == "wounded":
            session.change(wound=WOUND if value else {})
        elif name == "view":
            self.scene.look_from(value)
        elif name == "playing":
            self.playing = value
        elif name == "reset":
            session.reset()
        elif name == "step":
            self.playing = self.controls.playing.value = False
            session.tick()
        else:
            session.change(**{name: value})
        if not self.playing:
            session.targets = session.gait.at(session.phase)
        self._changes += 1

    def _guarded(self, action: Callable[..., None]) -> Callable[..., None]:
        """`action`, with what goes wrong in it told to the person, once, and the session kept."""

        def act(*arguments: Any) -> None:
            try:
                action(*arguments)
            except Exception as error:
                self._say(error)
            else:
                self._say(None)
            self._wake()

        return act

    def _say(self, error: Exception | None) -> None:
        words = ""
        if error is not None:
            where = "".join(traceback.format_exception(error)[-2:])
            words = (
                f'<div role="alert" style="border-left:4px solid #d55e00;padding:4px 10px">'
                f"<b>That did not work.</b> {html.escape(str(error))}"
                f"<details><summary>where</summary><pre>{html.escape(where)}</pre></details></div>"
            )
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
            self._draw()
            while self.playing and not self.scene.driver.alone:
                due = max(due + session.dt, monotonic() - session.dt)  # late: go on, do not race
                await asyncio.sleep(max(due - monotonic(), 0.001))
                session.tick()
                if self.scene.driver.ready:
                    self._draw()
                if session.ticks % PLOT_EVERY == 0:
                    self._report(table=session.ticks % TABLE_EVERY == 0)
        except Exception as error:  # a student's own solver, most likely
            self.pause()
            self._say(error)

    def _draw(self) -> None:
        session, gait = self.session, self.session.gait
        self.scene.show(
            session.theta[session.method],
            session.targets,
            floor=min(gait.back_y_leg, gait.front_y_leg),
            advance=session.advance,
            change=self._changes,
        )

    def _report(self, *, table: bool = True) -> None:
        session = self.session
        tracks = session.tracks(last=round(SECONDS / session.dt))
        self._chart.png = self._plot.png(tracks, session.method)
        if table:
            self.scene.driver.description = self._chart.alt = self._words()
            self._table.value = _table(tracks, session.method)

    def _words(self) -> str:
        session = self.session
        far = ", ".join(
            f"{name} {100 * d:.1f} cm"
            for name, d in zip(session.effectors.names, session.error, strict=True)
        )
        wounded = "wounded, " if session.gait.wound else ""
        return f"A human, {wounded}{session.gait.name} by {session.method}. From its target: {far}."


def _table(tracks: Mapping[str, Any], shown: str) -> str:
    if not tracks:
        return "<p>No tick yet: the table fills when the figure moves.</p>"
    table = distances(tracks).rename(index={shown: f"{shown} (shown)"})
    return (
        "<p>Distance to target in cm, mean of the last 10 s; worst distance in cm; jitter "
        "(mean ‖Δ²θ‖) in degrees; joints held at limits, on average.</p>"
        + table.to_html(float_format="{:.2f}".format, border=0, classes="ikteach-table")
    )


def _running_loop() -> asyncio.AbstractEventLoop | None:
    try:
        return asyncio.get_running_loop()
    except RuntimeError:  # no notebook: nothing moves by itself, and `session.tick()` still does
        return None
