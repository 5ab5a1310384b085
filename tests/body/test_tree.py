"""The rows that make a tree, what is refused, and that nothing can be written to."""

from math import inf, nan

import numpy as np
import pytest
from hypothesis import given
from numpy.testing import assert_allclose, assert_array_equal
from strategies import anybody

from ikteach import Effectors, Joint, Tree, figures

HIP, KNEE = Joint("hip"), Joint("knee", "hip", (0, -0.4, 0))


@pytest.mark.parametrize(
    ("rows", "error", "match"),
    [
        ([], ValueError, "at least one joint"),
        ([Joint("")], ValueError, "a joint needs a name, not ''"),
        ([Joint(None)], ValueError, "a joint needs a name, not None"),
        ([Joint(3)], ValueError, "a joint needs a name, not 3"),
        ([HIP, HIP], ValueError, "two joints called 'hip'"),
        ([KNEE, HIP], ValueError, "'knee' hangs from 'hip', which is not above it"),
        ([Joint("a", "a")], ValueError, "'a' hangs from 'a', which is not above it"),
        ([HIP, Joint("knee", "hop")], ValueError, "no joint 'hop'; did you mean 'hip'"),
        ([HIP, Joint("knee", 0)], ValueError, "'knee' hangs from 0, but there is no joint 0"),
        ([HIP, Joint("knee", ["hip"])], ValueError, r"'knee' hangs from \['hip'\]"),
        ([Joint("a", axis=(0, 0, 0))], ValueError, "axis of 'a' is zero"),
        ([Joint("a", axis=(1, 0))], ValueError, r"axis of 'a' must be three finite numbers"),
        ([Joint("a", axis="x")], ValueError, "axis of 'a' must be three numbers, not 'x'"),
        ([Joint("a", axis=(nan, 0, 1))], ValueError, "axis of 'a' must be three finite numbers"),
        ([Joint("a", axis=None)], ValueError, "axis of 'a'"),
        ([Joint("a", offset=(0, inf, 1))], ValueError, "offset of 'a' must be three finite"),
        ([Joint("a", offset=1.0)], ValueError, "offset of 'a' must be three finite numbers"),
        ([Joint("a", lower=1, upper=0)], ValueError, "'a' has lower limit 1 above its upper 0"),
        ([Joint("a", lower=nan)], ValueError, "'a' has lower limit nan"),
        ([Joint("a", upper=nan)], ValueError, "upper nan"),
        ([Joint("a", lower="0")], ValueError, "lower limit of 'a' must be a number, not '0'"),
        ([Joint("a", upper=None)], ValueError, "upper limit of 'a' must be a number, not None"),
        ([Joint("a", lower=inf)], ValueError, "no angle within"),
        ([Joint("a", upper=-inf)], ValueError, "no angle within"),
        ([Joint("a", rest=2, upper=1)], ValueError, "rest 2 of 'a' lies outside"),
        ([Joint("a", rest=nan)], ValueError, "rest nan of 'a'"),
        ([Joint("a", rest=inf)], ValueError, "rest inf of 'a'"),
        ([Joint("a", rest="up")], ValueError, "rest of 'a' must be a number, not 'up'"),
        ([Joint("a", mobility=1.5)], ValueError, "mobility of 'a' is 1.5; it goes from 0 to 1"),
        ([Joint("a", mobility=nan)], ValueError, "mobility of 'a' is nan"),
        ([Joint("a", mobility=None)], ValueError, "mobility of 'a' must be a number, not None"),
        ([Joint("a", axis=("0", "0", "1"))], ValueError, "axis of 'a' must be three numbers"),
        ([Joint("a", offset=(0, 1j, 0))], ValueError, "offset of 'a' must be three numbers"),
        ([Joint("a", offset=(0, 10**400, 0))], ValueError, "offset of 'a' must be three numbers"),
        ([Joint("a", slide="no")], ValueError, "slide of 'a' must be True or False, not 'no'"),
        ([Joint("a", lower=True)], ValueError, "lower limit of 'a' must be a number, not True"),
        ([Joint("a", upper=10**400)], ValueError, "upper limit of 'a' must be a number, not 1000"),
        ([Joint("a", mobility=True)], ValueError, "mobility of 'a' must be a number, not True"),
        ([Joint("a" * 10**6, "b")], ValueError, "aaa … aaa.* hangs from 'b'"),
        (None, TypeError, "a tree is made of Joints, not of None"),
        (HIP, TypeError, "a tree is made of Joints, not of Joint"),
        (["hip"], TypeError, "a tree is made of Joints, not of 'hip'"),
    ],
)
def test_a_bad_row_is_named(rows, error, match):
    with pytest.raises(error, match=match) as told:
        Tree.of(rows)
    assert len(str(told.value)) < 300


