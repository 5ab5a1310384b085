"""Which joint of a recording is which bone of ours: what programs call them."""

import re
from collections.abc import Iterator, Mapping, Sequence
from itertools import takewhile
from typing import Any

from ikteach.body import Tree
from ikteach.checks import shown

SIDES = {"left": ("left", "l"), "right": ("right", "r")}
MIDDLE = ("", "c", "center", "mid")  # what a bone between the sides may be marked by

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
    "hip.turn": ("upleg", "thigh", "thighbend", "upperleg", "femur", "hip", "hipturn"),
    "knee": ("leg", "shin", "knee", "lowleg", "lowerleg", "calf", "tibia"),
    "foot": ("foot", "ankle"),
    "shoulder.turn": (
        *("arm", "uparm", "upperarm", "shldr", "shldrbend", "humerus", "shoulder"),
        "shoulderturn",
    ),
    "elbow": ("forearm", "forearmbend", "elbow", "lowarm", "lowerarm", "radius"),
    "pelvis.z": ("hips", "pelvis", "hip", "lowertorso", "root"),
    "spine.twist": (
        *("spine1", "chest", "spine2", "chest2", "spine3", "chestlower", "uppertorso", "thorax"),
        *("t8", "torso", "spinetwist", "spine", "abdomen"),
    ),
}


def bones_of(recording: Any) -> dict[str, str]:
    """Find a walker's bones in a recording, by what programs call them.

    {row of ours: joint of theirs}, for `retarget` to `figures.walker()`. Words like LeftUpLeg,
    lThigh, thigh_l and mixamorig:LeftUpLeg are known, and those of our own files. Where no name is
    known, the pelvis is where the legs meet, the chest where the arms do, and a foot is the end of
    a leg. LookupError names what is not found.
    """
    rows = recording.tree.names
    joints = [*dict.fromkeys(name.rpartition(".")[0] for name in rows)]
    known = _words([*joints, *recording.effectors.names])
    bones: dict[str, str] = {}
    for part in CALLED:
        sides = {"": MIDDLE} if part in ("pelvis.z", "spine.twist") else SIDES
        for side, marks in sides.items():
            row = f"{part}.{side[0]}" if side else part
            found = next((known[one] for one in _forms(CALLED[part], marks) if one in known), None)
            if found is None or found in bones.values():
                found = _by_place(recording, bones, part, row)
            if found is None:
                what = f"{side} {CALLED[part][0]}".strip()
                raise LookupError(
                    f"no joint of the recording is its {what}: {shown(', '.join(joints))}"
                )
            bones[row] = found
    return {row: bones[row] for row in CMU}


def _forms(words: Sequence[str], marks: Sequence[str]) -> Iterator[str]:
    """Go through the words with their marks before them or behind."""
    for word in words:
        for mark in marks:
            yield from (mark + word, word + mark)


def _words(names: Sequence[str]) -> dict[str, str]:
    """Make {word: name}, without what all names begin with, name space, signs and zeros.

    Where a word is free, the name without its numbers counts, too. The first name is taken.
    """
    spaceless = {name: name.rpartition(":")[2] for name in names}
    plain = {name: _letters(one) for name, one in spaceless.items()}
    shared = _shared([one for one in plain.values() if one not in ROOTS])
    lone = {name: one.removeprefix(shared) or one for name, one in plain.items()}
    words: dict[str, str] = {}
    for made in (plain, lone, {name: re.sub(r"\d", "", one) for name, one in lone.items()}):
        for name, word in made.items():
            words.setdefault(word, name)
    return words


def _shared(words: Sequence[str]) -> str:
    """Find the letters that all words begin with."""
    columns = zip(*words, strict=False)
    return "".join(column[0] for column in takewhile(lambda one: len({*one}) == 1, columns))


ROOTS = ("root", "ground", "hips", "hip", "pelvis", "reference", "armature")  # without a prefix


def _letters(name: str) -> str:
    """Give a name in small letters, without signs, and zeros before numbers."""
    name = re.sub(r"\.end$", "", name)  # of an effector
    return re.sub(r"[\W_]+0*", "", name).lower()


def _by_place(recording: Any, bones: Mapping[str, str], part: str, row: str) -> str | None:
    """Find a pelvis, chest or foot by where it is among the bones that are known."""
    tree, effectors = recording.tree, recording.effectors
    below = {"pelvis.z": "hip.turn", "spine.twist": "shoulder.turn"}.get(part)
    if below is not None:
        each = [_above(tree, bones[f"{below}.{side}"]) for side in "lr"]
        met = next((j for j in each[0][1:] if j in each[1][1:]), None)
        return None if met is None else str(tree.names[met]).rpartition(".")[0]
    if part == "foot":
        knee = row_of(tree, bones[f"knee.{row[-1]}"])
        ends = [
            name
            for name, j in zip(effectors.names, effectors.joints.tolist(), strict=True)
            if knee in tree.above(j)
        ]
        return ends[0] if ends else None
    return None


def _above(tree: Tree, joint: str) -> list[int]:
    """List the rows from the first of a joint up to the ground."""
    first = next(j for j, name in enumerate(tree.names) if name.rpartition(".")[0] == joint)
    return [first, *tree.above(first)[1:]]


def row_of(tree: Tree, joint: str) -> int:
    """Return the last row of a joint, the lowest."""
    return max(j for j, name in enumerate(tree.names) if name.rpartition(".")[0] == joint)
