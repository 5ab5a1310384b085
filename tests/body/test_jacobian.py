"""The Jacobian against finite differences, and its two forms."""

import numpy as np
from hypothesis import given
from numpy.testing import assert_allclose, assert_array_equal
from strategies import SEEDS, SHAPES, anybody, bodies, poses

from ikteach import Effectors, figures, forward, jacobian, locate
from ikteach.body.cross import YZXY, cross

H = 1e-5  # the error of a central difference is of order H²


@given(anybody(directions=True), SHAPES, SEEDS)
def test_equals_central_differences(figure, shape, seed):
    tree, effectors = figure
    theta = poses(tree, np.random.default_rng(seed), shape)
    J = jacobian(tree, forward(tree, theta), effectors)
    assert J.shape == (*shape, 3 * len(effectors), len(tree))
    for j in range(len(tree)):
        there, back = (
            locate(forward(tree, theta + h * np.eye(len(tree))[j]), effectors) for h in (H, -H)
        )
        column = ((there - back) / (2 * H)).reshape(*shape, -1)
        assert_allclose(J[..., j], column, atol=1e-7)


@given(anybody(directions=True), SHAPES, SEEDS)
def test_a_batch_equals_a_loop(figure, shape, seed):
    tree, effectors = figure
    rng = np.random.default_rng(seed)
    theta, at = poses(tree, rng, shape), rng.normal(size=(*shape, len(effectors), 3))
    frames = forward(tree, theta)
    for points in (None, at):
        J = jacobian(tree, frames, effectors, at=points)
        for i in np.ndindex(shape):
            point = None if points is None else points[i]
            alone = jacobian(tree, forward(tree, theta[i]), effectors, at=point)
            assert_allclose(J[i], alone, atol=1e-13)


@given(anybody(), SEEDS)
def test_both_forms_are_one_where_the_effectors_are_at_their_targets(figure, seed):
    tree, effectors = figure
    frames = forward(tree, poses(tree, np.random.default_rng(seed)))
    at = locate(frames, effectors)
    J = jacobian(tree, frames, effectors)
    assert_array_equal(J, jacobian(tree, frames, effectors, at=at))


@given(anybody(), SEEDS)
def test_is_exactly_zero_where_a_joint_does_not_carry(figure, seed):
    tree, effectors = figure
    frames = forward(tree, poses(tree, np.random.default_rng(seed)))
    J = jacobian(tree, frames, effectors).reshape(len(effectors), 3, len(tree))
    assert not J[~effectors.carried[:, None, :].repeat(3, axis=1)].any()


def test_targets_far_from_the_body_and_one_pose_for_many_targets():
    tree, effectors = figures.human()
    frames = forward(tree, tree.rest)
    J = jacobian(tree, frames, effectors, at=np.full((5, 4, 3), 1e9))
    assert J.shape == (5, 12, 20)
    assert np.isfinite(J).all()


def test_cross_is_the_cross_product():
    a, b = np.random.default_rng(0).normal(size=(2, 5, 3, 7))
    ours = cross(a.take(YZXY, axis=-2), b.take(YZXY, axis=-2))
    assert_allclose(ours, np.cross(a, b, axis=-2), atol=1e-15)


@given(bodies(directions=True), SEEDS)
def test_points_are_the_same_beside_directions(figure, seed):
    """Bit for bit: what stands beside a point changes nothing of it."""
    tree, effectors = figure
    points = effectors.w == 1
    if not points.any():
        return
    names = {
        name: (tree.names[joint], offset)
        for name, joint, offset, w in zip(
            effectors.names, effectors.joints, effectors.offsets.tolist(), points, strict=True
        )
        if w
    }
    alone = Effectors.of(tree, names)
    frames = forward(tree, poses(tree, np.random.default_rng(seed)))
    assert_array_equal(locate(frames, effectors)[points], locate(frames, alone))
    J = jacobian(tree, frames, effectors).reshape(-1, 3, len(tree))[points]
    assert_array_equal(J.reshape(-1, len(tree)), jacobian(tree, frames, alone))


@given(bodies(directions=True, slides=True), SEEDS)
def test_a_direction_is_turned_and_not_moved(figure, seed):
    tree, effectors = figure
    theta = poses(tree, np.random.default_rng(seed))
    moved = theta + tree.slide
    turned = effectors.w == 0
    s, t = (locate(forward(tree, pose), effectors)[turned] for pose in (theta, moved))
    assert_allclose(s, t, atol=1e-12)
    assert_allclose(
        np.linalg.norm(s, axis=1), np.linalg.norm(effectors.offsets[turned], axis=1), rtol=1e-12
    )
