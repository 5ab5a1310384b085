"""Recordings and drawings as motions, and a recorded walk on another body."""

import re
from dataclasses import replace
from math import pi

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from ikteach import Effectors, figures, forward, locate
from ikteach.formats.bvh import recorded_walk
from ikteach.motion.paths import quality
from ikteach.motion.paths.bones import CMU, bones_of
from ikteach.motion.paths.perform import perform
from ikteach.motion.paths.recorded import Recorded, drawn
from ikteach.motion.paths.retarget import between, markers, retarget

ARM = figures.planar_arm(3)
TREE = figures.walker().tree
FEET = ("foot.l", "foot.r")


def walk_of(tree=TREE, effectors=None):
    figure = figures.Figure(tree, markers(tree) if effectors is None else effectors)
    return figure, retarget(recorded_walk(), figure, CMU, feet=FEET)


def test_at_its_own_times_a_recording_gives_its_own_targets():
    rng = np.random.default_rng(0)
    times = np.array([1.0, 1.5, 3.0, 3.25])
    one = Recorded(times, rng.normal(size=(4, 2, 3)), ("a", "b"), tempo=2.0)
    assert one.span == pytest.approx(2.5)
    assert one.period == pytest.approx(1.25)
    phases = 2 * pi * (times - 1) / one.span
    assert_allclose(one.at(phases), one.targets, atol=1e-9)
    assert_allclose(
        one.at(phases[3] + 2 * pi * 0.125 / 2.5)[0], one.targets[[3, 0], 0].mean(axis=0)
    )


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"times": [1.0]}, "two or more"),
        ({"times": [1.0, 1.0]}, "ascend"),
        ({"targets": np.zeros((2, 2, 3))}, r"need targets \(2, 1, 3\)"),
        ({"targets": np.full((2, 1, 3), np.nan)}, "finite"),
        ({"tempo": 0}, "tempo"),
        ({"standing": [True]}, "standing needs"),
    ],
)
def test_a_recording_that_is_none_is_refused(change, words):
    one = Recorded(np.array([0.0, 1.0]), np.zeros((2, 1, 3)), ("hand",))
    with pytest.raises(ValueError, match=words):
        replace(one, **change)


def test_a_curve_is_gone_along_always_as_fast():
    square = [[1, 0, 0], [2, 0, 0], [2, 0, 0], [2, 1, 0], [1, 1, 0]]
    path = drawn(square, 4.0, figure=ARM)
    assert path.period == pytest.approx(4)
    s = path.at(np.linspace(0, 2 * pi, 400, endpoint=False))[:, 0]
    speed = np.linalg.norm(np.diff(s, axis=0), axis=1) / (4 / 400)
    assert np.median(speed) == pytest.approx(1, abs=0.01)
    assert s.min(axis=0) == pytest.approx([1, 0, 0], abs=0.03)
    assert s.max(axis=0) == pytest.approx([2, 1, 0], abs=0.03)


def test_the_other_targets_of_a_drawing_stay():
    human = figures.human()
    path = drawn([[0, 1, 0], [0, 1, 1]], 2, figure=human, effector="hand.l")
    rest = locate(forward(human.tree, human.tree.rest), human.effectors)
    assert_allclose(path.at(1.0)[:3], rest[:3], atol=1e-15)


@pytest.mark.parametrize(
    ("points", "period", "effector", "error", "words"),
    [
        ([[0, 0, 0]], 1, None, ValueError, "two or more points"),
        ([[0, 0], [1, 1]], 1, None, ValueError, "two or more points"),
        ([[0, 0, 0], [0, 0, 0]], 1, None, ValueError, "in one place"),
        ([[0, 0, 0], [1, 0, 0]], 0, None, ValueError, "period"),
        ([[0, 0, 0], [1, 0, 0]], 1, "hnad", LookupError, "did you mean 'hand'"),
        ([[0, 0, 0], [1, 0, np.inf]], 1, None, ValueError, "two or more points"),
    ],
)
def test_a_drawing_that_is_none_is_refused(points, period, effector, error, words):
    with pytest.raises(error, match=words):
        drawn(points, period, figure=ARM, effector=effector)


