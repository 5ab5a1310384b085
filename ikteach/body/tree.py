"""The figure as a table: people write rows (`Joint`), the machine keeps columns (`Tree`).

The pose θ is not in here. It is an array of its own, so that one tree serves every pose, every
method and every figure on the screen at once.
"""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from numbers import Real

import numpy as np

from ikteach.arrays import Array, ArrayLike, Index, Mask, frozen
from ikteach.body.plan import Plan
from ikteach.checks import numbers, shown
from ikteach.names import unknown

GROUND = -1


@dataclass(frozen=True)
class Joint:
    """One degree of freedom: a hinge or a slide.

    A hinge turns about `axis`, a slide moves along it.

    name      its name in errors and tables
    parent    the name of the joint it hangs from, or None for the ground
    offset    (3,) where it sits in the parent's frame [m]
    axis      (3,) direction in the parent's frame; any length but zero
    slide     True: θ is a length [m]; False: θ is an angle [rad], right-handed about the axis
    lower, upper   limits of θ [rad or m]
    rest      θ of the rest pose [rad or m]; None: the value nearest 0 within the limits
    mobility  share of its step that the joint takes, from 0 (locked) to 1 (free)
    """

    name: str
    parent: str | None = None
    offset: Sequence[float] = (0.0, 0.0, 0.0)
    axis: Sequence[float] = (0.0, 0.0, 1.0)
    slide: bool = False
    lower: float = -math.inf
    upper: float = math.inf
    rest: float | None = None
    mobility: float = 1.0


@dataclass(frozen=True, eq=False)
class Tree:
    """A body of n one-axis joints, parents before children.

    Its arrays cannot be written to.

    names               n names
    parents   (n,)      index of the parent, GROUND (-1) for none
    offsets   (n, 3)    position in the parent's frame [m]
    axes      (n, 3)    unit axis in the parent's frame
    slide     (n,)      True where θ is a length
    lower, upper, rest  (n,) [rad, or m where slide]
    mobility  (n,)      0 locked .. 1 free
    """

    names: tuple[str, ...]
    parents: Index
    offsets: Array
    axes: Array
    slide: Mask
    lower: Array
    upper: Array
    rest: Array
    mobility: Array

    @classmethod
    def of(cls, joints: Iterable[Joint]) -> "Tree":
        """Make the tree of these rows.

        ValueError or LookupError names the row that is wrong.
        """
        if not isinstance(joints, Iterable):
            raise TypeError(f"a tree is made of Joints, not of {shown(joints)}")
        rows = list(joints)
        if not rows:
            raise ValueError("a tree needs at least one joint")
        for row in rows:
            if not isinstance(row, Joint):
                raise TypeError(f"a tree is made of Joints, not of {shown(row)}")
        parents: list[int] = []
        index: dict[str, int] = {}
        for row in rows:
            _check(row, index, [r.name for r in rows])
            parents.append(GROUND if row.parent is None else index[row.parent])
            index[row.name] = len(index)
        axes = np.array([numbers("axis", row.axis) for row in rows])
        axes /= abs(axes).max(axis=1, keepdims=True)  # so that no square under- or overflows
        return cls(
            names=tuple(index),
            parents=frozen(parents, np.intp),
            offsets=frozen([row.offset for row in rows]),
            axes=frozen(axes / np.linalg.norm(axes, axis=1, keepdims=True)),
            slide=frozen([row.slide for row in rows], bool),
            lower=frozen([row.lower for row in rows]),
            upper=frozen([row.upper for row in rows]),
            rest=frozen([_rest(row) for row in rows]),
            mobility=frozen([row.mobility for row in rows]),
        )

    @cached_property
    def plan(self) -> Plan:
        """The joints in the order in which `forward` climbs them."""
        return Plan.of(self.parents, self.offsets, self.axes, self.slide)

    @cached_property
    def free(self) -> bool:
        """Whether no joint is locked or stiff: all have mobility 1."""
        return bool((self.mobility == 1).all())

    def __len__(self) -> int:
        return len(self.names)

    def joints(self) -> list[Joint]:
        """Return the rows that this tree can be made of."""
        names = {GROUND: None, **dict(enumerate(self.names))}
        columns = (self.offsets, self.axes, self.slide, self.lower, self.upper, self.rest)
        each = zip(*(column.tolist() for column in (*columns, self.mobility)), strict=True)
        return [
            Joint(name, names[parent], *others)
            for name, parent, others in zip(self.names, self.parents.tolist(), each, strict=True)
        ]

    def index(self, name: str) -> int:
        """Return the row of the joint called `name`; LookupError suggests another."""
        try:
            return self.names.index(name)
        except ValueError:
            raise LookupError(unknown("joint", name, self.names)) from None

    def wrapped(self, theta: ArrayLike) -> Array:
        """Write θ (..., n) as a person reads it: endless hinges from −π to π [rad].

        Whole turns change nothing of where such a body is. Hinges with limits and slides stay.
        """
        theta = np.asarray(numbers("theta", theta))
        free = ~self.slide & np.isinf(self.lower) & np.isinf(self.upper)
        return np.where(free, (theta + np.pi) % (2 * np.pi) - np.pi, theta)

    def above(self, joint: int) -> list[int]:
        """Return a joint and all that it hangs from.

        The chain goes up to the ground.
        """
        chain = []
        while joint != GROUND:
            chain.append(joint)
            joint = int(self.parents[joint])
        return chain


