"""Chapter 11. A walk with stance and swing: the feet roll over heel, ball and toes.

Every foot stands for the share `duty` of its cycle. It comes down on the heel, tilted by `strike`;
lies flat; rises on its ball while the toes stay down; leaves at the tilt `push_off`. While it
stands, the point that it stands on does not move. Between, the ankle goes along a cubic curve from
where it leaves to where it comes down, with the speeds that it has there, and higher by `lift`.

All is seen from a frame that goes along with the walk's pace: the pelvis stays near the origin and
the ground goes by, as on a treadmill.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from functools import lru_cache
from math import isfinite, pi
from numbers import Real

import numpy as np

from ikteach.arrays import Array, ArrayLike, Mask, frozen
from ikteach.body import Tree, forward
from ikteach.body.figures import BALL, GAZE, HEEL, walker
from ikteach.checks import number, numbers, shown
from ikteach.motion.path import NamedMotion
from ikteach.motion.paths.stroke import rounded

NAMES = ("pelvis", "heel.l", "ball.l", "heel.r", "ball.r", "pelvis.up", "pelvis.ahead")
SIDES = (("l", 1, 0.0), ("r", -1, 0.5))  # name, where x is, cycles behind the left foot
SAMPLES = 1000  # of a cycle, in tables
SMOOTH = 0.015  # standard deviation of what rounds its corners [cycles]
FLAT = 0.5  # a foot that is tilted less lies on heel and ball [degrees]
EASE = 0.2  # height of the ball at which toes no longer keep level [m]
HERE = 1e-4  # step of a difference in time [cycles]

SPEEDS = 0.4, 2.0  # at which people walk [m/s]
WALK_RATIO = 0.0058  # step length over cadence [m min]
SINKS, BENT = 0.0025, 0.008  # steps by which a pelvis is lowered; what a bent knee spares [m]
SHAPE = ("duty", "reach", "lift", "strike", "push_off", "bob", "tilt", "height")

LEAST = {"cadence": 1.0, "duty": 0.51, "lift": 0.0, "lift_at": 0.05, "height": 0.5}
MOST = {"cadence": 400.0, "duty": 0.9, "lift": 0.3, "lift_at": 0.6, "height": 1.1}


@dataclass(frozen=True, eq=False)
class Walk(NamedMotion):
    """A walk in a straight line; `change` makes variants.

    speed          of the pelvis [m/s]
    cadence        steps a minute
    duty           share of its cycle for which a foot stands; both stand for 2 duty − 1 of it
    lift, lift_at  height of the ankle over its straight way, and when [m, share of the swing]
    strike         tilt of the foot where the heel comes down, toes up [degrees]
    push_off       and where the toes leave, below 0
    reach          where the heel comes down, ahead of the pelvis [m]
    step_width, toe_out   between the heels [m], and how far feet point outwards [degrees]
    height         of the pelvis on average over the ground [m]
    bob, bob_at, sway, surge   how far it goes up (when, in cycles), sideways and ahead [m]
    tilt, turn, drop   of the pelvis: forwards, and its swings about y and z [degrees]
    lean, twist    of the trunk over the pelvis [degrees]
    arm, arm_back, elbow, elbow_swing   swings of the arms and their means [degrees]

    Source of the parts: Perry & Burnfield, Gait Analysis, 2010. The values are chosen so that the
    figure comes near the norms that it is then measured by (`quality.gait_score`): such a score
    says how well it was fitted, not how well it foretells.
    """

    name: str = "natural"
    speed: float = 1.3
    cadence: float = 112.0
    duty: float = 0.6
    lift: float = 0.085
    lift_at: float = 0.22
    strike: float = 14.0
    push_off: float = -70.0
    reach: float = 0.24
    step_width: float = 0.10
    toe_out: float = 7.0
    height: float = 0.92
    bob: float = 0.016
    bob_at: float = 0.31
    sway: float = 0.018
    surge: float = 0.008
    tilt: float = 11.0
    turn: float = 5.0
    drop: float = 4.5
    lean: float = 3.0
    twist: float = 3.0
    arm: float = 16.0
    arm_back: float = 8.0
    elbow: float = 36.0
    elbow_swing: float = 12.0
    step_frequency: float = 1.0
    slowdown: int = 1
    forward: bool = False
    wound: Mapping[str, float] = field(default_factory=dict)

    names = NAMES

    def __post_init__(self) -> None:
        self.check()
        for one in fields(self):
            value = getattr(self, one.name)
            if one.name in ("name", "wound", "slowdown", "step_frequency"):
                continue
            of = f"{one.name} of {shown(self.name)}"
            if not (isinstance(value, Real) and isfinite(value)):
                raise ValueError(f"{of} must be a finite number, not {shown(value)}")
            value = float(value)
            least, most = LEAST.get(one.name, -np.inf), MOST.get(one.name, np.inf)
            if not least <= value <= most:
                raise ValueError(f"{of} goes from {least:g} to {most:g}; it is {value:g}")

    @property
    def rate(self) -> float:
        """Phase per second [rad/s]: a cycle is two steps."""
        return 2 * pi * self.cadence / 120

    @property
    def pace(self) -> float:
        """Speed at which the ground goes by [m/s]."""
        return self.speed

    @property
    def floor(self) -> float:
        """Height of the ground under the pelvis [m]."""
        return -self.height

    @property
    def stride(self) -> float:
        """Way of a cycle [m]."""
        return self.speed * 120 / self.cadence

    @property
    def spare(self) -> float:
        """How much longer a walker's legs are than it needs [m].

        It is about its longest reach; below 0 they are too short for its stride.
        """
        q = np.arange(0, SAMPLES, 10) / SAMPLES
        p, R = self.pelvis(q)
        hips, leg = legs()
        far = [
            np.linalg.norm(self._ankle((q - late) % 1, x)[0] - p - R @ hip, axis=-1).max()
            for (_, x, late), hip in zip(SIDES, hips, strict=True)
        ]
        return leg - float(max(far))

    def at(self, phase: ArrayLike) -> Array:
        """Return the targets `NAMES` at phases (...) [rad], (..., 7, 3) [m].

        At phase 0 the left heel comes down.
        """
        return around(targets_of(self), numbers("the phase", phase))

    def wish(self, tree: Tree, phase: ArrayLike) -> Array:
        """Return the pose (..., n) of trunk, arms and toes at phases (...) [rad].

        No target asks for it. The other joints would be at rest.
        """
        return around(wishes_of(self, tree), numbers("the phase", phase))

    def plan(self, q: Array) -> Array:
        """Work out the targets (..., 7, 3) after q (...) cycles [m]."""
        p, R = self.pelvis(q)
        feet = [point for _, x, late in SIDES for point in self._foot((q - late) % 1, x)]
        up, ahead = GAZE * R[..., 1], GAZE * R[..., 2]
        return np.stack([p, *feet, up, ahead], axis=-2)

    def stands(self, phase: ArrayLike) -> Mask:
        """Say which of `NAMES` stand on the ground at phases (...), (..., 7)."""
        q = numbers("the phase", phase) / (2 * pi)
        still = np.zeros(q.shape, dtype=bool)
        each = [still]
        for _, _, late in SIDES:
            u = (q - late) % 1
            down, tilt = u <= self.duty, self._tilt(u)
            each += [down & (tilt >= -FLAT), down & (tilt <= FLAT)]
        return np.stack([*each, still, still], axis=-1)

    def pelvis(self, q: Array) -> tuple[Array, Array]:
        """Find place (..., 3) [m] and turn (..., 3, 3) of the pelvis after q (...) cycles."""
        place = [
            self.sway * wave(q - 0.3),
            self.bob * wave(2 * (q - self.bob_at)),
            self.surge * wave(2 * (q - 0.175)),
        ]
        turn = turned("y", -self.turn * wave(q)) @ turned("z", self.drop * wave(q - 0.15))
        return np.stack(place, axis=-1), turn @ turned("x", np.full(q.shape, self.tilt))

    def posture(self, tree: Tree, q: Array) -> Array:
        """Work out the pose (..., n) that is wished for after q (...) cycles [rad]."""
        degrees = {
            "spine.bend": np.full(q.shape, self.lean - self.tilt),
            "spine.twist": (self.turn + self.twist) * wave(q),
        }
        for side, x, late in SIDES:
            degrees[f"shoulder.bend.{side}"] = -self.arm_back - self.arm * wave(q - late - 0.02)
            degrees[f"shoulder.out.{side}"] = np.full(q.shape, 8.0)
            degrees[f"toes.{side}"] = self._bend((q - late) % 1, x)
            degrees[f"elbow.{side}"] = self.elbow - self.elbow_swing * wave(q - late - 0.05)
        theta = np.tile(tree.rest, (*q.shape, 1))
        for name, angle in degrees.items():
            if name in tree.names:
                theta[..., tree.index(name)] = np.radians(angle)
        return np.asarray(np.clip(theta, tree.lower, tree.upper))

    # A foot, in cycles u since it came down; x is 1 on the left and −1 on the right.

    def _tilt(self, u: Array) -> Array:
        """Find how far the foot is tilted, toes up, (...) [degrees]."""
        table = tilts(self.duty, self.strike, self.push_off)
        return np.interp(u % 1, np.arange(SAMPLES + 1) / SAMPLES, table)

    def _ankle(self, u: Array, x: int) -> tuple[Array, Array]:
        """Find place (..., 3) [m] and turn (..., 3, 3) of a foot."""
        flat = turned("y", np.asarray(x * self.toe_out))
        place = np.where((u <= self.duty)[..., None], self._stance(u, x), self._swing(u, x))
        return place, flat @ turned("x", -self._tilt(u))

    def _foot(self, u: Array, x: int) -> tuple[Array, Array]:
        """Place heel and ball of a foot, (..., 3) each [m]."""
        ankle, R = self._ankle(u, x)
        return ankle + R @ HEEL, ankle + R @ BALL

    def _bend(self, u: Array, x: int) -> Array:
        """Find how far the toes bend up, (...) [degrees].

        On the ground they keep level; the higher a foot is that points down, the more they follow.
        """
        tilt = self._tilt(u)
        h = np.clip((self._foot(u, x)[1][..., 1] + self.height) / EASE, 0, 1)
        return np.where(tilt < 0, -tilt * (1 - h * h * (3 - 2 * h)), 0)

    def _stance(self, u: Array, x: int) -> Array:
        """Place the ankle while the foot stands, (..., 3) [m]; the ground goes by."""
        flat, tilt = turned("y", np.asarray(x * self.toe_out)), self._tilt(u)
        R = flat @ turned("x", -tilt)
        heel = np.array([x * self.step_width / 2, -self.height, self.reach])
        ball = heel + flat @ (np.subtract(BALL, HEEL))
        ankle = np.where((tilt >= 0)[..., None], heel - R @ HEEL, ball - R @ BALL)
        ankle[..., 2] -= u * self.stride
        return ankle

    def _swing(self, u: Array, x: int) -> Array:
        """Place the ankle while the foot swings, (..., 3) [m]."""
        leaves, lands = (self._stance(np.array(at), x) for at in (self.duty, 0.0))
        off = (leaves - self._stance(np.array(self.duty - HERE), x)) / HERE
        on = (self._stance(np.array(HERE), x) - lands) / HERE
        span = 1 - self.duty
        w = np.clip((u - self.duty) / span, 0, 1)
        at = hermite(w, leaves, span * off, lands, span * on)
        n = 2 * (1 - self.lift_at) / self.lift_at  # so that w² (1 − w)ⁿ is highest there
        highest = self.lift_at**2 * (1 - self.lift_at) ** n
        at[..., 1] += self.lift * w**2 * (1 - w) ** n / highest
        return at


natural = Walk()
slow = Walk(
    "slow",
    speed=0.95,
    cadence=100.0,
    duty=0.61,
    height=0.925,
    reach=0.18,
    lift=0.08,
    strike=5.0,
    push_off=-60.0,
    bob=0.007,
    tilt=9.5,
)
fast = Walk("fast", speed=1.5, cadence=126.0, reach=0.25, bob=0.012, strike=18.0)
WALKS: Mapping[str, Walk] = {"slow": slow, "natural": natural, "fast": fast}  # as the norms are


def at_speed(speed: float) -> Walk:
    """Make the walk of that speed [m/s], as people change theirs.

    Step length over cadence stays the same (Sekiya & Nagasaki 1998, Gait & Posture 7:225); the
    other parameters are between those of `WALKS`, and the pelvis sinks until the legs reach.
    ValueError beyond 0.4 and 2 m/s.
    """
    if not SPEEDS[0] <= (speed := number("speed", speed)) <= SPEEDS[1]:
        raise ValueError(f"people walk at {SPEEDS[0]:g} to {SPEEDS[1]:g} m/s, not {speed:g}")
    known = [walk.speed for walk in WALKS.values()]
    between = {
        name: float(np.interp(speed, known, [getattr(walk, name) for walk in WALKS.values()]))
        for name in SHAPE
    }
    cadence = float(np.sqrt(60 * speed / WALK_RATIO))
    walk = natural.change(**between, speed=speed, cadence=cadence)
    while walk.spare < BENT:
        walk = walk.change(height=walk.height - SINKS)
    return walk


@lru_cache(maxsize=1)
def legs() -> tuple[Array, float]:
    """Find a walker's hips, and the length of its leg [m].

    The hips (2, 3) are seen from its pelvis.
    """
    tree = walker().tree
    p = forward(tree, np.zeros(len(tree))).positions
    at = {name: p[tree.index(name)] for name in tree.names}
    hips = np.array([at[f"hip.turn.{side}"] - at["pelvis.z"] for side, *_ in SIDES])
    chain = np.array([at[f"{part}.l"] for part in ("hip.turn", "knee", "foot")])
    return frozen(hips), float(np.linalg.norm(np.diff(chain, axis=0), axis=1).sum())


@lru_cache(maxsize=32)
def targets_of(walk: Walk) -> Array:
    """Make a table of a walk's targets over a cycle, (SAMPLES + 1, 7, 3)."""
    return frozen(walk.plan(np.arange(SAMPLES + 1) / SAMPLES))


