"""Recordings from BVH files and to them."""

import re

import numpy as np
import pybvh
import pytest
from hypothesis import given
from numpy.testing import assert_allclose
from strategies import SEEDS, anybody, poses

from ikteach import Effectors, Joint, Tree, figures, forward, locate
from ikteach.formats.bvh import DATA, Recording, read_bvh, recorded_walk, write_bvh

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


HABITS = {
    "CRLF": LEG.replace("\n", "\r\n"),
    "old Macs": LEG.replace("\n", "\r"),
    "tabs": LEG.replace("  ", "\t"),
    "byte order mark": "\ufeff" + LEG,
    "lower case": LEG.lower(),
    "comments": LEG.replace("MOTION", "# made by hand\n// and by foot\nMOTION"),
    "blank lines": LEG.replace("\n", "\n\n"),
    "braces on the line": LEG.replace("\n{", " {").replace("\n      {", "{"),
    "exponents": LEG.replace("90 1 2 3", "9e1 1.0E0 +2 3."),
    "spaces at colons": LEG.replace("Frames:", "Frames :").replace("Time:", "Time :"),
    "no blank at colons": LEG.replace("Frames: ", "Frames:"),
    "channels before the offset": LEG.replace(
        "    OFFSET 0 -30 0\n      CHANNELS 1 Xrotation\n", "CHANNELS 1 Xrotation\nOFFSET 0 -30 0\n"
    ),
    "no line end at the end": LEG.rstrip(),
}


@pytest.mark.parametrize("habit", HABITS)
def test_habits_of_other_programs(habit):
    ours, theirs = read_bvh(LEG), read_bvh(HABITS[habit])
    assert theirs.dt == ours.dt
    assert_allclose(theirs.theta, ours.theta)
    s, t = (locate(forward(one.tree, one.theta), one.effectors) for one in (ours, theirs))
    assert_allclose(t, s)


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "shift-jis"])
def test_names_in_any_alphabet(tmp_path, encoding):
    path = tmp_path / "leg.bvh"
    path.write_bytes(LEG.replace("knee", "ひざ").encode(encoding))
    names = read_bvh(path).tree.names
    assert len(set(names)) == 7
    if encoding != "shift-jis":  # which nothing in the file tells of
        assert names[-1] == "ひざ.x"


def test_a_name_stays_text():
    wild = '<img src=x> =1+1 "&\u2028'
    names = read_bvh(LEG.replace("knee", wild)).tree.names
    assert names[-1] == " ".join(wild.split()) + ".x"


def test_names_that_stand_twice_are_told_apart():
    twice = read_bvh(LEG.replace("fixed", "knee").replace("hip joint", "knee"))
    assert len(set(twice.tree.names)) == 7
    assert read_bvh(LEG.replace("hip joint", "knee.2").replace("fixed", "knee")).tree.names[-1]


def test_where_an_end_site_is_missing_the_joint_is_the_end():
    bare = read_bvh(re.sub(r"End Site\s*{[^}]*}", "", LEG))
    assert bare.effectors.names == ("knee.end",)
    assert_allclose(bare.effectors.offsets, 0)


def test_several_roots_stand_on_one_ground():
    half = LEG.split("MOTION")[0]
    both = read_bvh(half + half.split("HIERARCHY\n")[1] + "MOTION\nFrames: 0\nFrame Time: 1\n")
    assert (both.tree.parents == -1).sum() == 2
    assert both.theta.shape == (0, 14)
    assert read_bvh(write_bvh(both), scale=0.01).theta.shape[0] == 0


