"""Chapter 6. One singular direction at a time: the answer of each method along it.

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
from ikteach.checks import number, numbers, system
from ikteach.solvers.dls import dls, filtered
from ikteach.solvers.door import FORMULAS, ask
from ikteach.solvers.pseudoinverse import pseudoinverse, pseudoinverse_response
from ikteach.solvers.sdls import SMALLEST, bounds, sdls, sdls_response, three_rows
from ikteach.solvers.stacked import strong
from ikteach.solvers.transpose import transpose, transpose_response


class Directions(NamedTuple):
    """The singular directions of J, strongest first.

    SDLS knows N, M and gamma of each.

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
    """Return the singular directions of J (..., 3k, n), and e (..., 3k) along them.

    M is infinite, and γ is 0, where σ is not above SDLS's smallest: those directions it leaves out.
    ValueError as in `sdls`. Source: thesis 4.4.5; Buss & Kim 2005.
    """
    (J, e), max_angle = system(J, e), number("max_angle", max_angle)
    three_rows(J)
    U, sigma, Vt = np.linalg.svd(J, full_matrices=False)
    sign = np.where(np.vecmat(e, U) < 0, -1.0, 1.0)
    U, Vt = U * sign[..., None, :], Vt * sign[..., None]
    used = np.isfinite(strong(sigma, SMALLEST))
    N, M, gamma = bounds(J, U, np.where(used, sigma, 1), Vt, max_angle)
    alpha = np.vecmat(e, U)
    return Directions(sigma, alpha, U, Vt, N, np.where(used, M, np.inf), np.where(used, gamma, 0))


def factors(J: ArrayLike, e: ArrayLike, dtheta: ArrayLike, *, least: float = 1e-9) -> Array:
    """Return f_i (..., r) [rad/m] of any step: Δθ = Σ f_i (u_iᵀe) v_i, for Δθ (..., n).

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
    """Return f (r,) [rad/m] of a method, for each singular direction of J and this e.

    By the formula for the four methods, also with options bound by `partial`; for any other by
    `factors` of its answer, and 0 where the error has no part.
    """
    J, e = system(J, e)
    plain, options = (solver.func, solver.keywords) if isinstance(solver, partial) else (solver, {})
    if plain not in RESPONSES or (isinstance(solver, partial) and solver.args):
        return np.nan_to_num(factors(J, e, ask(solver, J, e), least=1e-12))
    formula = FORMULAS[plain]
    options = {**(formula.apply.__kwdefaults__ or {}), **formula.check({**options}, J, e)}
    d = directions(J, e, max_angle=options.get("max_angle", pi / 4))
    return RESPONSES[plain](d, **options)


RESPONSES: Mapping[Any, Callable[..., Array]] = {
    transpose: lambda d, **options: transpose_response(d.sigma, d.alpha, **options),
    pseudoinverse: lambda d, **options: pseudoinverse_response(d.sigma, **options),
    dls: lambda d, **options: filtered(d.sigma, **options),
    sdls: lambda d, **options: sdls_response(d.sigma, d.alpha, d.Vt, d.gamma, **options),
}
