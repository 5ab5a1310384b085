"""Chapter 6. One singular direction at a time: what each method makes of what it is asked."""

from math import pi
from typing import NamedTuple

import numpy as np

from ikteach.arrays import Array, ArrayLike
from ikteach.solvers.sdls import SMALLEST, lengths


class Directions(NamedTuple):
    """The singular directions of J, strongest first, and what SDLS knows of each.

    sigma  (..., r)     σ_i [m/rad]
    alpha  (..., r)     α_i = u_iᵀe, the error along u_i [m]
    U      (..., m, r)  u_i in columns, ways of the effectors
    Vt     (..., r, n)  v_i in rows, ways of the joints
    N      (..., r)     how far the effectors get along u_i, summed over effectors
    M      (..., r)     how far the joints carry them for it, at most
    gamma  (..., r)     γ_i = min(1, N_i / M_i) γ_max, the bound on any joint along v_i [rad]
    """

    sigma: Array
    alpha: Array
    U: Array
    Vt: Array
    N: Array
    M: Array
    gamma: Array


def directions(J: Array, e: Array, *, max_angle: float = pi / 4) -> Directions:
    """The singular directions of J (..., 3k, n) with the error e (..., 3k) taken apart along them.

    M is infinite, and γ is 0, where σ is not above SDLS's smallest: those directions it leaves out.
    Source: thesis 4.4.5; Buss & Kim 2005.
    """
    U, sigma, Vt = np.linalg.svd(J, full_matrices=False)
    N = lengths(U).sum(axis=-2)
    moved = np.matvec(abs(Vt), lengths(J).sum(axis=-2))
    M = np.divide(moved, sigma, out=np.full_like(sigma, np.inf), where=sigma > SMALLEST)
    gamma = np.minimum(1, N / np.maximum(M, N)) * max_angle
    return Directions(sigma, np.vecmat(e, U), U, Vt, N, M, gamma)


def filtered(sigma: Array, damping: ArrayLike = 0.0) -> Array:
    """f_i = σ_i / (σ_i² + λ²) for σ (..., r), the factors of DLS [rad/m]; without damping 1 / σ_i.

    The largest that any σ can make of it is 1 / 2λ. Zero where σ and λ are.
    """
    size = np.square(sigma) + np.square(damping)
    return np.divide(sigma, size, out=np.zeros_like(size), where=size > 0)


def factors(J: Array, e: Array, dtheta: Array, *, least: float = 1e-9) -> Array:
    """f_i (..., r) [rad/m] of any step: Δθ = Σ f_i (u_iᵀe) v_i, for Δθ (..., n).

    The pseudoinverse has 1/σ_i, DLS σ_i / (σ_i² + λ²), the transpose α σ_i. Not a number where the
    error has no part along u_i, at most `least` of its length: there is nothing to answer.
    """
    U, _, Vt = np.linalg.svd(J, full_matrices=False)
    alpha = np.vecmat(e, U)
    asked = abs(alpha) > least * np.linalg.norm(e, axis=-1, keepdims=True)
    return np.divide(np.matvec(Vt, dtheta), alpha, out=np.full_like(alpha, np.nan), where=asked)