def test_a_long_chain_is_written_and_read():
    joints = [Joint("j0", axis=(1, 0, 0))]
    joints += [Joint(f"j{i}", f"j{i - 1}", (0, 0.01, 0), (0, 0, 1)) for i in range(1, 400)]
    tree = Tree.of(joints)
    effectors = Effectors.of(tree, {"end": ("j399", (0, 0.01, 0))})
    run = Recording(tree, effectors, np.full((1, 400), 0.01), 0.1)
    again = read_bvh(write_bvh(run), scale=0.01)
    s = locate(forward(tree, np.full(400, 0.01)), effectors)
    assert_allclose(locate(forward(again.tree, again.theta[0]), again.effectors), s, atol=1e-9)
    with pytest.raises(ValueError, match="at most 2000 joints"):
        read_bvh("HIERARCHY\n" + "ROOT a\n{\nOFFSET 0 0 0\n" + "JOINT a\n{\nOFFSET 0 0 0\n" * 5000)


def test_a_direction_is_no_end():
    tree, effectors = figures.walker()
    run = Recording(tree, effectors, tree.rest[None], 0.1)
    again = read_bvh(write_bvh(run))
    assert len(again.effectors) == 7 + 2  # its points, and the ends of the arms
    assert again.tree.names[:6] == tuple(f"pelvis.{c}" for c in ["xpos", "ypos", "zpos", *"yxz"])


def test_a_way_is_added_below_the_figure():
    leg = read_bvh(LEG, scale=0.01)
    way = np.array([[0, 0, 0], [0, 0, 1.5]])
    gone = read_bvh(write_bvh(leg, way=way), scale=0.01)
    s, t = (locate(forward(one.tree, one.theta), one.effectors)[:, 0] for one in (leg, gone))
    assert_allclose(t, s + way, atol=1e-9)


def test_a_file_is_read_as_its_text(tmp_path):
    path = tmp_path / "leg.bvh"
    path.write_text(LEG, encoding="utf-8")
    assert_allclose(read_bvh(path).theta, read_bvh(LEG).theta)


def nodes_of(path):
    """Names of joints and ends, and their places (T, N, 3), as pybvh has them."""
    theirs = pybvh.read_bvh_file(path)
    return [node.name for node in theirs.nodes], theirs.node_positions()


def test_joints_are_where_pybvh_has_them():
    """All joints and ends of the recorded walk, in all frames."""
    names, places = nodes_of(DATA / "cmu_12_01_walk.bvh")
    walk = read_bvh(DATA / "cmu_12_01_walk.bvh")
    frames = forward(walk.tree, walk.theta)
    row = {name.rpartition(".")[0]: j for j, name in enumerate(walk.tree.names)}
    joints = [i for i, name in enumerate(names) if name in row]
    assert len(joints) == len(row) == 31
    ours = frames.positions[:, [row[names[i]] for i in joints]]
    assert_allclose(ours, places[:, joints], rtol=0, atol=1e-9)
    ends = [i for i, name in enumerate(names) if name not in row]
    assert_allclose(locate(frames, walk.effectors), places[:, ends], rtol=0, atol=1e-9)


def test_pybvh_reads_what_was_written(tmp_path):
    tree, effectors = figures.human()
    theta = poses(tree, np.random.default_rng(1), (5,))
    path = tmp_path / "human.bvh"
    path.write_text(write_bvh(Recording(tree, effectors, theta, 1 / 30), scale=1))
    names, places = nodes_of(str(path))
    ends = [i for i, name in enumerate(names) if name.startswith("EndSite")]
    ours = locate(forward(tree, theta), effectors)
    gap = np.linalg.norm(ours[:, :, None] - places[:, None, ends], axis=-1).max(axis=0)
    assert gap.min(axis=1).max() < 1e-8


def test_the_recorded_walk_is_a_man_who_walks():
    walk = recorded_walk()
    assert walk.theta.shape == (131, 96)
    hips = forward(walk.tree, walk.theta).positions[:, walk.tree.index("Hips.x")]
    assert 0.8 < hips[:, 1].mean() < 1.1  # [m] above the floor
    way = np.linalg.norm(hips[-1] - hips[0]) / walk.times[-1]
    assert 0.8 < way < 1.6  # [m/s]


