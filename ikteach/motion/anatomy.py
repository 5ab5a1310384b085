"""One tick taken apart: what each singular direction of J becomes in each method.

With J = U Σ Vᵀ and α_i = u_iᵀe, every one of the four methods is

    Δθ = Σ_i  f_i α_i v_i

and they differ in the response f_i [rad/m] to the share of the error along u_i alone. σ_i f_i is
the share of α_i that JΔθ takes away: 1 is all of it. It is the filter factor of the method.
"""

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from ikteach.arrays import Array, ArrayLike, Mask
from ikteach.body import Effectors, Tree, forward, locate
from ikteach.motion.step import clamp_error, solver_of, step, whole
from ikteach.solvers import SOLVERS, Solver, dls, name_of, pseudoinverse, sdls, transpose
from ikteach.solvers.dls import TINY
from ikteach.solvers.sdls import SMALLEST, hard, lengths


class Directions(NamedTuple):
    """J = U diag(σ) Vᵀ, and how much of the error lies along each direction; r = min(3k, n).

    U      (3k, r)  directions of the error, in columns
    sigma  (r,)     singular values, largest first [m/rad]
    Vt     (r, n)   turns of the joints, in rows
    alpha  (r,)     Uᵀe, the error along each direction [m]
    """

    U: Array
    sigma: Array
    Vt: Array
    alpha: Array

    @classmethod
    def of(cls, J: Array, e: Array) -> "Directions":
        """The singular directions of J (3k, n) and the error e (3k,) along them."""
        U, sigma, Vt = np.linalg.svd(J, full_matrices=False)
        return cls(U, sigma, Vt, e @ U)


def respond_transpose(d: Directions, *, gain: float = 1.0) -> Array:
    """f_i = gain · a σ_i, with a = Σ σ²α² / Σ σ⁴α²: the strong directions first."""
    s = d.sigma / max(d.sigma[0], 1e-300)  # the lengths are taken in units of σ_max
    pull = (s * d.alpha) ** 2
    down = float(np.sum(pull * s**2))
    a = float(np.sum(pull)) / down if down > 0 else 0.0
    return gain * a * s / max(d.sigma[0], 1e-300)


def respond_pseudoinverse(d: Directions, *, cutoff: float = 0.01) -> Array:
    """f_i = 1/σ_i, and 0 for the directions weaker than cutoff · σ_max."""
    kept = d.sigma > max(1e-150, d.sigma[0] * max(cutoff, np.finfo(float).eps))
    return np.where(kept, 1 / np.where(kept, d.sigma, 1), 0)


def respond_dls(d: Directions, *, damping: float = 0.1) -> Array:
    """f_i = σ_i / (σ_i² + λ²). A λ that is lost in rounding is left to `dls` to raise."""
    return d.sigma / (d.sigma**2 + damping**2 + TINY)


def respond_sdls(
    d: Directions, *, max_angle: float = np.pi / 4, clamp: Callable[..., Array] = hard
) -> Array:
    """f_i = c c_i / σ_i, where c_i shortens φ_i to its own bound γ_i, and c all of Δθ to γ_max."""
    kept = d.sigma > SMALLEST
    sigma, alpha = np.where(kept, d.sigma, 1), np.where(kept, d.alpha, 0)
    N = lengths(d.U).sum(axis=-2)
    M = abs(d.Vt) @ lengths((d.U * d.sigma) @ d.Vt).sum(axis=-2) / sigma
    gamma = N / np.maximum(M, N) * max_angle
    phi = (alpha / sigma)[:, None] * d.Vt
    shares = _share(clamp(phi, gamma), phi)
    dtheta = shares @ phi
    over = abs(dtheta).max() > max_angle
    c = _share(clamp(dtheta[None], max_angle), dtheta[None])[0] if over else 1.0
    return np.where(kept, c * shares / sigma, 0)


def _share(after: Array, before: Array) -> Array:
    """By how much each row was shortened, 0..1; 1 where it is zero."""
    size = abs(before).max(axis=-1)
    return np.divide(abs(after).max(axis=-1), size, out=np.ones_like(size), where=size > 0)


