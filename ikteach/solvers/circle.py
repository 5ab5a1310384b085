"""Chapter 2. The circle of all steps of one length, and the ellipse that J makes of it."""

from typing import NamedTuple

import numpy as np

from ikteach.arrays import Array, ArrayLike
from ikteach.checks import matrix, numbers


class Image(NamedTuple):
    """What J (2, 2) makes of the circle ‖Δθ‖ = 1, with J = Σ σ_i u_i v_iᵀ.

    circle   (g, 2)  Δθ all round [rad]
    ellipse  (g, 2)  JΔθ of each [m]
    V        (2, 2)  v_i in rows; the sign is such that v₁ points right and v₂ up
    sigma    (2,)    σ_i [m/rad]
    U        (2, 2)  u_i in rows, unit vectors
    """

    circle: Array
    ellipse: Array
    V: Array
    sigma: Array
    U: Array


def image(J: ArrayLike, points: int = 73) -> Image:
    """Map the circle of unit steps by J (2, 2).

    The signs of u_i and v_i are free together; they are chosen so that no small change of J turns
    an arrow round, but where it passes the axis. ValueError for any other shape.
    """
    J = matrix(J)
    if J.shape != (2, 2):
        raise ValueError(f"a plane to a plane is J of shape (2, 2), not {J.shape}")
    angle = np.linspace(0, 2 * np.pi, points)
    circle = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    U, sigma, Vt = np.linalg.svd(J)
    sign = np.where(np.diag(Vt) < 0, -1.0, 1.0)
    return Image(circle, circle @ J.T, Vt * sign[:, None], sigma, U.T * sign[:, None])


def along(image: Image, dtheta: ArrayLike) -> Array:
    """Split Δθ (2,) along the v_i: (2,) [rad]; JΔθ is Σ a_i σ_i u_i."""
    return np.matvec(image.V, numbers("dtheta", dtheta))