@pytest.mark.parametrize(
    ("points", "error", "match"),
    [
        ({}, ValueError, "at least one effector"),
        ({"foot": ("kne", (0, 0, 0))}, LookupError, "no joint 'kne'; did you mean 'knee'"),
        ({"foot": ("knee", (0, 0))}, ValueError, "offset of effector 'foot' must be three"),
        ({"foot": ("knee", (0, nan, 0))}, ValueError, "offset of effector 'foot' must be three"),
        ({"foot": (3, (0, 0, 0))}, LookupError, "no joint 3; there are 'hip', 'knee'"),
        (
            {"foot": ("knee", ("0", "1", "2"))},
            ValueError,
            "offset of effector 'foot' must be three",
        ),
        ({3: ("knee", (0, 0, 0))}, ValueError, "an effector needs a name, not 3"),
        ({"": ("knee", (0, 0, 0))}, ValueError, "an effector needs a name, not ''"),
        ([("foot", "knee")], TypeError, r"effectors are {name: \(joint, offset\)}, not \[\("),
        ({"foot": "knee"}, ValueError, r"effector 'foot' needs \(joint, offset\), not 'knee'"),
        ({"foot": None}, ValueError, r"effector 'foot' needs \(joint, offset\), not None"),
    ],
)
def test_a_bad_effector_is_named(points, error, match):
    with pytest.raises(error, match=match):
        Effectors.of(Tree.of([HIP, KNEE]), points)


def test_an_unknown_joint_is_answered_with_what_may_have_been_meant():
    tree, _ = figures.human()
    with pytest.raises(LookupError, match=r"no joint 'kne.l'; did you mean 'knee.l' or 'knee.r'"):
        tree.index("kne.l")
    with pytest.raises(LookupError, match="no joint 'zzz'; there are 'hip', 'knee'"):
        Tree.of([HIP, KNEE]).index("zzz")


def test_the_columns():
    tree = Tree.of(
        [Joint("a", axis=(0, 0, 2), rest=0.5, mobility=0.5), Joint("b", "a", slide=True)]
    )
    assert tree.names == ("a", "b")
    assert len(tree) == 2
    assert_array_equal(tree.parents, [-1, 0])
    assert_array_equal(tree.axes, [[0, 0, 1], [0, 0, 1]])
    assert_array_equal(tree.slide, [False, True])
    assert_array_equal(tree.rest, [0.5, 0])
    assert_array_equal(tree.mobility, [0.5, 1])
    assert tree.index("b") == 1
    assert tree.above(1) == [1, 0]


def test_angles_as_a_person_reads_them():
    tree = Tree.of([Joint("free"), Joint("wall", lower=-9, upper=9), Joint("rail", slide=True)])
    turned = np.array([[7.0, 7.0, 7.0], [-1000.0, -8.0, -7.0], [np.pi / 2, 0.1, 0.2]])
    wrapped = tree.wrapped(turned)
    assert_array_equal(wrapped[:, 1:], turned[:, 1:])
    assert (abs(wrapped[:, 0]) <= np.pi).all()
    assert_allclose(np.exp(1j * wrapped[:, 0]), np.exp(1j * turned[:, 0]))
    assert_allclose(wrapped[2], turned[2])


