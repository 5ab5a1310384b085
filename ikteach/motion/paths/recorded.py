"""Targets as they were recorded, or drawn by hand: a table in time."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from math import pi
from typing import Any

import numpy as np

from ikteach.arrays import Array, ArrayLike, Mask, frozen
from ikteach.body import forward, locate
from ikteach.body.figures import Figure
from ikteach.checks import number, numbers, shown
from ikteach.motion.path import NamedMotion
from ikteach.names import unknown


@dataclass(frozen=True, eq=False)
class Recorded(NamedMotion):
    """Targets at times, straight between them; then it begins anew.

    times    (T,)       ascending [s]; the phase 2π is one after the last, as far as that from the
                        one before
    targets  (T, k, 3)  [m]
    names    k names, of effectors
    skeleton the bones of whom it was recorded from, of `with_skeleton`, if they are known
    standing (T, k)     whether each is to stand on the ground; none, if not given
    floor    height of the ground [m]
    pace     speed at which the ground goes by [m/s]
    tempo    how many times as fast as it was recorded
    notes    sentences on what was done to it

    `change` makes variants, of what is not data. ValueError if a shape is wrong, a number is not
    finite or there are fewer than two times.
    """

    times: Array
    targets: Array
    names: tuple[str, ...] = ()
    name: str = "recorded"
    standing: Mask | None = None
    skeleton: "Recorded | None" = None
    floor: float = 0.0
    speed: float = 0.0
    tempo: float = 1.0
    step_frequency: float = 1.0
    slowdown: int = 1
    forward: bool = False
    wound: Mapping[str, float] = field(default_factory=dict)
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        self.check()
        times, targets = numbers("times", self.times), numbers("targets", self.targets)
        T, k = len(times), len(self.names)
        if times.shape != (T,) or T < 2 or not (np.diff(times) > 0).all():
            raise ValueError("the times of a recording are two or more, and ascend")
        if targets.shape != (T, k, 3):
            raise ValueError(
                f"{T} times and {k} names need targets ({T}, {k}, 3), not {targets.shape}"
            )
        if not (np.isfinite(targets).all() and np.isfinite(times).all()):
            raise ValueError("the times and targets of a recording must be finite numbers")
        if not number("tempo", self.tempo):
            raise ValueError("the tempo of a recording must be more than 0")
        standing = np.zeros((T, k)) if self.standing is None else self.standing
        if np.shape(standing) != (T, k):
            raise ValueError(f"standing needs ({T}, {k}), not {np.shape(standing)}")
        object.__setattr__(self, "times", frozen(times))
        object.__setattr__(self, "targets", frozen(targets))
        object.__setattr__(self, "names", tuple(self.names))
        object.__setattr__(self, "standing", frozen(standing, bool))

    @property
    def span(self) -> float:
        """How long it takes as it was recorded [s]."""
        return float(2 * self.times[-1] - self.times[-2] - self.times[0])

    @property
    def rate(self) -> float:
        """Phase per second [rad/s]."""
        return self.tempo * 2 * pi / self.span

    @property
    def pace(self) -> float:
        """Speed at which the ground goes by [m/s]."""
        return self.tempo * self.speed

    def at(self, phase: ArrayLike) -> Array:
        """Return the targets of `names` at phases (...) [rad], (..., k, 3) [m]."""
        here, i = self._place(phase)
        after = (i + 1) % len(self.times)
        ends = np.append(self.times, self.times[0] + self.span)
        share = ((here - ends[i]) / (ends[i + 1] - ends[i]))[..., None, None]
        return np.asarray((1 - share) * self.targets[i] + share * self.targets[after])

    def stands(self, phase: ArrayLike) -> Mask:
        """Say which of `names` stand on the ground at phases (...), (..., k)."""
        assert self.standing is not None  # it was made
        return np.asarray(self.standing[self._place(phase)[1]])

    def settings(self) -> dict[str, Any]:
        """Return its parameters by name, without its data."""
        data = ("times", "targets", "names", "standing", "skeleton", "notes")
        return {name: value for name, value in vars(self).items() if name not in data}

    def _place(self, phase: ArrayLike) -> tuple[Array, Any]:
        """Find the time of phases (...) [s], and the last frame until then."""
        share = numbers("the phase", phase) / (2 * pi) % 1
        here = self.times[0] + self.span * share
        return here, np.searchsorted(self.times, here, side="right") - 1


def drawn(
    points: ArrayLike,
    period: float,
    *,
    figure: Figure,
    effector: str | None = None,
    name: str = "drawn",
) -> Recorded:
    """Make a motion along a drawn, closed curve, always as fast.

    points    (T, 3) [m], two or more; from the last it goes back to the first
    period    time of once round [s]
    figure    whose effectors have the targets
    effector  which of them goes along the curve, the first if none is named; the targets of the
              others stay where they are at rest

    ValueError if points are no such points, or all in one place; LookupError for an unknown name.
    """
    tree, effectors = figure
    which = effectors.names[0] if effector is None else effector
    if which not in effectors.names:
        raise LookupError(unknown("effector", which, effectors.names))
    curve = numbers("points", points)
    if curve.ndim != 2 or curve.shape[1] != 3 or len(curve) < 2 or not np.isfinite(curve).all():
        raise ValueError(f"a curve is drawn of two or more points (T, 3), not {shown(points)}")
    closed = np.concatenate([curve, curve[:1]])
    steps = np.linalg.norm(np.diff(closed, axis=0), axis=1)
    if not steps.sum() > 0:
        raise ValueError("the points of the curve are all in one place")
    period = number("period", period)
    if not period:
        raise ValueError("the period of a curve must be more than 0")
    keep = steps > 0
    along = np.concatenate([[0.0], steps[keep].cumsum()]) / steps.sum()
    targets = np.tile(locate(forward(tree, tree.rest), effectors), (keep.sum() + 1, 1, 1))
    row = effectors.names.index(which)
    targets[:, row] = np.concatenate([curve[keep], curve[:1]])
    return _closed(period * along, targets, effectors.names, name)


def _closed(times: Array, targets: Array, names: Sequence[str], name: str) -> Recorded:
    """Make a recording whose last targets, which are its first, come at the end of its period."""
    # Evenly in time, so that the step behind the last is as long as the one before.
    count = max(64, 4 * len(times))
    even = times[-1] * np.arange(count) / count
    flat = targets.reshape(len(times), -1).T
    values = np.stack([np.interp(even, times, column) for column in flat], axis=-1)
    return Recorded(even, values.reshape(count, -1, 3), tuple(names), name)
