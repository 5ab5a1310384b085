"""Chapter 2. Singularity: which ways the effectors can move, and which they cannot.

A pose is singular where J has less rank than the most that the body can have. How much that is, J
alone does not say: `ikteach.motion.rank.full_rank` finds it, and `rank` takes it. Without it, it is
taken to be all rows or all joints, whichever are fewer, but for the one coordinate that no joint
moves in any effector: an arm in the plane z = 0 has two rows that count.
"""

from typing import Any, NamedTuple

import numpy as np

from ikteach.arrays import Array, ArrayLike, Index
from ikteach.checks import count, matrix
from ikteach.solvers.stacked import EPS


class Ellipsoid(NamedTuple):
    """Where the effector goes for all joint steps with ‖Δθ‖ = 1.

    directions  (..., m, m)  its axes, unit vectors in columns, longest first
    lengths     (..., m)     half their lengths [m/rad]; 0 the way that no joint can move
    """

    directions: Array
    lengths: Array


def ellipsoid(J: ArrayLike) -> Ellipsoid:
    """Return the manipulability ellipsoid {JΔθ : ‖Δθ‖ = 1} of J (..., m, n) (Yoshikawa 1985)."""
    U, sigma, _ = np.linalg.svd(matrix(J))
    lengths = np.zeros(U.shape[:-1])
    lengths[..., : sigma.shape[-1]] = sigma
    return Ellipsoid(U, lengths)


def manipulability(J: ArrayLike, *, rank: int | None = None) -> Array:
    """Multiply σ_1 σ_2 … σ_rank of J (..., m, n).

    It is the volume of the ellipsoid up to a constant, and 0 at a singular pose. Where all m rows
    count, it is √det(JJᵀ). Near 0 is no test for nearly singular: its size depends on the units and
    on the body; use `conditioning` or the smallest σ. rank is the most that this body can have.
    """
    sigma, counts = _sigma(J, rank)
    return np.where(counts, sigma, 1).prod(axis=-1)


def conditioning(J: ArrayLike, *, rank: int | None = None) -> Array:
    """Divide σ_max / σ_rank of J (..., m, n).

    It is 1 where all ways are as easy, inf where one is lost. rank is the most that this body can
    have.
    """
    sigma, counts = _sigma(J, rank)
    strongest, weakest = sigma[..., 0], np.where(counts, sigma, np.inf).min(axis=-1)
    infinite = np.full_like(strongest, np.inf)
    return np.divide(strongest, weakest, out=infinite, where=weakest > 0)


def _sigma(J: ArrayLike, rank: int | None) -> tuple[Array, Any]:
    """σ (..., r), 0 where it is but rounding, and which of them count: the first `rank`."""
    J = matrix(J)
    sigma = np.linalg.svdvals(J)
    sigma = np.where(sigma > max(J.shape[-2:]) * EPS * sigma[..., :1], sigma, 0)
    if rank is None:
        most: Any = np.minimum(_rows_that_count(J), J.shape[-1])[..., None]
    else:
        most = count("rank", rank, 1, min(J.shape[-2:]))
    return sigma, np.arange(sigma.shape[-1]) < most


def _rows_that_count(J: Array) -> Index:
    """All rows, but for those of a plane's third coordinate where J has three per effector, (...).

    Where two coordinates are still, one of them counts: a plane's arm is then stretched out.
    """
    m, n = J.shape[-2:]
    if m % 3:
        return np.full(J.shape[:-2], m)
    coordinates = abs(J.reshape(*J.shape[:-2], m // 3, 3, n)).max(axis=(-3, -1))
    still = coordinates <= m * EPS * coordinates.max(axis=-1, keepdims=True)
    return m - np.where(still.any(axis=-1), m // 3, 0)