def recorded_knees():
    """Knee angles (T, 2) of the recording, from three places [degrees]."""
    walk = recorded_walk()
    places = forward(walk.tree, walk.theta).positions
    row = {name.rpartition(".")[0]: j for j, name in enumerate(walk.tree.names)}
    angles = []
    for side in "Left", "Right":
        hip, knee, ankle = (places[:, row[f"{side}{one}"]] for one in ("UpLeg", "Leg", "Foot"))
        thigh, shin = knee - hip, ankle - knee
        cos = np.vecdot(thigh, shin) / np.linalg.norm([thigh, shin], axis=-1).prod(axis=0)
        angles.append(np.degrees(np.arccos(cos)))
    return np.stack(angles, axis=-1)


def knees_along(path):
    """Those of the frames that were taken."""
    return recorded_knees()[round(path.times[0] / recorded_walk().dt) :]


def knees(run):
    return np.degrees(run.theta[:, [run.tree.index("knee.l"), run.tree.index("knee.r")]])


def test_a_recorded_walk_is_met_by_thirteen_effectors_and_its_knees_are_right():
    figure, path = walk_of()
    run = perform(path, figure, "dls", cycles=1)
    assert run.error.mean() <= 0.004  # m
    off = knees(run) - knees_along(path)[: len(run)]
    assert np.sqrt((off**2).mean()) <= 1.0  # degree


def test_four_targets_are_met_as_well_and_its_knees_are_wrong():
    """What the thesis's four effectors prove: that they were met."""
    tree = TREE
    four = {name: at for name, at in points_of(markers(tree), tree).items() if name[:4] in END}
    figure, path = walk_of(effectors=Effectors.of(tree, four))
    run = perform(path, figure, "dls", cycles=1, iterations=4)
    assert run.error.mean() < 0.002
    assert abs(knees(run) - knees_along(path)[: len(run)]).mean() > 10


END = ("ball", "hand")


def points_of(effectors, tree):
    each = zip(effectors.names, effectors.joints, effectors.offsets.tolist(), strict=True)
    return {name: (tree.names[joint], offset) for name, joint, offset in each}


def test_a_retargeted_walk_can_be_measured():
    figure, path = walk_of()
    run = perform(path, figure, "dls", cycles=1)
    assert 0.8 < path.pace < 1.3  # m/s
    assert quality.gait_score(run, path) < 15
    assert quality.arm_swing(run, path).max() < 0
    assert quality.soles(run, path).heights.min() > -0.05


def test_our_bones_keep_their_lengths():
    """What is asked of the limbs is a pose of them: reachable but for the spine's third turn."""
    figure, path = walk_of()
    names, rest = path.names, locate(forward(TREE, TREE.rest), figure.effectors)
    for a, b in ("knee.l", "ankle.l"), ("ankle.r", "ball.r"), ("elbow.r", "hand.r"):
        i, j = names.index(a), names.index(b)
        wanted = np.linalg.norm(path.targets[:, i] - path.targets[:, j], axis=1)
        assert_allclose(wanted, np.linalg.norm(rest[i] - rest[j]), atol=1e-9)


def test_a_recording_turned_and_moved_gives_the_same_targets():
    recording = recorded_walk()
    turned = recording.theta.copy()
    names = recording.tree.names
    x, z = (names.index(f"Hips.{axis}pos") for axis in "xz")
    turned[:, x] += 3
    turned[:, z] -= 5
    figure, path = walk_of()
    again = retarget(recording._replace(theta=turned), figure, CMU, feet=FEET)
    assert_allclose(again.targets, path.targets, atol=1e-9)
    assert again.pace == pytest.approx(path.pace)


