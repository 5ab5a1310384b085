"""The same body told otherwise: other units, whole turns, another ground, other names and numbers.

A change makes two cases of one, as they are to be compared, and says how an answer moves along:

    for change in SAME.values():
        one, other, along = change(case, rng)
        assert_allclose(f(*other), along.pose(f(*one)))

`SAME` are changes after which every answer is the same but for what `along` says. `OTHER` make
another body of a case, for which the same must hold (finite, within limits, `SAME`).
"""

from dataclasses import dataclass, field, replace
from functools import partial
from typing import NamedTuple

import numpy as np

from ikteach import Effectors, Joint, Tree
from ikteach.body.tree import GROUND

UNITS = (1e-6, 1e-3, 1e3, 1e6)


class Case(NamedTuple):
    """A body, a pose (..., n) and targets (..., k, 3)."""

    tree: Tree
    effectors: Effectors
    theta: np.ndarray
    targets: np.ndarray


@dataclass(frozen=True)
class Along:
    """How answers move along. All of them are for the first case, and give that for the second.

    length     what lengths of the world are multiplied by: distances, errors, bounds of errors
    turn       (3, 3) how directions of the world turn
    shift      (3,) where the origin goes
    joints     (n,) for each joint of the second, its row in the first
    effectors  (k,) the same
    scale      (n,) of the second's joints: what θ is multiplied by (lengths of slides)
    turns      (n,) what is added to θ then: whole turns
    damping    what σ and λ are multiplied by, None where joints have not one unit
    """

    joints: np.ndarray
    effectors: np.ndarray
    scale: np.ndarray
    turns: np.ndarray
    length: float = 1.0
    turn: np.ndarray = field(default_factory=lambda: np.eye(3))
    shift: np.ndarray = field(default_factory=lambda: np.zeros(3))
    damping: float | None = 1.0

    def pose(self, theta):
        """θ (..., n) of the second."""
        return self.step(theta) + self.turns

    def step(self, dtheta):
        """Δθ (..., n), or another difference of poses."""
        return np.asarray(dtheta)[..., self.joints] * self.scale

    def marks(self, of_joints):
        """What has no unit and is there once per joint (..., n): held, mobility."""
        return np.asarray(of_joints)[..., self.joints]

    def ways(self, v):
        """Ways in the world of each effector (..., k, 3) [m]: errors."""
        return self.length * np.matvec(self.turn, np.asarray(v)[..., self.effectors, :])

    def places(self, points):
        """Places of each effector in the world (..., k, 3) [m]: effectors, targets."""
        return self.ways(points) + self.shift

    def distances(self, d):
        """Distances of each effector (..., k) [m]."""
        return self.length * np.asarray(d)[..., self.effectors]

    def error(self, e):
        """e (..., 3k) [m]."""
        e = np.asarray(e)
        return self.ways(e.reshape(*e.shape[:-1], -1, 3)).reshape(e.shape)

    def jacobian(self, J):
        """J (..., 3k, n) [m/rad]."""
        columns = self.error(np.asarray(J).swapaxes(-1, -2))
        return columns[..., self.joints, :].swapaxes(-1, -2) / self.scale


def unchanged(case, **other):
    """Along, with nothing but `other` changed."""
    n, k = len(case.tree), len(case.effectors)
    same = {
        "joints": np.arange(n),
        "effectors": np.arange(k),
        "scale": np.ones(n),
        "turns": np.zeros(n),
    }
    return Along(**(same | other))


def rows(tree):
    """The joints of a tree."""
    parents = [None if parent == GROUND else tree.names[parent] for parent in tree.parents]
    slide = tree.slide.tolist()
    columns = tree.offsets, tree.axes, slide, tree.lower, tree.upper, tree.rest, tree.mobility
    return [Joint(*row) for row in zip(tree.names, parents, *columns, strict=True)]


def points(tree, effectors):
    """The effectors as they are given to `Effectors.of`."""
    joints = [tree.names[j] for j in effectors.joints]
    return dict(zip(effectors.names, zip(joints, effectors.offsets, strict=True), strict=True))


def moved(case, joints, ends, along):
    """The case of these rows and points, pose and targets moved along."""
    tree = Tree.of(joints)
    theta, targets = along.pose(case.theta), along.places(case.targets)
    return Case(tree, Effectors.of(tree, ends), theta, targets)


def in_units(case, rng, unit=1e3):
    """Every length times `unit`: metres become millimetres."""
    slide = case.tree.slide
    scale = np.where(slide, unit, 1.0)
    damping = 1.0 if slide.all() else None if slide.any() else unit
    along = unchanged(case, length=unit, scale=scale, damping=damping)
    joints = [
        replace(
            row,
            offset=unit * row.offset,
            **{
                what: getattr(row, what) * (unit if row.slide else 1)
                for what in ("lower", "upper", "rest")
            },
        )
        for row in rows(case.tree)
    ]
    ends = {name: (joint, unit * at) for name, (joint, at) in points(*case[:2]).items()}
    return case, moved(case, joints, ends, along), along


