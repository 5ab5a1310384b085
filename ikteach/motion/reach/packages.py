"""Chapter 10. The joint packages of CS 490: which three joints reach for the cursor, and how far.

All of it is trigonometry on one arm. In the frame of the chest, seen from the shoulder,

    r = L₁ sin a + L₂ sin (a + b)        y = −L₁ cos a − L₂ cos (a + b)
    hand = (± r sin φ, y, r cos φ)                          + left, − right

with φ about the shoulder's y axis, a about its x axis and b in the elbow. The chest itself is
turned by 2s where both segments of the back are turned by s.
"""

from functools import cached_property
from typing import NamedTuple

import numpy as np

from ikteach.arrays import Array, ArrayLike, Index, Mask, frozen
from ikteach.body import Effectors, Tree, forward, jacobian, partials
from ikteach.body.figures import TOGETHER, simulator
from ikteach.checks import numbers

MIDDLE = 0.05  # [m]; so near the middle plane no package answers
NONE = -1
SEARCH = 105  # poses of the back that are looked at, half a degree apart


class Package(NamedTuple):
    """Degrees of motion that reach together.

    They are three in CS 490; `side` is "l" (left) or "r".
    """

    name: str
    side: str
    degrees: tuple[str, ...]


def _packages() -> tuple[Package, ...]:
    sides = (("right", "r"), ("left", "l"))
    arms = (
        Package(f"{word} arm", s, (f"shoulder.y.{s}", f"shoulder.x.{s}", f"elbow.{s}"))
        for word, s in sides
    )
    backs = (
        Package(f"{word} arm and back", s, (f"shoulder.y.{s}", f"shoulder.x.{s}", "back"))
        for word, s in sides
    )
    return (*arms, *backs)


PACKAGES = _packages()  # two arms, then two arms with the back, the right one first


def degrees(tree: Tree) -> tuple[str, ...]:
    """Name the degrees of motion; rows of `figures.TOGETHER` are one."""
    return tuple(dict.fromkeys(map(_degree, tree.names)))


def coupling(tree: Tree) -> Array:
    """Return C (n, d), from degrees of motion to rows.

    It is 1 where row i of the tree is turned by degree of motion j, else 0. The angles of the rows
    are θ = C q, and the Jacobian of the degrees is J C.
    """
    names = degrees(tree)
    C = np.zeros((len(tree), len(names)))
    for row, name in enumerate(tree.names):
        C[row, names.index(_degree(name))] = 1
    return C


def _degree(row: str) -> str:
    """Name the degree that turns a row: of `back.lower` it is `back`."""
    shared = any(row in rows for rows in TOGETHER)
    return row.split(".")[0] if shared else row


class ReachingFigure:
    """The simulator's figure and its arms.

    Of the arms it has the lengths [m], rows and degrees of motion.
    """

    def __init__(self) -> None:
        self.tree, _ = simulator()
        self.degrees = degrees(self.tree)
        self.C: Array = frozen(coupling(self.tree))
        tree, elbow = self.tree, self.tree.index("elbow.r")
        hand = (0, -0.3612, 0)
        self.hands = {s: Effectors.of(tree, {f"hand.{s}": (f"elbow.{s}", hand)}) for s in "rl"}
        self.L1, self.L2 = -float(tree.offsets[elbow, 1]), -hand[1]
        self.waist = float(tree.offsets[tree.index("back.lower"), 1])
        self.segment = float(tree.offsets[tree.index("back.upper"), 1])
        self.neck, self.back = tree.index("neck"), tree.index("back.lower")

    @cached_property
    def rows(self) -> Index:
        """The first row of each degree of motion, (d,).

        It is the first of those that the degree turns.
        """
        return np.asarray(self.C.argmax(axis=0))

    def columns(self, names: tuple[str, ...]) -> Array:
        """Return these degrees' columns of C.

        They are (n, 3) for three degrees of motion.
        """
        return self.C[:, [self.degrees.index(name) for name in names]]

    def arm(self, side: str) -> Index:
        """Return the rows of φ, a and b."""
        names = f"shoulder.y.{side}", f"shoulder.x.{side}", f"elbow.{side}"
        return np.array([self.tree.index(name) for name in names])

    def shoulder(self, side: str) -> Array:
        """Return the shoulder's place in the frame of the chest, (3,) [m]."""
        return self.tree.offsets[self.tree.index(f"shoulder.y.{side}")]


