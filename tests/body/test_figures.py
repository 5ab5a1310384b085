"""The figures of the course against the numbers they were made from."""

import json
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from numpy.testing import assert_allclose, assert_array_equal
from reference import DATA, model
from strategies import SEEDS, anybody, poses

from ikteach import Tree, figures, forward, jacobian, locate

HUMAN = json.loads((DATA / "human20.json").read_text())


def test_the_human_is_the_table():
    tree, effectors = figures.human()
    rows = HUMAN["joints"]
    places = {row["name"]: row["i"] for row in rows} | {"root(pelvis)": -1}
    assert_array_equal(tree.parents, [places[row["parent"]] for row in rows])
    assert_allclose(tree.offsets, [row["offset"] for row in rows], atol=1e-15)
    assert_allclose(tree.axes, [row["axis"] for row in rows], atol=1e-15)
    assert_allclose(np.degrees(tree.lower), [row["min_deg"] for row in rows])
    assert_allclose(np.degrees(tree.upper), [row["max_deg"] for row in rows])
    assert not tree.slide.any()
    for ours, points in ((effectors, "effectors"), (figures.heels(tree), "heels")):
        wanted = HUMAN[points].values()
        assert_array_equal(ours.joints, [places[point["joint"]] for point in wanted])
        assert_allclose(ours.offsets, [point["offset"] for point in wanted], atol=1e-15)


def test_the_human_stands_upright_and_is_its_own_mirror_image():
    tree, effectors = figures.human()
    left_foot, right_foot, right_hand, left_hand = locate(forward(tree, tree.rest), effectors)
    assert_allclose(left_foot, right_foot * [-1, 1, 1])
    assert_allclose(left_hand, right_hand * [-1, 1, 1])
    assert left_foot[0] > 0
    assert left_foot[1] < -0.9
    # The same angles left and right are a mirror image, too.
    theta = tree.rest.copy()
    theta[2:] = 2 * [0.1, 0.2, 0.3, 0.4] + 2 * [0.1, 0.2, 0.1, 0.5, 0]
    left_foot, right_foot, right_hand, left_hand = locate(forward(tree, theta), effectors)
    assert_allclose(left_foot, right_foot * [-1, 1, 1], atol=1e-15)
    assert_allclose(left_hand, right_hand * [-1, 1, 1], atol=1e-15)


def test_the_y_is_busss():
    """To his floats: he writes 0.7 as a number of 32 bits."""
    tree, effectors = figures.y_shape()
    theirs, ends = model("yshape")
    assert_array_equal(tree.parents, theirs.parents)
    assert_allclose(tree.offsets, theirs.offsets, atol=1e-7)
    assert_allclose(tree.axes, theirs.axes, atol=1e-15)
    assert_array_equal(effectors.joints, ends.joints)
    assert_allclose(effectors.offsets, ends.offsets, atol=1e-7)


def test_the_double_y_has_25_joints_and_4_effectors():
    tree, effectors = figures.double_y()
    assert len(tree) == 25
    assert len(effectors) == 4
    assert jacobian(tree, forward(tree, tree.rest), effectors).shape == (12, 25)
    s = dict(zip(effectors.names, locate(forward(tree, tree.rest), effectors), strict=True))
    for height in ("low", "high"):
        assert_allclose(s[f"left.{height}"], s[f"right.{height}"] * [-1, 1, 1], atol=1e-12)


@pytest.mark.parametrize("links", [1, 3, [0.5, 2.0]])
def test_an_arm_is_stretched_along_x(links):
    tree, effectors = figures.planar_arm(links)
    length = links if isinstance(links, int) else sum(links)
    assert_allclose(locate(forward(tree, tree.rest), effectors), [[length, 0, 0]])


@pytest.mark.parametrize("links", [3, np.int64(3), 3.0, [1, 1, 1], np.ones(3, np.float32)])
def test_an_arm_of_three_links(links):
    tree, _ = figures.planar_arm(links)
    assert len(tree) == 3
    assert not np.isfinite([tree.lower, tree.upper]).any()


@pytest.mark.parametrize(
    "links",
    [0, -1, [], [1, 0], [1, -1], [np.nan], np.nan, 2.5, True, None, "3", [1, "2"], ["1", "2"],
     [1, np.inf], [[1, 2], [3, 4]], [[1], [2, 3]], 10**9, 10**400, [1.0] * 1001, 1j, {1: 2}, abs],
    ids=lambda links: str(links)[:20],
)  # fmt: skip
def test_an_arm_without_links(links):
    with pytest.raises(ValueError, match="an arm needs a number of links from 1 to 1000, or") as of:
        figures.planar_arm(links)
    assert len(str(of.value)) < 250


