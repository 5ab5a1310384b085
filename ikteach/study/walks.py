"""Chapter 11: three walks of one body, recorded, the thesis's, and a natural one."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
import pandas as pd

from ikteach.arrays import Array
from ikteach.body import Effectors, Tree, forward, locate
from ikteach.body.figures import BALL, GAZE, HAND, HEEL, Figure, walker
from ikteach.motion import gait
from ikteach.motion.live.session import Session
from ikteach.motion.path import Motion
from ikteach.motion.paths.bones import CMU, bones_of
from ikteach.motion.paths.perform import imitate, perform
from ikteach.motion.paths.recorded import Recorded
from ikteach.motion.paths.retarget import retarget
from ikteach.motion.paths.skeleton import with_skeleton
from ikteach.motion.paths.walk import natural
from ikteach.motion.track import Track
from ikteach.study.gaits import gait_report

FEET = ("foot.l", "foot.r")  # rows of a walker that lie flat in both zero poses
BALLS = dict(zip(gait.walking.names, ("ball.l", "ball.r", "hand.r", "hand.l"), strict=True))
NOTES = ("play", "pause", "error", "reset")  # events of a session that set nothing
FRAMES = 240  # of a cycle of the thesis's walk
FINE = 1 / 60  # time between two frames of a walk that is written down [s]
LONGEST = 60.0  # of a recording that becomes a human's motion [s]


def limbs(tree: Tree, names: Sequence[str] | None = None) -> Effectors:
    """Return effectors of a walker by their names, or all 13.

    The pelvis and two of its directions; heel and ball of each foot, knees, elbows, hands.
    """
    points: dict[str, tuple[str, Sequence[float]]] = {"pelvis": ("pelvis.z", (0, 0, 0))}
    for side in "lr":
        foot, elbow = f"foot.{side}", f"elbow.{side}"
        points |= {f"heel.{side}": (foot, HEEL), f"ball.{side}": (foot, BALL)}
        points |= {f"knee.{side}": (f"knee.{side}", (0, 0, 0)), elbow: (elbow, (0, 0, 0))}
        points[f"hand.{side}"] = (elbow, HAND)
    up, ahead = ("pelvis.z", (0, GAZE, 0)), ("pelvis.z", (0, 0, GAZE))
    directions = {"pelvis.up": up, "pelvis.ahead": ahead}
    if names is not None:
        points = {name: at for name, at in points.items() if name in names}
        directions = {name: at for name, at in directions.items() if name in names}
    return Effectors.of(tree, points, directions=directions)


def three_walks(recording: Any) -> dict[str, tuple[Figure, Motion]]:
    """Make {"recorded", "thesis", "natural": (figure, motion)}.

    recording  a walk, as `formats.bvh.recorded_walk` gives it

    All have the tree of `figures.walker()`, each the effectors that its targets ask for. Of the
    thesis's human the pelvis is the ground: those rows are stiff, and so are the feet.
    """
    tree, walk = walker().tree, gait.walking
    thirteen = Figure(tree, limbs(tree))
    recorded = retarget(recording, thirteen, CMU, feet=FEET)
    recorded = with_skeleton(recorded, recording, CMU, tree)
    times = walk.period * np.arange(FRAMES) / FRAMES
    course = walk.on(*Figure(tree, _as_thesis(tree)))
    targets = np.array([course.at(walk.rate * t) for t in times])
    stiff = [row for row in tree.names if row.startswith(("pelvis", "foot", "toes"))]
    thesis = Recorded(
        times,
        targets,
        tuple(BALLS[name] for name in walk.names),
        name="thesis",
        standing=walk.stands(walk.rate * times),
        floor=course.floor,
        speed=walk.pace,
        wound=dict.fromkeys(stiff, 0.0),
    )
    four = Figure(tree, limbs(tree, thesis.names))
    return {
        "recorded": (thirteen, recorded),
        "thesis": (four, thesis),
        "natural": (walker(), natural),
    }


def for_human(path: Motion, figure: Figure, name: str) -> Recorded:
    """Make the thesis's four targets of a walker's motion.

    For a human whose pelvis is the ground: balls and hands as `figure` has them when it follows
    `path`, seen from its pelvis.
    """
    run = perform(path, figure, "sdls", cycles=1, dt=FINE)
    frames, tree = forward(run.tree, run.theta), run.tree
    four = _as_thesis(tree)
    pelvis = frames.positions[:, tree.index("pelvis.z")]
    down, standing = path.stands(path.rate * run.times), np.zeros((len(run), len(four)), dtype=bool)
    for i, side in enumerate("lr"):  # the order of the thesis's feet
        foot = [path.names.index(f"{point}.{side}") for point in ("heel", "ball")]
        standing[:, i] = down[:, foot].any(axis=1)
    return Recorded(
        run.times,
        locate(frames, four) - pelvis[:, None],
        four.names,
        name=name,
        standing=standing,
        skeleton=getattr(path, "skeleton", None),
        floor=path.on(*figure).floor - float(pelvis[:, 1].mean()),
        speed=path.pace,
        notes=getattr(path, "notes", ()),
    )


def imported(recording: Any, name: str) -> Recorded:
    """Make the thesis's four targets of a recording of a person.

    Its bones are found by what programs call them; of a long one the first minute is taken. Its
    `notes` say what was done to it. The errors are those of `retarget`.
    """
    tree, most = walker().tree, int(LONGEST / recording.dt) + 1
    figure, long = Figure(tree, limbs(tree)), len(recording.theta) > most
    recording = recording._replace(theta=recording.theta[:most])
    bones = bones_of(recording)
    path = retarget(recording, figure, bones, feet=FEET)
    if long:
        path = replace(path, notes=(f"Only its first {LONGEST:g} s were taken.", *path.notes))
    return for_human(with_skeleton(path, recording, bones, tree), figure, name)


def _as_thesis(tree: Tree) -> Effectors:
    """Return the thesis's four effectors, by its names, of a walker."""
    known = limbs(tree, [*BALLS.values()])
    at = dict(zip(known.names, zip(known.joints, known.offsets, strict=True), strict=True))
    return Effectors.of(
        tree, {name: (tree.names[at[ours][0]], at[ours][1]) for name, ours in BALLS.items()}
    )


