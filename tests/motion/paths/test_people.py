"""Recordings of a person as many programs write them: they arrive alike, and say what was done."""

import re
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from people import HABITS, NAMES, Person, walk

from ikteach import figures
from ikteach.formats.bvh import read_bvh, write_bvh
from ikteach.motion import gait
from ikteach.motion.live.session import Session
from ikteach.motion.paths.bones import CMU, bones_of
from ikteach.motion.paths.retarget import retarget
from ikteach.motion.paths.walk import natural, turned
from ikteach.study.walks import FEET, imported, limbs

TREE = figures.walker().tree
FIGURE = figures.Figure(TREE, limbs(TREE))


def arrived(text, change=None):
    recording = read_bvh(text)
    if change is not None:
        recording = recording._replace(theta=change(recording))
    return retarget(recording, FIGURE, bones_of(recording), feet=FEET)


@pytest.fixture(scope="module")
def usual():
    return arrived(Person().bvh())


def test_a_person_arrives_upright_on_the_floor_and_ahead(usual):
    _, _, gone = walk()
    assert usual.pace == pytest.approx(natural.pace, abs=0.02)
    assert usual.floor == pytest.approx(-gone[:, 1].mean(), abs=0.01)
    ahead = usual.names.index("pelvis.ahead")
    assert usual.targets[:, ahead, 2].min() > 0
    feet = [i for i, name in enumerate(usual.names) if name.startswith(("heel", "ball"))]
    assert abs(usual.targets[:, feet, 1].min(axis=1) - usual.floor).max() < 0.02
    assert abs(usual.at(0.0) - usual.at(2 * np.pi * (1 - 1e-9))).max() < 0.03  # whole strides
    assert usual.standing[:, feet].any(axis=1).all()


SAID = {
    "inches": "A leg is 34.8 long (inches, it seems); one unit became 0.0254 m",
    "metres": "(metres, it seems)",
    "millimetres": "(millimetres, it seems)",
    "a unit of its own": "(a unit of its own); one unit became 0.37 m",
    "a pose first": "A pose to measure by, its first frame is left out.",
    "a pose first, z up": "Its z axis points up: it was set upright.",
    "z up": "Its z axis points up",
    "z up by the root": "Its z axis points up",
    "x up": "Its x axis points up",
    "facing back": "It was turned by 180° to its",
    "going right": "It was turned by 90° to its left, to head ahead.",
    "going askew": "It was turned by 37° to its right, to head ahead.",
    "a high floor": "Its ground, at a height of 3.00 m, was put under its feet.",
    "a floor below": "at a height of -12.00 m",
}


@pytest.mark.parametrize("habit", HABITS)
def test_a_person_of_any_habit_arrives_alike(usual, habit):
    path = arrived(HABITS[habit].bvh())
    assert_allclose(path.targets, usual.targets, rtol=0, atol=2e-5)  # 6 decimals in the file
    assert_allclose(path.standing, usual.standing)
    assert path.pace == pytest.approx(usual.pace, abs=1e-4)
    assert SAID.get(habit, "Whole strides were taken") in " ".join(path.notes)


@pytest.mark.parametrize("program", NAMES)
def test_bones_are_found_by_the_names_of(usual, program):
    path = arrived(Person(called=NAMES[program]).bvh())
    assert_allclose(path.targets, usual.targets, atol=1e-9)


def test_positions_that_repeat_the_offsets_are_no_bones():
    """Programs that put OFFSET into position channels: the bones are not twice as long."""
    plain, twice = (read_bvh(Person(channels=c).bvh()) for c in ("6", "in place"))
    assert_allclose(twice.theta, plain.theta, atol=1e-9)
    assert_allclose(twice.tree.offsets, plain.tree.offsets)


@pytest.mark.parametrize("way", [0.0, 1.0])
@pytest.mark.parametrize(("figure", "motion"), [("human", gait.walking), ("walker", natural)])
def test_our_own_files_come_back_as_a_person(figure, motion, way):
    session = Session(getattr(figures, figure)(), motion, ["dls"], iterations=2)
    for _ in range(100):
        session.tick()
    log = session.log()
    gone = np.zeros((len(log), 3))
    gone[:, 2] = way * motion.pace * log.time
    recording = read_bvh(write_bvh(log.tracks()["dls"], way=gone, dt=session.dt), scale=0.01)
    path = imported(recording, "again")
    bones = bones_of(recording)
    assert set(bones) == set(CMU)
    assert all(row in (joint, "pelvis.z") or row[:4] == "foot" for row, joint in bones.items())
    assert path.pace == pytest.approx(motion.pace, rel=0.2)
    said = " ".join(path.notes)
    assert ("It walks in its place" in said) == (way == 0)
    again = Session(gait=path, methods=["dls"], iterations=2)
    for _ in range(20):
        again.tick()
    assert again.error.mean() < 0.03