@pytest.mark.parametrize(
    ("bones", "feet", "error", "words"),
    [
        (CMU, ("toes.l",), ValueError, "'toes.l' is not among the bones"),
        (CMU, (), ValueError, "at least one foot"),
        ({**CMU, "pelvis.z": "Hip"}, FEET, LookupError, "did you mean 'Hips'"),
        ({**CMU, "shin": "Hips"}, FEET, LookupError, "no joint 'shin'"),
    ],
)
def test_bones_that_do_not_fit_are_named(bones, feet, error, words):
    figure = figures.Figure(TREE, markers(TREE))
    with pytest.raises(error, match=words):
        retarget(recorded_walk(), figure, bones, feet=feet)


DIALECTS = {
    "CMU": lambda name: name,
    "Mixamo": lambda name: f"mixamorig:{name}",
    "Poser": lambda name: {
        "Hips": "hip",
        "Spine1": "chest",
        "UpLeg": "Thigh",
        "Leg": "Shin",
        "Arm": "Shldr",
    }.get(re.sub("Left|Right", "", name), re.sub("Left|Right", "", name)),
    "Xsens": lambda name: {
        "Spine1": "Chest",
        "LeftUpLeg": "LeftHip",
        "RightUpLeg": "RightHip",
        "LeftLeg": "LeftKnee",
        "RightLeg": "RightKnee",
        "LeftFoot": "LeftAnkle",
        "RightFoot": "RightAnkle",
        "LeftShoulder": "LeftCollar",
        "RightShoulder": "RightCollar",
        "LeftArm": "LeftShoulder",
        "RightArm": "RightShoulder",
        "LeftForeArm": "LeftElbow",
        "RightForeArm": "RightElbow",
    }.get(name, name),
    "Unreal": lambda name: {
        "Hips": "pelvis",
        "Spine1": "spine_01",
        "LeftUpLeg": "thigh_l",
        "RightUpLeg": "thigh_r",
        "LeftLeg": "calf_l",
        "RightLeg": "calf_r",
        "LeftFoot": "foot_l",
        "RightFoot": "foot_r",
        "LeftArm": "upperarm_l",
        "RightArm": "upperarm_r",
        "LeftForeArm": "lowerarm_l",
        "RightForeArm": "lowerarm_r",
    }.get(name, name),
}


def renamed(recording, dialect):
    """The recording, its joints called as another program calls them."""

    def called(row):
        joint, _, channel = row.rpartition(".")
        side = {"L": "l", "R": "r"}.get(joint[:1], "") if dialect == "Poser" else ""
        side = side if joint.startswith(("Left", "Right")) else ""
        return f"{side}{DIALECTS[dialect](joint)}.{channel}"

    names = tuple(map(called, recording.tree.names))
    return recording._replace(tree=replace(recording.tree, names=names))


@pytest.mark.parametrize("dialect", DIALECTS)
def test_bones_are_found_by_what_programs_call_them(dialect):
    figure, path = walk_of()
    other = renamed(recorded_walk(), dialect)
    bones = bones_of(other)
    if dialect == "CMU":
        assert bones == dict(CMU)
    again = retarget(other, figure, bones, feet=FEET)
    assert_allclose(again.targets, path.targets, atol=1e-9)


def test_a_bone_that_is_not_there_is_named():
    other = renamed(recorded_walk(), "CMU")
    names = tuple(name.replace("LeftForeArm", "Wing") for name in other.tree.names)
    with pytest.raises(LookupError, match="no joint of the recording is its left forearm"):
        bones_of(other._replace(tree=replace(other.tree, names=names)))


VECTORS = st.lists(st.floats(-1, 1), min_size=3, max_size=3)


@given(VECTORS, VECTORS)
def test_the_least_turn_takes_one_direction_to_another(a, b):
    a, b = np.round(a, 3), np.round(b, 3)
    R = between(a, b)
    assert_allclose(R @ R.T, np.eye(3), atol=1e-9)
    assert np.linalg.det(R) == pytest.approx(1)
    if a.any() and b.any():
        assert_allclose(R @ a / np.linalg.norm(a), b / np.linalg.norm(b), atol=1e-6)
