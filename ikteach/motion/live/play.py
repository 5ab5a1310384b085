"""A figure in time: a pose for each method, on the same targets and the same clock."""

from collections import deque
from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

import numpy as np

from ikteach.arrays import Array, ArrayLike
from ikteach.body import Frames, forward, locate
from ikteach.body.figures import Figure
from ikteach.checks import count, number, shown
from ikteach.motion.live.history import History
from ikteach.motion.live.log import Event, Log, Moment
from ikteach.motion.live.settings import (
    SESSION,
    Settings,
    check_options,
    figure_of,
    in_words,
    motion_of,
    pose_of,
    try_options,
    usual_methods,
)
from ikteach.motion.methods import Methods, methods_of
from ikteach.motion.mix import PerPose
from ikteach.motion.path import Motion
from ikteach.motion.step import step
from ikteach.motion.track import Track
from ikteach.names import unknown

LONG = 400  # letters of an error that the log keeps


class Play:
    """A figure that follows its targets, tick by tick.

    It moves as it is set, and records all that happens. Its options are those of a `Session`,
    which can also be changed.
    """

    def __init__(
        self,
        figure: Figure | None = None,
        gait: Motion | None = None,
        methods: Methods | None = None,
        *,
        method: str | None = None,
        dt: float = 1 / 30,
        keep: int = 3000,
        keep_events: int = 1000,
        iterations: int = 1,
        start: ArrayLike | None = None,
        **options: Any,
    ) -> None:
        self.tree, self.effectors = figure_of(figure)
        self.dt = number("dt", dt)
        if not self.dt:
            raise ValueError(f"dt must be more than 0, not {shown(dt)}")
        steps = count("iterations", iterations)
        self.start = pose_of(self.tree, start)
        check_options(options, SESSION)
        try_options(self.tree, self.effectors, options)
        self.history = History(count("keep", keep), count("keep_events", keep_events))
        usual = usual_methods(self.tree, self.effectors)
        known = usual if methods is None else methods_of(methods)
        method = method or ("dls" if "dls" in known else next(iter(known)))
        motion = motion_of(self.tree, self.effectors, gait)
        self._settings = self._first = Settings(*motion, known, method, options, iterations=steps)
        self._known(method)
        self.runs = self.ticks = self._waited = 0
        self._begin()

    def note(self, kind: str, **what: Any) -> None:
        """Put an event into the log.

        It may be a pause or a remark; nothing else happens.
        """
        self.history.note(self._event(kind, what))

    def reset(self) -> None:
        """Go back to the start and time zero.

        The record is then empty. Settings stay as they are, targets set by hand too. The events go
        on.
        """
        self.note("reset", ticks=self.ticks)
        self.runs += 1
        self._begin()

    # Time passes.

    def tick(self) -> None:
        """Let one tick of the clock pass.

        At every `gait.slowdown`-th, time leaps and poses follow.
        """
        self._waited += 1
        if self._waited >= self._settings.gait.slowdown:
            try:
                self._leap()
            except Exception as error:  # a student's own solver or path: nothing has happened
                self._waited -= 1
                words = str(error)[:LONG] or type(error).__name__
                if not (self.events and self.events[-1].what == {"words": words}):
                    self.note("error", words=words)
                raise
            self._waited = 0
        self.ticks += 1

    def ahead(self) -> tuple[float, float, float, Array]:
        """Return time, phase, advance and targets after the next leap."""
        gait, course = self._settings.gait, self._settings.course
        elapsed = gait.step_frequency * self.dt * max(self._waited, gait.slowdown)
        time = self.time + elapsed
        if self._settings.by_hand is not None:
            return time, self.phase, self.advance, self.targets
        phase = self.phase + gait.rate * elapsed
        gone = course.size * gait.pace * elapsed if gait.forward else 0.0
        return time, phase, self.advance + gone, course.at(phase)

    def _leap(self) -> None:
        """Let time leap: solve first, so that a solver that fails changes nothing."""
        settings, (time, phase, advance, targets) = self._settings, self.ahead()
        options = settings.options_of_all() | {"mobility": settings.gait.mobility(self.tree)}
        options["wish"] = settings.course.wish(phase)
        frames: Frames | None = self.frames
        theta, capped = self._poses, np.zeros(len(self._poses), dtype=bool)
        for _ in range(settings.iterations):
            solver = PerPose(settings.methods.values())
            to = step(self.tree, theta, self.effectors, targets, solver, frames=frames, **options)
            theta, frames, capped = to.theta, None, capped | to.capped
        self._stand(theta)
        self.time, self.phase, self.advance, self.targets = time, phase, advance, targets
        self.history.add(
            Moment(
                tick=self.ticks + 1,
                time=time,
                phase=phase,
                advance=advance,
                floor=self.floor,
                shown=self._row(settings.method),
                targets=targets,
                theta=to.theta,
                error=self._distances(),
                capped=capped,
                held=to.held,
            )
        )

    # What can be asked.

    @property
    def record(self) -> deque[Moment]:
        """The last ticks in which poses followed."""
        return self.history.ticks

    @property
    def events(self) -> deque[Event]:
        """The last changes, notes and errors."""
        return self.history.events

    @property
    def dropped(self) -> int:
        """How many ticks the record has let go."""
        return self.history.dropped["ticks"]

    @property
    def events_dropped(self) -> int:
        """How many events have been let go."""
        return self.history.dropped["events"]

    def frames_of(self, method: str) -> Frames:
        """Return where the joints are, in the pose of a method."""
        row = self._row(method)
        return Frames(*(part[row] for part in self.frames))

    def options_of(self, method: str) -> dict[str, Any]:
        """Return the options of `step` for a method."""
        return self._settings.options_of(method)

    @property
    def error(self) -> Array:
        """Distance of each effector to its target (k,) [m].

        The effectors are those of the shown method.
        """
        return self._distances()[self._row(self._settings.method)]

    def jitter(self, last: int = 1) -> dict[str, Array]:
        """Return ‖Δ²θ‖ of each method in the last ticks.

        They are {name: (≤ last,)} [rad per tick²], of the ticks in the record. Before the first one
        the figure is taken to have stood still.
        """
        jitter = self.history.jitter(last).reshape(-1, len(self._settings.methods))
        return dict(zip(self._settings.methods, jitter.T, strict=True))

    @property
    def floor(self) -> float:
        """Height of the ground [m].

        For a human it is that of the lower foot's target.
        """
        return self._settings.course.floor

    def log(self, last: int | None = None) -> Log:
        """Return the run as data that no longer changes.

        It is the whole record, or its last ticks.
        """
        history, methods = self.history, list(self._settings.methods)
        about = {"events": tuple(self.events), "dropped": dict(history.dropped)}
        about["settings"] = self.settings()
        return Log.of(self.tree, self.effectors, self.dt, methods, history.last(last), **about)

    def tracks(self, last: int | None = None) -> dict[str, Track]:
        """Return the record as {method: Track}.

        It is the whole record, or its last ticks, and empty before the first tick.
        """
        ticks, methods = self.history.last(last), list(self._settings.methods)
        return Log.of(self.tree, self.effectors, self.dt, methods, ticks).tracks()

    def settings(self) -> dict[str, Any]:
        """Return how everything stands, in plain words and numbers."""
        return {
            "shown": self._settings.method,
            "by_hand": self._settings.by_hand is not None,
            "targets": self.targets.tolist(),
            "dt": self.dt,
            "iterations": self._settings.iterations,
            "gait": in_words(self._settings.gait.settings()),
            "methods": in_words(self._settings.methods),
            "options": in_words(self._settings.options),
            "caps": in_words(self._settings.caps),
        }

    # Behind it.

    def _begin(self) -> None:
        self.time = self.phase = self.advance = 0.0
        self.ticks = self._waited = 0
        self._stand(np.tile(self.start, (len(self._settings.methods), 1)))
        self._retarget()
        self.history.clear()

    def _stand(self, poses: Array) -> None:
        """Put the figure of each method into its pose (M, n) [rad]."""
        poses.setflags(write=False)  # a pose that is changed would no longer be that of the frames
        self._poses, self.frames = poses, forward(self.tree, poses)
        self.theta = MappingProxyType(dict(zip(self._settings.methods, poses, strict=True)))

    def _retarget(self) -> None:
        by_hand = self._settings.by_hand
        self.targets = self._settings.course.at(self.phase) if by_hand is None else by_hand

    def _event(self, kind: str, what: Mapping[str, Any]) -> Event:
        return Event(self.runs, self.ticks, self.time, kind, what)

    def _distances(self) -> Array:
        """Distance of each effector to its target, by each method, (M, k) [m]."""
        gap = self.targets - locate(self.frames, self.effectors)
        return np.asarray(np.sqrt(np.vecdot(gap, gap)))

    def _row(self, method: str) -> int:
        """Return the row of a method in arrays (M, ...) of all methods."""
        return list(self._settings.methods).index(self._known(method))

    def _known(self, method: str) -> str:
        if method not in self._settings.methods:
            raise LookupError(unknown("method", method, self._settings.methods))
        return method
