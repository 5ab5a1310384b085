"""Robots from URDF files, held against frames computed by pinocchio."""

import json
import re
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

from ikteach import forward, jacobian
from ikteach.formats.urdf import ARM, read_urdf

DATA = Path(__file__).parents[1] / "data"
TEXT = ARM.read_text(encoding="utf-8")
POSES = json.loads((DATA / "arm7_frames.json").read_text(encoding="utf-8"))["poses"]


@pytest.mark.parametrize("pose", POSES)
def test_links_are_where_pinocchio_has_them(pose):
    robot = read_urdf(ARM)
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
        ('link="l1"', 'link="nowhere"', "no link 'nowhere'"),
        ('mimic joint="finger_a"', 'mimic joint="a9"', "'finger_b' has a mimic, but there is no"),
        ('mimic joint="finger_a"', 'mimic joint="finger_b"', "no other joint 'finger_b'"),
        ("<mimic joint=", "<mimic to=", "no other joint None"),
        ('<axis xyz="0 0 2"/>', '<axis xyz="0 0 0"/>', "the joint 'a6' has the axis zero"),
        ('lower="-2.9" upper="2.9"', 'lower="3" upper="2.9"', "'a1' has its lower limit 3"),
        ('lower="-2.9"', 'lower="-2_9"', "lower of the joint 'a1' must be a number"),
        ('<link name="l1"/>', '<link name="l1"/><link name="l1"/>', "two links called 'l1'"),
        ('<link name="l1"/>', "<link/>", "a link has no name"),
        ('<link name="l1"/>', '<link name="l1"/><link name="x"/>', "hang from nothing, not 2"),
        ('<parent link="pedestal"/>', '<parent link="l3"/>', "hangs from itself in a circle"),
        ('<link name="base"/>', '<link name="base"/><link name="b"/>', "from nothing, not 2"),
        ('xyz="0 0 0.333"', 'xyz="0 0 ${high}"', "xyz of the joint 'a1' must be 3 numbers"),
        ('xyz="0 0 0.333"', 'xyz="0 0"', "3 numbers"),
        ('xyz="0 0 0.333"', 'xyz="0 0 up"', "3 numbers"),
        ('name="a2"', 'name="a1"', "two joints called 'a1'"),
        ('<child link="l2"/>', "", "has no child"),
        ('<child link="l2"/>', '<child link="l1"/>', "hangs from two joints"),
    ],
)
def test_damage_is_named(old, new, words):
    damaged = TEXT.replace(old, new, 1)
    with pytest.raises(ValueError, match=re.escape(words)) as caught:
        read_urdf(damaged)
    line = re.match(r"URDF, line (\d+): |URDF: one link must hang", str(caught.value))
    assert line is not None
    if line[1] and "no XML" not in words:  # it is that of the element, whose name stands there
        named = re.findall(r"'(\w+)'", str(caught.value)) or ["link"]
        assert any(name in damaged.splitlines()[int(line[1]) - 1] for name in named)


HABITS = {
    "comments": TEXT.replace("<link", "<!-- <joint name='no'/> --><link", 3),
    "tags of others": TEXT.replace("</robot>", "<gazebo><joint name='no'/></gazebo></robot>"),
    "a namespace": TEXT.replace("<robot", "<robot xmlns='http://ros.org/urdf'", 1),
    "xacro was here": TEXT.replace("<robot", "<robot xmlns:xacro='http://www.ros.org/xacro'", 1),
    "looks": TEXT.replace(
        '<link name="l1"/>',
        '<link name="l1"><visual><origin xyz="a b c"/><geometry/></visual></link>',
    ),
    "CRLF and blanks": "\ufeff\r\n " + TEXT[TEXT.index("<robot") :].replace("\n", "\r\n"),
    "another order": TEXT.replace("<joint name=", "\n<joint name="),
}


@pytest.mark.parametrize("habit", HABITS)
def test_habits_of_other_programs(habit):
    ours, theirs = read_urdf(TEXT), read_urdf(HABITS[habit])
    assert theirs.tree.names == ours.tree.names
    theta = np.linspace(-1, 1, len(ours.tree))
    assert_allclose(forward(theirs.tree, theta).positions, forward(ours.tree, theta).positions)
    assert theirs.effectors.names == ours.effectors.names


def robot(*joints, links=("base",)):
    """A robot of these joints, each (name, type, parent, child, inside)."""
    links = [*links, *(child for _, _, _, child, _ in joints)]
    return (
        "<robot name='r'>"
        + "".join(f"<link name='{link}'/>" for link in links)
        + "".join(
            f"<joint name='{name}' type='{kind}'><parent link='{parent}'/><child link='{child}'/>"
            f"{inside}</joint>"
            for name, kind, parent, child, inside in joints
        )
        + "</robot>"
    )


def test_rows_keep_the_order_of_the_file_where_parents_come_first():
    one = robot(
        ("late", "revolute", "b", "c", ""),
        ("other", "continuous", "base", "d", ""),
        ("early", "revolute", "base", "b", ""),
    )
    assert read_urdf(one).tree.names == ("other", "early", "late")


