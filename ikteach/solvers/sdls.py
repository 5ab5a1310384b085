"""Chapter 6. Selectively damped least squares: a bound of its own for each singular direction."""

from collections.abc import Callable
from math import pi

import numpy as np

from ikteach.arrays import Array, ArrayLike, Mask
from ikteach.checks import function, number, system

# Directions with a σ not above this share of the strongest are left out. Buss's code has 1e-10
# without a share, in his lengths.
SMALLEST = 1e-10
NONE = 1e-150  # [m/rad]; a motion this small is none

TINY = 1e-200  # keeps 0 / 0 away where a step is zero

Clamp = Callable[[Array, ArrayLike], Array]


def hard(phi: Array, bound: ArrayLike) -> Array:
    """φ (..., n), shortened as a whole so that no entry exceeds bound (...). ClampMaxAbs."""
    return phi * np.minimum(1, np.divide(bound, _peak(phi)))[..., None]


def soft(phi: Array, bound: ArrayLike) -> Array:
    """φ · γ / (γ + max|φ|), for bound γ (...): it nears the bound and does not meet it."""
    return phi * np.divide(bound, np.add(bound, _peak(phi)))[..., None]


def _peak(phi: Array) -> Array:
    """max|φ_j|, and TINY where φ is zero."""
    return np.maximum.reduce(abs(phi), axis=-1, initial=TINY)


def sdls(J: ArrayLike, e: ArrayLike, *, max_angle: float = pi / 4, clamp: Clamp = hard) -> Array:
    """Δθ = clamp(Σ φ_i, γ_max), with φ_i = clamp(σ_i⁻¹ (u_iᵀe) v_i, γ_i).

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
    (J, e), max_angle = system(J, e), number("max_angle", max_angle)
    function("clamp", clamp)
    three_rows(J)
    U, sigma, Vt = np.linalg.svd(J, full_matrices=False)
    sigma = np.where(kept(sigma), sigma, np.inf)  # left out: u_iᵀe / σ_i is then 0
    _, _, gamma = bounds(J, U, sigma, Vt, max_angle)
    phi = clamp((np.vecmat(e, U) / sigma)[..., None] * Vt, gamma)  # (..., r, n), a row a direction
    dtheta = np.add.reduce(phi, axis=-2)
    over = _peak(dtheta) > max_angle
    if not np.count_nonzero(over):
        return dtheta
    return np.where(over[..., None], clamp(dtheta, max_angle), dtheta)


def kept(sigma: Array) -> Mask:
    """Whether SDLS uses each direction, by its σ (..., r)."""
    return sigma > np.maximum(NONE, SMALLEST * sigma[..., :1])


def three_rows(J: Array) -> None:
    """Refuse a J (..., m, n) that has not three rows per effector."""
    if J.shape[-2] % 3:
        raise ValueError(f"sdls needs three rows per effector, not {J.shape[-2]} rows")


def bounds(
    J: Array, U: Array, sigma: Array, Vt: Array, max_angle: float
) -> tuple[Array, Array, Array]:
    """N, M [m] and γ [rad] of each singular direction of J = U diag(σ) Vᵀ with σ > 0, (..., r)."""
    both = np.add.reduce(lengths(np.concatenate([U, J], axis=-1)), axis=-2)
    N, rho = both[..., : U.shape[-1]], both[..., U.shape[-1] :]
    M = np.matvec(abs(Vt), rho) / sigma
    return N, M, N / np.maximum(M, N) * max_angle  # min(1, N/M), and no division by M = 0


def lengths(A: Array) -> Array:
    """The length of each 3-vector in the columns of A (..., 3k, r): (..., k, r)."""
    squares = (A * A).reshape(*A.shape[:-2], A.shape[-2] // 3, 3, A.shape[-1])
    return np.sqrt(np.add.reduce(squares, axis=-2))
