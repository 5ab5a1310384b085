"""The 3 × 3 inverse of CS 490: three joints, three coordinates, Cramer's rule."""

import numpy as np

from ikteach.arrays import Array, ArrayLike
from ikteach.checks import matrix, number, numbers, system
from ikteach.solvers.stacked import NONE


def determinant(A: ArrayLike) -> Array:
    """Return det A = a · (b × c) of A (..., 3, 3) with the columns a, b, c: (...)."""
    a, b, c = columns(A)
    return np.vecdot(a, np.linalg.cross(b, c))


def adjugate(A: ArrayLike) -> Array:
    """Return adj A (..., 3, 3), with adj(A) A = det(A) I: its rows are b × c, c × a and a × b."""
    a, b, c = columns(A)
    rows = np.linalg.cross(b, c), np.linalg.cross(c, a), np.linalg.cross(a, b)
    return np.stack(rows, axis=-2)


def independence(J: ArrayLike) -> Array:
    """Divide |det J| by the product of its columns' lengths.

    The quotient (...) is from 0 to 1. It is 1 where the three joints of J (..., 3, 3) move the
    effector at right angles to each other and 0 where the ways lie in a plane. No change of units
    changes it, as it would det J.
    """
    unit, length = _unit_columns(_square(J))
    return np.where((length > NONE).all(axis=-1), abs(determinant(unit)), 0)


def cramer(J: ArrayLike, e: ArrayLike, *, least: float = 1e-6) -> Array:
    """Step Δθ = J⁻¹e = adj(J) e / det(J), for 3 joints and 3 coordinates.

    J      (..., 3, 3)  Jacobian [m/rad]
    e      (..., 3)     error [m]
    least  where `independence` is not above it, J counts as singular and is refused: that step
           is zero. The columns are brought to length 1 first, so that it has no unit.
    Returns (..., 3) [rad]. ValueError unless J has three rows and three columns.
    Source: CS 490. Its `dtheta = J*r` stands for J⁻¹r, its "nonsingular (i.e. square)" for det ≠ 0.
    """
    (J, e), least = system(_square(J), e), number("least", least)
    unit, length = _unit_columns(J)
    det = determinant(unit)
    regular = (abs(det) > least) & (length > NONE).all(axis=-1)
    det = np.where(regular, det, 1)[..., None]
    dtheta = np.matvec(adjugate(unit), e) / det / length
    return np.where(regular[..., None], dtheta, 0)


def columns(A: ArrayLike) -> tuple[Array, Array, Array]:
    """Return the three columns of A (..., 3, 3), each (..., 3)."""
    A = _square(A)
    return A[..., 0], A[..., 1], A[..., 2]


def _square(A: ArrayLike) -> Array:
    A = numbers("J", A)
    if A.shape[-2:] != (3, 3):
        raise ValueError(f"Cramer's rule here is for J of shape (..., 3, 3), not {A.shape}")
    return matrix(A)


def _unit_columns(J: Array) -> tuple[Array, Array]:
    """J with columns of length 1, and their lengths (..., 3), no shorter than NONE."""
    peak = np.maximum(abs(J).max(axis=-2), NONE)  # so that no square under- or overflows
    length = np.maximum(peak * np.linalg.norm(J / peak[..., None, :], axis=-2), NONE)
    return J / length[..., None, :], length