@pytest.mark.parametrize(("lower", "upper", "rest"), [(1, 2, 1), (-2, -1, -1), (-1, 1, 0)])
def test_the_rest_is_the_angle_nearest_0(lower, upper, rest):
    assert Tree.of([Joint("a", lower=lower, upper=upper)]).rest == rest


def test_nothing_can_be_written_to():
    tree, effectors = figures.human()
    columns = [*vars(tree).values(), *vars(effectors).values(), effectors.mask]
    columns += vars(tree.plan).values()
    arrays = [c for c in columns if isinstance(c, np.ndarray)]
    assert len(arrays) > 15
    for array in arrays:
        with pytest.raises(ValueError, match="read-only"):
            array[...] = 0
    with pytest.raises(AttributeError):
        tree.names = ()


def test_a_tree_does_not_follow_the_arrays_it_was_made_of():
    offset = np.array([0.0, 1, 0])
    tree = Tree.of([Joint("a", offset=offset)])
    offset[:] = 5
    assert_array_equal(tree.offsets, [[0, 1, 0]])


def test_effectors_anywhere():
    tree = Tree.of([HIP, KNEE, Joint("arm")])
    ends = {"a": ("knee", (0, 0, 0)), "b": ("knee", (1, 0, 0)), "c": ("hip", (0, 0, 0))}
    effectors = Effectors.of(tree, ends | {"d": ("arm", (0, 0, 0))})
    assert len(effectors) == 4
    assert_array_equal(
        effectors.carried,
        [[True, True, False], [True, True, False], [True, False, False], [False, False, True]],
    )
    assert effectors.chains[0] == effectors.chains[1] != effectors.chains[2]


def test_chains_of_the_human_are_two_legs_and_the_arms_with_the_spine():
    tree, effectors = figures.human()
    chain = dict(zip(tree.names, effectors.chains, strict=True))
    assert chain["elbow.l"] == chain["elbow.r"] == chain["spine.bend"]
    assert len({chain["elbow.l"], chain["knee.l"], chain["knee.r"]}) == 3
    hand = Effectors.of(tree, {"hand": ("elbow.l", (0, 0, 0))})
    assert hand.chains[tree.index("knee.l")] == -1


def test_axes_are_unit_vectors_whatever_their_length():
    tree = Tree.of([Joint("a", axis=(3e-200, 0, 4e-200)), Joint("b", axis=(0, 3e200, 4e200))])
    assert_allclose(tree.axes, [[0.6, 0, 0.8], [0, 0.6, 0.8]])


@given(anybody(limits=True))
def test_a_tree_of_its_own_joints_is_the_same(figure):
    tree = figure.tree
    again = Tree.of(tree.joints())
    assert again.names == tree.names
    for name in ("parents", "offsets", "slide", "lower", "upper", "rest", "mobility"):
        assert_array_equal(getattr(again, name), getattr(tree, name))
    assert_allclose(again.axes, tree.axes, atol=1e-15)


@pytest.mark.parametrize(
    ("directions", "error", "words"),
    [
        ([], TypeError, "effectors are"),
        ({"gaze": ("joint3", (0, 0, 0))}, ValueError, "the direction 'gaze' is zero"),
        ({"hand": ("joint3", (0, 0, 1))}, ValueError, "two effectors called 'hand'"),
        ({"gaze": ("head", (0, 0, 1))}, LookupError, "no joint 'head'"),
        ({"gaze": ("joint3", (0, 1))}, ValueError, "'gaze' must be three"),
        ({"gaze": "joint3"}, ValueError, "'gaze' needs"),
    ],
)
def test_a_direction_that_is_none_is_named(directions, error, words):
    tree = figures.planar_arm(3).tree
    with pytest.raises(error, match=words):
        Effectors.of(tree, {"hand": ("joint3", (1, 0, 0))}, directions=directions)