class Followed(NamedTuple):
    """How well a recorded walk was followed.

    limbs  mean distance of feet and hands to their targets [m]
    knees  how far the knees are from the recorded ones, root mean square [degrees]
    """

    run: Track
    limbs: float
    knees: float


def followed(recording: Any, parts: Sequence[str] | None = None, method: str = "dls") -> Followed:
    """Follow a recorded walk by some effectors.

    parts  beginnings of their names, such as "ball" and "hand"; all thirteen if none are given
    """
    tree = walker().tree
    names = [name for name in limbs(tree).names if parts is None or name.startswith(tuple(parts))]
    figure = Figure(tree, limbs(tree, names))
    path = retarget(recording, figure, CMU, feet=FEET)
    run = perform(path, figure, method, cycles=1, dt=recording.dt)
    four = [name.startswith(("ball", "hand")) for name in figure.effectors.names]
    ours = np.degrees(run.theta[:, [tree.index("knee.l"), tree.index("knee.r")]])
    first = round(path.times[0] / recording.dt)
    off = ours - knee_angles(recording)[first : first + len(run)]
    return Followed(run, float(run.error[:, four].mean()), float(np.sqrt(np.mean(off**2))))


def knee_angles(recording: Any) -> Array:
    """Find the knee angles of the recorded walk from places, (T, 2) [degrees].

    Left and right: the angle between thigh and shin.
    """
    tree, each = recording.tree, []
    places = forward(tree, recording.theta).positions
    row = {name.rpartition(".")[0]: j for j, name in enumerate(tree.names)}
    for side in "Left", "Right":
        hip, knee, ankle = (places[:, row[f"{side}{one}"]] for one in ("UpLeg", "Leg", "Foot"))
        thigh, shin = knee - hip, ankle - knee
        long = np.linalg.norm(thigh, axis=-1) * np.linalg.norm(shin, axis=-1)
        each.append(np.degrees(np.arccos(np.clip(np.vecdot(thigh, shin) / long, -1, 1))))
    return np.stack(each, axis=-1)


def compared(recording: Any, methods: Sequence[str], *, cycles: float = 3) -> pd.DataFrame:
    """Measure the three walks by each method.

    And the norm's angles, for which nothing is solved. The columns are those of `gait_report`.
    """
    runs: dict[str, Track] = {}
    paths: dict[str, Motion] = {}
    for name, (figure, path) in three_walks(recording).items():
        for method in methods:
            runs[f"{name}, {method}"] = perform(path, figure, method, cycles=cycles)
            paths[f"{name}, {method}"] = path
    runs["norm, not solved"] = imitate(natural, walker(), cycles=cycles)
    paths["norm, not solved"] = natural
    return gait_report(runs, paths)


def lately(session: Session, last: int) -> Track | None:
    """Return the last ticks on the motion's own clock.

    The poses are those of the shown method, from when the session was last set otherwise: before,
    it was another walk. The time of a frame is its phase by `path.rate`, as the measures of a gait
    want it. None before the second tick.
    """
    changes = [e.tick for e in session.events if e.run == session.runs and e.kind not in NOTES]
    log = session.log(last=last)
    begin = int(np.searchsorted(log.tick, max(changes, default=0), side="right"))
    if len(log) - begin < 2:
        return None
    run = log.tracks()[session.method]
    return replace(
        run,
        times=log.phase[begin:] / session.gait.rate,
        targets=run.targets[begin:],
        theta=run.theta[begin:],
        error=run.error[begin:],
        capped=run.capped[begin:],
        held=run.held[begin:],
    )
