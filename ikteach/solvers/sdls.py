"""Chapter 6. Selectively damped least squares: a bound of its own for each singular direction."""

from collections.abc import Callable
from math import pi

import numpy as np

from ikteach.arrays import Array, ArrayLike
from ikteach.checks import function, number
from ikteach.solvers.door import solver
from ikteach.solvers.stacked import TINY, matvec, strong, vecmat

# Directions with a σ not above this share of the strongest are left out. Buss's code has 1e-10
# without a share, in his lengths.
SMALLEST = 1e-10

Clamp = Callable[[Array, ArrayLike], Array]


def hard(phi: Array, bound: ArrayLike) -> Array:
    """Shorten φ (..., n) as a whole so that no entry exceeds bound (...). ClampMaxAbs."""
    return phi * np.minimum(1, np.divide(bound, _peak(phi)))[..., None]


def soft(phi: Array, bound: ArrayLike) -> Array:
    """Make φ · γ / (γ + max|φ|) for bound γ (...).

    It nears the bound and does not meet it.
    """
    return phi * np.divide(bound, np.add(bound, _peak(phi)))[..., None]


@solver(max_angle=number, clamp=function)
def sdls(J: Array, e: Array, *, max_angle: float = pi / 4, clamp: Clamp = hard) -> Array:
    """Step Δθ = clamp(Σ φ_i, γ_max), with φ_i = clamp(σ_i⁻¹ (u_iᵀe) v_i, γ_i).

    The bound γ_i = min(1, N_i / M_i) γ_max is small where a turn of the joints along v_i moves the
    effectors much (M_i) for the little that it gains along u_i (N_i).

    J          (..., 3k, n)  Jacobian [m/rad]
    e          (..., 3k)     error [m]
    max_angle  γ_max [rad]; the thesis prints 4/π, very probably for π/4
    clamp      `hard` as in the paper and the thesis, or `soft` as in Buss's code
    Returns (..., n) [rad]. Not unique where singular values repeat.
    ValueError unless J has three rows per effector, if shapes do not fit or a number is none.
    Source: thesis 4.4.5; Buss & Kim 2005, J. Graphics Tools 10(3):37.
    """
    three_rows(J)
    U, sigma, Vt = np.linalg.svd(J, full_matrices=False)
    sigma = strong(sigma, SMALLEST)  # ∞ where a direction is left out
    _, _, gamma = bounds(J, U, sigma, Vt, max_angle)
    phi = clamp((vecmat(e, U) / sigma)[..., None] * Vt, gamma)  # (..., r, n), a row per direction
    return clamped_where_over(np.add.reduce(phi, axis=-2), max_angle, clamp)


def sdls_response(
    sigma: Array, alpha: Array, Vt: Array, gamma: Array, *, max_angle: float, clamp: Clamp
) -> Array:
    """Answer u_iᵀe = alpha (r,) by f_i = c c_i / σ_i.

    c_i shortens φ_i to its own bound γ_i = gamma (r,), and c all of Δθ to γ_max.
    """
    inverse = 1 / strong(sigma, SMALLEST)
    phi = (inverse * alpha)[:, None] * Vt
    shares = _share(clamp(phi, gamma), phi)
    dtheta = (shares @ phi)[None]
    c = _share(clamped_where_over(dtheta, max_angle, clamp), dtheta)
    return c * shares * inverse


def clamped_where_over(dtheta: Array, max_angle: float, clamp: Clamp) -> Array:
    """Clamp the steps (..., n) beyond max_angle [rad].

    A step is beyond it if some joint turns further than that.
    """
    if dtheta.ndim == 1:
        return dtheta if np.maximum.reduce(abs(dtheta)) <= max_angle else clamp(dtheta, max_angle)
    over = _peak(dtheta) > max_angle
    if not np.count_nonzero(over):
        return dtheta
    return np.where(over[..., None], clamp(dtheta, max_angle), dtheta)


def _peak(phi: Array) -> Array:
    """Find max|φ_j|, and TINY where φ is zero."""
    return np.maximum.reduce(abs(phi), axis=-1, initial=TINY)


def _share(after: Array, before: Array) -> Array:
    """Find by how much each row was shortened, 0..1; 1 where it is zero."""
    size = abs(before).max(axis=-1)
    return np.divide(abs(after).max(axis=-1), size, out=np.ones_like(size), where=size > 0)


def three_rows(J: Array) -> None:
    """Refuse a J (..., m, n) that has not three rows per effector."""
    if J.shape[-2] % 3:
        raise ValueError(f"sdls needs three rows per effector, not {J.shape[-2]} rows")


def bounds(
    J: Array, U: Array, sigma: Array, Vt: Array, max_angle: float
) -> tuple[Array, Array, Array]:
    """Return N, M and γ [rad] of each singular direction of J = U diag(σ) Vᵀ, (..., r).

    γ_i = min(1, N_i / M_i) γ_max; the σ are above 0.
    """
    both = np.add.reduce(lengths(np.concatenate([U, J], axis=-1)), axis=-2)
    N, rho = both[..., : U.shape[-1]], both[..., U.shape[-1] :]
    M = matvec(abs(Vt), rho) / sigma
    return N, M, N / np.maximum(M, N) * max_angle  # min(1, N/M), and no division by M = 0


def lengths(A: Array) -> Array:
    """Return the length of each 3-vector in the columns of A (..., 3k, r): (..., k, r)."""
    squares = (A * A).reshape(*A.shape[:-2], A.shape[-2] // 3, 3, A.shape[-1])
    return np.sqrt(np.add.reduce(squares, axis=-2))
