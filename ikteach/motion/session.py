"""What a live figure is at this moment: one clock, one set of targets, a pose for each method.

State lives here and nowhere else. Panels change the session, the scene is told what it says, and
neither is known to it.
"""

from collections import deque
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from ikteach.arrays import Array, Mask
from ikteach.body import forward, locate
from ikteach.body.figures import Figure, human
from ikteach.motion.gait import Gait, walking
from ikteach.motion.step import step
from ikteach.motion.track import Track
from ikteach.names import unknown
from ikteach.solvers import SOLVERS, Solver


class Session:
    """A figure that walks, by every method at once, on the same targets and the same clock.

    gait      what the targets do; change it with `change(...)` or put another in its place
    methods   {name: solver}
    method    the one that is shown
    dt        clock time of one tick [s]
    options   go to `step`, the same for all methods
    keep      how many ticks the record holds; `dropped` counts those it has let go
    """

    def __init__(
        self,
        figure: Figure | None = None,
        gait: Gait = walking,
        methods: Mapping[str, Solver] = SOLVERS,
        *,
        method: str = "dls",
        dt: float = 1 / 30,
        keep: int = 3000,
        **options: Any,
    ) -> None:
        self.tree, self.effectors = figure or human()
        self.gait = gait
        self.methods = dict(methods)
        self.dt = dt
        self.options = options
        self.record: deque[tuple[float, Array, dict[str, _Tick]]] = deque(maxlen=keep)
        self.show(method)
        self.reset()

    def show(self, method: str) -> None:
        """Show the pose of `method`; LookupError for a name that is not among the methods."""
        if method not in self.methods:
            raise LookupError(unknown("method", method, self.methods))
        self.method = method

    def change(self, **parameters: Any) -> None:
        """Give the gait other parameters; TypeError or ValueError says which one cannot be."""
        unfit = [name for name in parameters if name not in vars(self.gait)]
        if unfit:
            raise LookupError(unknown("gait parameter", unfit[0], vars(self.gait)))
        self.gait = replace(self.gait, **parameters)

    def reset(self) -> None:
        """Back to the rest pose and the beginning of time, with an empty record."""
        self.time = self.phase = self.advance = 0.0
        self.ticks = self._waited = self.dropped = 0
        self.theta = dict.fromkeys(self.methods, self.tree.rest)
        self.targets = self.gait.at(0.0)
        self.record.clear()

    def tick(self) -> None:
        """Let one tick of the clock pass; every `gait.slowdown`-th, time leaps and poses follow."""
        self.ticks += 1
        self._waited += 1
        if self._waited < self.gait.slowdown:
            return
        elapsed = self.gait.step_frequency * self.dt * self._waited
        self._waited = 0
        self.time += elapsed
        self.phase += self.gait.speed * elapsed
        self.advance += self.gait.pace * elapsed if self.gait.forward else 0.0
        self.targets = self.gait.at(self.phase)
        self._follow()

    def _follow(self) -> None:
        free = self.gait.mobility(self.tree)
        done = {}
        for name, solver in self.methods.items():
            tick = step(
                self.tree, self.theta[name], self.effectors, self.targets, solver,
                mobility=free, **self.options,
            )  # fmt: skip
            s = locate(forward(self.tree, tick.theta), self.effectors)
            error = np.linalg.norm(self.targets - s, axis=-1)
            done[name] = _Tick(tick.theta, error, bool(tick.capped), tick.held)
        for name, tick_done in done.items():  # only now: a solver that fails changes nothing
            self.theta[name] = tick_done.theta
        self.dropped += len(self.record) == self.record.maxlen
        self.record.append((self.time, self.targets, done))

    @property
    def error(self) -> Array:
        """Distance of each effector of the shown method to its target, (k,) [m]."""
        s = locate(forward(self.tree, self.theta[self.method]), self.effectors)
        return np.linalg.norm(self.targets - s, axis=-1)

    def tracks(self, last: int | None = None) -> dict[str, Track]:
        """The record, or its last ticks, as {method: Track}; empty before the first tick."""
        rows = list(self.record)[-last:] if last else list(self.record)
        if not rows:
            return {}
        times, targets = np.array([r[0] for r in rows]), np.array([r[1] for r in rows])

        def of(name: str, what: str) -> Array:
            return np.array([getattr(row[2][name], what) for row in rows])

        return {
            name: Track(
                name, self.tree, self.effectors, times, targets, rows[0][2][name].theta,
                of(name, "theta"), of(name, "error"), of(name, "capped").astype(float),
                of(name, "held").astype(bool), seconds=float("nan"),
            )
            for name in self.methods
        }  # fmt: skip


class _Tick:
    """What one method did in one tick."""

    __slots__ = ("capped", "error", "held", "theta")

    def __init__(self, theta: Array, error: Array, capped: bool, held: Mask) -> None:
        self.theta, self.error, self.capped, self.held = theta, error, capped, held