@lru_cache(maxsize=32)
def wishes_of(walk: Walk, tree: Tree) -> Array:
    """Make a table of a walk's wishes over a cycle, (SAMPLES + 1, n)."""
    return frozen(walk.posture(tree, np.arange(SAMPLES + 1) / SAMPLES))


def around(table: Array, phase: Array) -> Array:
    """Read a table of a cycle (SAMPLES + 1, ...) at phases (...) [rad].

    It is straight between its entries.
    """
    along = SAMPLES * (phase / (2 * pi) % 1)
    i = np.minimum(along.astype(int), SAMPLES - 1)
    share = (along - i).reshape(*along.shape, *[1] * (table.ndim - 1))
    return np.asarray((1 - share) * table[i] + share * table[i + 1])


def wave(q: ArrayLike) -> Array:
    """Return cos 2πq."""
    return np.cos(2 * pi * np.asarray(q))


def hermite(w: Array, a: Array, v: Array, b: Array, u: Array) -> Array:
    """Go from a with speed v to b with speed u, (..., 3).

    w (...) goes from 0 to 1.
    """
    w = w[..., None]
    go = (1 + 2 * w) * (1 - w) ** 2 * a + w * (1 - w) ** 2 * v
    return np.asarray(go + w**2 * (3 - 2 * w) * b + w**2 * (w - 1) * u)