RESPONSES: Mapping[Solver, Callable[..., Array]] = {
    transpose: respond_transpose,
    pseudoinverse: respond_pseudoinverse,
    dls: respond_dls,
    sdls: respond_sdls,
}


def response(solver: Solver | str, J: Array, e: Array) -> Array:
    """f (r,) [rad/m] of a method: what it makes of each singular direction of J for this e.

    By the formula for the four methods, also with options bound by `partial`; for any other it is
    found from its answer, f_i = v_iᵀΔθ / α_i, and 0 where α_i is.
    """
    function, d = solver_of(solver), Directions.of(J, e)
    plain, options = (
        (function.func, function.keywords) if isinstance(function, partial) else (function, {})
    )
    if plain in RESPONSES and not getattr(function, "args", ()):
        return RESPONSES[plain](d, **options)
    along = d.Vt @ function(J, e)
    return np.divide(along, d.alpha, out=np.zeros_like(along), where=abs(d.alpha) > 1e-12)


class Anatomy(NamedTuple):
    """Everything about one tick, from error to movement. n joints, k effectors, r = min(3k, n).

    method     the solver's name
    e          (3k,)      the error, shortened by max_error if there is one [m]
    J          (3k, n)    what the solver is given: each column times its joint's mobility [m/rad]
    mobility   (n,)       s, so that wanted = s ∘ Σ f_i α_i v_i
    U          (3k, r)    its singular directions, as in `Directions`
    sigma      (r,)       singular values [m/rad]
    Vt         (r, n)
    alpha      (r,)       the error along each direction [m]
    responses  {name: (r,)}  f of each of `methods` [rad/m]; the solver's own among them
    wanted     (n,)       Δθ that the solver asks for [rad]
    capped     (n,)       after the cap [rad]
    dtheta     (n,)       after the limits: what was done [rad]
    held       (n,)       True where a limit stopped the joint
    predicted  (k, 3)     JΔθ, how far the effectors were to move [m]
    actual     (k, 3)     how far they did move [m]
    theta      (n,)       the new pose [rad]
    """

    method: str
    e: Array
    J: Array
    mobility: Array
    U: Array
    sigma: Array
    Vt: Array
    alpha: Array
    responses: dict[str, Array]
    wanted: Array
    capped: Array
    dtheta: Array
    held: Mask
    predicted: Array
    actual: Array
    theta: Array

    @property
    def filters(self) -> dict[str, Array]:
        """σ f of each method (r,): the share of each direction's error that it takes away."""
        return {name: self.sigma * f for name, f in self.responses.items()}


def anatomy(
    tree: Tree, theta: ArrayLike, effectors: Effectors, targets: ArrayLike, solver: Solver | str,
    *, methods: Mapping[str, Solver] = SOLVERS, **options: Any,
) -> Anatomy:  # fmt: skip
    """Take one step of `solver` apart, from one pose θ (n,) and targets (k, 3) [m].

    methods  whose responses are shown beside it
    options  as in `step`, whose errors these are
    """
    done = step(tree, theta, effectors, targets, solver, **options)
    if done.theta.ndim != 1:
        raise ValueError(f"one pose is taken apart at a time, not {done.theta.shape[:-1]} of them")
    given = {"mobility": None, "max_error": None, "max_step": None, "cap": whole} | options
    free = tree.mobility if given["mobility"] is None else np.asarray(given["mobility"], float)
    J, e, capped = done.J * free, done.e, done.wanted
    if given["max_error"] is not None:
        e = clamp_error(e.reshape(-1, 3), given["max_error"]).ravel()
    if given["max_step"] is not None:
        capped = given["cap"](done.wanted, given["max_step"], effectors.chains)
    chosen, function = dict(methods), solver_of(solver)
    name = next((name for name, one in chosen.items() if one is function), name_of(function))
    chosen[name] = function
    before = locate(forward(tree, theta), effectors)
    return Anatomy(
        name, e, J, free, *Directions.of(J, e),
        {name: response(one, J, e) for name, one in chosen.items()},
        done.wanted, capped, done.dtheta, done.held,
        predicted=(done.J @ done.dtheta).reshape(-1, 3),
        actual=locate(forward(tree, done.theta), effectors) - before,
        theta=done.theta,
    )  # fmt: skip
