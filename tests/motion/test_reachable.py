"""What can be reached, where the answer is known."""

import numpy as np
import pytest
from hypothesis import given, settings
from numpy.testing import assert_allclose, assert_array_equal
from strategies import SEEDS, SHAPES, bodies, poses

from ikteach import Effectors, Joint, Tree, figures, forward, locate, reachable
from ikteach.motion.reachable import nearest


@settings(max_examples=20)
@given(bodies(limits=True), SHAPES, SEEDS)
def test_where_some_pose_is_can_be_reached(figure, shape, seed):
    tree, effectors = figure
    theta = poses(tree, np.random.default_rng(seed), shape)
    can = reachable(tree, effectors, locate(forward(tree, theta), effectors))
    assert can.shape == (*shape, len(effectors))
    assert can.mean() > 0.9  # a search: it may miss a corner of a random body, never invent one


@settings(max_examples=20)
@given(bodies(limits=True, slides=False), SEEDS)
def test_further_than_the_chain_is_long_cannot(figure, seed):
    tree, effectors = figure
    rng = np.random.default_rng(seed)
    length = np.linalg.norm(tree.offsets, axis=1).sum()
    length += np.linalg.norm(effectors.offsets, axis=1)
    away = rng.normal(size=(len(effectors), 3))
    away *= (length + 0.01)[:, None] / np.linalg.norm(away, axis=1, keepdims=True)
    assert not reachable(tree, effectors, away).any()
    assert (nearest(tree, effectors, away) >= 0.01 - 1e-12).all()


def test_how_near_a_planar_arm_can_come():
    tree, effectors = figures.planar_arm([1.0, 0.5])
    targets = np.array([[2.0, 0, 0], [0.2, 0, 0], [0, 1, 0], [1, 0, 1]])[:, None]
    wanted = [0.5, 0.3, 0, 1]
    assert_allclose(nearest(tree, effectors, targets)[:, 0], wanted, atol=1e-4)
    assert_array_equal(reachable(tree, effectors, targets, within=0.31)[:, 0], [0, 1, 1, 0])


def test_limits_count():
    def arm(upper):
        tree = Tree.of([Joint("a", lower=0, upper=upper)])
        return tree, Effectors.of(tree, {"hand": ("a", (1, 0, 0))})

    assert reachable(*arm(2.0), [[0, 1, 0]])
    assert not reachable(*arm(1.5), [[0, 1, 0]])
    assert_allclose(nearest(*arm(np.pi / 4), [[0, 1, 0]]), 2 * np.sin(np.pi / 8), atol=1e-9)


def test_slides_count():
    tree = Tree.of([Joint("lift", axis=(0, 1, 0), slide=True, lower=0, upper=0.5)])
    effectors = Effectors.of(tree, {"top": ("lift", (0, 0, 0))})
    assert_allclose(nearest(tree, effectors, [[0, 0.8, 0]]), 0.3, atol=1e-9)
    assert reachable(tree, effectors, [[0, 0.4, 0]])


def test_each_effector_is_asked_by_itself_and_mobility_does_not_count():
    tree = Tree.of([Joint("a", mobility=0.0)])
    ends = {"one": ("a", (1, 0, 0)), "other": ("a", (1, 0, 0))}
    effectors = Effectors.of(tree, ends)
    assert reachable(tree, effectors, [[0, 1, 0], [0, -1, 0]]).all()


def test_bad_targets_are_named():
    tree, effectors = figures.human()
    with pytest.raises(ValueError, match="4 effectors need targets of shape"):
        reachable(tree, effectors, np.zeros((3, 3)))
    with pytest.raises(ValueError, match=r"target of 'foot.l' is not finite"):
        reachable(tree, effectors, np.full((4, 3), np.nan))
