"""Chapter 7. Gait as the thesis has it: four targets that swing as sinusoids of time.

    z = amplitude · sin(speed · T),   x and y constant

T advances by `step_frequency` · dt a tick, in leaps of `slowdown` ticks (Buss's demonstration, on
which the thesis builds, calls a larger slowdown "larger, less frequent steps").

The thesis does not print its constants. These are chosen so that its own statement holds on
`human()` with its limits: walking, both feet can always reach and both hands never; running, none
of the four can. `tests/motion/test_gait.py` proves it by bounded least squares.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from math import isfinite, pi
from numbers import Real

import numpy as np

from ikteach.arrays import Array, ArrayLike, Mask
from ikteach.body import Effectors, Tree
from ikteach.body.figures import human, simulator
from ikteach.checks import common_batch, count, number, numbers, shown
from ikteach.motion.path import Course, Motion
from ikteach.names import unknown

# A wound of the right leg, as joint: mobility. The thesis (5.2.3) wounds by weights on joints.
WOUND: Mapping[str, float] = {"hip.bend.r": 0.5, "knee.r": 0.1, "ankle.r": 0.1}
LIMBS = ("foot.l", "foot.r", "hand.r", "hand.l")  # whose targets a gait moves, in its order
ALIKE = 1e-3  # share of its length by which a limb may differ from a human's of another size


@dataclass(frozen=True)
class Gait(Motion):
    """One motion with all its parameters; `dataclasses.replace` makes variants.

    speed            ω in sin(ω T) [rad/s]
    step_frequency   seconds of gait time T a second of clock time
    slowdown         ticks that one leap of T waits for and makes up for; 1 is smooth
    back_z_leg, front_z_leg   amplitudes of the feet, left (target 0) and right (target 1) [m]
    back_y_leg, front_y_leg   their heights, under the pelvis [m]
    hand_z           amplitude of the right hand (target 2); the left one swings against it [m]
    back_y_hand, front_y_hand   heights of the right hand and of the left one [m]
    x_leg, x_hand    how far to the side the targets are [m]
    forward          move forward through the world instead of in place
    wound            mobility by joint name; empty for a sound body
    """

    name: str
    speed: float
    back_z_leg: float
    front_z_leg: float
    back_y_leg: float
    front_y_leg: float
    hand_z: float
    back_y_hand: float
    front_y_hand: float
    step_frequency: float = 1.0
    slowdown: int = 1
    x_leg: float = 0.35
    x_hand: float = 0.8
    forward: bool = False
    wound: Mapping[str, float] = field(default_factory=dict)

    names = LIMBS

    def __post_init__(self) -> None:
        if not isinstance(self.name, str):
            raise ValueError(f"the name of a gait is a text, not {shown(self.name)}")
        for name, value in vars(self).items():
            if name not in ("name", "wound") and not (isinstance(value, Real) and isfinite(value)):
                of = f"{name} of {shown(self.name)}"
                raise ValueError(f"{of} is {shown(value)}; it must be a finite number")
        if self.slowdown < 1 or self.slowdown != int(self.slowdown):
            raise ValueError(f"slowdown counts ticks, from 1 up; it is {shown(self.slowdown)}")
        if not isinstance(self.wound, Mapping):
            raise ValueError(f"a wound is {{joint: mobility}}, not {shown(self.wound)}")
        for joint, value in self.wound.items():
            if not (isinstance(value, Real) and 0 <= value <= 1):
                of = f"the mobility of {shown(joint)}"
                raise ValueError(f"{of} must be from 0 to 1, not {shown(value)}")

    def __call__(self, T: ArrayLike) -> Array:
        """Find the targets at gait times T (...) [s], (..., 4, 3) [m], seen from the pelvis.

        Order: left foot, right foot, right hand, left hand. Source: thesis 5.1, 5.2.
        """
        return self.at(self.speed * numbers("T", T))

    def at(self, phase: ArrayLike) -> Array:
        """Return the targets at sin(`phase`), phase (...) [rad], (..., 4, 3) [m]."""
        phase = numbers("the phase", phase)
        if not np.isfinite(phase).all():
            raise ValueError("the phase of a gait must be finite")
        swing = np.sin(phase)
        z = [self.back_z_leg, self.front_z_leg, -self.hand_z, self.hand_z]
        targets = np.empty((*swing.shape, 4, 3))
        targets[..., 0] = [self.x_leg, -self.x_leg, -self.x_hand, self.x_hand]
        targets[..., 1] = [self.back_y_leg, self.front_y_leg, self.back_y_hand, self.front_y_hand]
        targets[..., 2] = swing[..., None] * z
        return targets

    @property
    def floor(self) -> float:
        """Height of the ground, under the lower foot [m]."""
        return min(self.back_y_leg, self.front_y_leg)

    def stands(self, phase: ArrayLike) -> Mask:
        """Say which of `names` stand at phases (...), (..., 4).

        Feet that go back would; these never lift.
        """
        ahead = np.cos(numbers("the phase", phase)) * np.sign(self.speed)
        left, right = self.back_z_leg * ahead < 0, self.front_z_leg * ahead < 0
        never = np.zeros(left.shape, dtype=bool)
        return np.stack([left, right, never, never], axis=-1)

    def on(self, tree: Tree, effectors: Effectors) -> Course:
        """Fit this gait to a body.

        It goes by the body's size, from its pelvis. A body with the limbs of a human in other
        proportions is given the lengths as they are. ValueError if one of its effectors is no foot
        and no hand.
        """
        if strange := [name for name in effectors.names if name not in LIMBS]:
            raise ValueError(
                f"{self.name!r} moves targets for {', '.join(LIMBS)}, and none for"
                f" {shown(strange[0])}: only a figure with such limbs can walk; give others a Path"
            )
        order = [LIMBS.index(name) for name in effectors.names]
        unit, pelvis = stature(tree, effectors) or (1.0, np.zeros(3))

        def at(phase: float) -> Array:
            return np.asarray(pelvis + unit * self.at(phase)[order])

        ours = order == [*range(len(LIMBS))] and unit == 1 and not np.any(pelvis)
        return Course(self.at if ours else at, float(pelvis[1] + unit * self.floor), unit)

    def clock(self, frames: int, dt: float = 1 / 30) -> Array:
        """Return the gait time T at the end of each tick, (frames,) [s]."""
        leaps = np.arange(1.0, count("frames", frames, least=0) + 1) // self.slowdown
        return self.step_frequency * number("dt", dt) * self.slowdown * leaps

    @property
    def rate(self) -> float:
        """Phase per second of gait time [rad/s]: ω."""
        return self.speed

    @property
    def pace(self) -> float:
        """Speed forward that fits the feet on average [m/s].

        A foot's backward swing is then, on average, still on the ground. It goes over 2A in half a
        cycle. Sinusoidal feet slip all the same: they go by the mean and never lift.
        """
        stride = abs(self.back_z_leg) + abs(self.front_z_leg)  # 2A when both feet swing alike
        return stride * abs(self.speed) / pi

    def advance(self, T: ArrayLike) -> Array:
        """Return the pelvis's way forward at gait times T (...), (..., 3) [m]."""
        T = numbers("T", T)
        moved = np.zeros((*T.shape, 3))
        moved[..., 2] = self.pace * T if self.forward else 0.0
        return moved


