"""What a live figure is at this moment: one clock, one set of targets, a pose for each method.

State lives here and nowhere else. Panels change the session, the scene is told what it says, and
neither is known to it. What is changed is noted and can be taken back; what happens is recorded.
"""

import inspect
from collections import deque
from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from itertools import islice
from time import monotonic
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np

from ikteach.arrays import Array, ArrayLike, frozen
from ikteach.body import Frames, forward, locate
from ikteach.body.extent import extent
from ikteach.body.figures import Figure, human
from ikteach.checks import numbers
from ikteach.motion.checks import checked, solver_of
from ikteach.motion.gait import LIMBS, Gait, stature, walking
from ikteach.motion.live.log import Event, Log, Moment
from ikteach.motion.methods import Methods, methods_of
from ikteach.motion.mix import Mix, PerPose
from ikteach.motion.path import Path, swinging
from ikteach.motion.step import step
from ikteach.motion.track import Track
from ikteach.names import unknown
from ikteach.solvers import SOLVERS, Solver, dls, name_of

ONE_MOVE = 0.7  # [s] a slider that is moved again so soon is still making the same change
LONG = 400  # letters of an error that the log keeps
DAMPING = inspect.signature(dls).parameters["damping"].default  # for a human [m/rad]
# What `adjust` may set: the options of `step`, but for the mobility, which is the gait's wound, and
# the frames, which are those of the poses.
OPTIONS = [
    name
    for name, parameter in inspect.signature(step).parameters.items()
    if parameter.kind is parameter.KEYWORD_ONLY and name not in ("mobility", "frames")
]


