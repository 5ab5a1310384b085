"""A recorded motion on another body: its turns, on our bones.

Each bone of ours has the length that it has, and the direction that the recorded one has. So the
targets are a pose of our own body, all but where a joint of ours lacks a turn, and they can be
reached. Positions taken as they are cannot, for nobody's bones are as long as another's.
"""

import re
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from ikteach.arrays import Array, Mask
from ikteach.body import Effectors, Tree, forward
from ikteach.body.figures import BALL, GAZE, HAND, HEEL, Figure
from ikteach.checks import shown
from ikteach.motion.paths.recorded import Recorded
from ikteach.names import unknown

NEAR, SLOW = 0.03, 0.5  # a foot nearer to the ground [m] and slower over it [m/s] stands

SIDES = {"left": ("left", "l"), "right": ("right", "r")}

CMU: Mapping[str, str] = {  # rows of `figures.walker()`, and joints of the recorded walk
    "pelvis.z": "Hips",
    "spine.twist": "Spine1",
    **{f"hip.turn.{s}": f"{side}UpLeg" for s, side in (("l", "Left"), ("r", "Right"))},
    **{f"knee.{s}": f"{side}Leg" for s, side in (("l", "Left"), ("r", "Right"))},
    **{f"foot.{s}": f"{side}Foot" for s, side in (("l", "Left"), ("r", "Right"))},
    **{f"shoulder.turn.{s}": f"{side}Arm" for s, side in (("l", "Left"), ("r", "Right"))},
    **{f"elbow.{s}": f"{side}ForeArm" for s, side in (("l", "Left"), ("r", "Right"))},
}


# What programs call the joints, in small letters; the first that is there is taken.
CALLED: Mapping[str, tuple[str, ...]] = {
    "pelvis.z": ("hips", "pelvis", "hip", "root"),
    "spine.twist": ("spine1", "chest", "spine2", "chest2", "thorax", "torso", "spine", "abdomen"),
    "hip.turn": ("upleg", "thigh", "upperleg", "femur", "hip"),
    "knee": ("leg", "shin", "knee", "lowleg", "lowerleg", "calf", "tibia"),
    "foot": ("foot", "ankle"),
    "shoulder.turn": ("arm", "uparm", "upperarm", "shldr", "humerus", "shoulder"),
    "elbow": ("forearm", "elbow", "lowarm", "lowerarm", "radius"),
}


def bones_of(recording: Any) -> dict[str, str]:
    """Find a walker's bones in a recording, by what programs call them.

    {row of ours: joint of theirs}, for `retarget` to `figures.walker()`. Words like LeftUpLeg,
    lThigh, thigh_l and mixamorig:LeftUpLeg are known. LookupError names what is not found.
    """
    joints = {name.rpartition(".")[0]: None for name in recording.tree.names}
    # Without name space, signs, and zeros before numbers.
    plain = {name: re.sub(r"[\W_]+0*", "", name.rpartition(":")[2]).lower() for name in joints}
    called = {word: name for name, word in reversed(plain.items())}
    bones = {}
    for row, words in CALLED.items():
        sides = {"": ("",)} if row in ("pelvis.z", "spine.twist") else SIDES
        for side, marks in sides.items():
            each = [f for word in words for m in marks for f in (m + word, word + m)]
            found = next((called[one] for one in each if one in called), None)
            if found is None:
                what = f"{side} {words[0]}".strip()
                known = ", ".join(joints)
                raise LookupError(f"no joint of the recording is its {what}: {shown(known)}")
            bones[f"{row}.{side[0]}" if side else row] = found
    return bones


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
               last of rows called "hip.x" and so on
    feet       rows of ours that lie flat in both zero poses: they take the whole turn. So do rows
               from which several bones go, as pelvis and chest; a bone takes its direction alone

    The targets are in a frame that goes along at the recording's mean pace, heading along z, in
    the size of our legs. ValueError if there are too few frames, or feet that are no bones;
    LookupError for an unknown row or joint.
    """
    if lost := [foot for foot in feet if foot not in bones]:
        raise ValueError(f"the foot {shown(lost[0])} is not among the bones")
    if not feet:
        raise ValueError("at least one foot is needed: it tells the floor and the size")
    theirs = _theirs(recording, set(bones.values()))
    tree, effectors = figure
    turns = {row: theirs.turns[joint] for row, joint in bones.items()}
    zero = forward(tree, np.zeros(len(tree))).positions
    for row, below in _below(tree, bones).items():
        if row not in feet and len(below) < 2:
            ours = _bone(figure, zero, row, below)
            turns[row] = turns[row] @ between(ours, theirs.bone(bones, row, below))
    legs = [_leg(tree, bones, foot) for foot in feet]
    size = np.mean([_long(zero, [tree.index(row) for row in leg]) for leg in legs])
    size /= np.mean([theirs.long([bones[row] for row in leg]) for leg in legs])
    root = size * np.mean([theirs.places[bones[leg[-1]]] for leg in legs], axis=0)
    places, R = _posed(tree, turns, root)
    soles = Effectors.of(
        tree, {f"{f}{i}": (f, o) for f in feet for i, o in enumerate((HEEL, BALL))}
    )
    ground = _Ground.under(theirs.times, _at(places, R, soles), root)
    return Recorded(
        theirs.times,
        _at(places - ground.way[:, None], R, effectors),
        effectors.names,
        standing=ground.standing(effectors, [tree.index(foot) for foot in feet]),
        floor=ground.floor,
        speed=ground.speed,
    )


class _Theirs(NamedTuple):
    """The other's joints in time, heading along z: places (T, 3), turns (T, 3, 3)."""

    times: Array
    places: dict[str, Array]
    turns: dict[str, Array]
    zero: dict[str, Array]  # places (3,) in the zero pose
    ends: dict[str, Array]  # of each, a bone (3,) in the zero pose

    def bone(self, bones: Mapping[str, str], row: str, below: list[str]) -> Array:
        """Return the bone (3,) that lies along ours."""
        joint = bones[row]
        return self.zero[bones[below[0]]] - self.zero[joint] if below else self.ends[joint]

    def long(self, joints: list[str]) -> float:
        """Add up the distances between joints, one after the other."""
        return _long(np.array([self.zero[joint] for joint in joints]), range(len(joints)))