walking = Gait(
    "walking",
    speed=5.6,
    back_z_leg=-0.25,
    front_z_leg=0.25,
    back_y_leg=-0.88,
    front_y_leg=-0.88,
    hand_z=0.3,
    back_y_hand=-0.2,
    front_y_hand=-0.2,
)
running = Gait(
    "running",
    speed=9.0,
    back_z_leg=-0.5,
    front_z_leg=0.5,
    back_y_leg=-1.1,
    front_y_leg=-1.1,
    hand_z=1.0,
    back_y_hand=0.0,
    front_y_hand=0.0,
)


def stature(tree: Tree, effectors: Effectors) -> tuple[float, Array] | None:
    """Compare a body with a human.

    Return its size as a multiple of a human's, and where its pelvis is (3,) [m]; None if its limbs,
    by the names of their ends, are not in a human's proportions.
    """
    for like in human(), simulator():
        if not set(effectors.names) <= set(like.effectors.names):
            continue
        ours, theirs = (_limbs(*one, effectors.names) for one in ((tree, effectors), like))
        if [len(limb) for limb in ours] != [len(limb) for limb in theirs]:
            continue
        a, b = (np.concatenate([limb[1:] for limb in limbs]) for limbs in (ours, theirs))
        unit = float((a * b).sum() / (b * b).sum())
        pelvis = [limb[0] - unit * other[0] for limb, other in zip(ours, theirs, strict=True)]
        differ = max(abs(a - unit * b).max(), float(np.ptp(pelvis, axis=0).max()))
        if unit > 0 and differ <= ALIKE * unit:
            if abs(unit - 1) < 1e-9 and not np.any(pelvis):
                return 1.0, np.zeros(3)  # a human, to the last bit
            return unit, np.asarray(pelvis[0])
    return None


def _limbs(tree: Tree, effectors: Effectors, names: Iterable[str]) -> list[Array]:
    """Find the links (links, 3) from the ground to each of these effectors, at θ = 0 [m]."""
    rows = [effectors.names.index(name) for name in names]
    return [
        np.array([*tree.offsets[tree.above(int(effectors.joints[i]))[::-1]], effectors.offsets[i]])
        for i in rows
    ]


class Motions(dict[str, Gait]):
    """Gaits by name.

    An unknown name is answered with the names that may have been meant.
    """

    def __missing__(self, name: str) -> Gait:
        raise LookupError(unknown("motion", name, self))


MOTIONS = Motions(walking=walking, running=running)


def displayed(theta: ArrayLike, *, times: ArrayLike = 1.0, plus: ArrayLike = 0.0) -> Array:
    """Weigh a pose as the thesis draws a wounded body.

    It is θ × weight + weight, joint by joint. The solver never hears of it (thesis 5.1.1, 5.2.3),
    so that the drawn pose misses targets that the logged one has reached. `Gait.wound` says it to
    the solver instead.
    """
    theta, times, plus = (
        numbers(name, value) for name, value in (("theta", theta), ("times", times), ("plus", plus))
    )
    common_batch("theta, times and plus", theta.shape, times.shape, plus.shape)
    return theta * times + plus
