"""Targets as functions of time: what every motion has, and motions along curves of any kind."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from math import isfinite, pi
from numbers import Real
from typing import Any, Self

import numpy as np

from ikteach.arrays import Array, ArrayLike, Mask, frozen
from ikteach.body import Effectors, Tree, forward, locate
from ikteach.body.extent import extent
from ikteach.checks import LONG, function, numbers, shown
from ikteach.names import unknown

SWING = 0.5  # how far a hinge turns to either side of its rest [rad]; a slide, as share of the body


class Motion:
    """A motion of targets: a `Gait`, a `Path`, a `Walk`, a `Recorded`, or one of your own.

    name            what it is called
    rate            phase per second of its time [rad/s]; 2π are once round
    pace            speed at which its ground goes by, as on a treadmill [m/s]
    step_frequency  seconds of its time per second of clock time
    slowdown        ticks that one leap waits for and makes up for; 1 is smooth
    forward         whether the figure is shown going over the ground
    wound           mobility by joint name; empty for a sound body
    """

    name: str
    step_frequency: float
    slowdown: int
    wound: Mapping[str, float]
    names: tuple[str, ...] = ()  # of effectors, in the order of its targets, if it knows them
    # Whether these are fields, properties or numbers is the motion's own affair.
    rate: Any = 1.0
    pace: Any = 0.0
    forward: Any = False

    def on(self, tree: Tree, effectors: Effectors) -> "Course":
        """Fit this motion to a body.

        ValueError if it has no targets for it.
        """
        raise NotImplementedError

    @property
    def period(self) -> float:
        """Time of once round [s].

        It is infinite if nothing moves.
        """
        return 2 * pi / abs(self.rate) if self.rate else np.inf

    def stands(self, phase: ArrayLike) -> Mask:
        """Say which of `names` stand on the ground at phases (...), (..., k)."""
        return np.zeros((*np.shape(phase), len(self.names)), dtype=bool)

    def wish(self, tree: Tree, phase: ArrayLike) -> Array | None:
        """Return the pose (..., n) wished for at phases (...) [rad], or None."""
        return None

    def mobility(self, tree: Tree) -> Array:
        """Return the tree's mobility with the wound in it, (n,).

        LookupError for an unknown joint.
        """
        s = tree.mobility.copy()
        for joint, value in self.wound.items():
            s[tree.index(joint)] = value
        return s

    def settings(self) -> dict[str, Any]:
        """Return its parameters by name."""
        return dict(vars(self))

    def change(self, **parameters: Any) -> Self:
        """Make a variant of this motion.

        LookupError, TypeError or ValueError says which parameter cannot be.
        """
        known = self.settings()
        if unfit := [name for name in parameters if name not in known]:
            raise LookupError(unknown("gait parameter", unfit[0], known))
        return replace(self, **parameters)  # type: ignore[type-var]

    def check(self) -> None:
        """Refuse a name, a clock or a wound that cannot be, by ValueError."""
        if not (isinstance(self.name, str) and 0 < len(self.name) <= LONG):
            raise ValueError(f"a path's name has 1 to {LONG} letters, not {shown(self.name)}")
        for name in ("step_frequency", "slowdown"):
            value = getattr(self, name)
            if not (isinstance(value, Real) and isfinite(value)):
                raise ValueError(f"{name} of a path must be a finite number, not {shown(value)}")
        if self.slowdown < 1 or self.slowdown != int(self.slowdown):
            raise ValueError(f"slowdown counts ticks, from 1 up; it is {self.slowdown}")
        if not isinstance(self.wound, Mapping):
            raise ValueError(f"a wound is {{joint: mobility}}, not {shown(self.wound)}")
        for joint, value in self.wound.items():
            if not (isinstance(value, Real) and 0 <= value <= 1):
                said = f"must be from 0 to 1, not {shown(value)}"
                raise ValueError(f"the mobility of {shown(joint)} {said}")


class NamedMotion(Motion):
    """A motion that has targets for effectors by their names.

    names  k names, in the order of `at`
    floor  height of its ground [m]
    """

    floor: Any

    def at(self, phase: float) -> Array:
        """Return the targets of `names` at that phase [rad], (k, 3) [m]."""
        raise NotImplementedError

    def on(self, tree: Tree, effectors: Effectors) -> "Course":
        """Fit this motion to a body.

        It may have fewer effectors than there are targets. ValueError names one that has none.
        """
        if strange := [name for name in effectors.names if name not in self.names]:
            raise ValueError(
                f"{shown(self.name)} moves targets for {shown(', '.join(self.names))}, and none"
                f" for {shown(strange[0])}"
            )
        order = [self.names.index(name) for name in effectors.names]

        def at(phase: float) -> Array:
            return self.at(phase)[order]

        def wish(phase: float) -> Array | None:
            return self.wish(tree, phase)

        return Course(at, float(self.floor), wish=wish)


@dataclass(frozen=True, eq=False)
class Path(Motion):
    """A motion of k targets along curves of their own.

    `change` makes variants.

    curve           a function: from the phase [rad], of which 2π are once round, to the targets
                    (k, 3) [m]
    name            its name
    speed           phase per second of its time [rad/s]
    step_frequency  seconds of its time per second of clock time
    slowdown        ticks that one leap waits for and makes up for; 1 is smooth
    wound           mobility by joint name; empty for a sound body
    """

    curve: Callable[[float], ArrayLike]
    name: str = "path"
    speed: float = 1.0
    step_frequency: float = 1.0
    slowdown: int = 1
    wound: Mapping[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        function("the curve of a path", self.curve)
        self.check()
        if not (isinstance(self.speed, Real) and isfinite(self.speed)):
            raise ValueError(f"speed of a path must be a finite number, not {shown(self.speed)}")

    @property
    def rate(self) -> float:
        """Phase per second of its time [rad/s]."""
        return self.speed

    @classmethod
    def through(cls, points: ArrayLike, name: str = "path", **others: float) -> "Path":
        """Make a closed path straight from point to point.

        The points are (T, k, 3) [m], and it goes back to the first. Once round takes 2π of phase,
        whatever the lengths. `others` are fields of a path.
        """
        stops = frozen(numbers("points of a path", points))
        if stops.ndim != 3 or stops.shape[-1] != 3 or not len(stops):
            raise ValueError(f"a path goes through points (T, k, 3), not {stops.shape}")
        if not np.isfinite(stops).all():
            raise ValueError("the points of a path must be finite numbers")

        def curve(phase: float) -> Array:
            along = len(stops) * (phase / (2 * pi) % 1)
            i, share = int(along) % len(stops), along % 1
            return np.asarray((1 - share) * stops[i] + share * stops[(i + 1) % len(stops)])

        return cls(curve, name, **others)  # type: ignore[arg-type]

    def at(self, phase: float) -> Array:
        """Return the targets at that phase [rad], (k, 3) [m].

        ValueError if the curve gives none.
        """
        targets = numbers(f"targets of {self.name!r}", self.curve(phase))
        if targets.ndim != 2 or targets.shape[-1] != 3:
            raise ValueError(f"{self.name!r} must give targets (k, 3), not {targets.shape}")
        return targets

    def on(self, tree: Tree, effectors: Effectors) -> "Course":
        """Fit this motion to a body.

        ValueError if it has not a target for each effector.
        """
        targets = self.at(0.0)
        if len(targets) != len(effectors):
            raise ValueError(
                f"{self.name!r} gives {len(targets)} targets, and this figure has"
                f" {len(effectors)} effectors: {shown(', '.join(effectors.names))}"
            )
        rest = forward(tree, tree.rest)
        points = np.concatenate([rest.positions, locate(rest, effectors)[effectors.w == 1]])
        return Course(self.at, float(points[:, 1].min()))


def no_wish(phase: float) -> None:
    """Wish for nothing."""


@dataclass(frozen=True)
class Course:
    """A motion as a body has it, in its place and size.

    at     from the phase [rad] to targets (k, 3) [m], in the order of its effectors
    floor  height of the ground under it [m]
    size   the factor of all lengths of the motion
    wish   from the phase to the pose (n,) that is wished for beside the targets, or None
    """

    at: Callable[[float], Array]
    floor: float
    size: float = 1.0
    wish: Callable[[float], Array | None] = no_wish


def swinging(tree: Tree, effectors: Effectors) -> Path:
    """Make the path of effectors whose joints all swing.

    The joints swing about their rest. So every target is within reach at every moment, of any body.
    Joints at an odd depth swing twice as often, so that hands do not come back the way they went.
    """
    wide = np.where(tree.slide, SWING * extent(tree, effectors).radius / 2, SWING)
    up = np.minimum(tree.upper - tree.rest, wide)
    down = np.minimum(tree.rest - tree.lower, wide)
    often = np.array([2 - len(tree.above(joint)) % 2 for joint in range(len(tree))])

    def curve(phase: float) -> Array:
        swing = np.sin(often * phase)
        theta = tree.rest + np.where(swing > 0, up, down) * swing
        return locate(forward(tree, theta), effectors)

    return Path(curve, "swinging")
