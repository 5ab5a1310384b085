"""Chapter 8's widget: four humans, one set of targets, one clock, one log."""

import asyncio
from collections.abc import Callable, Mapping
from math import radians
from time import monotonic
from typing import Any, ClassVar

import ipywidgets as widgets
import numpy as np

from ikteach.body.figures import human
from ikteach.motion import BUSS_CAPS, gait
from ikteach.motion.experiment import capped
from ikteach.motion.session import Session
from ikteach.solvers import SOLVERS, Solver
from ikteach.study import distances
from ikteach.view.bench import alert, choice, running_loop, slider
from ikteach.view.picture import Picture
from ikteach.view.plots import SECONDS, ErrorPlot, portrait
from ikteach.view.scene import Scene

EQUAL, OWN = "equal caps", "each author's caps"
PLOT_EVERY, TABLE_EVERY = 15, 30  # ticks


def runners(caps: str, degrees: float) -> dict[str, Solver]:
    """The four methods, each with its cap: all `degrees` a step, or as their authors have them."""
    chains = human().effectors.chains
    bounds: Mapping[str, float | None] = (
        BUSS_CAPS if caps == OWN else dict.fromkeys(SOLVERS, radians(degrees))
    )
    return {name: capped(solver, bounds[name], chains) for name, solver in SOLVERS.items()}