def by_whole_turns(case, rng):
    """Limits, rest and angle of each hinge moved by whole turns."""
    turns = 2 * np.pi * rng.integers(-3, 4, len(case.tree)) * ~case.tree.slide
    along = unchanged(case, turns=turns)
    joints = [
        replace(row, lower=row.lower + turn, upper=row.upper + turn, rest=row.rest + turn)
        for row, turn in zip(rows(case.tree), turns, strict=True)
    ]
    return case, moved(case, joints, points(*case[:2]), along), along


def ground_moved(case, rng, far=10.0):
    """The whole body and its targets elsewhere."""
    along = unchanged(case, shift=far * rng.normal(size=3))
    joints = [
        replace(row, offset=row.offset + along.shift) if row.parent is None else row
        for row in rows(case.tree)
    ]
    return case, moved(case, joints, points(*case[:2]), along), along


def ground_turned(case, rng):
    """The whole world turned about its origin, the body in it."""
    Q = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    Q *= np.sign(np.linalg.det(Q))  # a mirror would turn hinges the other way round
    along = unchanged(case, turn=Q)
    joints = [replace(row, offset=Q @ row.offset, axis=Q @ row.axis) for row in rows(case.tree)]
    ends = {name: (joint, Q @ at) for name, (joint, at) in points(*case[:2]).items()}
    return case, moved(case, joints, ends, along), along


def reordered(case, rng):
    """Joints and effectors in another order, with other names."""
    tree, n = case.tree, len(case.tree)
    weight, order = rng.random(n), []
    while len(order) < n:  # of the joints whose parent has been, any
        free = [j for j in range(n) if j not in order and tree.parents[j] in (GROUND, *order)]
        order.append(min(free, key=lambda j: weight[j]))
    ends = rng.permutation(len(case.effectors))
    along = unchanged(case, joints=np.array(order), effectors=ends)
    name = {old: f"joint {i} of {old!r}" for i, old in enumerate(tree.names)}
    old = rows(tree)
    joints = [
        replace(old[j], name=name[old[j].name], parent=name.get(old[j].parent)) for j in order
    ]
    was = list(points(*case[:2]).items())
    named = {f"end {i} of {was[i][0]!r}": (name[was[i][1][0]], was[i][1][1]) for i in ends}
    return case, moved(case, joints, named, along), along


def in_float32(case, rng):
    """Pose and targets in single precision."""
    theta, targets = (np.float32(part) for part in (case.theta, case.targets))
    one = case._replace(theta=theta.astype(float), targets=targets.astype(float))
    return one, case._replace(theta=theta, targets=targets), unchanged(case)


def in_lists(case, rng):
    """Pose and targets as lists of Python's numbers."""
    other = case._replace(theta=case.theta.tolist(), targets=case.targets.tolist())
    return case, other, unchanged(case)


def in_integers(case, rng):
    """Pose and targets in whole radians and metres."""
    theta, targets = (np.rint(part) for part in (case.theta, case.targets))
    other = case._replace(theta=theta.astype(int), targets=targets.astype(int))
    return case._replace(theta=theta, targets=targets), other, unchanged(case)


def in_other_memory(case, rng):
    """Pose and targets in arrays that are not contiguous, not ours to write to, big-endian."""
    theta, targets = (
        np.repeat(part, 2, axis=-1)[..., ::2].astype(">f8") for part in (case.theta, case.targets)
    )
    theta.setflags(write=False)
    targets.setflags(write=False)
    return case, case._replace(theta=theta, targets=targets), unchanged(case)


BODY = {
    **{f"units {unit:g}": partial(in_units, unit=unit) for unit in UNITS},
    "whole turns": by_whole_turns,
    "ground moved": ground_moved,
    "ground turned": ground_turned,
    "renamed and reordered": reordered,
}
NUMBERS = {
    "float32": in_float32,
    "lists": in_lists,
    "integers": in_integers,
    "other memory": in_other_memory,
}
SAME = BODY | NUMBERS


def slides_for_hinges(case, rng):
    """Every hinge a slide along its axis, and every slide a hinge; limits and pose stay numbers."""
    joints = [replace(row, slide=not row.slide) for row in rows(case.tree)]
    tree = Tree.of(joints)
    return case._replace(tree=tree, effectors=Effectors.of(tree, points(*case[:2])))


def in_a_plane(case, rng):
    """The body laid flat: axes of hinges along z, everything else in the plane z = 0."""
    flat = np.array([1.0, 1, 0])
    joints = []
    for row in rows(case.tree):
        axis = row.axis * flat if row.slide else np.array([0.0, 0, 1])
        axis = axis if np.any(axis) else np.array([1.0, 0, 0])
        joints.append(replace(row, offset=row.offset * flat, axis=axis))
    tree = Tree.of(joints)
    ends = {name: (joint, at * flat) for name, (joint, at) in points(*case[:2]).items()}
    return Case(tree, Effectors.of(tree, ends), case.theta, case.targets * flat)


OTHER = {"slides for hinges": slides_for_hinges, "in a plane": in_a_plane}