def test_the_simulator_has_16_degrees_of_motion():
    tree, effectors = figures.simulator()
    shared = sum(len(rows) - 1 for rows in figures.TOGETHER)
    assert len(tree) - shared == 16
    for rows in figures.TOGETHER:  # one angle fits all of them, and turns them alike
        joints = [tree.index(row) for row in rows]
        for column in (tree.lower, tree.upper, tree.rest, tree.axes):
            assert_array_equal(column[joints], column[joints[:1]].repeat(len(joints), axis=0))
    neck = tree.index("neck")
    assert_allclose(np.degrees([tree.lower[neck], tree.upper[neck]]), [-30, 60])
    assert (np.degrees(tree.upper - tree.lower) <= 240).all()
    assert effectors.names == figures.human().effectors.names


def test_the_simulator_is_a_human_with_fewer_hinges():
    """Stretched out, both figures have their hands and feet in the same places."""
    (tree, effectors), (human, human_effectors) = figures.simulator(), figures.human()
    straight, upright = np.zeros(len(tree)), np.zeros(len(human))
    s = locate(forward(tree, straight), effectors)
    assert_allclose(s, locate(forward(human, upright), human_effectors), atol=1e-12)
    assert_allclose(s[0], s[1] * [-1, 1, 1])
    # Raised by the shoulder's x axis the arms point forward, and its y axis swings them outward.
    for side, x in ("l", 1), ("r", -1):
        straight[tree.index(f"shoulder.x.{side}")] = np.pi / 2
        straight[tree.index(f"shoulder.y.{side}")] = np.pi / 2
        shoulder = forward(tree, straight).positions[tree.index(f"shoulder.y.{side}")]
        hand = locate(forward(tree, straight), effectors)[effectors.names.index(f"hand.{side}")]
        assert_allclose(hand - shoulder, [0.696 * x, 0, 0], atol=1e-12)


@pytest.mark.parametrize(("links", "length"), [(1, 0.5), (2, 0.9), (3, 1.2)])
def test_the_planar_model_stays_in_its_plane(links, length):
    tree, effectors = figures.planar_model(links)
    theta = np.random.default_rng(0).uniform(tree.lower, tree.upper, (50, links))
    s = locate(forward(tree, theta), effectors)
    assert_allclose(s[..., 2], 0)
    assert np.linalg.norm(s, axis=-1).max() <= length + 1e-12
    assert_allclose(locate(forward(tree, np.zeros(links)), effectors), [[length, 0, 0]])


@pytest.mark.parametrize("links", [0, 4, "three", True, 2.5, None, [1, 2], np.nan])
def test_the_planar_model_has_at_most_three_links(links):
    with pytest.raises(ValueError, match="1, 2 or 3 links"):
        figures.planar_model(links)


def test_a_walker_has_30_rows_and_stands_on_bent_knees():
    tree, effectors = figures.walker()
    assert len(tree) == 30
    assert len(effectors) == 7
    assert (tree.rest > tree.lower).all()
    human = figures.human().tree
    for name in human.names:  # a human's, but for what hangs from the pelvis and for the rest
        ours, theirs = (one.joints()[one.index(name)] for one in (tree, human))
        assert replace(ours, parent=None, rest=None) == replace(theirs, parent=None, rest=None)


@given(anybody(limits=True, directions=True), SEEDS)
def test_a_floating_body_is_the_same_body_moved_and_turned(figure, seed):
    rng = np.random.default_rng(seed)
    free = figures.floating(figure, name="of the air")
    theta, gone, turn = poses(figure.tree, rng), rng.normal(size=3), rng.uniform(-1, 1, 3)
    frames = forward(free.tree, np.concatenate([gone, turn, theta]))
    R, w = frames.orientations[5], figure.effectors.w[:, None]
    s = locate(forward(figure.tree, theta), figure.effectors)
    assert_allclose(locate(frames, free.effectors), w * gone + s @ R.T, atol=1e-9)


@pytest.mark.parametrize("order", ["YXZ", "XYZ", "ZX"])
def test_a_ball_turns_in_its_order(order):
    tree = Tree.of(figures.ball("hip", order=order, lower=-1, upper=[2, 1, 3][: len(order)]))
    assert tree.names == tuple(f"hip.{letter.lower()}" for letter in order)
    assert tree.upper.tolist() == [2, 1, 3][: len(order)]
    alone = [Tree.of(figures.ball("hip", order=letter)) for letter in order]
    turns = [forward(one, [0.3 * i]).orientations[0] for i, one in enumerate(alone, start=1)]
    R = forward(tree, 0.3 * np.arange(1, len(order) + 1)).orientations[-1]
    assert_allclose(R, np.linalg.multi_dot(turns), atol=1e-15)


@pytest.mark.parametrize("options", [{"order": "XYX"}, {"order": ""}, {"order": 3}, {"lower": [1]}])
def test_a_ball_that_is_none_is_refused(options):
    with pytest.raises(ValueError, match="of a ball"):
        figures.ball("hip", **options)