class Race(widgets.VBox):  # type: ignore[misc]
    """Four humans that follow the same targets at the same moment, each by its own method.

    Display it in a notebook. `session` holds all state; `values` is what the controls say. To run
    the cell again closes the race that it made before. Time passes only while somebody looks.
    """

    _living: ClassVar["Race | None"] = None

    def __init__(self, degrees: float = 30.0) -> None:
        if Race._living is not None:
            Race._living.close()
        Race._living = self
        self.session = Session(methods=runners(EQUAL, degrees))
        tree, effectors = self.session.tree, self.session.effectors
        self.scene = Scene(tree, effectors, names=list(SOLVERS), apart=1.9, width=960, height=400)
        self.playing, self._changes = True, 0
        self._waiting: list[Callable[[], None]] = []
        self._task: asyncio.Task[None] | None = None
        self._loop = running_loop()
        self._plot = ErrorPlot(effectors, list(SOLVERS))
        self._chart, self._table, self._alert = Picture(), widgets.HTML(), widgets.HTML()
        self._play = widgets.ToggleButton(value=True, description="Pause")
        self._step, self._reset = (widgets.Button(description=d) for d in ("Step", "Reset"))
        self.controls = {
            "caps": choice("caps", [EQUAL, OWN]),
            "degrees": slider("equal cap [° a step]", degrees, 1.0, 45.0, 0.5),
            "motion": choice("motion", list(gait.MOTIONS)),
            "speed": slider("speed ω [rad/s]", self.session.gait.speed, 0.0, 20.0, 0.1),
        }
        self._play.observe(lambda change: self._ask(self._played), "value")
        self._step.on_click(lambda _: self._ask(self._stepped))
        self._reset.on_click(lambda _: self._ask(self.session.reset))
        for name, control in self.controls.items():
            control.observe(lambda _, name=name: self._ask(lambda: self._obey(name)), "value")
        self.scene.driver.on_sign = self._seen
        buttons = widgets.HBox([self._play, self._step, self._reset])
        super().__init__(
            [buttons, *self.controls.values(), self._alert, self.scene.widget, self._chart,
             self._table]
        )  # fmt: skip
        self._report()

    @property
    def values(self) -> dict[str, Any]:
        """What the controls say now."""
        return {name: control.value for name, control in self.controls.items()}

    @property
    def words(self) -> str:
        """What is seen, for those who cannot see it."""
        return self._words()

    def refresh(self) -> None:
        """Do what was asked for, take one tick, and report."""
        self._act()
        self.session.tick()
        self._report()

    def pause(self) -> None:
        """Stop the clock; controls still act."""
        self._play.value = False

    def close(self) -> None:
        """Stop the loop and free all that the page and the kernel hold of it."""
        self.playing = False
        if self._task is not None:
            self._task.cancel()
        if Race._living is self:
            Race._living = None
        if getattr(self, "comm", None) is None:
            return
        self.scene.close()
        parts = [*self.controls.values(), self._play, self._step, self._reset]
        for widget in (*parts, self._chart, self._table, self._alert):
            widget.close()
        super().close()

    def _repr_mimebundle_(self, **kwargs: Any) -> Any:
        """The live widget, and beside it a still for places without a kernel."""
        session = self.session
        tree, effectors = session.tree, session.effectors
        still = portrait(tree, effectors, session.theta[session.method], session.targets)
        bundle = super()._repr_mimebundle_(**kwargs)
        return {**bundle, "image/png": still, "text/plain": self._words()}

    # Callbacks may come on another thread: they store, and the loop acts.

    def _ask(self, act: Callable[[], None]) -> None:
        self._waiting.append(act)
        if self._loop is None or self._loop.is_closed():
            self._act()
        else:
            self._loop.call_soon_threadsafe(self._start)

    def _obey(self, name: str) -> None:
        session, values = self.session, self.values
        if name == "motion":
            session.gait = gait.MOTIONS[values["motion"]]
            self.controls["speed"].value = session.gait.speed
        elif name == "speed":
            session.change(speed=values["speed"])
        else:
            session.methods.update(runners(values["caps"], values["degrees"]))

    def _played(self) -> None:
        self.playing = bool(self._play.value)
        self._play.description = "Pause" if self.playing else "Play"

    def _stepped(self) -> None:
        self._play.value = False
        self.playing = False
        self.session.tick()

    def _act(self) -> None:
        """Do what was asked for, and tell in words what goes wrong."""
        waiting, self._waiting = self._waiting, []
        try:
            for act in waiting:
                act()
                self._changes += 1
        except Exception as error:
            self._alert.value = alert(error)
        else:
            if waiting:
                self._alert.value = ""

    # The loop.

    def _seen(self, new: bool) -> None:
        if (new or self.playing) and self._loop is not None and not self._loop.is_closed():
            self._loop.call_soon_threadsafe(self._start)

    def _start(self) -> None:
        self._act()
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
            self._report()
        except Exception as error:
            self._play.value = self.playing = False
            self._alert.value = alert(error)

    def _draw(self) -> None:
        session = self.session
        self.scene.show(
            np.array([session.theta[name] for name in SOLVERS]),
            session.targets,
            floor=min(session.gait.back_y_leg, session.gait.front_y_leg),
            change=self._changes,
        )

    def _report(self, *, table: bool = True) -> None:
        session = self.session
        tracks = session.tracks(last=round(SECONDS / session.dt))
        self._chart.png = self._plot.png(tracks, session.method)
        if table:
            self.scene.driver.description = self._chart.alt = self._words()
            self._table.value = (
                _table(distances(tracks).to_html) if tracks else "<p>No tick yet.</p>"
            )

    def _words(self) -> str:
        """Who is how far from the targets, on average of the last seconds."""
        session = self.session
        tracks = session.tracks(last=round(SECONDS / session.dt))
        far = ", ".join(f"{name} {100 * run.error.mean():.1f} cm" for name, run in tracks.items())
        caps = self.values["caps"]
        return f"Four humans, {session.gait.name}, {caps}. Mean distance: {far or 'no tick yet'}."


def _table(to_html: Callable[..., str]) -> str:
    return (
        "<p>On the left above: the effectors of dls. Last 10 s: distance to target in cm, mean and "
        "worst; jitter (mean ‖Δ²θ‖) in degrees; joints held at limits.</p>"
        + to_html(float_format="{:.2f}".format, border=0, classes="ikteach-table")
    )
