"""Least squares within limits: held against scipy's active set, and its own laws."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import lsq_linear

from ikteach.solvers import dls_following
from ikteach.solvers.bvls import bvls


def problem(seed, batch=()):
    """J, e and ends; some joints have no lower end, some are locked."""
    rng = np.random.default_rng(seed)
    n, m = rng.integers(1, 21), 3 * rng.integers(1, 5)
    J, e = rng.normal(size=(*batch, m, n)), rng.normal(size=(*batch, m))
    down, up = 0.3 * abs(rng.normal(size=(2, *batch, n)))
    down = np.where(rng.random(down.shape) < 0.1, np.inf, down)
    locked = rng.random(down.shape) < 0.1
    return J, e, np.where(locked, 0, -down), np.where(locked, 0, up)


@given(st.integers(0, 10_000))
def test_it_is_the_least_squares_within_the_ends(seed):
    J, e, low, high = problem(seed)
    found = bvls(J, e, low=low, high=high)
    n = J.shape[1]
    damping = np.sqrt(0.25 * e @ e + 4e-4**2 * np.square(J).sum())
    wider = np.where(low == high, 1e-9, high)  # scipy wants room
    A, b = np.vstack([J, damping * np.eye(n)]), np.concatenate([e, np.zeros(n)])
    best = lsq_linear(A, b, (low, wider), method="bvls", tol=1e-14)
    assert found == pytest.approx(best.x, abs=1e-6)
    assert (found >= low).all()
    assert (found <= high).all()


def test_without_ends_it_is_dls_that_follows():
    J, e, *_ = problem(3)
    free = bvls(J, e, low=np.full(J.shape[1], -np.inf), high=np.full(J.shape[1], np.inf))
    assert free == pytest.approx(dls_following(J, e, least=4e-4), rel=1e-3)


def test_a_batch_is_its_members():
    J, e, low, high = problem(5, batch=(4, 3))
    every = bvls(J, e, low=low, high=high)
    for i in np.ndindex(4, 3):
        one = bvls(J[i], e[i], low=low[i], high=high[i])
        assert every[i] == pytest.approx(one, abs=1e-12)
