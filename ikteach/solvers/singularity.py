"""Chapter 2. Singularity: which ways the effectors can move, and which they cannot."""

from typing import NamedTuple

import numpy as np

from ikteach.arrays import Array


class Ellipsoid(NamedTuple):
    """Where the effector goes for all joint steps with ‖Δθ‖ = 1.

    directions  (..., m, m)  its axes, unit vectors in columns, longest first
    lengths     (..., m)     half their lengths [m/rad]; 0 the way that no joint can move
    """

    directions: Array
    lengths: Array


def ellipsoid(J: Array) -> Ellipsoid:
    """The manipulability ellipsoid {JΔθ : ‖Δθ‖ = 1} of J (..., m, n) (Yoshikawa 1985)."""
    U, sigma, _ = np.linalg.svd(J)
    lengths = np.zeros(U.shape[:-1])
    lengths[..., : sigma.shape[-1]] = sigma
    return Ellipsoid(U, lengths)


def manipulability(J: Array) -> Array:
    """√det(JJᵀ) = σ_1 σ_2 … σ_m of J (..., m, n): the volume of the ellipsoid up to a constant.

    It is 0 at a singular pose. Near 0 is no test for nearly singular: its size depends on the
    units and on the body; use `conditioning` or the smallest σ.
    """
    return ellipsoid(J).lengths.prod(axis=-1)


def conditioning(J: Array) -> Array:
    """σ_max / σ_min of J (..., m, n): 1 where every way is as easy, infinite where one is lost."""
    sigma = np.linalg.svdvals(J)
    strongest, weakest = sigma[..., 0], sigma[..., -1]
    infinite = np.full_like(strongest, np.inf)
    return np.divide(strongest, weakest, out=infinite, where=weakest > 0)