def test_limits_that_are_missing():
    limits = robot(
        ("free", "revolute", "base", "a", ""),
        ("half", "revolute", "a", "b", "<limit upper='1'/>"),
        ("slide", "prismatic", "b", "c", "<axis xyz='0 3 4'/>"),
        ("endless", "continuous", "c", "d", "<limit lower='-1' upper='1'/>"),
    )
    tree = read_urdf(limits).tree
    assert tree.lower.tolist() == [-np.inf, 0, -np.inf, -np.inf]
    assert tree.upper.tolist() == [np.inf, 1, np.inf, np.inf]
    assert_allclose(tree.axes[2], [0, 0.6, 0.8])


def test_fixed_joints_are_folded_however_many():
    """A turn of a quarter in each of four, as one chain of fixed joints, comes back."""
    quarter = "<origin xyz='1 0 0' rpy='0 0 1.5707963267948966'/>"
    chain = [(f"f{i}", "fixed", f"l{i}", f"l{i + 1}", quarter) for i in range(4)]
    one = robot(("hinge", "revolute", "base", "l0", ""), *chain)
    link = read_urdf(one).links["l4"]
    assert_allclose(link.d, 0, atol=1e-12)
    assert_allclose(link.C, np.eye(3), atol=1e-12)


def test_a_chain_of_a_thousand_links_is_read():
    step = "<origin xyz='0.01 0 0'/><axis xyz='0 0 1'/>"
    links = ["base", *(f"l{i}" for i in range(1000))]
    chain = [(f"j{i}", "revolute", links[i], links[i + 1], step) for i in range(1000)]
    arm = read_urdf(robot(*reversed(chain)))
    assert_allclose(forward(arm.tree, np.zeros(1000)).positions[-1], [10, 0, 0])


def test_an_unknown_link_is_named():
    one = read_urdf(TEXT)
    with pytest.raises(LookupError, match="did you mean 'tool'"):
        one.place(forward(one.tree, one.tree.rest), "tol")


def test_what_xacro_has_left_is_told():
    left = TEXT.replace("<robot", "<robot xmlns:xacro='http://www.ros.org/wiki/xacro'", 1).replace(
        "</robot>", "<xacro:arm side='l'/></robot>"
    )
    with pytest.raises(ValueError, match="<xacro:arm> is left"):
        read_urdf(left)


def test_entities_are_not_followed_in_any_encoding(tmp_path):
    path = tmp_path / "wide.urdf"
    path.write_bytes("<!DOCTYPE x [<!ENTITY a 'b'>]><robot/>".encode("utf-16"))
    with pytest.raises(ValueError, match="entities"):
        read_urdf(path)


def test_what_is_no_robot_is_refused():
    for text in (
        "<robot/>",
        "<svg/>",
        "<robot><link name='a'/></robot>",
        "<!DOCTYPE x [<!ENTITY a 'b'>]><robot/>",
    ):
        with pytest.raises(ValueError, match="URDF"):
            read_urdf(text)


JOINT = (
    "\n\n<robot name='r'>\n<link name='a'/>\n<link name='b'/>\n<joint name='j' type='revolute'>\n"
    "<parent link='a'/><child link='b'/><axis xyz='0 3 4'/></joint>\n</robot>"
)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("revolute", "planar", "URDF, line 6: the joint 'j' is 'planar'; only fixed, revolute"),
        ("revolute", "floating", "URDF, line 6: the joint 'j' is 'floating'; only fixed"),
        ("0 3 4", "0,3,4", "line 6: xyz of the joint 'j' must be 3 numbers, not '0,3,4'"),
        ("0 3 4", "nan 0 1", "line 6: xyz of the joint 'j' must be 3 numbers"),
        ("<link name='b'/>", "<link name='b'/><xacro:arm/>", "line 5: <xacro:arm> is left"),
        ("</joint>", "</joint></robot><robot>", "line 7: this is no XML (junk after document"),
        (
            "<robot",
            "<!DOCTYPE r [<!ENTITY a 'b'>\n<!ENTITY c '&a;&a;'>]><robot",
            "line 3: entities",
        ),
        ("<robot", "<sdf", "no XML (mismatched tag)"),
        ("'a'/><child", "'b'/><child", "line 6: the joint 'j' hangs from itself in a circle"),
        ("</joint>", "<mimic joint='j'/></joint>", "line 6: the joint 'j' has a mimic, but"),
        ("type='revolute'", "", "line 6: the joint 'j' is None"),
        (JOINT, JOINT[:130], "line 7: this is no XML (unclosed token)"),
    ],
)
def test_damage_is_told_with_its_line(old, new, words):
    with pytest.raises(ValueError, match=re.escape(words)) as caught:
        read_urdf(JOINT.replace(old, new, 1))
    assert len(str(caught.value)) < 300


def test_a_base_of_inertia_alone_and_an_axis_that_is_no_unit():
    heavy = JOINT.replace(
        "<link name='a'/>", "<link name='a'><inertial><mass value='1'/></inertial></link>"
    )
    tree = read_urdf(heavy).tree
    assert_allclose(tree.axes, [[0, 0.6, 0.8]])


def test_what_is_nested_without_end_is_no_robot():
    with pytest.raises(ValueError, match="URDF"):
        read_urdf("<robot>" + "<a>" * 50_000 + "</a>" * 50_000 + "</robot>")
