"""Forward kinematics by its laws, and against loops."""

import numpy as np
import pytest
import textbook
from hypothesis import given
from numpy.testing import assert_allclose, assert_array_equal
from strategies import SEEDS, SHAPES, anybody, poses

from ikteach import Effectors, Joint, Tree, figures, forward, jacobian, locate


@given(anybody(), SHAPES, SEEDS)
def test_orientations_are_rotations_and_axes_have_length_1(figure, shape, seed):
    tree, _ = figure
    frames = forward(tree, poses(tree, np.random.default_rng(seed), shape))
    R = frames.orientations
    assert_allclose(R @ R.mT, np.broadcast_to(np.eye(3), R.shape), atol=1e-13)
    assert_allclose(np.linalg.det(R), 1, atol=1e-13)
    assert_allclose(np.linalg.norm(frames.axes, axis=-1), 1, atol=1e-13)
    # A joint's own rotation leaves its axis alone.
    assert_allclose(np.matvec(R, tree.axes), frames.axes, atol=1e-13)


@given(anybody(), SEEDS)
def test_equals_the_textbook_loop(figure, seed):
    tree, _ = figure
    theta = poses(tree, np.random.default_rng(seed))
    frames, matrices = forward(tree, theta), np.array(textbook.forward(tree, theta))
    assert_allclose(frames.positions, matrices[:, :3, 3], atol=1e-13)
    assert_allclose(frames.orientations, matrices[:, :3, :3], atol=1e-13)
    assert_allclose(frames.axes, np.matvec(matrices[:, :3, :3], tree.axes), atol=1e-13)


@given(anybody(), SHAPES, SEEDS)
def test_a_batch_equals_a_loop(figure, shape, seed):
    tree, effectors = figure
    theta = poses(tree, np.random.default_rng(seed), shape)
    frames = forward(tree, theta)
    s = locate(frames, effectors)
    for i in np.ndindex(shape):
        alone = forward(tree, theta[i])
        for together, one in zip(frames, alone, strict=True):
            assert_allclose(together[i], one, atol=1e-14)
        assert_allclose(s[i], locate(alone, effectors), atol=1e-14)


@given(anybody(slides=False), SEEDS)
def test_a_full_turn_changes_nothing(figure, seed):
    tree, effectors = figure
    rng = np.random.default_rng(seed)
    theta = poses(tree, rng)
    turned = theta + 2 * np.pi * rng.integers(-2, 3, len(tree))
    there, back = (locate(forward(tree, pose), effectors) for pose in (theta, turned))
    assert_allclose(there, back, atol=1e-12)


@given(anybody(), SEEDS)
def test_a_joint_moves_only_what_hangs_from_it(figure, seed):
    tree, effectors = figure
    rng = np.random.default_rng(seed)
    theta, j = poses(tree, rng), rng.integers(len(tree))
    before = locate(forward(tree, theta), effectors)
    theta[j] += 1
    after = locate(forward(tree, theta), effectors)
    stay = ~effectors.carried[:, j]
    assert_array_equal(before[stay], after[stay])


def test_a_quarter_turn_is_right_handed():
    tree, effectors = figures.planar_arm([2.0])
    assert_allclose(locate(forward(tree, [np.pi / 2]), effectors), [[0, 2, 0]], atol=1e-15)


def test_a_slide_goes_along_its_axis_and_does_not_turn():
    tree = Tree.of([Joint("lift", axis=(0, 2, 0), slide=True), Joint("arm", "lift", (1, 0, 0))])
    effectors = Effectors.of(tree, {"hand": ("arm", (0, 0, 0)), "base": ("lift", (0, 0, 1))})
    assert_allclose(locate(forward(tree, [0.3, 1]), effectors), [[1, 0.3, 0], [0, 0.3, 1]])


@pytest.mark.parametrize("n", [1, 2, 3, 7, 8, 9, 33])
def test_a_long_chain(n):
    tree, effectors = figures.planar_arm(n)
    theta = np.linspace(-0.3, 0.4, n)
    turned = np.exp(1j * np.cumsum(theta)).sum()  # the plane as complex numbers
    s = locate(forward(tree, theta), effectors)
    assert_allclose(s, [[turned.real, turned.imag, 0]], atol=1e-13)


def test_no_pose_at_all_is_a_batch_too():
    tree, effectors = figures.human()
    frames = forward(tree, np.zeros((0, 20)))
    assert locate(frames, effectors).shape == (0, 4, 3)


@pytest.mark.parametrize("shape", [(19,), (20, 1), ()])
def test_a_wrong_number_of_angles(shape):
    tree, _ = figures.human()
    with pytest.raises(ValueError, match=r"20 joints need theta of shape \(\.\.\., 20\), not \("):
        forward(tree, np.zeros(shape))


@pytest.mark.parametrize(
    ("theta", "match"),
    [
        (["0"] * 20, "theta must be made of numbers"),
        ([np.nan] * 20, "the angle of 'spine.bend' is not finite"),
        ([1j] * 20, "theta must be made of numbers"),
        (None, "theta must be made of numbers, not None"),
    ],
)
def test_what_is_no_pose(theta, match):
    tree, effectors = figures.human()
    with pytest.raises(ValueError, match=match):
        forward(tree, theta)
    with pytest.raises(TypeError, match="a Tree is needed here, not Figure"):
        forward((figures.human()), theta)
    frames = forward(tree, tree.rest)
    with pytest.raises(TypeError, match="Effectors are needed here"):
        locate(frames, tree)
    with pytest.raises(TypeError, match="the frames of forward"):
        locate(tree.rest, effectors)
    with pytest.raises(ValueError, match="of a body of 17 joints, not of 20"):
        locate(frames, figures.simulator().effectors)
    with pytest.raises(ValueError, match="these frames are of 20 joints, not of 17"):
        jacobian(figures.simulator().tree, frames, effectors)
    with pytest.raises(ValueError, match=r"a point per effector, \(\.\.\., 4, 3\), not the shape"):
        jacobian(tree, frames, effectors, at=[0, 0, 0])
    with pytest.raises(ValueError, match="at must be made of numbers"):
        jacobian(tree, frames, effectors, at="there")
