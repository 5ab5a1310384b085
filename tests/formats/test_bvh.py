"""Recordings from BVH files and to them."""

import re

import numpy as np
import pytest
from hypothesis import given
from numpy.testing import assert_allclose
from strategies import SEEDS, anybody, poses

from ikteach import figures, forward, locate
from ikteach.formats.bvh import Recording, read_bvh, write_bvh

LEG = """HIERARCHY
ROOT hip joint
{
  OFFSET 0 90 0
  CHANNELS 6 Zrotation Xposition Yposition Zposition Xrotation Yrotation
  JOINT fixed
  {
    OFFSET 0 -10 0
    JOINT knee {
      OFFSET 0 -30 0
      CHANNELS 1 Xrotation
      End Site
      {
        OFFSET 0 -40 0
      }
    }
  }
}
MOTION
Frames: 2
Frame Time: 0.04
0 0 0 0 0 0 0
90 1 2 3 0 0 90
"""


def test_a_joint_is_a_row_per_channel_positions_first():
    leg = read_bvh(LEG, scale=0.01)
    assert leg.tree.names == (
        *(f"hip joint.{axis}pos" for axis in "xyz"),
        *(f"hip joint.{axis}" for axis in "zxy"),
        "knee.x",
    )
    assert leg.effectors.names == ("knee.end",)
    assert leg.dt == 0.04
    s = locate(forward(leg.tree, leg.theta), leg.effectors)[:, 0]
    assert_allclose(s[0], [0, 0.9 - 0.1 - 0.3 - 0.4, 0], atol=1e-12)
    # The knee bends by 90° about x: −y becomes −z; then all turns by 90° about z: −y becomes x.
    assert_allclose(s[1], [0.01 + 0.4, 0.92, 0.03 - 0.4], atol=1e-12)


@pytest.mark.parametrize(
    "changed", [LEG.replace("\n", "\r\n"), LEG.replace("  ", "\t"), "\ufeff" + LEG]
)
def test_habits_of_other_programs(changed):
    assert_allclose(read_bvh(changed).theta, read_bvh(LEG).theta)


def test_a_file_is_read_as_its_text(tmp_path):
    path = tmp_path / "leg.bvh"
    path.write_text(LEG, encoding="utf-8")
    assert_allclose(read_bvh(path).theta, read_bvh(LEG).theta)


@given(anybody(limits=True), SEEDS)
def test_what_is_written_and_read_again_moves_as_before(figure, seed):
    tree, effectors = figure
    theta = poses(tree, np.random.default_rng(seed), (3,))
    again = read_bvh(write_bvh(Recording(tree, effectors, theta, 0.1), scale=1), scale=1)
    ours = locate(forward(tree, theta), effectors)
    theirs = locate(forward(again.tree, again.theta), again.effectors)
    gap = np.linalg.norm(ours[:, :, None] - theirs[:, None], axis=-1).max(axis=0)
    assert gap.min(axis=1).max() < 1e-8


def test_reading_what_was_written_gives_the_same_rows():
    once = read_bvh(write_bvh(Recording(*figures.human(), np.zeros((2, 20)), 0.1)), scale=0.01)
    twice = read_bvh(write_bvh(once), scale=0.01)
    assert twice.tree.names == once.tree.names
    assert_allclose(twice.theta, once.theta, atol=1e-9)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("HIERARCHY", "HIERARCHIES", "begins with HIERARCHY"),
        ("OFFSET 0 90 0", "OFFSET 0 90", "line 4: 3 numbers are wanted"),
        ("OFFSET 0 90 0", "OFFSET 0 ninety 0", "line 4: there is a word"),
        ("OFFSET 0 90 0", "OFFSET 0 inf 0", "not finite"),
        ("CHANNELS 1", "CHANNELS 2", "line 10: CHANNELS"),
        ("CHANNELS 1 Xrotation", "CHANNELS 1 Wrotation", "no channel 'Wrotation'"),
        ("Xposition Yposition", "Xposition Xposition", "twice"),
        ("Frames: 2", "Frames: 3", "3 frames are announced"),
        ("Frames: 2", "Frames: 1", "more than the 1 frames"),
        ("Frame Time: 0.04", "Frame Time: 0", "more than 0"),
        ("90 1 2 3 0 0 90", "90 1 2 3 0 0", "line 23: 7 numbers are wanted, not 6"),
        ("MOTION", "}", "means nothing"),
        ("MOTION\n", "", "means nothing"),
    ],
)
def test_damage_is_named_by_its_line(old, new, words):
    with pytest.raises(ValueError, match=re.escape(words)):
        read_bvh(LEG.replace(old, new, 1))


@pytest.mark.parametrize("end", range(0, len(LEG), 17))
def test_a_file_cut_short_is_refused_in_a_sentence(end):
    with pytest.raises((ValueError, FileNotFoundError)) as caught:
        read_bvh("HIERARCHY" + LEG[9:end])
    assert len(str(caught.value)) < 300