@given(anybody(limits=True), SEEDS)
def test_what_is_written_and_read_again_moves_as_before(figure, seed):
    tree, effectors = figure
    theta = poses(tree, np.random.default_rng(seed), (3,))
    again = read_bvh(write_bvh(Recording(tree, effectors, theta, 0.1), scale=1), scale=1)
    ours = locate(forward(tree, theta), effectors)
    theirs = locate(forward(again.tree, again.theta), again.effectors)
    gap = np.linalg.norm(ours[:, :, None] - theirs[:, None], axis=-1).max(axis=0)
    assert gap.min(axis=1).max() < 1e-8  # each of ours is one of theirs
    twice = read_bvh(write_bvh(again, scale=1), scale=1)
    assert_allclose(
        locate(forward(twice.tree, twice.theta), twice.effectors), theirs, rtol=0, atol=1e-9
    )


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
        ("CHANNELS 1", "CHANNELS 2", "line 11: CHANNELS"),
        ("CHANNELS 1 Xrotation", "CHANNELS 1 Wrotation", "no channel 'Wrotation'"),
        ("Xposition Yposition", "Xposition Xposition", "twice"),
        ("Frames: 2", "Frames: 3", "3 frames are announced"),
        ("Frames: 2", "Frames: 1", "more than the 1 frames"),
        ("Frame Time: 0.04", "Frame Time: 0", "more than 0"),
        ("90 1 2 3 0 0 90", "90 1 2 3 0 0", "line 23: 7 numbers are wanted, not 6"),
        ("Frames: 2", "Frames: two", "line 20: after MOTION comes"),
        ("Frame Time: 0.04", "Frame Time:", "line 21: after Frames comes"),
        ("90 1 2 3 0 0 90\n", "", "line 23: 2 frames are announced, and the file ends after 1"),
        ("1 2 3", "1_0 2 3", "line 23: there is a word"),
        ("OFFSET 0 -40 0", "", "line 15: 'knee.end' ends without an OFFSET"),
        ("OFFSET 0 90 0", "OFFSET 0 90 0\nOFFSET 0 90 0", "line 5: a second OFFSET"),
        ("ROOT", "JOINT", "line 2: this hangs from nothing"),
        ("JOINT knee", "ROOT knee", "line 9: a ROOT inside a joint"),
        ("OFFSET 0 -40 0", "OFFSET 0 -40 0\nCHANNELS 1 Xrotation", "these are no CHANNELS"),
        ("CHANNELS 1", "CHANNELS ²", "CHANNELS is followed"),
        ("{", "", "line 4: a brace { is missing before this"),
        ("MOTION", "}", "means nothing"),
        ("MOTION\n", "", "means nothing"),
    ],
)
def test_damage_is_named_by_its_line(old, new, words):
    with pytest.raises(ValueError, match=re.escape(words)):
        read_bvh(LEG.replace(old, new, 1))


@pytest.mark.parametrize("end", range(20, len(LEG) - 17, 17))
def test_a_file_cut_short_is_refused_in_a_sentence(end):
    with pytest.raises(ValueError, match=r"BVH, line \d+: ") as caught:
        read_bvh(LEG[:end])
    assert len(str(caught.value)) < 300


def test_what_is_neither_a_file_nor_a_text_is_refused(tmp_path):
    with pytest.raises(OSError, match="cannot be read"):
        read_bvh("h" * 10_000)
    with pytest.raises(FileNotFoundError):
        read_bvh(tmp_path / "nowhere.bvh")
    with pytest.raises(OSError, match="folder"):
        read_bvh(tmp_path)
    with pytest.raises(ValueError, match="empty"):
        read_bvh("")
    with pytest.raises(TypeError, match="path or its text"):
        read_bvh(3)
    with pytest.raises(ValueError, match="scale must be"):
        read_bvh(LEG, scale=0)
    (tmp_path / "picture.bvh").write_bytes(b"\x89PNG\n\0\0")
    with pytest.raises(ValueError, match="not text"):
        read_bvh(tmp_path / "picture.bvh")
