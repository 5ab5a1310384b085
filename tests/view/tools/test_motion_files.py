"""Motions from files, and what was played as files, by buttons."""

import shutil

import numpy as np
import pytest

from ikteach import forward, locate
from ikteach.formats.bvh import DATA, read_bvh
from ikteach.motion.live.session import Session
from ikteach.view.tools.motion_files import MotionFiles

LEFT_FOOT = 0


@pytest.fixture
def files(tmp_path):
    session, taken = Session(keep=40), []
    session.change(forward=True)
    made = MotionFiles(session, taken.append, folder=tmp_path, slot=None)
    made.taken = taken
    yield made
    made.close()


def test_what_was_played_is_saved_with_its_way(files, tmp_path):
    for _ in range(20):
        files.session.tick()
    files.bvh.click()
    assert files.status.said.startswith("20 frames by dls are saved in")
    back, log = read_bvh(tmp_path / "played.bvh", scale=0.01), files.session.log()
    assert len(back.theta) == 20
    assert back.dt == pytest.approx(log.dt)
    names = back.effectors.names
    foot = next(i for i, name in enumerate(names) if name.startswith(("foot.l", "ankle.l")))
    there = locate(forward(back.tree, back.theta), back.effectors)[:, foot]
    ours = locate(forward(log.tree, log.theta[:, log.shown[0]]), log.effectors)[:, LEFT_FOOT]
    ours = ours + log.advance[:, None] * np.array([0, 0, 1])
    assert there == pytest.approx(ours, abs=1e-6)
    files.glb.click()
    assert (tmp_path / "played.glb").read_bytes()[:4] == b"glTF"


def test_a_clock_that_leaps_is_kept(files, tmp_path):
    files.session.change(slowdown=3)
    for _ in range(12):
        files.session.tick()
    files.bvh.click()
    assert read_bvh(tmp_path / "played.bvh").dt == pytest.approx(3 * files.session.dt)


def test_a_recording_becomes_a_motion(files, tmp_path):
    shutil.copy(DATA / "cmu_12_01_walk.bvh", tmp_path / "Ada's walk.BVH")
    files.name.value = "Ada's walk.BVH"
    files.opening.click()
    assert files.status.wrong == ""
    (motion,) = files.taken
    assert motion.name == "Ada's walk"
    assert motion.pace == pytest.approx(1.0, abs=0.1)
    files.session.gait = motion
    for _ in range(60):
        files.session.tick()
    assert files.session.error.mean() < 0.03


ARM = """HIERARCHY
ROOT shoulder
{
  OFFSET 0 0 0
  CHANNELS 1 Zrotation
}
MOTION
Frames: 1
Frame Time: 0.1
0
"""


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        ("none", None, "there is no file"),
        (" ", None, "needs a file name"),
        ("cut", "HIERARCHY\nROOT hips\n{\n", "line 4"),
        ("arm", ARM, "no joint of the recording is its left upleg: 'shoulder'"),
        ("short", None, "4 frames or more, not 1"),
    ],
)
def test_what_cannot_be_is_one_sentence(files, tmp_path, name, content, words):
    if content is not None:
        (tmp_path / f"{name}.bvh").write_text(content)
    if name == "short":
        files.session.tick()
        files.name.value = name
        files.bvh.click()
    files.name.value = name
    files.opening.click()
    assert words in files.status.wrong
    assert files.taken == []


def test_nothing_is_overwritten_unasked(files, tmp_path):
    files.bvh.click()
    assert "nothing to save yet" in files.status.wrong
    files.session.tick()
    files.bvh.click()
    before = (tmp_path / "played.bvh").read_bytes()
    files.session.tick()
    files.bvh.click()
    assert "tick the box to replace it" in files.status.wrong
    assert (tmp_path / "played.bvh").read_bytes() == before
    files.replace.value = True
    files.bvh.click()
    assert files.status.wrong == ""
    assert (tmp_path / "played.bvh").read_bytes() != before
