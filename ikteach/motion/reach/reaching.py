"""Chapter 10. The simulator of CS 490 as a session: one cursor, one clock, a pose for each way.

It also says how a run ends. A tick depends on pose and cursor alone, so that a pose which does not
change any more never will, and poses that come back come back for ever.
"""

from collections import deque
from collections.abc import Mapping
from math import radians
from typing import Any, NamedTuple

import numpy as np

from ikteach.arrays import Array, ArrayLike, Index, Mask
from ikteach.body import Effectors, Tree
from ikteach.checks import count as count_of
from ikteach.checks import number, numbers, shown
from ikteach.motion.reach.packages import (
    MIDDLE,
    NONE,
    PACKAGES,
    ReachingFigure,
    backs_reach,
    both_reach,
)
from ikteach.motion.reach.ways import (
    ARRIVED,
    MAX_STEP,
    PARTS,
    SINGULAR,
    WAYS,
    Tick,
    Way,
    Ways,
    advance,
    checked_parts,
    checked_way,
    hands,
    which,
)

ROOM = np.array([[-1.0, -1.0, -0.8], [1.0, 1.3, 1.2]])  # where a cursor can be [m]
EVERYWHERE = np.array([[-np.inf] * 3, [np.inf] * 3])
START = (-0.35, 0.25, 0.35)  # [m]; within reach of the right arm
STILL = radians(1e-3)  # a tick that turns no joint further has come to rest
SWAY = radians(0.2)  # a pose that comes and goes by less is at rest, too
LONGEST = 75  # ticks of the longest cycle that is looked for
PATIENCE = 300  # ticks before a run that goes on is said not to settle
LOOK_EVERY = 10  # ticks


