"""Chapter 6. Selectively damped least squares: a bound of its own for each singular direction."""

from collections.abc import Callable
from math import pi

import numpy as np

from ikteach.arrays import Array, ArrayLike

SMALLEST = 1e-10  # [m/rad]; directions with a σ not above it are left out, as in Buss's code

Clamp = Callable[[Array, ArrayLike], Array]


def hard(phi: Array, bound: ArrayLike) -> Array:
    """φ (..., n), shortened as a whole so that no entry exceeds bound (...). ClampMaxAbs."""
    bound, peak = np.asarray(bound, dtype=float), abs(phi).max(axis=-1, initial=0)
    over = peak > bound
    return phi * np.where(over, bound / np.where(over, peak, 1), 1)[..., None]


def soft(phi: Array, bound: ArrayLike) -> Array:
    """φ · γ / (γ + max|φ|), for bound γ (...): it nears the bound and does not meet it."""
    bound, peak = np.asarray(bound, dtype=float), abs(phi).max(axis=-1, initial=0)
    return phi * (bound / (bound + np.where(peak > 0, peak, 1)))[..., None]


def sdls(J: Array, e: Array, *, max_angle: float = pi / 4, clamp: Clamp = hard) -> Array:
    """Δθ = clamp(Σ φ_i, γ_max), with φ_i = clamp(σ_i⁻¹ (u_iᵀe) v_i, γ_i).

    The bound γ_i = min(1, N_i / M_i) γ_max is small where a turn of the joints along v_i moves the
    effectors much (M_i) for the little that it gains along u_i (N_i).

    J          (..., 3k, n)  Jacobian [m/rad]
    e          (..., 3k)     error [m]
    max_angle  γ_max [rad]; the thesis prints 4/π, very probably for π/4
    clamp      `hard` as in the paper and the thesis, or `soft` as in Buss's code
    Returns (..., n) [rad]. Not unique where singular values repeat.
    ValueError unless J has three rows an effector.
    Source: thesis 4.4.5; Buss & Kim 2005, J. Graphics Tools 10(3):37.
    """
    m, n = J.shape[-2:]
    if m % 3:
        raise ValueError(f"sdls needs three rows an effector, not {m} rows")
    U, sigma, Vt = np.linalg.svd(J, full_matrices=False)
    kept = sigma > SMALLEST
    sigma = np.where(kept, sigma, 1)
    N = lengths(U).sum(axis=-2)
    rho = lengths(J).sum(axis=-2)
    M = np.matvec(abs(Vt), rho) / sigma
    gamma = N / np.maximum(M, N) * max_angle  # min(1, N/M), and no division by M = 0
    alpha = np.where(kept, np.vecmat(e, U), 0)
    phi = clamp((alpha / sigma)[..., None] * Vt, gamma)  # (..., r, n), one row a direction
    dtheta = phi.sum(axis=-2)
    over = abs(dtheta).max(axis=-1, keepdims=True, initial=0) > max_angle
    return np.where(over, clamp(dtheta, max_angle), dtheta)


def lengths(A: Array) -> Array:
    """The length of each 3-vector in the columns of A (..., 3k, r): (..., k, r)."""
    blocks = A.reshape(*A.shape[:-2], -1, 3, A.shape[-1])
    return np.sqrt((blocks * blocks).sum(axis=-2))
