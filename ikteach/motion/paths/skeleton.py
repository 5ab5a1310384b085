"""The bones of whom a motion was recorded from, in the place and size of who follows it."""

from collections.abc import Mapping
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np

from ikteach.arrays import Array
from ikteach.body import Effectors, Tree, forward, locate
from ikteach.motion.path import Motion
from ikteach.motion.paths.recorded import Recorded

LEGS = tuple((f"hip.turn.{s}", f"knee.{s}", f"foot.{s}") for s in "lr")  # rows of a walker
PLACES = ("knee.l", "knee.r", "elbow.l", "elbow.r")  # rows whose own place is a target, too


def with_skeleton(path: Recorded, recording: Any, bones: Mapping[str, str], tree: Tree) -> Recorded:
    """Give a motion the bones of its recording.

    path   as `retarget` makes it, with targets for pelvis, knees and elbows, at times of the
           recording
    bones  {row of ours: joint of theirs}, as `retarget` takes them
    tree   of a walker

    Its `skeleton` has targets at both ends of every bone, one after the other, as seen from the
    pelvis. Their legs are as long as ours, and they are turned so that knees and elbows are where
    the targets are, all in all (Kabsch 1976, Acta Cryst. A 32:922).
    """
    frame = np.searchsorted(recording.times, path.times - recording.dt / 2)
    places, ends = _joints(recording, frame)
    pelvis = np.mean([places[bones[row]] for row, *_ in LEGS], axis=0)
    theirs = np.stack([places[bones[row]] - pelvis for row in PLACES], axis=1)
    at = dict(zip(path.names, path.targets.swapaxes(0, 1), strict=True))
    ours = np.stack([at[row] - at["pelvis"] for row in PLACES], axis=1)
    U, _, V = np.linalg.svd(np.einsum("tki,tkj->ij", ours, theirs))
    R = (U * [1, 1, np.sign(np.linalg.det(U @ V))]) @ V
    rest = forward(tree, np.zeros(len(tree))).positions
    size = np.mean([_long([rest[tree.index(row)] for row in leg]) for leg in LEGS])
    size /= np.mean([_long([places[bones[row]] for row in leg]) for leg in LEGS])
    names = [f"{bone}, {end}" for bone in ends for end in ("from", "to")]
    pairs = np.stack([np.stack(pair, axis=1) for pair in ends.values()], axis=1)  # (T, b, 2, 3)
    seen = size * (pairs - pelvis[:, None, None]) @ R.T
    flat = seen.reshape(len(seen), -1, 3)
    return replace(path, skeleton=Recorded(path.times, flat, tuple(names), name="skeleton"))


def bones_at(motion: Motion, phase: float, effectors: Effectors, targets: Array) -> Array | None:
    """Return the bones of a recorded motion, (b, 2, 3) [m].

    They hang at the target of the pelvis or, of a human whose pelvis is the ground, in the origin.
    None if the motion was not recorded.
    """
    skeleton = getattr(motion, "skeleton", None)
    if skeleton is None:
        return None
    names = effectors.names
    root = targets[names.index("pelvis")] if "pelvis" in names else np.zeros(3)
    return np.asarray(skeleton.at(phase).reshape(-1, 2, 3) + root)


def _long(chain: list[Array]) -> float:
    """Add up the mean distances between places (..., 3) of a chain."""
    return sum(float(np.linalg.norm(b - a, axis=-1).mean()) for a, b in pairwise(chain))


def _joints(
    recording: Any, frames: Array
) -> tuple[dict[str, Array], dict[str, tuple[Array, Array]]]:
    """Place joints (T, 3) by name, and both ends of each bone by the name of what it leads to."""
    tree, effectors = recording.tree, recording.effectors
    posed = forward(tree, recording.theta[frames])
    places = {name.rpartition(".")[0]: posed.positions[:, j] for j, name in enumerate(tree.names)}
    tips = locate(posed, effectors)
    places |= {name: tips[:, i] for i, name in enumerate(effectors.names)}
    bones = {}
    for j, name in enumerate(tree.names):
        joint, above = name.rpartition(".")[0], int(tree.parents[j])
        before = tree.names[above].rpartition(".")[0] if above >= 0 else joint
        if before != joint:
            bones[joint] = places[before], places[joint]
    for name, j in zip(effectors.names, effectors.joints, strict=True):
        bones[name] = places[tree.names[j].rpartition(".")[0]], places[name]
    return places, bones