def period(poses: ArrayLike, longest: int = LONGEST) -> Index:
    """Return the period of poses at their end, in ticks.

    The poses are (T, ..., n), the periods (...), 0 where poses do not repeat themselves.

    The last p ≥ 2 ticks have to be the p before them, to a tenth of how far they range, and to
    range over more than `SWAY`. The smallest such p is returned.
    """
    poses = numbers("poses", poses)
    found = np.zeros(poses.shape[1:-1], dtype=np.intp)
    for p in range(min(longest, len(poses) // 2), 1, -1):
        last, before = poses[-p:], poses[-2 * p : -p]
        apart = abs(last - before).max(axis=(0, -1))
        extent = np.ptp(last, axis=0).max(axis=-1)
        found[(extent > SWAY) & (apart < 0.1 * extent)] = p
    return found


class Standing:
    """The standing of one way since the cursor moved.

    ticks    since the cursor moved
    arrived  the tick since which the hand has been within a centimetre, or None
    largest  the largest step of a joint in one tick, the neck's left out [rad]
    moves    how far the last tick turned the joint that it turned most [rad]
    period   ticks after which the poses repeat themselves; 0: they do not
    """

    def __init__(self, tick: Tick) -> None:
        self.tick = tick
        self.begin()

    def begin(self) -> None:
        """Count from now on, as the cursor has moved."""
        self.ticks = self.period = 0
        self.arrived: int | None = None
        self.largest = self.moves = 0.0
        self.poses: deque[Array] = deque([self.tick.theta], maxlen=2 * LONGEST)

    def take(self, tick: Tick, besides: int | None = None) -> None:
        """Note the outcome of one more tick.

        `besides` is a joint whose steps do not count.
        """
        turned = abs(tick.theta - self.tick.theta)
        if besides is not None:
            turned[besides] = 0
        self.tick, self.moves = tick, float(turned.max())
        self.ticks += 1
        self.largest = max(self.largest, self.moves)
        self.poses.append(tick.theta)
        if tick.distance > ARRIVED:
            self.arrived = None
        elif self.arrived is None:
            self.arrived = self.ticks
        if self.moves <= STILL:
            self.period = 0
        elif self.ticks % LOOK_EVERY == 0:
            self.period = int(period(np.array(self.poses)))

    @property
    def settled(self) -> bool:
        """Whether nothing moves any more."""
        return self.ticks > 0 and self.moves <= STILL

    @property
    def words(self) -> str:
        """How it stands, in words."""
        tick, rest = self.tick, self.moves <= STILL
        if not self.ticks:
            return "about to move"
        far = f"{100 * tick.distance:.1f} cm away"
        if self.period:
            return f"oscillates, {far}: its poses repeat every {self.period} ticks"
        if tick.package == NONE:
            return "does not answer: at rest" if rest else "does not answer: goes to rest"
        if self.ticks >= PATIENCE and not rest:
            return f"has not come to rest in {self.ticks} ticks, {far}"
        if self.arrived is not None:
            return f"arrived in {self.arrived} ticks"
        if tick.independence <= SINGULAR:
            return f"det is near 0: no step, {far}"
        return f"stuck {far}" if rest else "on its way"


def placed(cursor: ArrayLike, room: Array) -> Array:
    """Bring the cursor (3,) [m] between the corners of the room (2, 3)."""
    place = numbers("the cursor", cursor)
    if place.shape != (3,) or not np.isfinite(place).all():
        raise ValueError(f"a cursor is three finite numbers, not {shown(cursor)}")
    return np.clip(place, *room)


class Reaching:
    """A figure that reaches for a cursor, by every way.

    All ways reach at once, and one of them is shown.

    cursor    (3,) [m]; move it with `put` or `move`
    ways      {name: way}
    method    the name of the one that is shown
    parts, max_step   into how many parts the error is divided; the largest step of a tick [rad]
    dt        clock time of one tick [s]
    room      (2, 3) corners of where the cursor can be [m]
    standing  {name: Standing}

    A subclass says which cursors can be reached (`_look`), and how a way goes one step on
    (`_advance`).
    """

    tree: Tree
    effectors: Effectors
    neck: int | None = None  # a joint whose steps do not count: it only looks on

    def __init__(
        self,
        ways: Mapping[str, Any],
        room: Array,
        method: str,
        parts: int,
        max_step: float | None,
        dt: float,
        cursor: ArrayLike,
    ) -> None:
        self.ways, self.room = ways, room
        self.parts, self.dt = checked_parts(parts), number("dt", dt)
        self.max_step = None if max_step is None else number("max_step", max_step)
        self._start = cursor
        self.show(method)
        self.reset()

    def show(self, method: str) -> None:
        """Show the pose of `method`.

        LookupError for a name that is not among the ways.
        """
        self.ways[method]
        self.method = method

    def reset(self) -> None:
        """Go back to the rest pose.

        The cursor goes back to where it was at first.
        """
        nothing = np.asarray(np.nan)
        rest = Tick(self.tree.rest, np.asarray(NONE), nothing, nothing, nothing, nothing)
        self.ticks = 0
        self.standing = {name: Standing(rest) for name in self.ways}
        self.put(self._start)

    def put(self, cursor: ArrayLike) -> None:
        """Put the cursor to (3,) [m].

        It stays in the room: the nearest place in it is taken. ValueError if unfit.
        """
        self.cursor = placed(cursor, self.room)
        self._look()
        for one in self.standing.values():
            one.begin()

    def move(self, by: ArrayLike) -> None:
        """Move the cursor by (3,) [m]."""
        self.put(self.cursor + placed(by, EVERYWHERE))

    def tick(self) -> None:
        """Let one tick of the clock pass.

        Every way goes one step on.
        """
        done = {name: self._advance(name) for name in self.ways}
        self.ticks += 1
        for name, tick in done.items():  # only now: a solver that fails changes nothing
            self.standing[name].take(tick, self.neck)

    @property
    def theta(self) -> Array:
        """The pose of the shown method, (n,) [rad]."""
        return self.standing[self.method].tick.theta

    @property
    def settled(self) -> bool:
        """Whether nothing moves any more, by any method."""
        return all(one.settled for one in self.standing.values())

    @property
    def within(self) -> bool:
        """Whether the shown method can reach the cursor.

        The method then has a package, or an arm, that reaches it. White means yes, red no.
        """
        raise NotImplementedError

    @property
    def words(self) -> str:
        """The meaning of white or red here, in words."""
        raise NotImplementedError

    def _look(self) -> None:
        """Find out which hands or packages reach the cursor now."""
        raise NotImplementedError

    def _advance(self, name: str) -> Tick:
        """One step of a way, which changes nothing yet."""
        raise NotImplementedError


class Reach(Reaching):
    """The figure of CS 490, reaching.

    It reaches with the hand on the cursor's side; `ways` are `Way`s.
    """

    def __init__(
        self,
        ways: Mapping[str, Way] = WAYS,
        *,
        method: str = "cramer",
        parts: int = PARTS,
        max_step: float | None = MAX_STEP,
        dt: float = 1 / 30,
        cursor: ArrayLike = START,
    ) -> None:
        self.body = ReachingFigure()
        self.tree, self.neck = self.body.tree, self.body.neck
        super().__init__(Ways.of(ways), ROOM, method, parts, max_step, dt, cursor)

    @property
    def effectors(self) -> Effectors:  # type: ignore[override]
        """The hand on the cursor's side."""
        return self.body.hands[self.side]

    @property
    def side(self) -> str:
        """The side whose hand is nearer to the cursor's: "r" or "l"."""
        return "r" if self.cursor[0] < 0 else "l"

    @property
    def within(self) -> bool:
        """Whether the shown method can reach the cursor.

        The method then has a package, or an arm, that reaches it. White means yes, red no.
        """
        way = self.ways[self.method]
        return self._package(way) != NONE if way.packaged else self._arms[self.side]

    @property
    def words(self) -> str:
        """The meaning of white or red here, in words."""
        way, side = self.ways[self.method], {"r": "right", "l": "left"}[self.side]
        if not way.packaged:
            what = f"the {side} arm and back together"
            return f"within reach of {what}" if self.within else f"out of reach of {what}"
        number = self._package(way)
        if number != NONE:
            return f"within reach of the {PACKAGES[number].name}"
        if abs(self.cursor[0]) <= MIDDLE:
            return "in the middle, where no package answers"
        return "out of reach of every package"

    def _look(self) -> None:
        self._backs = backs_reach(self.body, self.cursor)
        self._arms = {side: bool(both_reach(self.body, side, self.cursor)) for side in "rl"}

    def _advance(self, name: str) -> Tick:
        return advance(
            self.body,
            self.standing[name].tick.theta,
            self.cursor,
            self.ways[name],
            parts=self.parts,
            max_step=self.max_step,
            backs=self._backs,
        )

    def _package(self, way: Way) -> int:
        theta = self.standing[self.method].tick.theta
        return int(which(self.body, theta, self.cursor, way, self._backs))


class Trial(NamedTuple):
    """The ends of runs from rest to cursors (...).

    The cursors stand still.

    distance  (...)  from hand to cursor at the end [m]
    ticks     (...)  after which the hand came within a centimetre and stayed; -1: it did not
    largest   (...)  the largest step of a joint in one tick, the neck's left out [rad]
    period    (...)  ticks after which the poses repeat themselves; 0: they do not
    settled   (...)  True where nothing moves any more
    silent    (...)  True where no package answered at the end
    """

    distance: Array
    ticks: Index
    largest: Array
    period: Index
    settled: Mask
    silent: Mask

    @property
    def arrived(self) -> Mask:
        """Where the hand has come within a centimetre and stayed, (...)."""
        return self.ticks >= 0


def trial(
    body: ReachingFigure,
    cursors: ArrayLike,
    way: Way,
    *,
    ticks: int = PATIENCE,
    parts: int = PARTS,
    max_step: float | None = MAX_STEP,
) -> Trial:
    """Reach for cursors (..., 3) [m] from rest.

    Each run takes `ticks` ticks, and its end is returned. Runs that have come to rest are not
    followed further: they would stay.
    """
    cursors, ticks = numbers("the cursors", cursors), count_of("ticks", ticks)
    if cursors.shape[-1:] != (3,) or not np.isfinite(cursors).all():
        raise ValueError(f"cursors (..., 3) are x, y and z, all finite, not {shown(cursors)}")
    checked_way(way)
    goals = cursors.reshape(-1, 3)
    count = len(goals)
    backs = backs_reach(body, goals)
    poses = np.tile(body.tree.rest, (count, 1))
    distance, largest = np.full(count, np.nan), np.zeros(count)
    since, settled, silent = np.full(count, -1), np.zeros(count, bool), np.zeros(count, bool)
    left = np.arange(count)
    recent: deque[tuple[Index, Array]] = deque(maxlen=2 * LONGEST)
    for tick in range(1, ticks + 1):
        if not len(left):
            break
        at, goal, back = poses[left], goals[left], backs[left]
        done = advance(body, at, goal, way, parts=parts, max_step=max_step, backs=back)
        turned = abs(done.theta - poses[left])
        turned[:, body.neck] = 0
        moves = turned.max(axis=-1)
        poses[left], distance[left], silent[left] = done.theta, done.distance, done.package == NONE
        largest[left] = np.maximum(largest[left], moves)
        near = done.distance <= ARRIVED
        since[left] = np.where(near, np.where(since[left] < 0, tick, since[left]), -1)
        settled[left] = moves <= STILL
        recent.append((left, poses[left]))
        left = left[~settled[left]]
    cycles = np.zeros(count, dtype=np.intp)
    if len(left):
        cycles[left] = period(np.array([p[np.isin(of, left)] for of, p in recent]))
    shape = cursors.shape[:-1]
    return Trial(
        distance.reshape(shape),
        since.reshape(shape),
        largest.reshape(shape),
        cycles.reshape(shape),
        settled.reshape(shape),
        silent.reshape(shape),
    )


def reachable_cursors(body: ReachingFigure, count: int, seed: int = 0) -> Array:
    """Draw places (count, 3) [m] that a hand can reach.

    They are hands of random poses within the limits. Each can be reached by arm and back of the
    side that it lies on, if not by a package.
    """
    rng, tree = np.random.default_rng(seed), body.tree
    count_of("the number of cursors", count, least=0)
    found: list[Array] = []
    while sum(map(len, found)) < count:
        q = rng.uniform(tree.lower[body.rows], tree.upper[body.rows], (count, len(body.degrees)))
        side = rng.choice([-1.0, 1.0], (count, 1)) * [1.0, 0, 0]
        s = hands(body, q @ body.C.T, side)
        found.append(s[s[:, 0] * side[:, 0] >= 0])
    return np.concatenate([np.zeros((0, 3)), *found])[:count]