def about_x(angle: ArrayLike, v: Array) -> Array:
    """Turn v (..., 3) about the x axis by `angle` (...)."""
    c, s = np.cos(angle), np.sin(angle)
    x, y, z = np.moveaxis(v, -1, 0)
    return np.stack(np.broadcast_arrays(x, c * y - s * z, s * y + c * z), axis=-1)


def points(point: ArrayLike) -> Array:
    """Check that these are points (..., 3), finite."""
    array = numbers("a point", point)
    if array.shape[-1:] != (3,) or not np.isfinite(array).all():
        raise ValueError(f"points (..., 3) are x, y and z, all finite; this has {array.shape}")
    return array


def in_chest(body: ReachingFigure, point: ArrayLike, back: ArrayLike) -> Array:
    """Turn a point (..., 3) into the chest's frame.

    The back is turned by s = `back` (...).
    """
    back = numbers("back", back)
    low = about_x(-back, points(point) - [0, body.waist, 0])
    return about_x(-back, low - [0, body.segment, 0])


def by_columns(body: ReachingFigure, theta: ArrayLike, package: Package) -> Array:
    """Return J (..., 3, 3) of a package at θ (..., n), from the geometric columns, J C."""
    J = jacobian(body.tree, forward(body.tree, theta), body.hands[package.side])
    return J @ body.columns(package.degrees)


def by_differences(body: ReachingFigure, theta: ArrayLike, package: Package) -> Array:
    """Return J (..., 3, 3) of a package at pose θ (..., n), from central differences."""
    J = partials.by_differences(body.tree, theta, body.hands[package.side])
    return J @ body.columns(package.degrees)


def by_hand(body: ReachingFigure, theta: ArrayLike, package: Package) -> Array:
    """Write out the Jacobian of a package.

    J (..., 3, 3) at pose θ (..., n), from partial derivatives worked out by hand.

    ∂r/∂a = −y,  ∂y/∂a = r,  ∂r/∂b = L₂ cos (a + b),  ∂y/∂b = L₂ sin (a + b), and for the back
    with hand h seen from the chest, height u of its lower segment:

        ∂Y/∂s = −u sin s − 2 h_y sin 2s − 2 h_z cos 2s
        ∂Z/∂s =  u cos s + 2 h_y cos 2s − 2 h_z sin 2s
    """
    theta = numbers("theta", theta)
    if theta.shape[-1:] != (len(body.tree),):
        n = len(body.tree)
        raise ValueError(f"{n} joints need theta of shape (..., {n}), not {theta.shape}")
    phi, a, b = np.moveaxis(theta[..., body.arm(package.side)], -1, 0)
    s, x = theta[..., body.back], 1 if package.side == "l" else -1
    sin, cos, L1, L2 = np.sin, np.cos, body.L1, body.L2
    r, y = L1 * sin(a) + L2 * sin(a + b), -L1 * cos(a) - L2 * cos(a + b)

    def across(r: Array, y: Array) -> Array:
        return np.stack([x * r * sin(phi), y, r * cos(phi)], axis=-1)

    d_phi = np.stack([x * r * cos(phi), 0 * r, -r * sin(phi)], axis=-1)
    d_a, d_b = across(-y, r), across(L2 * cos(a + b), L2 * sin(a + b))
    if "back" not in package.degrees:
        return np.stack([about_x(2 * s, d) for d in (d_phi, d_a, d_b)], axis=-1)
    _, hy, hz = np.moveaxis(body.shoulder(package.side) + across(r, y), -1, 0)
    d_s = np.stack(
        [
            0 * s,
            -body.segment * sin(s) - 2 * hy * sin(2 * s) - 2 * hz * cos(2 * s),
            body.segment * cos(s) + 2 * hy * cos(2 * s) - 2 * hz * sin(2 * s),
        ],
        axis=-1,
    )
    return np.stack([about_x(2 * s, d_phi), about_x(2 * s, d_a), d_s], axis=-1)


