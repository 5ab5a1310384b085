"""The two doors of a solver: its question and its answer are checked, whoever wrote it."""

from collections.abc import Callable, Mapping
from functools import partial, wraps
from types import FunctionType
from typing import Any, Concatenate, NamedTuple, ParamSpec, cast

import numpy as np

from ikteach.arrays import Array, ArrayLike, finite
from ikteach.checks import FLOAT, LONG, common_batch, number, numbers, shown, system

HUGE = 1e150  # its square is still finite

Check = Callable[[str, Any], Any]
P = ParamSpec("P")


class Formula(NamedTuple):
    """A solver's formula and the checks of its options.

    `apply` gets a J, an e and options that have been checked.
    """

    apply: Callable[..., Array]
    checks: Mapping[str, Check]

    def check(self, options: dict[str, Any], J: Array, e: Array) -> dict[str, Any]:
        """Check options, in place.

        ValueError or TypeError names the one that cannot be.
        """
        for name, check in self.checks.items():
            if name in options:
                value = options[name] = check(name, options[name])
                if type(value) is np.ndarray:
                    common_batch(f"J, e and {name}", J.shape[:-2], e.shape[:-1], value.shape)
        return options


FORMULAS: dict[Any, Formula] = {}  # of our own solvers


def solver(
    **checks: Check,
) -> Callable[
    [Callable[Concatenate[Array, Array, P], Array]],
    Callable[Concatenate[ArrayLike, ArrayLike, P], Array],
]:
    """Make a solver of a formula.

    J, e and the options named here are checked first.

    A check is a function of an option's name and value; it gives the value for the formula.
    `step`, which has checked J and e already, goes to the formula directly (`ask`).
    """

    def made(
        formula: Callable[Concatenate[Array, Array, P], Array],
    ) -> Callable[Concatenate[ArrayLike, ArrayLike, P], Array]:
        @wraps(formula)
        def checked(J: ArrayLike, e: ArrayLike, *args: P.args, **given: P.kwargs) -> Array:
            J, e = system(J, e)
            if given:
                own.check(given, J, e)
            return formula(J, e, *args, **given)

        own = FORMULAS[checked] = Formula(formula, checks)
        return cast(Callable[Concatenate[ArrayLike, ArrayLike, P], Array], checked)

    return made


def unchecked(solver: Any) -> Callable[..., Array]:
    """Get the formula of one of our own solvers."""
    return FORMULAS[solver].apply


def per_pose(name: str, value: ArrayLike) -> Any:
    """Check one number, or one per pose.

    Each is 0 or more, and its square is finite; one per pose is (...).
    """
    if type(value) is float and 0 <= value < HUGE:
        return value
    if np.ndim(value) == 0:
        one = number(name, value)
        if one < HUGE:
            return one
    else:
        each = numbers(name, value)
        if ((each >= 0) & (each < HUGE)).all():  # NaN fits nowhere
            return each
    raise ValueError(f"{name} must be 0 or more, and finite, not {shown(value)}")


def takes_stacks(solver: Any) -> bool:
    """Tell whether a solver surely takes stacks (..., m, n): our own do."""
    while isinstance(solver, partial):
        solver = solver.func
    return type(solver) is FunctionType and (solver in FORMULAS or hasattr(solver, "wants"))


def ask(solver: Any, J: Array, e: Array) -> Array:
    """Ask a solver for Δθ (..., n).

    It is given J (..., m, n) and e (..., m), to which it cannot write. A list, or whole numbers, of
    the right shape are an answer too. ValueError says which answer came and which is wanted,
    FloatingPointError that a number is not finite; both name the solver. An error of the solver's
    own stays what it is, with a note of where it came from.
    """
    if (formula := _ours(solver, J, e)) is not None:
        try:
            answer = formula(J, e)
            if finite(answer):
                return answer
        except ValueError:  # of numpy, about J; the solver's own checks say it in a sentence
            pass
    return _asked(solver, sealed(J), sealed(e))


def _ours(solver: Any, J: Array, e: Array) -> Callable[[Array, Array], Array] | None:
    """Find the formula of one of our own solvers, with its options if there are any; else None."""
    if type(solver) is FunctionType:
        own = FORMULAS.get(solver)
        return own and own.apply
    if type(solver) is partial and type(solver.func) is FunctionType and not solver.args:
        own = FORMULAS.get(solver.func)
        try:
            return own and partial(own.apply, **own.check({**solver.keywords}, J, e))
        except (TypeError, ValueError):  # the long way says whose option it is
            return None
    return None


def _asked(solver: Any, J: Array, e: Array) -> Array:
    """Find the answer of any solver, once it has been looked at from all sides."""
    try:
        answer = solver(J, e)
    except Exception as error:
        if isinstance(error, ValueError) and str(error).endswith("is read-only"):  # numpy's words
            error.args = (
                f"{name_of(solver)} writes into the J or e that it is given, which are not its own;"
                " let it make new arrays: e = 0.1 * e in place of e *= 0.1, or e = e.copy() first",
            )
        else:
            error.add_note(f"It was raised in the solver {name_of(solver)}.")
        raise
    shape = e.shape[:-1] + J.shape[-1:]
    if J.shape[:-1] != e.shape:
        shape = (*np.broadcast_shapes(J.shape[:-2], e.shape[:-1]), J.shape[-1])
    if not (type(answer) is np.ndarray and answer.dtype is FLOAT and answer.shape == shape):
        answer = _converted(name_of(solver), answer, shape)
    if not finite(answer):
        raise FloatingPointError(f"{name_of(solver)} gave a step that is not finite")
    return answer


def sealed(array: Array) -> Array:
    """Return the array, or a copy, sealed against writing.

    It is a copy only where somebody could write to the array.
    """
    if array.flags.writeable:
        array = array.copy()
        array.setflags(write=False)
    return array


def name_of(solver: Any) -> str:
    """Return the name of a solver.

    It may have its options bound; if it has no name, it is called by its class.
    """
    while isinstance(solver, partial):
        solver = solver.func
    try:
        name = solver.__name__
    except Exception:  # a stranger's attribute may raise anything
        name = None
    return name[:LONG] if isinstance(name, str) and name else type(solver).__name__[:LONG]


def _converted(name: str, answer: Any, shape: tuple[int, ...]) -> Array:
    """Find the answer as an array of floats of this shape; ValueError if it is none."""
    wanted = f"wanted is Δθ, one number per joint: an array of shape {shape}"
    if answer is None:
        raise ValueError(f"{name} gave back nothing (has it a return?); {wanted}")
    try:
        dtheta = numbers("a step", answer)
    except ValueError:
        raise ValueError(f"{name} gave back {shown(answer)}; {wanted}") from None
    if dtheta.shape == shape:
        return dtheta
    if not dtheta.ndim:
        raise ValueError(f"{name} gave back one number, {shown(answer)}; {wanted}")
    hint = "; of a column c, c[..., 0] has it" if dtheta.shape == (*shape, 1) else ""
    raise ValueError(f"{name} gave back an array of shape {dtheta.shape}; {wanted}{hint}")