def turned(axis: str, degrees: Array) -> Array:
    """Return turns (..., 3, 3) about x, y or z by (...) degrees."""
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    o, one = np.zeros_like(c), np.ones_like(c)
    rows = {
        "x": [one, o, o, o, c, -s, o, s, c],
        "y": [c, o, s, o, one, o, -s, o, c],
        "z": [c, -s, o, s, c, o, o, o, one],
    }[axis]
    return np.stack(rows, axis=-1).reshape(*c.shape, 3, 3)


@lru_cache(maxsize=64)
def tilts(duty: float, strike: float, push_off: float) -> Array:
    """Make a table of the foot's tilt over a cycle, (SAMPLES + 1,) [degrees].

    Straight from corner to corner, the corners rounded; they are at shares of stance and swing.
    """
    stance = {0.0: strike, 0.14: 0.0, 0.6: 0.0, 0.78: 0.17 * push_off, 0.92: 0.5 * push_off}
    swing = {
        **{0.0: 0.84 * push_off, 0.09: push_off, 0.42: 0.53 * push_off},
        **{0.7: 0.25 * strike, 0.88: 1.15 * strike},
    }
    at = [*(duty * u for u in stance), *(duty + (1 - duty) * u for u in swing)]
    u = np.arange(SAMPLES) / SAMPLES
    straight = np.interp(u, at, [*stance.values(), *swing.values()], period=1)
    smooth = rounded(straight, SMOOTH)
    return frozen([*smooth, smooth[0]])