def test_ground_that_slopes_is_made_level(usual):
    def climb(recording):
        theta, rows = recording.theta.copy(), recording.tree.names
        y = rows.index("Hips.ypos")
        theta[:, y] += 100 * 0.02 * recording.times
        return theta

    path = arrived(Person(unit=0.01).bvh(), climb)
    assert_allclose(path.targets, usual.targets, atol=0.01)
    assert "Its ground rose by 6 cm: it was made level." in path.notes


def test_who_stands_still_has_no_stride_and_faces_ahead():
    def stay(recording):
        theta = np.tile(recording.theta[:1], (40, 1))
        return theta

    path = arrived(Person(turn=turned("y", np.asarray(90.0))).bvh(), stay)
    assert "It has no whole stride" in path.notes[-1]
    assert path.pace == 0
    assert len(path.times) == 40
    assert path.targets[0, path.names.index("pelvis.ahead"), 2] > 0.9 * 0.2


def test_who_turns_on_the_way_is_told():
    def curve(recording):
        theta, rows = recording.theta.copy(), recording.tree.names
        theta[:, rows.index("Hips.y")] += np.linspace(0, 2, len(theta))
        return theta

    path = arrived(Person(order="YXZ").bvh(), curve)
    assert any(re.search(r"It turns by 1\d\d° on its way", note) for note in path.notes)


def test_a_body_that_never_stands_is_refused():
    recording = read_bvh(Person().bvh())
    tree = recording.tree
    offsets = np.linalg.norm(tree.offsets, axis=1)[:, None] * [0, 0, 1.0]  # along one line
    with pytest.raises(ValueError, match="no standing pose"):
        retarget(
            recording._replace(tree=replace(tree, offsets=offsets), theta=0 * recording.theta),
            FIGURE,
            bones_of(recording),
            feet=FEET,
        )


def test_of_a_long_recording_a_minute_is_taken(monkeypatch):
    recording = read_bvh(Person().bvh())
    monkeypatch.setattr("ikteach.study.walks.LONGEST", 2.0)
    path = imported(recording, "slow")
    assert path.notes[0] == "Only its first 2 s were taken."
    assert path.span < 2.1


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda text: text.replace("Frames: 87", "Frames: 0").partition("Frame Time")[0], "Frame"),
        (lambda text: re.sub(r"(\d)\.(\d)", r"\1,\2", text), "a decimal point, and no comma"),
        (lambda text: text.replace("0.033333", "0,033333"), "a decimal point, and no comma"),
        (lambda text: text[: len(text) // 2], "line"),
        (lambda text: text.replace("\n0.", "\nnan ", 1), "BVH, line"),
        (lambda text: text.replace("Frames: 87", "Frames: 87000000"), "87000000 frames are"),
        (lambda text: text.replace("Frame Time: 0.033333", "Frame Time: 1e400"), "not finite"),
    ],
)
def test_damage_is_told_in_one_sentence(change, words):
    with pytest.raises(ValueError, match=re.escape(words)) as caught:
        read_bvh(change(Person().bvh()))
    assert len(str(caught.value)) < 300
    assert "\n" not in str(caught.value)


def test_no_frames_are_read_and_are_no_motion():
    text = re.sub(r"Frames: \d+(\nFrame Time: \S+\n).*", r"Frames: 0\1", Person().bvh(), flags=16)
    recording = read_bvh(text)
    assert len(recording.theta) == 0
    with pytest.raises(ValueError, match="4 frames or more, not 0"):
        imported(recording, "nothing")


def test_two_people_in_a_file_are_the_first():
    one = Person().bvh()
    head, _, motion = one.partition("MOTION\n")
    frames, dt, *rows = motion.splitlines()
    both = [head + head.partition("HIERARCHY\n")[2] + "MOTION", frames, dt]
    both += [f"{row} {row}" for row in rows]
    recording = read_bvh("\n".join(both))
    assert (recording.tree.parents == -1).sum() == 2
    path = retarget(recording, FIGURE, bones_of(recording), feet=FEET)
    assert_allclose(path.targets, arrived(one).targets, atol=1e-9)
