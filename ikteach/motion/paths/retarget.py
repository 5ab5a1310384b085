"""A recorded motion on another body: its turns, on our bones.

Each bone of ours has the length that it has, and the direction that the recorded one has. So the
targets are a pose of our own body, all but where a joint of ours lacks a turn, and they can be
reached. Positions taken as they are cannot, for nobody's bones are as long as another's.
"""

from collections.abc import Mapping, Sequence
from itertools import permutations, product
from typing import Any, NamedTuple

import numpy as np

from ikteach.arrays import Array, Mask
from ikteach.body import Effectors, Tree, forward, locate
from ikteach.body.figures import BALL, GAZE, HAND, HEEL, Figure
from ikteach.checks import shown
from ikteach.motion.paths.ground import GOES, Ground
from ikteach.motion.paths.recorded import Recorded
from ikteach.names import unknown

UNITS = {  # length of a leg in each [units], of grown-ups and children
    "metres": (0.4, 1.3),
    "inches": (15.0, 52.0),
    "centimetres": (52.0, 130.0),
    "millimetres": (400.0, 1300.0),
}
STANDS = 0.7  # cosine between our bones and theirs, from which on a pose is a standing one
LEAP, FAR = 4.0, 0.1  # times the usual way of a joint between frames; share of the body's size
EARLY = 0.1  # share of the frames that may be a pose to measure by
TOLD = np.radians(5)  # of a turn, from which on it is told
FLOOR, SLOPE = 0.2, 0.01  # of a floor's height, and of its rise on the way [m]


def markers(tree: Tree) -> Effectors:
    """Return 13 effectors of a walker, for its pelvis and its limbs.

    The pelvis and two of its directions; ankle and ball of each foot, knees, elbows, hands.
    """
    points: dict[str, tuple[str, Sequence[float]]] = {"pelvis": ("pelvis.z", (0, 0, 0))}
    for side in "lr":
        foot, knee, elbow = f"foot.{side}", f"knee.{side}", f"elbow.{side}"
        points |= {f"ankle.{side}": (foot, (0, 0, 0)), f"ball.{side}": (foot, BALL)}
        points |= {knee: (knee, (0, 0, 0)), elbow: (elbow, (0, 0, 0))}
        points[f"hand.{side}"] = (elbow, HAND)
    up, ahead = ("pelvis.z", (0, GAZE, 0)), ("pelvis.z", (0, 0, GAZE))
    return Effectors.of(tree, points, directions={"pelvis.up": up, "pelvis.ahead": ahead})


def retarget(
    recording: Any, figure: Figure, bones: Mapping[str, str], *, feet: Sequence[str]
) -> Recorded:
    """Make targets for a figure from a recording of another.

    recording  with tree, theta (T, n) and times (T,), as `formats.bvh.read_bvh` gives it
    bones      {row of ours: joint of theirs}: our row turns as theirs does. "hip" stands for the
               last of rows called "hip.x" and so on; an end without a joint may be one, too
    feet       rows of ours that lie flat in our zero pose: they take the whole turn. So do rows
               from which several bones go, as pelvis and chest; a bone takes its direction alone

    It arrives upright, heading along z, on level ground, in the size of our legs, in a frame that
    goes along at its mean pace. A first pose that is no part of the motion is left out. Of a walk
    whole strides are taken, so that it can begin anew. Its `notes` say what was done. ValueError if
    there are too few frames, no standing pose, or feet that are no bones; LookupError for an
    unknown row or joint.
    """
    if lost := [foot for foot in feet if foot not in bones]:
        raise ValueError(f"the foot {shown(lost[0])} is not among the bones")
    if not feet:
        raise ValueError("at least one foot is needed: it tells the floor and the size")
    tree, effectors = figure
    zero = forward(tree, np.zeros(len(tree))).positions
    ours = {row: zero[tree.index(row)] for row in bones}
    legs = [_leg(tree, bones, foot) for foot in feet]
    tops = _below(tree, bones)
    pelvis = next((row for row, below in tops.items() if legs[0][-1] in below), legs[0][-1])
    theirs = _standing(_theirs(recording, bones), ours, legs, pelvis)
    turns = dict(theirs.turns)
    for row, below in tops.items():
        if row not in feet and len(below) < 2:
            bone = theirs.zero[below[0]] - theirs.zero[row] if below else theirs.ends[row]
            if not bone.any():  # an end that the file does not tell: as the bone above it goes on
                bone = next(theirs.zero[row] - theirs.zero[up] for up in tops if row in tops[up])
            turns[row] = turns[row] @ between(_bone(figure, zero, row, below), bone)
    size = np.mean([_long(ours, leg) for leg in legs]) / np.mean(
        [_long(theirs.zero, leg) for leg in legs]
    )
    root = size * np.mean([theirs.places[leg[-1]] for leg in legs], axis=0)
    places, R = _posed(tree, turns, root)
    soles = Effectors.of(
        tree, {f"{f}{i}": (f, o) for f in feet for i, o in enumerate((HEEL, BALL))}
    )
    ground = Ground.under(theirs.times, _at(places, R, soles), root)
    targets = _at(places - ground.way[:, None], R, effectors)
    targets[..., 1] -= ground.rise[:, None] * effectors.w
    whole, said = _whole(theirs.times, ground)
    return Recorded(
        theirs.times[whole],
        targets[whole],
        effectors.names,
        standing=_stands(effectors, [tree.index(foot) for foot in feet], ground.down)[whole],
        floor=ground.floor,
        speed=ground.speed if abs(ground.speed) > GOES else 0.0,
        notes=(*theirs.notes, _unit(theirs, legs, float(size)), *said),
    )