def arm_reaches(body: ReachingFigure, side: str, point: ArrayLike, back: ArrayLike) -> Mask:
    """Check whether φ, a and b within limits reach point (..., 3): (...).

    `back` (...) is the angle s of the back. The elbow follows from the law of cosines, the rest
    from two arcs of tangent; an arm turned round by half a turn is the other way to get there.
    """
    v = in_chest(body, point, back) - body.shoulder(side)
    far, y = np.hypot(v[..., 0], v[..., 2]), v[..., 1]
    L1, L2 = body.L1, body.L2
    cos_b = (far**2 + y**2 - L1**2 - L2**2) / (2 * L1 * L2)
    b = np.arccos(np.clip(cos_b, -1, 1))
    phi = np.arctan2(v[..., 0] if side == "l" else -v[..., 0], v[..., 2])
    inside = np.zeros(far.shape, dtype=bool)
    for r, turned in ((far, phi), (-far, phi - np.copysign(np.pi, phi))):
        a = np.arctan2(r, -y) - np.arctan2(L2 * np.sin(b), L1 + L2 * np.cos(b))
        inside |= _allowed(body, side, np.stack([turned, a, b], axis=-1))
    inside &= abs(cos_b) <= 1
    return inside


def _allowed(body: ReachingFigure, side: str, angles: Array) -> Mask:
    rows = body.arm(side)
    angles = (angles + np.pi) % (2 * np.pi) - np.pi
    low, high = body.tree.lower[rows], body.tree.upper[rows]
    return np.asarray(((angles >= low) & (angles <= high)).all(axis=-1))


def back_angles(body: ReachingFigure) -> Array:
    """Return the angles s of the back from limit to limit, (SEARCH,)."""
    return np.linspace(body.tree.lower[body.back], body.tree.upper[body.back], SEARCH)


def back_reaches(body: ReachingFigure, side: str, point: ArrayLike) -> Mask:
    """Check whether shoulder and back reach point (..., 3).

    The answer is (...), True where they put the hand there, the elbow being at rest. The arm then
    keeps its length; the back has to bring the shoulder to just that distance.
    """
    s, point = back_angles(body), points(point)
    v = in_chest(body, point[..., None, :], s) - body.shoulder(side)
    bend = body.tree.rest[body.arm(side)[2]]
    length = np.sqrt(body.L1**2 + body.L2**2 + 2 * body.L1 * body.L2 * np.cos(bend))
    over = np.linalg.norm(v, axis=-1) > length
    passes = over[..., 1:] != over[..., :-1]
    turns = arm_reaches(body, side, point[..., None, :], s)
    return np.asarray((passes & (turns[..., 1:] | turns[..., :-1])).any(axis=-1))


def both_reach(body: ReachingFigure, side: str, point: ArrayLike) -> Mask:
    """Check whether arm and back reach point (..., 3).

    The answer is (...), True where some pose of both together puts the hand there.
    """
    point = points(point)[..., None, :]
    return np.asarray(arm_reaches(body, side, point, back_angles(body)).any(axis=-1))


def backs_reach(body: ReachingFigure, cursor: ArrayLike) -> Mask:
    """Return `back_reaches` for both sides, right first: (..., 2) for cursor (..., 3)."""
    return np.stack([back_reaches(body, side, cursor) for side in "rl"], axis=-1)


def choose(
    body: ReachingFigure, cursor: ArrayLike, back: ArrayLike, backs: Mask | None = None
) -> Index:
    """Choose the package that answers to cursor (..., 3): (...), NONE (-1) for none.

    An arm answers where it reaches by itself from where the back, turned by `back` (...), has put
    its shoulder; else arm and back do where they reach; in the middle nothing does. `backs` is
    `backs_reach` of the cursor where it is known already: it does not depend on the pose.
    """
    cursor = points(cursor)
    backs = backs_reach(body, cursor) if backs is None else backs
    arms = np.stack([arm_reaches(body, side, cursor, back) for side in "rl"], axis=-1)
    x = cursor[..., 0]
    sides = np.stack([x < -MIDDLE, x > MIDDLE], axis=-1)
    answers = np.concatenate([sides & arms, sides & backs], axis=-1)  # in the order of PACKAGES
    return np.where(answers.any(axis=-1), answers.argmax(axis=-1), NONE)


def look(body: ReachingFigure, cursor: ArrayLike, back: ArrayLike, eyes: float = 0.15) -> Array:
    """Return the nod (...) that turns the face to the cursor.

    The cursor is (..., 3), and the neck stays within its limits. It is trigonometry alone: the
    eyes are at height `eyes` [m] above the neck, and their line of sight, at right angles to it,
    is to meet the cursor. The head does not turn sideways.
    """
    v = in_chest(body, cursor, back) - body.tree.offsets[body.neck]
    y, z = v[..., 1], v[..., 2]
    far = np.maximum(np.hypot(y, z), eyes)
    nod = np.arcsin(eyes / far) - np.arctan2(y, z)
    return np.clip(nod, body.tree.lower[body.neck], body.tree.upper[body.neck])
