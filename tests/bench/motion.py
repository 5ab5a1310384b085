"""Motion beyond the sine, in numbers: python tests/bench/motion.py [--fast]

Recorded, natural and the thesis's own walk, at 30 Hz: what is met, and what it looks like. Then the
cost of a tick. `--fast` leaves the cost out.
"""

import sys
from functools import partial
from time import perf_counter

import numpy as np

from ikteach import Effectors, dls_following, figures, forward, jacobian, locate
from ikteach.body.partials import by_differences
from ikteach.formats.bvh import read_bvh, recorded_walk, write_bvh
from ikteach.motion import gait
from ikteach.motion.live.session import Session
from ikteach.motion.paths import quality
from ikteach.motion.paths.bones import CMU
from ikteach.motion.paths.perform import imitate, perform
from ikteach.motion.paths.retarget import markers, retarget
from ikteach.motion.paths.walk import WALKS, Walk
from ikteach.study import gait_report

FEET = ("foot.l", "foot.r")
WALKER = figures.walker()
METHODS = {"sdls": "sdls", "following": dls_following, "dls": "dls"}


def files():
    """BVH read, written and read again; J of directions against differences."""
    walk = recorded_walk()
    again = read_bvh(write_bvh(walk, scale=1 / 0.056444), scale=0.056444)
    gap = [locate(forward(one.tree, one.theta), one.effectors) for one in (walk, again)]
    print(f"BVH read, written, read: {abs(gap[0] - gap[1]).max():.1e} m")
    tree, effectors = WALKER
    J = jacobian(tree, forward(tree, tree.rest), effectors)
    off = abs(J - by_differences(tree, tree.rest, effectors)).max()
    print(f"J of points and directions against differences: {off:.1e}")


def knee_angles(recording):
    """Knee angles (T, 2) of the recording, from places [degrees]."""
    places = forward(recording.tree, recording.theta).positions
    row = {name.rpartition(".")[0]: j for j, name in enumerate(recording.tree.names)}
    each = []
    for side in "Left", "Right":
        hip, knee, ankle = (places[:, row[f"{side}{one}"]] for one in ("UpLeg", "Leg", "Foot"))
        thigh, shin = knee - hip, ankle - knee
        cos = np.vecdot(thigh, shin) / np.linalg.norm([thigh, shin], axis=-1).prod(axis=0)
        each.append(np.degrees(np.arccos(cos)))
    return np.stack(each, axis=-1)


def retargeted():
    """The recorded walk by thirteen effectors, and by four."""
    tree, all_of_them = WALKER.tree, markers(WALKER.tree)
    each = zip(all_of_them.names, all_of_them.joints, all_of_them.offsets.tolist(), strict=True)
    four = {name: (tree.names[j], o) for name, j, o in each if name[:4] in ("ball", "hand")}
    print("\nthe recorded walk             targets [mm]   knees off [degrees]")
    for effectors in all_of_them, Effectors.of(tree, four):
        path = retarget(recorded_walk(), figures.Figure(tree, effectors), CMU, feet=FEET)
        run = perform(path, figures.Figure(tree, effectors), "dls", cycles=1)
        knees = np.degrees(run.theta[:, [tree.index("knee.l"), tree.index("knee.r")]])
        first = round(path.times[0] / recorded_walk().dt)
        theirs = knee_angles(recorded_walk())[first : first + len(run)]
        off = np.sqrt(((knees - theirs) ** 2).mean())
        met = 1000 * run.error.mean()
        print(f"dls × 2, {len(effectors):2} effectors{'':12}{met:10.1f}{off:17.1f}")


def walks():
    """A walk at each speed of the norms, and that of the thesis."""
    for speed, walk in zip(quality.SPEEDS, WALKS.values(), strict=True):
        runs = {name: perform(walk, WALKER, solver, cycles=4) for name, solver in METHODS.items()}
        runs["the norm itself"] = imitate(walk, WALKER, cycles=4, speed=speed)
        print(f"\n{walk.name}, {walk.speed} m/s, against the norm {speed!r} [m, degrees]")
        print(gait_report(runs, walk, speed=speed).round(4).to_string())
    human = figures.human()
    runs = {name: perform(gait.walking, human, solver) for name, solver in METHODS.items()}
    print("\nthe thesis's walk")
    print(gait_report(runs, gait.walking).round(4).to_string())


def tick(session, count=60):
    """Seconds of a tick, the median."""
    each = []
    for _ in range(count):
        began = perf_counter()
        session.tick()
        each.append(perf_counter() - began)
    return np.median(each)


def cost():
    """A walker's tick by four methods, over a human's, measured in turns."""
    thirteen = figures.Figure(WALKER.tree, markers(WALKER.tree))
    recorded = retarget(recorded_walk(), thirteen, CMU, feet=FEET)
    them = {
        "human × 4 effectors × 1": partial(Session, gait=gait.walking),
        "walker × 7 × 2, natural": partial(Session, WALKER, Walk(), iterations=2),
        "walker × 13 × 2, recorded": partial(Session, thirteen, recorded, iterations=2),
    }
    sessions = {name: make() for name, make in them.items()}
    rounds = [{name: tick(session) for name, session in sessions.items()} for _ in range(5)]
    human = np.median([one["human × 4 effectors × 1"] for one in rounds])
    print("\na tick of four methods [ms], over the human's")
    for name in sessions:
        own = np.median([one[name] for one in rounds])
        print(f"{name:28}{1000 * own:8.2f}{own / human:8.2f}")


if __name__ == "__main__":
    files()
    retargeted()
    walks()
    if "--fast" not in sys.argv:
        cost()