class _Theirs(NamedTuple):
    """The other's joints by the rows of ours: in time, and in a pose that stands as ours does."""

    times: Array
    places: dict[str, Array]  # (T, 3)
    turns: dict[str, Array]  # (T, 3, 3) from the standing pose
    zero: dict[str, Array]  # places (3,) in the standing pose
    ends: dict[str, Array]  # of each, a bone (3,) in the standing pose
    notes: tuple[str, ...] = ()


def _theirs(recording: Any, bones: Mapping[str, str]) -> _Theirs:
    """Find the joints that are wanted; the standing pose is that of the file, all angles zero."""
    tree, theta, effectors = recording.tree, recording.theta, recording.effectors
    if len(theta) < 4:
        raise ValueError(f"a recording needs 4 frames or more, not {len(theta)}")
    last = {name.rpartition(".")[0]: j for j, name in enumerate(tree.names)}
    last |= {name: j for j, name in enumerate(tree.names)}
    ends = {name: i for i, name in enumerate(effectors.names)}
    frames, zero = forward(tree, theta), forward(tree, np.zeros(len(tree)))
    s, s0 = locate(frames, effectors), locate(zero, effectors)
    found = _Theirs(recording.times, {}, {}, {}, {})
    for row, joint in bones.items():
        if joint not in last and joint not in ends:
            raise LookupError(unknown("joint of the recording", joint, [*last, *ends]))
        j = last[joint] if joint in last else int(effectors.joints[ends[joint]])
        found.turns[row] = frames.orientations[:, j]
        if joint in last:
            found.places[row], found.zero[row] = frames.positions[:, j], zero.positions[j]
            below = np.flatnonzero((tree.parents == j) & tree.offsets.any(axis=1))
            own = effectors.offsets[effectors.joints == j]
            found.ends[row] = tree.offsets[below[0]] if len(below) else [*own, np.zeros(3)][0]
        else:
            i = ends[joint]
            found.places[row], found.zero[row], found.ends[row] = s[:, i], s0[i], np.zeros(3)
    return found


def _standing(
    theirs: _Theirs, ours: Mapping[str, Array], legs: list[list[str]], pelvis: str
) -> _Theirs:
    """Set the recording upright and ahead, and its standing pose as ours stands (`ours`).

    The standing pose is the zero pose of the file or, where that is none, the first frame.
    """
    first, notes = _apart(theirs), []
    A = _fit(ours, theirs.zero, legs, snap=True)
    if A is None:
        zero = {row: places[0] for row, places in theirs.places.items()}
        R = {row: turns[0] for row, turns in theirs.turns.items()}
        A = _fit(ours, zero, legs, snap=False)
        if A is None:
            raise ValueError("no standing pose: neither all angles at zero nor the first frame")
        notes.append("Bones are measured in its first frame.")
        theirs = theirs._replace(
            zero=zero,
            turns={row: turns @ R[row].T for row, turns in theirs.turns.items()},
            ends={row: R[row] @ end for row, end in theirs.ends.items()},
        )
    if first:
        one = "its first frame is" if first == 1 else f"its first {first} frames are"
        notes.append(f"A pose to measure by, {one} left out.")
    turns = {row: turns[first:] @ A for row, turns in theirs.turns.items()}
    places = {row: at[first:] for row, at in theirs.places.items()}
    G, said = _upright_ahead(turns[pelvis], places, legs)
    return theirs._replace(
        times=theirs.times[first:],
        places={row: at @ G.T for row, at in places.items()},
        turns={row: G @ turn for row, turn in turns.items()},
        zero={row: A.T @ at for row, at in theirs.zero.items()},
        ends={row: A.T @ end for row, end in theirs.ends.items()},
        notes=(*notes, *said),
    )


