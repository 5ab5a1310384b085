"""A made-up person who walks, as BVH files of many programs' habits."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cache

import numpy as np

from ikteach import figures, forward
from ikteach.body.figures import BALL, HAND
from ikteach.motion.paths.bones import CMU
from ikteach.motion.paths.perform import perform
from ikteach.motion.paths.walk import natural, turned

PARENTS = {  # of the joints, by the names of the recorded walk
    "Hips": None,
    "Spine1": "Hips",
    **{f"{s}UpLeg": "Hips" for s in ("Left", "Right")},
    **{f"{s}Leg": f"{s}UpLeg" for s in ("Left", "Right")},
    **{f"{s}Foot": f"{s}Leg" for s in ("Left", "Right")},
    **{f"{s}Arm": "Spine1" for s in ("Left", "Right")},
    **{f"{s}ForeArm": f"{s}Arm" for s in ("Left", "Right")},
}
ENDS = {f"{s}Foot": BALL for s in ("Left", "Right")} | {
    f"{s}ForeArm": HAND for s in ("Left", "Right")
}
Z_UP = np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])


@cache
def walk():
    """Zero places {joint: (3,)}, turns {joint: (T, 3, 3)}, and the root's way (T, 3) [m]."""
    run = perform(natural, figures.walker(), "sdls", cycles=2.7)
    tree, row = run.tree, {joint: figures.walker().tree.index(r) for r, joint in CMU.items()}
    frames, zero = forward(tree, run.theta), forward(tree, np.zeros(len(tree))).positions
    gone = frames.positions[:, row["Hips"]] + [0, 0.92, 0]
    gone[:, 2] += natural.pace * run.times
    zeros = {joint: zero[j] for joint, j in row.items()}
    return zeros, {joint: frames.orientations[:, j] for joint, j in row.items()}, gone


@dataclass
class Person:
    """How a program writes the person.

    called    the joints, from their names in the recorded walk
    unit      of the file [m]
    order     of rotation channels
    world     (3, 3) what it takes for our x, y and z, in the whole file
    turn      (3, 3) of the root alone
    floor     height of the ground [m]
    arms      degrees by which the arms are lifted in the zero pose
    first     whether the first frame is a pose to measure by
    channels  "6" everywhere, "in place" with OFFSET in the position channels too, or 3 but at the
              root
    ends      whether there are End Sites
    text      changes the text
    """

    called: Callable[[str], str] = str
    unit: float = 0.01
    order: str = "ZXY"
    world: np.ndarray = field(default_factory=lambda: np.eye(3))
    turn: np.ndarray = field(default_factory=lambda: np.eye(3))
    floor: float = 0.0
    arms: float = 90.0
    first: bool = False
    channels: str = ""
    ends: bool = True
    text: Callable[[str], str] = str

    def bvh(self) -> str:
        """The text of the file."""
        zeros, turns, gone = walk()
        lifted = {joint: np.eye(3) for joint in PARENTS}
        for side, x in (("Left", 1), ("Right", -1)):
            for joint in (f"{side}Arm", f"{side}ForeArm"):
                lifted[joint] = turned("z", np.asarray(x * self.arms))
        offsets = {
            joint: self.world @ lifted[above] @ (zeros[joint] - zeros[above])
            for joint, above in PARENTS.items()
            if above
        }
        R = {j: self.world @ turns[j] @ lifted[j].T @ self.world.T for j in PARENTS}
        R = {j: self.turn @ one for j, one in R.items()}
        at = (gone + [0, self.floor, 0]) @ self.world.T @ self.turn.T
        if self.first:
            R = {j: np.concatenate([np.eye(3)[None], one]) for j, one in R.items()}
            at = np.concatenate([np.zeros((1, 3)), at])
        lines, columns = ["HIERARCHY"], []
        self._joint("Hips", 0, lines, columns, offsets, lifted, R, at)
        table = np.concatenate(columns, axis=1)
        lines += ["MOTION", f"Frames: {len(table)}", f"Frame Time: {1 / 30:.6f}"]
        lines += [" ".join(f"{value:.6f}" for value in row) for row in table]
        return self.text("\n".join([*lines, ""]))

    def _joint(self, joint, depth, lines, columns, offsets, lifted, R, at) -> None:
        above, tab = PARENTS[joint], "  " * depth
        offset = offsets.get(joint, np.zeros(3)) / self.unit
        local = R[joint] if above is None else np.swapaxes(R[above], -1, -2) @ R[joint]
        names = [f"{letter}rotation" for letter in self.order]
        places = above is None or self.channels
        if places:
            names = ["Xposition", "Yposition", "Zposition", *names]
            moved = at / self.unit if above is None else np.zeros_like(at)
            columns.append(moved + (offset if above and self.channels == "in place" else 0))
        columns.append(np.degrees(angles(self.order, local)))
        lines += [f"{tab}{'JOINT' if above else 'ROOT'} {self.called(joint)}", tab + "{"]
        lines.append(f"{tab}  OFFSET {' '.join(f'{x:.6f}' for x in offset)}")
        lines.append(f"{tab}  CHANNELS {len(names)} {' '.join(names)}")
        for below in (one for one, up in PARENTS.items() if up == joint):
            self._joint(below, depth + 1, lines, columns, offsets, lifted, R, at)
        if self.ends and joint in ENDS:
            end = self.world @ lifted[joint] @ np.asarray(ENDS[joint]) / self.unit
            lines += [f"{tab}  End Site", tab + "  {"]
            lines += [f"{tab}    OFFSET {' '.join(f'{x:.6f}' for x in end)}", tab + "  }"]
        lines.append(tab + "}")


