"""The circle of chapter 2 and its ellipse, against the SVD by hand and against turns."""

import numpy as np
import pytest

from ikteach.solvers.circle import along, image

BY_HAND = np.array([[-1.0, 0.0], [1.0, 1.0]])  # chapter 2 works it out on paper


def test_the_two_by_two_of_the_chapter():
    golden = (1 + np.sqrt(5)) / 2
    seen = image(BY_HAND)
    np.testing.assert_allclose(seen.sigma, [golden, golden - 1])
    np.testing.assert_allclose(seen.V[0], np.array([golden, 1]) / np.hypot(golden, 1))
    np.testing.assert_allclose(seen.U.T * seen.sigma @ seen.V, BY_HAND, atol=1e-12)


@pytest.mark.parametrize("seed", range(5))
def test_ellipse_and_parts(seed):
    rng = np.random.default_rng(seed)
    J, dtheta = rng.normal(size=(2, 2)), rng.normal(size=2)
    seen = image(J)
    np.testing.assert_allclose(seen.ellipse, seen.circle @ J.T)
    lengths = np.linalg.norm(seen.ellipse, axis=1)
    assert seen.sigma[1] - 1e-12 <= lengths.min() <= lengths.max() <= seen.sigma[0] + 1e-12
    share = along(seen, dtheta)
    np.testing.assert_allclose(share @ seen.V, dtheta)
    np.testing.assert_allclose((share * seen.sigma) @ seen.U, J @ dtheta)


def test_a_small_bend_turns_no_arrow_round():
    before = None
    for bend in np.linspace(0.05, 3, 100):
        J = np.array([[-np.sin(bend), -np.sin(bend)], [1 + np.cos(bend), np.cos(bend)]])
        V = image(J).V
        if before is not None:
            assert (np.vecdot(V, before) > 0.9).all()
        before = V


def test_another_shape_is_refused():
    with pytest.raises(ValueError, match=r"shape \(2, 2\), not \(3, 2\)"):
        image(np.ones((3, 2)))
