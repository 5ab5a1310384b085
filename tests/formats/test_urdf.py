"""Robots from URDF files, held against frames computed by pinocchio."""

import json
import re
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

from ikteach import forward, jacobian
from ikteach.formats.urdf import read_urdf

DATA = Path(__file__).parents[1] / "data"
TEXT = (DATA / "arm7.urdf").read_text(encoding="utf-8")
POSES = json.loads((DATA / "arm7_frames.json").read_text(encoding="utf-8"))["poses"]


@pytest.mark.parametrize("pose", POSES)
def test_links_are_where_pinocchio_has_them(pose):
    robot = read_urdf(DATA / "arm7.urdf")
    frames = forward(robot.tree, [pose["q"][name] for name in robot.tree.names])
    for name, link in pose["links"].items():
        p, R = robot.place(frames, name)
        assert_allclose(p, link["p"], atol=1e-9)
        if "R" in link:
            assert_allclose(R, link["R"], atol=1e-9)
    J = jacobian(robot.tree, frames, robot.effectors)[:3]  # of the tool, which comes first
    for j, name in enumerate(robot.tree.names):
        assert_allclose(J[:, j], pose["J"]["tool"].get(name, np.zeros(3)), atol=1e-9)


def test_rows_effectors_limits_and_mimics():
    robot = read_urdf(TEXT)
    assert robot.tree.names == (*(f"a{i}" for i in range(1, 8)), "finger_a", "finger_b")
    assert robot.effectors.names == ("tool", "finger_l", "finger_r")
    assert robot.tree.slide.tolist() == [False] * 7 + [True] * 2
    assert np.isinf(robot.tree.upper[2])  # it turns for ever
    assert robot.mimics["finger_b"] == ("finger_a", 1.0, 0.0)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("<robot", "<machine", "no XML"),
        ('type="prismatic"', 'type="floating"', "'finger_a' is 'floating'"),
        ('link="l1"', 'link="nowhere"', "is no link"),
        ('xyz="0 0 0.333"', 'xyz="0 0"', "3 numbers"),
        ('xyz="0 0 0.333"', 'xyz="0 0 up"', "3 numbers"),
        ('name="a2"', 'name="a1"', "two joints called 'a1'"),
        ('<child link="l2"/>', "", "has no child"),
        ('<child link="l2"/>', '<child link="l1"/>', "hangs from two joints"),
    ],
)
def test_damage_is_named(old, new, words):
    with pytest.raises(ValueError, match=re.escape(words)):
        read_urdf(TEXT.replace(old, new, 1))


def test_what_is_no_robot_is_refused():
    for text in (
        "<robot/>",
        "<svg/>",
        "<robot><link name='a'/></robot>",
        "<!DOCTYPE x [<!ENTITY a 'b'>]><robot/>",
    ):
        with pytest.raises(ValueError, match="URDF"):
            read_urdf(text)
