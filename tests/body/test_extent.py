"""The ball that holds all poses of a body."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from metamorphic import BODY, Case
from numpy.testing import assert_allclose
from strategies import SEEDS, anybody, poses

from ikteach import Effectors, Joint, Tree, figures, forward, locate
from ikteach.body.extent import extent

X, Y, Z = np.eye(3)


def body(*joints, at=(0, 0, 0)):
    tree = Tree.of(joints)
    return tree, Effectors.of(tree, {"end": (tree.names[-1], at)})


def everything(tree, effectors, theta):
    """Joints and effectors (..., n + k, 3) [m]."""
    frames = forward(tree, theta)
    return np.concatenate([frames.positions, locate(frames, effectors)], axis=-2)


@given(anybody(limits=True), SEEDS)
def test_no_pose_leaves_it(figure, seed):
    tree, effectors = figure
    rng = np.random.default_rng(seed)
    theta = poses(tree, rng, (200,))
    ends = np.where(rng.random((100, len(tree))) < 0.5, tree.lower, tree.upper)
    theta[:100] = np.where(np.isfinite(ends), ends, theta[:100])  # a free joint has no end
    centre, radius = extent(tree, effectors)
    far = np.linalg.norm(everything(tree, effectors, theta) - centre, axis=-1)
    assert far.max() <= radius * (1 + 1e-9)


@given(anybody(limits=True), SEEDS, st.sampled_from(list(BODY)))
def test_it_moves_along_with_the_body(figure, seed, change):
    case = Case(*figure, figure.tree.rest, np.zeros((len(figure.effectors), 3)))
    one, other, along = BODY[change](case, np.random.default_rng(seed))
    (c, r), (d, s) = extent(*one[:2]), extent(*other[:2])
    assert s == pytest.approx(along.length * r, rel=2e-3)
    wanted = along.length * along.turn @ c + along.shift
    assert_allclose(d, wanted, atol=5e-3 * s)  # the search for the centre ends somewhere near


@pytest.mark.parametrize(
    ("figure", "centre", "radius"),
    [
        (figures.planar_arm(3), (0, 0, 0), 3),
        (figures.planar_arm([1e-6, 2e-6]), (0, 0, 0), 3e-6),
        # A quarter of a circle stands on its chord.
        (body(Joint("a", lower=0, upper=np.pi / 2), at=(1, 0, 0)), (0.5, 0.5, 0), np.sqrt(0.5)),
        (body(Joint("a", lower=0, upper=1.5 * np.pi), at=(1, 0, 0)), (0, 0, 0), 1),
        (body(Joint("a", axis=X, slide=True, lower=1, upper=5)), (3, 0, 0), 2),
        (body(Joint("a", offset=(9, 9, 9))), (9, 9, 9), 1),  # a body without any length
        # Without a limit a slide goes as far as the body is large.
        (body(Joint("a", axis=X, slide=True), Joint("b", "a"), at=(2, 0, 0)), (0, 0, 0), 4),
        (body(Joint("a", axis=X, slide=True, lower=3, rest=3), Joint("b", "a"), at=(2, 0, 0)),
         (4, 0, 0), 3),
    ],
)  # fmt: skip
def test_balls_that_are_known(figure, centre, radius):
    found = extent(*figure)
    assert_allclose(found.centre, centre, atol=1e-3 * radius)
    assert found.radius == pytest.approx(radius, rel=1e-3)


def test_it_is_not_much_larger_than_it_must_be():
    for figure, room in (
        (figures.human(), 1.12), (figures.y_shape(), 1.03), (figures.double_y(), 1.2),
    ):  # fmt: skip
        theta = poses(figure.tree, np.random.default_rng(0), (20000,))
        points = everything(*figure, theta).reshape(-1, 3)
        radius = extent(*figure).radius
        middle = (points.min(axis=0) + points.max(axis=0)) / 2
        assert radius < room * np.linalg.norm(points - middle, axis=-1).max()
