"""Linear algebra on stacks of matrices (..., m, n), made fast for one matrix alone.

The formulas of the solvers are written with these. Here is all that a formula leaves out: scalar
paths, as an array of one number costs as much as JJᵀ does, and bounds that keep 0 / 0 away.
"""

from math import sqrt
from typing import Any

import numpy as np

from ikteach.arrays import Array

# Numbers whose squares still are numbers. A motion smaller than NONE is none; a squared length
# below SQUARE is rounding, and nothing may be divided by it.
NONE = 1e-150  # [m/rad]
SQUARE = 1e-300
TINY = 1e-200  # keeps JJᵀ + λ²I regular, and 0 / 0 away where a step is zero
EPS = float(np.finfo(float).eps)  # weaker directions have come of rounding
ROUNDING = 1e-13  # of the diagonal of JJᵀ: what is added below it is lost


def vecmat(v: Array, A: Array) -> Array:
    """Multiply Aᵀv, v (..., m), A (..., m, n): (..., n)."""
    return v.dot(A) if v.ndim == 1 and A.ndim == 2 else np.vecmat(v, A)


def matvec(A: Array, v: Array) -> Array:
    """Multiply Av, A (..., m, n), v (..., n): (..., m)."""
    return A.dot(v) if v.ndim == 1 and A.ndim == 2 else np.matvec(A, v)


def inverse_times(A: Array, b: Array) -> Any:
    """Solve Ax = b for A (..., m, m), b (..., m): (..., m)."""
    return np.linalg.solve(A, b) if b.ndim == 1 else np.linalg.solve(A, b[..., None])[..., 0]


def gram(A: Array) -> Array:
    """Multiply AAᵀ, A (..., m, n): (..., m, m)."""
    return A.dot(A.T) if A.ndim == 2 else A @ A.mT


def plus_diagonal(A: Array, d: Any) -> Array:
    """Add d to the diagonal of A (..., m, m), in place.

    d is one number or (...); A is changed where it has room. Added is at least as much as rounding
    lets us see of JJᵀ, so that the sum is regular.
    """
    m = A.shape[-1]
    if A.ndim == 2 and type(d) is not np.ndarray:
        diagonal = A.ravel()[:: m + 1]  # a view of A
        if d * d > ROUNDING * ROUNDING * np.vdot(
            diagonal, diagonal
        ):  # d is above the rounding of all
            diagonal += d
            return A
    elif type(d) is np.ndarray:
        if d.shape != A.shape[:-2]:
            A = np.array(np.broadcast_to(A, (*np.broadcast_shapes(d.shape, A.shape[:-2]), m, m)))
        d = d[..., None]
    diagonal = A.reshape(*A.shape[:-2], m * m)[..., :: m + 1]
    diagonal += np.maximum(d + TINY, ROUNDING * diagonal)
    return A


def unit(v: Array) -> Array:
    """Divide v (..., n) by its largest entry.

    No square of it then under- or overflows.
    """
    return v / np.maximum.reduce(abs(v), axis=-1, keepdims=True, initial=SQUARE)


def ratio(v: Array, w: Array) -> Any:
    """Divide ⟨v, v⟩ / ⟨w, w⟩ of v (..., n), w (..., m): (..., 1); 0 where w is zero."""
    if v.ndim == w.ndim == 1:
        below = float(w.dot(w))
        return float(v.dot(v)) / below if below > SQUARE else 0.0
    above, below = np.vecdot(v, v)[..., None], np.vecdot(w, w)[..., None]
    return np.divide(above, below, out=np.zeros_like(above), where=below > SQUARE)


def norm(A: Array) -> Any:
    """Return ‖A‖, the root of the sum of squares of A (..., m, n): (...)."""
    return sqrt(np.vdot(A, A)) if A.ndim == 2 else np.sqrt(np.square(A).sum(axis=(-2, -1)))


def strong(sigma: Array, share: float) -> Array:
    """Put ∞ for each weak σ (..., r).

    A weak σ is not above this share of the largest; its 1/σ is then 0.
    """
    return np.where(sigma > np.maximum(NONE, share * sigma[..., :1]), sigma, np.inf)