def _theirs(recording: Any, joints: set[str]) -> _Theirs:
    """Find the joints that are wanted."""
    tree, theta, times = recording.tree, recording.theta, recording.times
    if len(theta) < 4:
        raise ValueError(f"a recording needs 4 frames or more, not {len(theta)}")
    last = {name.rpartition(".")[0]: j for j, name in enumerate(tree.names)}
    last |= {name: j for j, name in enumerate(tree.names)}
    for joint in joints:
        if joint not in last:
            raise LookupError(unknown("joint of the recording", joint, last))
    frames = forward(tree, theta)
    roots = frames.positions[:, [last[joint] for joint in joints]].mean(axis=1)
    way = roots[-1] - roots[0]
    along = np.arctan2(way[0], way[2])
    c, s = np.cos(along), np.sin(along)
    turn = np.array([[c, 0, -s], [0, 1, 0], [s, 0, c]])  # so that the way is along z
    zero = forward(tree, np.zeros(len(tree))).positions
    ends = {}
    for joint in joints:
        below = np.flatnonzero((tree.parents == last[joint]) & tree.offsets.any(axis=1))
        effectors = recording.effectors
        own = effectors.offsets[effectors.joints == last[joint]]
        ends[joint] = tree.offsets[below[0]] if len(below) else [*own, np.zeros(3)][0]
    return _Theirs(
        times,
        {joint: frames.positions[:, last[joint]] @ turn.T for joint in joints},
        {joint: turn @ frames.orientations[:, last[joint]] for joint in joints},
        {joint: zero[last[joint]] for joint in joints},
        ends,
    )


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


def _long(places: Array, order: Any) -> float:
    """Add up the distances between places (n, 3), in this order."""
    chain = places[list(order)]
    return float(np.linalg.norm(np.diff(chain, axis=0), axis=1).sum())


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


class _Ground(NamedTuple):
    """The ground of a recording.

    way (T, 3) of a frame that goes along with it, its speed, floor as that frame has it, and
    down (T, 2 feet)
    """

    way: Array
    speed: float
    floor: float
    down: Mask

    @classmethod
    def under(cls, times: Array, soles: Array, root: Array) -> "_Ground":
        """Find the ground under soles (T, 2 feet, 3), heel and ball."""
        speed, start = np.polyfit(times, root[:, 2], 1)
        height = float(np.quantile(soles[..., 1].min(axis=1), 0.1))
        middle = root.mean(axis=0)
        way = np.stack([0 * times + middle[0], 0 * times + middle[1], speed * times + start], -1)
        fast = np.linalg.norm(np.gradient(soles, times, axis=0), axis=-1)
        down = (soles[..., 1] < height + NEAR) & (fast < SLOW)
        return cls(way, float(speed), height - float(middle[1]), down)

    def standing(self, effectors: Effectors, feet: list[int]) -> Mask:
        """Say which effectors stand, (T, k).

        They are those of a foot whose name says heel or ball.
        """
        stands = np.zeros((len(self.way), len(effectors)), dtype=bool)
        for i, (name, joint) in enumerate(zip(effectors.names, effectors.joints, strict=True)):
            if joint in feet and name.startswith(("heel", "ball")):
                stands[:, i] = self.down[:, 2 * feet.index(joint) + name.startswith("ball")]
        return stands
