"""Targets that go along curves, for any figure, as a gait is for a human."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from math import isfinite, pi
from numbers import Real

import numpy as np

from ikteach.arrays import Array, ArrayLike, frozen
from ikteach.body import Effectors, Tree, forward, locate
from ikteach.body.extent import extent
from ikteach.checks import LONG, function, numbers, shown

SWING = 0.5  # how far a hinge turns to either side of its rest [rad]; a slide, as share of the body


@dataclass(frozen=True, eq=False)
class Path:
    """A motion of k targets along curves of their own.

    `dataclasses.replace` makes variants.

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

    forward = False  # it is seen from where the figure is fixed
    pace = 0.0

    def __post_init__(self) -> None:
        function("the curve of a path", self.curve)
        if not (isinstance(self.name, str) and 0 < len(self.name) <= LONG):
            raise ValueError(f"a path's name has 1 to {LONG} letters, not {shown(self.name)}")
        for name in ("speed", "step_frequency", "slowdown"):
            value = getattr(self, name)
            if not (isinstance(value, Real) and isfinite(value)):
                raise ValueError(f"{name} of a path must be a finite number, not {shown(value)}")
        if self.slowdown < 1 or self.slowdown != int(self.slowdown):
            raise ValueError(f"slowdown counts ticks, from 1 up; it is {self.slowdown}")
        for joint, value in self.wound.items():
            if not 0 <= value <= 1:
                raise ValueError(f"the mobility of {joint!r} must be from 0 to 1, not {value}")

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

    def mobility(self, tree: Tree) -> Array:
        """Return the tree's mobility with the wound in it, (n,).

        LookupError for an unknown joint.
        """
        s = tree.mobility.copy()
        for joint, value in self.wound.items():
            s[tree.index(joint)] = value
        return s


@dataclass(frozen=True)
class Course:
    """A motion as a body has it, in its place and size.

    at     from the phase [rad] to targets (k, 3) [m], in the order of its effectors
    floor  height of the ground under it [m]
    size   the factor of all lengths of the motion
    """

    at: Callable[[float], Array]
    floor: float
    size: float = 1.0


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
