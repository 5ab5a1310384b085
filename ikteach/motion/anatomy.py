"""One tick taken apart, from the error to the movement that came of it."""

from typing import Any, NamedTuple

import numpy as np

from ikteach.arrays import Array, ArrayLike, Mask
from ikteach.body import Effectors, Tree, forward, locate
from ikteach.motion.checks import solver_of
from ikteach.motion.methods import Methods, methods_of
from ikteach.motion.step import step
from ikteach.solvers import SOLVERS, Solver, name_of
from ikteach.solvers.response import directions, response


class Anatomy(NamedTuple):
    """One tick, taken apart from error to movement.

    n joints, k effectors, r = min(3k, n).

    method     the solver's name
    e          (3k,)      the error, shortened by max_error and weighed, as the solver gets it [m]
    J          (3k, n)    as it gets it: each column times its joint's mobility, each row weighed
    mobility   (n,)       s, so that wanted = s ∘ Σ f_i α_i v_i
    U          (3k, r)    its singular directions, as in `solvers.response.Directions`
    sigma      (r,)       singular values [m/rad]
    Vt         (r, n)
    alpha      (r,)       the error along each direction [m]
    responses  {name: (r,)}  f of each of `methods` [rad/m]; the solver's own among them
    wanted     (n,)       Δθ that the solver asks for [rad]
    capped     (n,)       after the cap [rad]
    dtheta     (n,)       after the limits, as it was done [rad]
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
        """σ f of each method, (r,).

        It is the share of each direction's error that the method takes away.
        """
        return {name: self.sigma * f for name, f in self.responses.items()}


def anatomy(
    tree: Tree,
    theta: ArrayLike,
    effectors: Effectors,
    targets: ArrayLike,
    solver: Solver | str,
    *,
    methods: Methods = SOLVERS,
    **options: Any,
) -> Anatomy:
    """Take one step of `solver` apart, from one pose θ (n,) and targets (k, 3) [m].

    methods  whose responses are shown beside it; if one of them has the solver's name and is
             another, the solver is called "name, here"
    options  as in `step`, whose errors these are
    """
    done = step(tree, theta, effectors, targets, solver, **options)
    if done.theta.ndim != 1:
        raise ValueError(f"one pose is taken apart at a time, not {done.theta.shape[:-1]} of them")
    w = np.repeat(done.weights, 3)
    J, e = w[:, None] * done.J * done.mobility, w * done.aim
    chosen, function = methods_of(methods), solver_of(solver)
    name = next((name for name, one in chosen.items() if one is function), name_of(function))
    if chosen.get(name, function) is not function:
        name += ", here"
    chosen[name] = function
    before = locate(forward(tree, theta), effectors)
    d = directions(J, e)
    return Anatomy(
        name,
        e,
        J,
        done.mobility,
        d.U,
        d.sigma,
        d.Vt,
        d.alpha,
        {name: response(one, J, e) for name, one in chosen.items()},
        done.wanted,
        done.allowed,
        done.dtheta,
        done.held,
        predicted=(done.J @ done.dtheta).reshape(-1, 3),
        actual=locate(forward(tree, done.theta), effectors) - before,
        theta=done.theta,
    )
