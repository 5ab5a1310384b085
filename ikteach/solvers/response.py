"""Chapter 6. One singular direction at a time: what each method makes of what it is asked.

With J = U Σ Vᵀ and α_i = u_iᵀe, every one of the four methods is

    Δθ = Σ_i  f_i α_i v_i

and they differ in the response f_i [rad/m] alone. σ_i f_i is the share of α_i that JΔθ takes away:
1 is all of it. It is the filter factor of the method.
"""

from collections.abc import Callable, Mapping
from functools import partial
from math import pi
from typing import Any, NamedTuple

import numpy as np

from ikteach.arrays import Array, ArrayLike
from ikteach.checks import function, number, numbers, system
from ikteach.solvers.ask import ask
from ikteach.solvers.dls import dls
from ikteach.solvers.pseudoinverse import pseudoinverse
from ikteach.solvers.sdls import Clamp, bounds, hard, kept, sdls, three_rows
from ikteach.solvers.transpose import transpose


class Directions(NamedTuple):
    """The singular directions of J, strongest first, and what SDLS knows of each.

    sigma  (..., r)     σ_i [m/rad]
    alpha  (..., r)     α_i = u_iᵀe, the error along u_i [m]; the signs of u_i and v_i, which are
                        free together, are those that make it 0 or more
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


def directions(J: ArrayLike, e: ArrayLike, *, max_angle: float = pi / 4) -> Directions:
    """The singular directions of J (..., 3k, n) with the error e (..., 3k) taken apart along them.

    M is infinite, and γ is 0, where σ is not above SDLS's smallest: those directions it leaves out.
    ValueError as in `sdls`. Source: thesis 4.4.5; Buss & Kim 2005.
    """
    (J, e), max_angle = system(J, e), number("max_angle", max_angle)
    three_rows(J)
    U, sigma, Vt = np.linalg.svd(J, full_matrices=False)
    sign = np.where(np.vecmat(e, U) < 0, -1.0, 1.0)
    U, Vt = U * sign[..., None, :], Vt * sign[..., None]
    used = kept(sigma)
    N, M, gamma = bounds(J, U, np.where(used, sigma, 1), Vt, max_angle)
    alpha = np.vecmat(e, U)
    return Directions(sigma, alpha, U, Vt, N, np.where(used, M, np.inf), np.where(used, gamma, 0))


def filtered(sigma: ArrayLike, damping: ArrayLike = 0.0) -> Array:
    """f_i = σ_i / (σ_i² + λ²) for σ (..., r), the factors of DLS [rad/m]; without damping 1 / σ_i.

    The largest that any σ can make of it is 1 / 2λ. Zero where σ and λ are.
    """
    sigma, damping = numbers("sigma", sigma), numbers("damping", damping)
    size = np.square(sigma) + np.square(damping)
    return np.divide(sigma, size, out=np.zeros_like(size), where=size > 0)


def factors(J: ArrayLike, e: ArrayLike, dtheta: ArrayLike, *, least: float = 1e-9) -> Array:
    """f_i (..., r) [rad/m] of any step: Δθ = Σ f_i (u_iᵀe) v_i, for Δθ (..., n).

    The pseudoinverse has 1/σ_i, DLS σ_i / (σ_i² + λ²), the transpose α σ_i. Not a number where the
    error has no part along u_i, at most `least` of its length: there is nothing to answer.
    """
    (J, e), dtheta, least = system(J, e), numbers("dtheta", dtheta), number("least", least)
    if dtheta.shape[-1:] != J.shape[-1:]:
        n = J.shape[-1]
        raise ValueError(f"a J of {n} columns needs dtheta of shape (..., {n}), not {dtheta.shape}")
    U, _, Vt = np.linalg.svd(J, full_matrices=False)
    alpha = np.vecmat(e, U)
    asked = abs(alpha) > least * np.linalg.norm(e, axis=-1, keepdims=True)
    return np.divide(np.matvec(Vt, dtheta), alpha, out=np.full_like(alpha, np.nan), where=asked)


def response(solver: Callable[..., Array], J: ArrayLike, e: ArrayLike) -> Array:
    """f (r,) [rad/m] of a method: what it makes of each singular direction of J for this e.

    By the formula for the four methods, also with options bound by `partial`; for any other by
    `factors` of its answer, and 0 where the error has no part.
    """
    J, e = system(J, e)
    plain, options = (solver.func, solver.keywords) if isinstance(solver, partial) else (solver, {})
    if plain in RESPONSES and not getattr(solver, "args", ()):
        return RESPONSES[plain](J, e, **options)
    return np.nan_to_num(factors(J, e, ask(solver, J, e), least=1e-12))


def of_transpose(J: Array, e: Array, *, gain: float = 1.0) -> Array:
    """f_i = gain · a σ_i, with a = Σ σ²α² / Σ σ⁴α²: the strong directions first."""
    d = directions(J, e)
    s = d.sigma / max(d.sigma[0], 1e-300)  # the lengths are taken in units of σ_max
    pull = (s * d.alpha) ** 2
    down = float(np.sum(pull * s**2))
    a = float(np.sum(pull)) / down if down > 0 else 0.0
    return number("gain", gain) * a * s / max(d.sigma[0], 1e-300)


def of_pseudoinverse(J: Array, e: Array, *, cutoff: float = 0.01) -> Array:
    """f_i = 1/σ_i, and 0 for the directions weaker than cutoff · σ_max."""
    sigma = directions(J, e).sigma
    strong = sigma > max(1e-150, sigma[0] * max(number("cutoff", cutoff), np.finfo(float).eps))
    return filtered(np.where(strong, sigma, 0))


def of_dls(J: Array, e: Array, *, damping: float = 0.1) -> Array:
    """f_i = σ_i / (σ_i² + λ²). A λ that is lost in rounding is left to `dls` to raise."""
    return filtered(directions(J, e).sigma, number("damping", damping))


def of_sdls(J: Array, e: Array, *, max_angle: float = pi / 4, clamp: Clamp = hard) -> Array:
    """f_i = c c_i / σ_i, where c_i shortens φ_i to its own bound γ_i, and c all of Δθ to γ_max."""
    d = directions(J, e, max_angle=max_angle)
    function("clamp", clamp)
    inverse = filtered(np.where(kept(d.sigma), d.sigma, 0))
    phi = (inverse * d.alpha)[:, None] * d.Vt
    shares = _share(clamp(phi, d.gamma), phi)
    dtheta = shares @ phi
    over = abs(dtheta).max() > max_angle
    c = _share(clamp(dtheta[None], max_angle), dtheta[None])[0] if over else 1.0
    return c * shares * inverse


def _share(after: Array, before: Array) -> Array:
    """By how much each row was shortened, 0..1; 1 where it is zero."""
    size = abs(before).max(axis=-1)
    return np.divide(abs(after).max(axis=-1), size, out=np.ones_like(size), where=size > 0)


RESPONSES: Mapping[Any, Callable[..., Array]] = {
    transpose: of_transpose,
    pseudoinverse: of_pseudoinverse,
    dls: of_dls,
    sdls: of_sdls,
}
