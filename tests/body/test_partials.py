"""Three ways to the Jacobian agree: cross products, derivatives by hand, differences."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ikteach import figures, forward, jacobian
from ikteach.body.partials import by_differences, by_hand

ANGLES = st.lists(st.floats(-3, 3), min_size=3, max_size=3)


@given(ANGLES, st.lists(st.floats(0.1, 2), min_size=3, max_size=3))
def test_by_hand_is_the_jacobian_of_a_planar_arm(theta, lengths):
    tree, effectors = figures.planar_arm(lengths)
    J = jacobian(tree, forward(tree, theta), effectors)
    assert np.allclose(by_hand(theta, lengths), J[:2], atol=1e-12)


@pytest.mark.parametrize("figure", ["human", "simulator", "planar_model", "double_y"])
def test_differences_are_the_jacobian(figure):
    tree, effectors = getattr(figures, figure)()
    theta = np.random.default_rng(0).uniform(-1, 1, (2, 3, len(tree)))
    J = jacobian(tree, forward(tree, theta), effectors)
    assert by_differences(tree, theta, effectors).shape == J.shape
    assert np.allclose(by_differences(tree, theta, effectors), J, atol=1e-8)


def test_batches():
    theta = np.random.default_rng(1).uniform(-1, 1, (4, 2, 3))
    lengths = [0.5, 0.4, 0.3]
    assert by_hand(theta, lengths).shape == (4, 2, 2, 3)
    assert np.allclose(by_hand(theta, lengths)[3, 1], by_hand(theta[3, 1], lengths))


def test_differences_are_as_wrong_as_h_is_large_or_as_rounding_lets_them():
    tree, effectors = figures.human()
    J = jacobian(tree, forward(tree, tree.rest), effectors)
    wrong = {
        h: abs(by_differences(tree, tree.rest, effectors, h=h) - J).max()
        for h in (0.1, 0.01, 1e-6, 1e-12)
    }
    assert 90 < wrong[0.1] / wrong[0.01] < 110
    assert wrong[1e-12] > wrong[1e-6]  # what chapter 1 asks about
    with pytest.raises(ValueError, match="h must be more than 0, not 0"):
        by_differences(tree, tree.rest, effectors, h=0)
