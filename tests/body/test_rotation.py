import numpy as np
import pytest
from numpy.testing import assert_allclose

from ikteach.body.rotation import sticks

UP = np.array([0.0, 1, 0])


@pytest.mark.parametrize(
    "along", [UP, -UP, [0, -2, 1e-17], [0, -1, 1e-9], [0, 0, 3], [1e-9, 0, 0], [3, -4, 12]]
)
def test_a_stick_lies_along_its_segment_and_is_not_mirrored(along):
    start = np.array([1.0, 2, 3])
    M = sticks(start, start + along)
    x, y, z, p = M.T
    assert_allclose(p, start)
    assert_allclose(y, start + along - start)
    assert_allclose([np.linalg.norm(x), np.linalg.norm(z)], 1)
    assert_allclose([x @ y, x @ z, y @ z], 0, atol=1e-12)
    assert np.linalg.det(M[:, :3]) == pytest.approx(np.linalg.norm(y))


def test_many_sticks_are_each_that_one():
    start, end = np.random.default_rng(0).normal(size=(2, 5, 4, 3))
    many = sticks(start, end)
    for i in np.ndindex(5, 4):
        assert_allclose(many[i], sticks(start[i], end[i]), atol=1e-15)


def test_a_stick_of_no_length_is_flat_and_finite():
    M = sticks(np.ones(3), np.ones(3))
    assert_allclose(M[:, 1], 0)
    assert np.isfinite(M).all()