@dataclass(frozen=True, eq=False)
class Effectors:
    """The k points and directions of a body that reach for targets.

    Each is fixed to some joint, as a homogeneous point o with its w: s = w p + R o.

    names             k names
    joints   (k,)     the joint that carries each of them
    offsets  (k, 3)   o: where a point is in that joint's frame, or a direction there [m]
    w        (k,)     1 for a point, 0 for a direction: it is turned with the joint, and not moved
    carried  (k, n)   True where joint j moves effector i
    chains   (n,)     a number per joint; joints that share an effector, directly or through others,
                      have the same one, and -1 stands where a joint moves no effector
    """

    names: tuple[str, ...]
    joints: Index
    offsets: Array
    w: Array
    carried: Mask
    chains: Index

    @classmethod
    def of(
        cls,
        tree: Tree,
        points: Mapping[str, tuple[str, Sequence[float]]],
        *,
        directions: Mapping[str, tuple[str, Sequence[float]]] | None = None,
    ) -> "Effectors":
        """Make the effectors {name: (joint, offset)} of `tree`, on any joints.

        directions  {name: (joint, vector)}, which come after the points. Its target is a vector of
                    the same length; a direction that is off by φ has the error 2ℓ sin(φ/2), so that
                    its length ℓ [m] is its weight beside the points. Two make an orientation

        TypeError, ValueError or LookupError names the effector that is wrong.
        """
        if not isinstance(tree, Tree):
            raise TypeError(f"a Tree is needed here, not {shown(tree)}")
        for kind in (points, {} if directions is None else directions):
            if not isinstance(kind, Mapping):
                raise TypeError(f"effectors are {{name: (joint, offset)}}, not {shown(kind)}")
        each = [*points.items(), *(directions or {}).items()]
        if not each:
            raise ValueError("at least one effector is needed")
        for name, point in each:
            _check_point(name, point)
        for name, (_, vector) in (directions or {}).items():
            if not np.any(vector):
                raise ValueError(f"the direction {shown(name)} is zero; its length is its weight")
            if name in points:
                raise ValueError(f"there are two effectors called {shown(name)}")
        joints = [tree.index(joint) for _, (joint, _) in each]
        carried = np.zeros((len(each), len(tree)), dtype=bool)
        for row, joint in zip(carried, joints, strict=True):
            row[tree.above(joint)] = True
        w = np.arange(len(each)) < len(points)
        # A slide does not move a direction.
        carried &= ~tree.slide | w[:, None]
        return cls(
            names=tuple(name for name, _ in each),
            joints=frozen(joints, np.intp),
            offsets=frozen([offset for _, (_, offset) in each]),
            w=frozen(w),
            carried=frozen(carried, bool),
            chains=frozen(_chains(carried), np.intp),
        )

    @cached_property
    def alike(self) -> Array:
        """Weights (k,) of effectors that all weigh 1."""
        return frozen(np.ones(len(self)))

    @cached_property
    def directed(self) -> bool:
        """Whether there are directions among them."""
        return not self.w.all()

    @cached_property
    def mask(self) -> Array:
        """`carried` as numbers, (k, 1, n): 1 where joint j moves effector i, else 0."""
        return frozen(self.carried[:, None, :])

    def __len__(self) -> int:
        return len(self.names)