def angles(order: str, R: np.ndarray) -> np.ndarray:
    """Angles (T, 3) [rad] with R = R_1 R_2 R_3 about three different axes."""
    i, j, k = ("XYZ".index(letter) for letter in order)
    sign = 1 if (j - i) % 3 == 1 else -1
    middle = np.arcsin(np.clip(sign * R[:, i, k], -1, 1))
    first = np.arctan2(-sign * R[:, j, k], R[:, k, k])
    last = np.arctan2(-sign * R[:, i, j], R[:, i, i])
    return np.stack([first, middle, last], axis=-1)


def said(names: Mapping[str, str], sides: Callable[[str, str], str]) -> Callable[[str], str]:
    """How a program calls joints: words for the parts, and where the side stands."""

    def called(joint: str) -> str:
        for side in ("Left", "Right"):
            if joint.startswith(side):
                return sides(names[joint.removeprefix(side)], side)
        return names[joint]

    return called


def _words(text: str) -> dict[str, str]:
    parts = ("Hips", "Spine1", "UpLeg", "Leg", "Foot", "Arm", "ForeArm")
    return dict(zip(parts, text.split(","), strict=True))


NAMES = {  # of joints, in these programs
    "MotionBuilder": said(_words("Hips,Spine1,UpLeg,Leg,Foot,Arm,ForeArm"), lambda w, s: s + w),
    "Mixamo": lambda joint: f"mixamorig:{joint}",
    "Mixamo in Blender": lambda joint: f"mixamorig_{joint}",
    "Rokoko": said(_words("Hips,Spine3,Thigh,Shin,Foot,Arm,ForeArm"), lambda w, s: s + w),
    "Xsens": said(_words("Hips,Chest,Hip,Knee,Ankle,Shoulder,Elbow"), lambda w, s: s + w),
    "MVN": said(_words("Pelvis,T8,UpperLeg,LowerLeg,Foot,UpperArm,ForeArm"), lambda w, s: s + w),
    "Bandai": said(
        _words("Hips,Chest,UpperLeg,LowerLeg,Foot,UpperArm,LowerArm"), lambda w, s: f"{w}_{s[0]}"
    ),
    "Biped": said(
        _words("Bip01,Bip01 Spine1,Thigh,Calf,Foot,UpperArm,Forearm"),
        lambda w, s: f"Bip01 {s[0]} {w}",
    ),
    "Truebones": said(
        _words("Hips,BN_Chest,Thigh,Calf,Foot,UpperArm,ForeArm"), lambda w, s: f"BN_{s[0]}_{w}"
    ),
    "Daz": said(
        _words("hip,chestLower,ThighBend,Shin,Foot,ShldrBend,ForearmBend"),
        lambda w, s: s[0].lower() + w,
    ),
    "Unreal": said(
        _words("pelvis,spine_01,thigh,calf,foot,upperarm,lowerarm"),
        lambda w, s: f"{w}_{s[0].lower()}",
    ),
    "Rigify": said(
        _words("DEF-spine,DEF-spine.003,thigh,shin,foot,upper_arm,forearm"),
        lambda w, s: f"DEF-{w}.{s[0]}",
    ),
    "MakeHuman": said(
        _words("root,spine03,upperleg01,lowerleg01,foot,upperarm01,lowerarm01"),
        lambda w, s: f"{w}.{s[0]}",
    ),
    "VRM": said(
        _words("J_Bip_C_Hips,J_Bip_C_Chest,UpperLeg,LowerLeg,Foot,UpperArm,LowerArm"),
        lambda w, s: f"J_Bip_{s[0]}_{w}",
    ),
    "Second Life": said(
        _words("mPelvis,mTorso,Hip,Knee,Ankle,Shoulder,Elbow"), lambda w, s: f"m{w}{s}"
    ),
    "SMPL": said(
        _words("pelvis,spine1,hip,knee,ankle,shoulder,elbow"), lambda w, s: f"{s.lower()}_{w}"
    ),
    "nobody's words for the trunk": said(
        _words("a,b,UpLeg,Leg,Foot,Arm,ForeArm"), lambda w, s: s + w
    ),
}
HABITS = {
    **{order: Person(order=order) for order in ("XYZ", "XZY", "YXZ", "YZX", "ZYX")},
    "metres": Person(unit=1.0),
    "inches": Person(unit=0.0254),
    "millimetres": Person(unit=0.001),
    "a unit of its own": Person(unit=0.37),
    "arms down": Person(arms=0.0),
    "A-pose": Person(arms=45.0),
    "a pose first": Person(first=True),
    "a pose first, z up": Person(first=True, world=Z_UP),
    "z up": Person(world=Z_UP),
    "z up by the root": Person(turn=Z_UP),
    "x up": Person(world=np.roll(np.eye(3), 1, axis=1)),
    "facing back": Person(world=turned("y", np.asarray(180.0))),
    "going right": Person(turn=turned("y", np.asarray(-90.0))),
    "going askew": Person(turn=turned("y", np.asarray(37.0))),
    "a high floor": Person(floor=3.0),
    "a floor below": Person(floor=-12.0, unit=0.0254),
    "6 channels": Person(channels="6"),
    "OFFSET in place": Person(channels="in place"),
    "no End Sites": Person(ends=False),
    "CRLF": Person(text=lambda text: text.replace("\n", "\r\n")),
    "tabs and a mark": Person(text=lambda text: "\ufeff" + text.replace("  ", "\t")),
}