def _apart(theirs: _Theirs) -> int:
    """Count the first frames from which the motion leaps away: a pose to measure the body by."""
    places = np.stack([*theirs.places.values()], axis=1)
    steps = np.linalg.norm(np.diff(places, axis=0), axis=-1)  # (T − 1, joints)
    early = max(1, int(EARLY * len(steps)))
    i = int(steps[:early].max(axis=1).argmax())
    far = FAR * np.ptp(places[i + 1], axis=0).max()  # of the body's size
    usual = np.quantile(steps[i + 1 :], 0.95, axis=0)
    return i + 1 if (steps[i] > np.maximum(LEAP * usual, far)).any() else 0


def _fit(
    ours: Mapping[str, Array], zero: Mapping[str, Array], legs: list[list[str]], *, snap: bool
) -> Array | None:
    """Find the turn (3, 3) that takes our standing pose to theirs; None if theirs does not stand.

    The best for all joints (Kabsch 1976, Acta Cryst. A 32:922), or of the turns that take axes to
    axes the nearest.
    """
    P, Q = (np.array([at[row] for row in ours]) for at in (ours, zero))
    P, Q = P - P.mean(axis=0), Q - Q.mean(axis=0)
    U, _, V = np.linalg.svd(Q.T @ P)
    A = U @ np.diag([1, 1, np.sign(np.linalg.det(U @ V))]) @ V
    if snap:
        A = max(AXES_TO_AXES, key=lambda one: float((one * A).sum()))
    bones = [pair for leg in legs for pair in zip(leg[1:], leg, strict=False)]
    bones += [(legs[-1][-1], legs[0][-1])] if len(legs) > 1 else []
    for a, b in bones:
        u, v = A @ (ours[b] - ours[a]), zero[b] - zero[a]
        if u @ v <= STANDS * np.linalg.norm(u) * np.linalg.norm(v):
            return None
    return np.asarray(A)


AXES_TO_AXES = [
    np.eye(3)[list(order)] * np.array(signs)
    for order in permutations(range(3))
    for signs in product((1, -1), repeat=3)
    if np.linalg.det(np.eye(3)[list(order)] * np.array(signs)) > 0
]


def _upright_ahead(
    pelvis: Array, places: Mapping[str, Array], legs: list[list[str]]
) -> tuple[Array, list[str]]:
    """Find the turn (3, 3) after which y is up and the way is along z, and say it.

    pelvis  (T, 3, 3) its turns; where the body goes nowhere, it faces along z
    """
    said, up = [], pelvis[..., 1].mean(axis=0)
    axis = np.eye(3)[abs(up).argmax()] * np.sign(up[abs(up).argmax()])
    G = between(axis, np.array([0.0, 1, 0]))
    if axis[1] != 1:
        named = f"{'-' if axis.sum() < 0 else ''}{'xyz'[abs(axis).argmax()]}"
        said.append(f"Its {named} axis points up: it was set upright.")
    roots = np.mean([places[leg[-1]] for leg in legs], axis=0) @ G.T
    long = np.linalg.norm(np.mean([places[leg[-1]] - places[leg[0]] for leg in legs], axis=(0, 1)))
    way, faces = (roots[-1] - roots[0])[[0, 2]], (pelvis[..., 2] @ G.T)[:, [0, 2]]
    ahead = way if np.linalg.norm(way) > long else faces.mean(axis=0)
    along = float(np.arctan2(*ahead))
    if abs(along) > TOLD:
        side = "right" if along > 0 else "left"
        said.append(f"It was turned by {np.degrees(abs(along)):.0f}° to its {side}, to head ahead.")
    turned = np.unwrap(np.arctan2(*faces.T))
    if (bend := np.degrees(abs(turned[-1] - turned[0]))) > 45:
        said.append(f"It turns by {bend:.0f}° on its way, and the ground does not.")
    c, s = np.cos(along), np.sin(along)
    return np.array([[c, 0, -s], [0, 1, 0], [s, 0, c]]) @ G, said


def _unit(theirs: _Theirs, legs: list[list[str]], size: float) -> str:
    """Say in which unit it seems to be, and how its size was changed."""
    long = float(np.mean([_long(theirs.zero, leg) for leg in legs]))
    name = next((unit for unit, (low, high) in UNITS.items() if low <= long < high), None)
    which = f"{name}, it seems" if name else "a unit of its own"
    return f"A leg is {long:.3g} long ({which}); one unit became {size:.3g} m, to be as ours."


