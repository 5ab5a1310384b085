"""The one door for what a solver gives back, whoever wrote it."""

from functools import partial
from typing import Any

import numpy as np

from ikteach.arrays import Array, finite
from ikteach.checks import FLOAT, LONG, numbers, shown


def ask(solver: Any, J: Array, e: Array) -> Array:
    """Ask a solver for Δθ (..., n), given copies of J (..., m, n) and e (..., m) to read only.

    A list, or whole numbers, of the right shape are an answer too. ValueError says what came
    instead and what is wanted, FloatingPointError that a number is not finite; both name the
    solver. An error of the solver's own stays what it is, with a note of where it came from.
    """
    J, e = J.copy(), e.copy()
    J.flags.writeable = e.flags.writeable = False
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
    shape = (*J.shape[:-2], J.shape[-1])
    if J.ndim != e.ndim + 1 or J.shape[:-2] != e.shape[:-1]:
        shape = (*np.broadcast_shapes(J.shape[:-2], e.shape[:-1]), J.shape[-1])
    if not (type(answer) is np.ndarray and answer.dtype is FLOAT and answer.shape == shape):
        answer = _converted(name_of(solver), answer, shape)
    if not finite(answer):
        raise FloatingPointError(f"{name_of(solver)} gave a step that is not finite")
    return answer


def name_of(solver: Any) -> str:
    """The name of a solver, also of one with its options bound; else that of its class."""
    while isinstance(solver, partial):
        solver = solver.func
    try:
        name = solver.__name__
    except Exception:  # a stranger's attribute may raise anything
        name = None
    return name[:LONG] if isinstance(name, str) and name else type(solver).__name__[:LONG]


def _converted(name: str, answer: Any, shape: tuple[int, ...]) -> Array:
    """The answer as an array of floats of this shape; ValueError if it is none."""
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