def _check_point(name: object, point: object) -> None:
    who = shown(name)
    if not isinstance(name, str) or not name:
        raise ValueError(f"an effector needs a name, not {who}")
    if not isinstance(point, Sequence) or isinstance(point, str) or len(point) != 2:
        raise ValueError(f"effector {who} needs (joint, offset), not {shown(point)}")
    _check_vector(f"the offset of effector {who}", point[1])


def _chains(carried: Mask) -> list[int]:
    """Give a number to each connected group of joints (an effector connects them)."""
    chains = np.full(carried.shape[1], -1)
    for i, row in enumerate(carried):
        met = set(chains[row]) - {-1}
        chains[row | np.isin(chains, list(met))] = i
    return [int(c) for c in chains]


def _rest(row: Joint) -> float:
    return float(np.clip(0.0, row.lower, row.upper)) if row.rest is None else float(row.rest)


def _check(row: Joint, above: Mapping[str, int], names: Sequence[str]) -> None:
    who, parent = shown(row.name), shown(row.parent)
    if not isinstance(row.name, str) or not row.name:
        raise ValueError(f"a joint needs a name, not {who}")
    if row.name in above:
        raise ValueError(f"there are two joints called {who}")
    if row.parent is not None and row.parent not in list(above):
        if row.parent in names:
            raise ValueError(f"{who} hangs from {parent}, which is not above it")
        raise ValueError(
            f"{who} hangs from {parent}, but there is " + unknown("joint", row.parent, names)
        )
    _check_vector(f"the offset of {who}", row.offset)
    _check_vector(f"the axis of {who}", row.axis)
    if not np.any(row.axis):
        raise ValueError(f"the axis of {who} is zero; it needs a direction")
    for what in ("lower limit", "upper limit", "rest", "mobility"):
        value = getattr(row, what.split()[0])
        if not (_is_number(value) or (what == "rest" and value is None)):
            raise ValueError(f"the {what} of {who} must be a number, not {shown(value)}")
    if not isinstance(row.slide, bool | np.bool_):
        raise ValueError(f"slide of {who} must be True or False, not {shown(row.slide)}")
    if not row.lower <= row.upper:
        raise ValueError(f"{who} has lower limit {row.lower} above its upper {row.upper}")
    if (math.isinf(row.lower) and row.lower > 0) or (math.isinf(row.upper) and row.upper < 0):
        raise ValueError(f"{who} has no angle within [{row.lower}, {row.upper}]")
    if not (math.isfinite(_rest(row)) and row.lower <= _rest(row) <= row.upper):
        raise ValueError(f"the rest {row.rest} of {who} lies outside [{row.lower}, {row.upper}]")
    if not 0 <= row.mobility <= 1:
        raise ValueError(f"the mobility of {who} is {row.mobility}; it goes from 0 to 1")


def _is_number(value: object) -> bool:
    """Whether it is a number that a float can hold, and no switch; NaN and ±∞ are such."""
    if isinstance(value, bool) or not isinstance(value, Real):
        return False
    try:
        float(value)
    except OverflowError:
        return False
    return True


def _check_vector(what: str, vector: Sequence[float]) -> None:
    try:
        array = numbers(what, vector)
    except ValueError:
        raise ValueError(f"{what} must be three numbers, not {shown(vector)}") from None
    if array.shape != (3,) or not np.isfinite(array).all():
        raise ValueError(f"{what} must be three finite numbers, not {shown(vector)}")