class Session:
    """A figure that walks, by every method at once, on the same targets and the same clock.

    figure    the human if none is given
    gait      what the targets do, a `Gait` or a `Path`; change it with `change(...)` or put another
              in its place. If none is given, what can walk walks, and any other figure's targets
              go where its own joints would swing them
    methods   {name: solver}, and whatever `methods_of` takes; put another to a name with `use`.
              If none are given, those of `SOLVERS`, with the λ of dls in proportion to the body
    method    the one that is shown; if none is given, dls or the first
    by_hand   True where the targets stay where `aim` has put them, and the gait rests
    dt        clock time of one tick [s]
    options   go to `step`, the same for all methods; set them with `adjust`
    caps      {method: max_step [rad] or None}: the step caps of methods that have their own; set
              them with `bound`
    theta     {method: pose (n,)} [rad], and
    frames    where the joints of each are (M, ...); both are for looking at
    keep      how many ticks the record holds; `dropped` counts those it has let go
    events    the last changes, notes and errors; `events_dropped` counts those it has let go
    """

    def __init__(
        self,
        figure: Figure | None = None,
        gait: Gait | Path | None = None,
        methods: Methods | None = None,
        *,
        method: str | None = None,
        dt: float = 1 / 30,
        keep: int = 3000,
        keep_events: int = 1000,
        **options: Any,
    ) -> None:
        self.tree, self.effectors = figure or human()
        self.methods = self._solvers() if methods is None else methods_of(methods)
        self.dt = dt
        self.options = options
        self.caps: Mapping[str, float | None] = {}
        self.record: deque[Moment] = deque(maxlen=keep)
        self.events: deque[Event] = deque(maxlen=keep_events)
        self.runs = self.events_dropped = self.ticks = self._waited = 0
        self._gait, self._by_hand = self._usual() if gait is None else gait, False
        self._course = self._gait.on(self.tree, self.effectors)
        self._before: deque[_Settings] = deque(maxlen=100)
        self._moved = -ONE_MOVE  # when something was last changed, by the clock on the wall
        self.method = self._known(
            method or ("dls" if "dls" in self.methods else next(iter(self.methods)))
        )
        self._begin()

    # What can be changed. Each change is an event, and `undo` takes it back.

    @property
    def gait(self) -> Gait | Path:
        """What the targets do."""
        return self._gait

    @gait.setter
    def gait(self, gait: Gait | Path) -> None:
        new, old = vars(gait), vars(self._gait)
        what = {n: value for n, value in new.items() if n not in old or value != old[n]}
        if "name" in what or "curve" in what:
            what = {"motion": gait.name}
        if what:
            course = gait.on(self.tree, self.effectors)
            same = self._soon("gait", what)
            self._change("gait", what, going_on=same, _gait=gait, _course=course)

    def change(self, **parameters: Any) -> None:
        """Give the gait other parameters; TypeError or ValueError says which one cannot be."""
        unfit = [name for name in parameters if name not in vars(self.gait)]
        if unfit:
            raise LookupError(unknown("gait parameter", unfit[0], vars(self.gait)))
        self.gait = replace(self.gait, **parameters)

    def show(self, method: str) -> None:
        """Show the pose of `method`; LookupError for a name that is not among the methods."""
        if self._known(method) != self.method:
            self._change("method", {"shown": method}, method=method)

    def use(self, method: str, solver: Solver | str) -> None:
        """Put another solver, or the same with other options bound, to the name of a method."""
        new = self.methods | {self._known(method): solver_of(solver)}
        self._try(method, new[method], self.options)
        what = {"method": method, "solver": in_words(new[method])}
        same = self._soon("solver", what) and self.events[-1].what["method"] == method
        self._change("solver", what, going_on=same, methods=new)

    def adjust(self, **options: Any) -> None:
        """Set options of `step` for all methods; the errors are those of `step`."""
        for name in options:
            if name not in OPTIONS:
                raise LookupError(unknown("option", name, OPTIONS))
        new = self.options | options
        self._try(self.method, self.methods[self.method], new)
        self._change(
            "options", in_words(options), going_on=self._soon("options", options), options=new
        )

    def bound(self, caps: Mapping[str, float | None]) -> None:
        """Give methods step caps of their own [rad], None for no cap; {}: all by `options`."""
        for method, cap in caps.items():
            known = self._known(method)
            self._try(known, self.methods[known], self.options | {"max_step": cap})
        same = self._soon("caps", caps)
        self._change("caps", dict(caps), going_on=same, caps=dict(caps))

    @property
    def by_hand(self) -> bool:
        """Whether the targets are set by hand and not by the gait."""
        return self._by_hand

    @by_hand.setter
    def by_hand(self, by_hand: bool) -> None:
        if bool(by_hand) != self._by_hand:
            self._change("by hand", {"by_hand": bool(by_hand)}, _by_hand=bool(by_hand))

    def aim(self, which: int | str, position: ArrayLike, *, going_on: bool = False) -> None:
        """Put the target of an effector, by its name or number, to a position (3,) [m].

        From then on the targets are set by hand. `going_on` says that it is still the same move of
        the mouse, which is one event and is undone as one. LookupError, ValueError.
        """
        i = self._effector(which)
        name, at = self.effectors.names[i], numbers("position", position)
        if at.shape != (3,):
            raise ValueError(f"a target is a point (3,), not {at.shape}")
        targets = self.targets.copy()
        targets[i] = at
        checked(self.tree, self.tree.rest, self.effectors, targets)
        what = {"effector": name, "position": at.tolist()}
        last = self.events[-1] if self.events else None
        same = going_on and last is not None and last.kind == "target"
        same = same and last is not None and last.what["effector"] == name
        self._change("target", what, going_on=same, _by_hand=True, targets=frozen(targets))

    def undo(self) -> Event:
        """Take the last change back, and say which it was; LookupError if there is none."""
        if not self._before:
            raise LookupError("there is nothing to undo")
        then = self._before.pop()
        for name, value in then.state.items():
            setattr(self, name, value)
        self._retarget()
        self.note("undo", taken_back=str(then.event))
        return then.event

    def note(self, kind: str, **what: Any) -> None:
        """Put an event into the log: a pause, a remark; nothing else happens."""
        self.events_dropped += len(self.events) == self.events.maxlen
        self.events.append(Event(self.runs, self.ticks, self.time, kind, what))

    def reset(self) -> None:
        """Back to the rest pose and the beginning of time, with an empty record.

        Settings stay as they are, targets set by hand too. The events go on.
        """
        self.note("reset", ticks=self.ticks)
        self.runs += 1
        self._begin()

    # Time passes.

    def tick(self) -> None:
        """Let one tick of the clock pass; every `gait.slowdown`-th, time leaps and poses follow."""
        self._waited += 1
        if self._waited >= self.gait.slowdown:
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
        """Time, phase, advance and targets after the next leap."""
        elapsed = self.gait.step_frequency * self.dt * max(self._waited, self.gait.slowdown)
        if self.by_hand:
            return self.time + elapsed, self.phase, self.advance, self.targets
        phase = self.phase + self.gait.speed * elapsed
        gone = self._course.size * self.gait.pace * elapsed if self.gait.forward else 0.0
        return self.time + elapsed, phase, self.advance + gone, self._course.at(phase)

    def _leap(self) -> None:
        """Let time leap: solve first, so that a solver that fails changes nothing."""
        time, phase, advance, targets = self.ahead()
        options = self.options | {"max_step": self._max_steps()}
        to = step(
            self.tree, self._poses, self.effectors, targets, PerPose(self.methods.values()),
            mobility=self.gait.mobility(self.tree), frames=self.frames, **options,
        )  # fmt: skip
        self._stand(to.theta)
        self.time, self.phase, self.advance, self.targets = time, phase, advance, targets
        self.dropped += len(self.record) == self.record.maxlen
        self.record.append(
            Moment(
                self.ticks + 1, self.time, self.phase, self.advance, self.floor,
                self._row(self.method), self.targets, to.theta, self._distances(), to.capped,
                to.held,
            )
        )  # fmt: skip

    # What can be asked.

    def frames_of(self, method: str) -> Frames:
        """Where the joints are, in the pose of a method."""
        row = self._row(method)
        return Frames(*(part[row] for part in self.frames))

    def options_of(self, method: str) -> dict[str, Any]:
        """What goes to `step` for a method."""
        own = {"max_step": self.caps[method]} if method in self.caps else {}
        return {**self.options, **own}

    def _max_steps(self) -> Array | None:
        """The cap of each method, inf where it has none; None if no method has one."""
        caps = [self.options_of(name).get("max_step") for name in self.methods]
        if all(cap is None for cap in caps):
            return None
        return np.array([np.inf if cap is None else cap for cap in caps])

    @property
    def error(self) -> Array:
        """Distance of each effector of the shown method to its target, (k,) [m]."""
        return self._distances()[self._row(self.method)]

    def _distances(self) -> Array:
        """Distance of each effector to its target, by each method, (M, k) [m]."""
        gap = self.targets - locate(self.frames, self.effectors)
        return np.asarray(np.sqrt(np.vecdot(gap, gap)))

    def jitter(self, last: int = 1) -> dict[str, Array]:
        """‖Δ²θ‖ of each method in the last ticks of the record, {name: (≤ last,)} [rad a tick²].

        Before the first tick of the record the figure is taken to have stood still.
        """
        poses = [row.theta for row in self._recent(last + 2)]
        if not poses:
            return {name: np.zeros(0) for name in self.methods}
        if len(poses) < last + 2:  # they begin with the first of all
            poses = [*2 * poses[:1], *poses][-(last + 2) :]
        jitter = np.linalg.norm(np.diff(poses, n=2, axis=0), axis=-1)
        return dict(zip(self.methods, jitter.T, strict=True))

    @property
    def floor(self) -> float:
        """Height of the ground [m]: of a human, that of the lower foot's target."""
        return self._course.floor

    def log(self, last: int | None = None) -> Log:
        """What happened, or its last ticks, as data that no longer changes."""
        return Log.of(
            self.tree, self.effectors, self.dt, list(self.methods), self._recent(last),
            events=tuple(self.events), settings=self.settings(),
            dropped={"ticks": self.dropped, "events": self.events_dropped},
        )  # fmt: skip

    def tracks(self, last: int | None = None) -> dict[str, Track]:
        """The record, or its last ticks, as {method: Track}; empty before the first tick."""
        return Log.of(
            self.tree, self.effectors, self.dt, list(self.methods), self._recent(last)
        ).tracks()

    def settings(self) -> dict[str, Any]:
        """How everything stands, in plain words and numbers."""
        return {
            "shown": self.method,
            "by_hand": self.by_hand,
            "targets": self.targets.tolist(),
            "dt": self.dt,
            "gait": in_words(vars(self.gait)),
            "methods": in_words(self.methods),
            "options": in_words(self.options),
            "caps": in_words(self.caps),
        }

    def _recent(self, last: int | None) -> list[Moment]:
        return list(islice(reversed(self.record), last))[::-1]

    # Behind the changes.

    def _solvers(self) -> dict[str, Solver]:
        """Give the four methods, damped in proportion to the body: λ is a length per radian."""
        known = stature(self.tree, self.effectors)
        size = known[0] if known else self._size()
        if size == 1:
            return dict(SOLVERS)
        damped = partial(dls, damping=DAMPING * size)
        return {**SOLVERS, "dls": damped}

    def _size(self) -> float:
        """How far the body reaches, against a human."""
        return extent(self.tree, self.effectors).radius / extent(*human()).radius

    def _usual(self) -> Gait | Path:
        """What the targets of this figure do where nobody says what."""
        walks = set(self.effectors.names) == set(LIMBS) or stature(self.tree, self.effectors)
        return walking if walks else swinging(self.tree, self.effectors)

    def _begin(self) -> None:
        self.time = self.phase = self.advance = 0.0
        self.ticks = self._waited = self.dropped = 0
        self._stand(np.tile(self.tree.rest, (len(self.methods), 1)))
        if not self.by_hand:
            self.targets = self._course.at(0.0)
        self.record.clear()

    def _stand(self, poses: Array) -> None:
        """Put the figure of each method into its pose (M, n) [rad]."""
        poses.setflags(write=False)  # a pose that is changed would no longer be that of the frames
        self._poses, self.frames = poses, forward(self.tree, poses)
        self.theta = MappingProxyType(dict(zip(self.methods, poses, strict=True)))

    def _change(
        self, kind: str, what: Mapping[str, Any], *, going_on: bool = False, **state: Any
    ) -> None:
        """Set this state, and note it: as a new event, or in place of the one that goes on."""
        if going_on and self._before:
            self.events.pop()
            before = self._before.pop().state
        else:
            before = {name: getattr(self, name) for name in _STATE}
        for name, value in state.items():
            setattr(self, name, value)
        self._retarget()
        self.note(kind, **what)
        self._before.append(_Settings(self.events[-1], before))
        self._moved = monotonic()

    def _retarget(self) -> None:
        if not self.by_hand:
            self.targets = self._course.at(self.phase)

    def _soon(self, kind: str, what: Mapping[str, Any]) -> bool:
        """Whether a change of the same things has only just been made: a slider on its way."""
        last = self.events[-1] if self.events else None
        recent = monotonic() - self._moved < ONE_MOVE
        return bool(recent and last and last.kind == kind and last.what.keys() == what.keys())

    def _row(self, method: str) -> int:
        """The row of a method in whatever has a row for each, (M, ...)."""
        return list(self.methods).index(self._known(method))

    def _known(self, method: str) -> str:
        if method not in self.methods:
            raise LookupError(unknown("method", method, self.methods))
        return method

    def _effector(self, which: int | str) -> int:
        names = self.effectors.names
        if isinstance(which, str):
            if which not in names:
                raise LookupError(unknown("effector", which, names))
            return names.index(which)
        if not 0 <= which < len(names):
            raise LookupError(f"effectors are numbered 0 to {len(names) - 1}, not {which}")
        return int(which)

    def _try(self, method: str, solver: Solver, options: Mapping[str, Any]) -> None:
        """Take a step that changes nothing, so that what cannot be is refused at once."""
        step(self.tree, self.theta[method], self.effectors, self.targets, solver, **options)


_STATE = ("method", "methods", "options", "caps", "targets", "_gait", "_course", "_by_hand")


class _Settings(NamedTuple):
    """How things stood before an event."""

    event: Event
    state: dict[str, Any]


def in_words(value: Any) -> Any:
    """Settings as what a file can hold: numbers, words, lists and dictionaries of them.

    A function becomes its name, one with bound options {"function": name, option: value}.
    """
    if isinstance(value, Mix):
        return {"function": "mix", **in_words(value.methods)}
    if isinstance(value, Mapping):
        return {str(name): in_words(one) for name, one in value.items()}
    if isinstance(value, partial):
        return {"function": name_of(value), **in_words(value.keywords)}
    if callable(value):
        return name_of(value)
    if isinstance(value, np.ndarray | np.generic):
        return value.tolist()
    if isinstance(value, list | tuple):
        return [in_words(one) for one in value]
    return value
