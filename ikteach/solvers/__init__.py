"""The methods: functions of the Jacobian J and the error e, and of nothing else.

    solver(J (..., m, n), e (..., m), *, its own options) -> dtheta (..., n)

As optimisers of ½‖t − s(θ)‖² they have other names, under which a student meets them elsewhere:

    transpose       steepest descent, with the step that is best for the linear model
    pseudoinverse   Gauss–Newton, of all solutions the shortest, small σ cut off
    dls             Levenberg–Marquardt with a λ that stays, Tikhonov regularisation
    dls_following   Levenberg–Marquardt with a λ in proportion to the residual
    sdls            Gauss–Newton in singular directions, a trust region for each
    bvls            Levenberg–Marquardt in a box: a quadratic programme per step (active set)
    ccd             coordinate descent, each joint exactly (in `ikteach.motion.ccd`)

The last two are no part of `SOLVERS`, the four of the thesis; they are given as functions wherever
a method can be: `solve`, `track`, `Session`, `GaitPlayer({"ccd": ccd, "bvls": bvls})`, `Race`. They
know the limits themselves, so that no joint of theirs counts as held.

Options are bound with `functools.partial`. Weights, limits, caps and clamps are not in here: they
are the same for all methods and stand in `ikteach.motion.step`.
"""

from collections.abc import Callable

from ikteach.arrays import Array
from ikteach.names import unknown
from ikteach.solvers.bvls import bvls
from ikteach.solvers.cramer import adjugate, cramer, determinant, independence
from ikteach.solvers.dls import dls, dls_following
from ikteach.solvers.door import ask, name_of
from ikteach.solvers.pseudoinverse import pseudoinverse
from ikteach.solvers.sdls import sdls
from ikteach.solvers.singularity import Ellipsoid, conditioning, ellipsoid, manipulability
from ikteach.solvers.transpose import transpose

Solver = Callable[..., Array]


class Solvers(dict[str, Solver]):
    """Solvers by name.

    An unknown name is answered with the names that may have been meant.
    """

    def __missing__(self, name: str) -> Solver:
        raise LookupError(unknown("method", name, self))


SOLVERS = Solvers(transpose=transpose, pseudoinverse=pseudoinverse, dls=dls, sdls=sdls)


__all__ = [
    "SOLVERS",
    "Ellipsoid",
    "Solver",
    "Solvers",
    "adjugate",
    "ask",
    "bvls",
    "conditioning",
    "cramer",
    "determinant",
    "dls",
    "dls_following",
    "ellipsoid",
    "independence",
    "manipulability",
    "name_of",
    "pseudoinverse",
    "sdls",
    "transpose",
]
