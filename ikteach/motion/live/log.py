"""The record of a session, as data that no longer changes."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np

from ikteach.arrays import Array, Mask
from ikteach.body import Effectors, Tree
from ikteach.checks import shown
from ikteach.motion.track import Track


class Event(NamedTuple):
    """Something that was changed or went wrong.

    run   how many resets came before it
    tick  after how many ticks of that run
    time  gait time then [s]
    kind  "method", "gait", "target", "by hand", "options", "undo", "reset", "pause", "error" …
    what  its particulars, by name
    """

    run: int
    tick: int
    time: float
    kind: str
    what: Mapping[str, Any]

    def __str__(self) -> str:
        words = ", ".join(f"{name} {_brief(value)}" for name, value in self.what.items())
        return f"{self.kind}: {words}" if words else self.kind


def _brief(value: Any) -> str:
    """Write a value with as many digits as a person reads."""
    match value:
        case float():
            return str(float(f"{value:.4g}"))
        case Mapping():
            return f"({', '.join(f'{name} {_brief(one)}' for name, one in value.items())})"
        case list() | tuple():
            return f"({', '.join(map(_brief, value))})"
        case _:
            return str(value)


class Moment(NamedTuple):
    """One tick in which poses followed.

    It is a row of a `Log`, which says how the names are meant.
    """

    tick: int
    time: float
    phase: float
    advance: float
    floor: float
    shown: int
    targets: Array
    theta: Array
    error: Array
    capped: Mask
    held: Mask


@dataclass(frozen=True, eq=False)
class Log:
    """A finished run of T ticks, by M methods on the same targets.

    tree, effectors  the figure
    dt               clock time of one tick [s]
    methods          their names
    tick     (T,)       how many ticks of the clock had passed
    time     (T,)       gait time [s]
    phase    (T,)       argument of the gait's sine [rad]
    advance  (T,)       how far the figure had gone [m]
    floor    (T,)       height of the ground under the pelvis [m]
    shown    (T,)       the method that was shown, as its place in `methods`
    targets  (T, k, 3)  [m]
    theta    (T, M, n)  the pose by each method [rad]
    error    (T, M, k)  distance to target [m]
    capped   (T, M)     whether the cap shortened the step
    held     (T, M, n)  whether a limit stopped the joint
    events           the changes, in order
    settings         how the session stood at the end: plain words and numbers, by name
    dropped          how many ticks and events came before these and were not kept
    """

    tree: Tree
    effectors: Effectors
    dt: float
    methods: tuple[str, ...]
    tick: np.ndarray[Any, np.dtype[np.int64]]
    time: Array
    phase: Array
    advance: Array
    floor: Array
    shown: np.ndarray[Any, np.dtype[np.int64]]
    targets: Array
    theta: Array
    error: Array
    capped: Mask
    held: Mask
    events: tuple[Event, ...] = ()
    settings: Mapping[str, Any] = field(default_factory=dict)
    dropped: Mapping[str, int] = field(default_factory=lambda: {"ticks": 0, "events": 0})

    @classmethod
    def of(
        cls,
        tree: Tree,
        effectors: Effectors,
        dt: float,
        methods: Sequence[str],
        moments: Sequence[Moment],
        **others: Any,
    ) -> "Log":
        """Make the log of these moments.

        `others` are its events, settings and dropped.
        """
        T, m, n, k = len(moments), len(methods), len(tree), len(effectors)
        shapes = {"targets": (k, 3), "theta": (m, n), "error": (m, k), "capped": (m,)}
        shapes |= {"held": (m, n)}
        kinds: dict[str, Any] = {"tick": np.int64, "shown": np.int64, "capped": bool, "held": bool}
        columns = zip(*moments, strict=True) if moments else [()] * len(Moment._fields)
        arrays: dict[str, Any] = {
            name: np.array(column, dtype=kinds.get(name, float)).reshape(T, *shapes.get(name, ()))
            for name, column in zip(Moment._fields, columns, strict=True)
        }
        return cls(tree, effectors, dt, tuple(methods), **arrays, **others)

    def __len__(self) -> int:
        return len(self.tick)

    @property
    def clock(self) -> Array:
        """Clock time of each tick (T,) [s].

        It counts from the beginning of the run.
        """
        return np.asarray(self.dt * self.tick, dtype=float)

    def tracks(self) -> dict[str, Track]:
        """Return the run of each method, {method: Track}.

        It is empty if there is no tick.
        """
        if not len(self):
            return {}
        return {name: self._track(i) for i, name in enumerate(self.methods)}

    def _track(self, i: int) -> Track:
        return Track(
            method=self.methods[i],
            tree=self.tree,
            effectors=self.effectors,
            times=self.time,
            targets=self.targets,
            start=self.theta[0, i],
            theta=self.theta[:, i],
            error=self.error[:, i],
            capped=self.capped[:, i].astype(float),
            held=self.held[:, i],
            seconds=float("nan"),
        )

    def lost(self) -> str:
        """Say in a sentence how much was dropped.

        The sentence is empty if all is there.
        """
        gone = {what: number for what, number in self.dropped.items() if number}
        if not gone:
            return ""
        parts = [f"the {number} earliest {what}" for what, number in gone.items()]
        return f"The log is bounded: {' and '.join(parts)} were dropped."


def same_targets(tracks: Mapping[str, Track]) -> list[Track]:
    """Check that runs can stand in one table.

    They are {name: Track}, at least one, and all on the same targets.
    """
    if not isinstance(tracks, Mapping):
        raise TypeError(f"runs are {{name: Track}}, as `study.runs` makes, not {shown(tracks)}")
    if not tracks:
        raise ValueError("there is no run: at least one run is needed")
    runs = [of_run(run) for run in tracks.values()]
    for name, run in tracks.items():
        if not (
            run.effectors.names == runs[0].effectors.names
            and np.array_equal(run.targets, runs[0].targets)
            and np.array_equal(run.times, runs[0].times)
        ):
            raise ValueError(
                "the runs of one table must follow the same targets at the same times, and"
                f" {shown(name)} does not follow those of {shown(next(iter(tracks)))}"
            )
    return runs


def of_run(run: Track) -> Track:
    """Check that this is a run, and finite."""
    if not isinstance(run, Track):
        raise TypeError(f"a run is a Track, as `track` makes, not {shown(run)}")
    if not len(run):
        raise ValueError(f"the run of {shown(run.method)} has no frame")
    for what in ("times", "targets", "start", "theta", "error"):
        if not np.isfinite(getattr(run, what)).all():
            raise ValueError(f"the run of {shown(run.method)} has {what} that are not finite")
    return run
