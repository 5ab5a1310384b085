"""Chapter 8. Damped least squares within limits: the limits are part of the problem.

To clip, or to hold and ask again, mends a step that the solver made without knowing of limits.
Here the solver knows them: of all steps that stay within, it takes the one that brings e nearest.
"""

import numpy as np

from ikteach.arrays import Array, ArrayLike, Mask

FULL = 3  # rounds without progress in which all wrong joints change sides; then one at a time


def bvls(
    J: Array, e: Array, *, low: ArrayLike, high: ArrayLike, share: float = 0.5, least: float = 4e-4
) -> Array:
    """Step within a box: damped least squares of bounded variables.

    Δθ is the least of ‖e − JΔθ‖² + λ²‖Δθ‖² with low ≤ Δθ ≤ high.

    J            (..., m, n)  Jacobian [m/rad]
    e            (..., m)     error [m]
    low, high    (..., n)     how far each joint may turn down and up [rad]
    share, least λ² = (share ‖e‖)² + (least ‖J‖)², as in `dls_following`
    Returns (..., n) [rad], within low and high.
    Every joint is free, or stands at one of its ends. The free ones solve their normal equations;
    one that then leaves its range is put to the end that it passed, one that its end only holds
    back is set free, until all are right. Source: block principal pivoting, Portugal, Júdice &
    Vicente 1994, Math. Comp. 63:625.
    """
    J, e = np.asarray(J, dtype=float), np.asarray(e, dtype=float)
    lambda2 = (share * share) * np.vecdot(e, e) + (least * least) * np.square(J).sum(axis=(-2, -1))
    n = J.shape[-1]
    H = J.mT @ J + np.maximum(lambda2, 1e-200)[..., None, None] * np.eye(n)
    g = np.vecmat(e, J)
    batch = np.broadcast_shapes(g.shape, np.shape(low), np.shape(high))[:-1]
    H = np.broadcast_to(H, (*batch, n, n)).reshape(-1, n, n)
    g, low, high = (np.broadcast_to(x, (*batch, n)).reshape(-1, n) for x in (g, low, high))
    return _pivot(H, g, low, high).reshape(*batch, n)


bvls.wants = ("low", "high")  # type: ignore[attr-defined]


def _pivot(H: Array, g: Array, low: Array, high: Array) -> Array:
    """Find the least of ½xᵀHx − gᵀx with low ≤ x ≤ high, (b, n); H (b, n, n) is positive."""
    b, n = g.shape
    at_low, at_high = np.zeros((2, b, n), dtype=bool)
    stuck = low == high
    fewest, patience = np.full(b, n + 1), np.full(b, FULL)
    for _ in range(10 * n):
        x = _with_ends(H, g, np.where(at_low | stuck, low, high), at_low | at_high | stuck)
        pull = g - np.matvec(H, x)  # where the error would have a joint that stands at an end
        below = ~(at_low | at_high | stuck) & (x < low)
        above = ~(at_low | at_high | stuck) & (x > high)
        back = (at_low & ~stuck & (pull > 0)) | (at_high & ~stuck & (pull < 0))
        wrong = below | above | back
        count = wrong.sum(axis=-1)
        if not count.any():
            break
        fewer = count < fewest
        fewest = np.where(fewer, count, fewest)
        patience = np.where(fewer, FULL, patience - 1)
        one = np.zeros_like(wrong)  # of those whose patience is at an end only the last changes
        one[np.arange(b), n - 1 - wrong[:, ::-1].argmax(axis=-1)] = True
        change = wrong & (one | (patience >= 0)[:, None])
        at_low = (at_low | (change & below)) & ~(change & back)
        at_high = (at_high | (change & above)) & ~(change & back)
    return np.minimum(np.maximum(x, low), high)


def _with_ends(H: Array, g: Array, ends: Array, fixed: Mask) -> Array:
    """Solve the rows of H x = g that are not fixed; x (b, n) is at `ends` where they are."""
    free = ~fixed
    put = np.where(fixed, ends, 0)
    both = free[:, :, None] & free[:, None, :]
    A = np.where(both, H, np.eye(H.shape[-1]))
    y = np.where(free, g - np.matvec(H, put), put)
    return np.linalg.solve(A, y[..., None])[..., 0]