def _whole(times: Array, ground: Ground) -> tuple[slice, list[str]]:
    """Choose the frames that are taken, whole strides of a walk, and say it."""
    said, height = [], ground.floor + ground.way[0, 1]
    if abs(height) > FLOOR:
        said.append(f"Its ground, at a height of {height:.2f} m, was put under its feet.")
    if abs(rise := ground.rise[-1] - ground.rise[0]) > SLOPE:
        goes = "rose" if rise > 0 else "fell"
        said.append(f"Its ground {goes} by {100 * abs(rise):.0f} cm: it was made level.")
    left = [*range(min(2, ground.down.shape[1]))]
    strides = ground.strides(left) if abs(ground.speed) > GOES else None
    if strides is None or strides.stop - strides.start < 4:
        return slice(None), [*said, "It has no whole stride: where it begins anew it may leap."]
    if ground.still:
        said.append(f"It walks in its place: the ground goes by at {ground.speed:.2f} m/s.")
    span = times[strides.stop] - times[strides.start]
    return strides, [*said, f"Whole strides were taken: {span:.2g} s of {times[-1]:.2g} s."]


def _stands(effectors: Effectors, feet: list[int], down: Mask) -> Mask:
    """Say which effectors stand, (T, k): those of a foot whose name says heel or ball."""
    stands = np.zeros((len(down), len(effectors)), dtype=bool)
    for i, (name, joint) in enumerate(zip(effectors.names, effectors.joints, strict=True)):
        if joint in feet and name.startswith(("heel", "ball")):
            stands[:, i] = down[:, 2 * feet.index(joint) + name.startswith("ball")]
    return stands


def _below(tree: Tree, bones: Mapping[str, str]) -> dict[str, list[str]]:
    """Find the rows next below each among the bones."""
    below: dict[str, list[str]] = {row: [] for row in bones}
    for row in bones:
        above = [tree.names[j] for j in tree.above(tree.index(row))[1:]]
        found = next((name for name in above if name in below), None)
        if found is not None:
            below[found].append(row)
    return below


def _bone(figure: Figure, zero: Array, row: str, below: list[str]) -> Array:
    """Return a bone (3,) of ours in the zero pose: to the next row, or to an effector."""
    tree, effectors = figure
    j = tree.index(row)
    if below:
        return np.asarray(zero[tree.index(below[0])] - zero[j])
    own = effectors.offsets[(effectors.joints == j) & (effectors.w == 1)]
    return np.asarray([*own[own.any(axis=1)], np.zeros(3)][0])


def _leg(tree: Tree, bones: Mapping[str, str], foot: str) -> list[str]:
    """Go up from a foot along bones to the last that does not branch."""
    below, leg = _below(tree, bones), [foot]
    for j in tree.above(tree.index(foot))[1:]:
        row = tree.names[j]
        if row in bones:
            if len(below[row]) > 1:
                break
            leg.append(row)
    return leg


def _long(places: Mapping[str, Array], chain: Sequence[str]) -> float:
    """Add up the distances between the places (3,) of a chain."""
    at = np.array([places[row] for row in chain])
    return float(np.linalg.norm(np.diff(at, axis=0), axis=1).sum())


def between(a: Array, b: Array) -> Array:
    """Return the least turn (3, 3) from one direction to another.

    It takes that of a (3,) to that of b (3,). It is none where one of them is zero, and about any
    axis where they are opposite.
    """
    if not (a.any() and b.any()):
        return np.eye(3)
    a, b = a / np.linalg.norm(a), b / np.linalg.norm(b)
    half = a + b
    if np.linalg.norm(half) < 1e-9:
        half = np.cross(a, np.eye(3)[abs(a).argmin()])
    half /= np.linalg.norm(half)
    # Two half-turns: about a, which leaves it, and about what is half way between.
    return (2 * np.outer(half, half) - np.eye(3)) @ (2 * np.outer(a, a) - np.eye(3))


def _posed(tree: Tree, turns: dict[str, Array], root: Array) -> tuple[Array, Array]:
    """Place our rows: (T, n, 3), turned (T, n, 3, 3); those above all bones stand at the root."""
    T, n = len(root), len(tree)
    places, R = np.empty((T, n, 3)), np.empty((T, n, 3, 3))
    for j, parent in enumerate(tree.parents.tolist()):
        up = np.eye(3) if parent < 0 else R[:, parent]
        places[:, j] = root if parent < 0 else places[:, parent]
        places[:, j] += np.matvec(up, tree.offsets[j])
        R[:, j] = turns.get(tree.names[j], up)
    return places, R


def _at(places: Array, R: Array, effectors: Effectors) -> Array:
    """Place effectors (T, k, 3) on rows."""
    j = effectors.joints
    return effectors.w[:, None] * places[:, j] + np.matvec(R[:, j], effectors.offsets)
