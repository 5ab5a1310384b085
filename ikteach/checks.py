"""Refusals at the doors: one sentence each, with the culprit's name and the values allowed."""

from collections.abc import Callable
from math import isfinite
from numbers import Real
from typing import Any

import numpy as np

from ikteach.arrays import Array, ArrayLike, finite

FLOAT = np.dtype(float)
LONG = 80  # letters of a value that a sentence shows


def numbers(name: str, values: ArrayLike) -> Array:
    """Make an array of floats of real numbers.

    Whatever is made of real numbers is taken; ValueError names the values that are not.
    """
    if type(values) is np.ndarray and values.dtype is FLOAT:  # the common case costs nothing
        return values
    try:
        array = np.asarray(values)
        real = array.dtype.kind in "biuf" or (array.dtype.kind == "O" and _all_real(array))
        if real and not np.ma.is_masked(values):
            return array.astype(float, copy=False)
    except (TypeError, ValueError, OverflowError, RecursionError):  # of numpy: ragged, too large …
        pass
    raise ValueError(f"{name} must be made of numbers, not {shown(values)}")


def number(name: str, value: Any) -> float:
    """Make a float of one number, 0 or more.

    ValueError names the option that is none.
    """
    if type(value) is float and 0 <= value < np.inf:
        return value
    if not isinstance(value, bool | np.bool_):  # a switch is no number
        try:
            one = numbers(name, value)
        except ValueError:  # it has a sentence of its own
            one = np.zeros(0)
        if one.ndim == 0 and 0 <= one < np.inf:  # NaN is neither
            return float(one)
    one_of_many = "one number, " if np.ndim(value) else ""
    raise ValueError(f"{name} must be {one_of_many}0 or more, and finite, not {shown(value)}")


def count(name: str, value: Any, least: int = 1, most: float = np.inf) -> int:
    """Make an int of a whole number.

    3, 3.0 and np.int64(3) are whole numbers; ValueError names the option that is none.
    """
    is_number = isinstance(value, Real) and not isinstance(value, bool)
    if is_number and least <= value <= most and value % 1 == 0:  # of infinity that is NaN
        return int(value)
    allowed = f"{least} or more" if most == np.inf else f"from {least} to {most}"
    raise ValueError(f"{name} must be {allowed}, and whole, not {shown(value)}")


def function(name: str, value: Any) -> Callable[..., Any]:
    """Return a function; TypeError names any other value."""
    if not callable(value):
        raise TypeError(f"{name} must be a function, not {shown(value)}")
    return value


def system(J: Any, e: Any) -> tuple[Array, Array]:
    """Make arrays of floats of J (..., m, n) and e (..., m).

    ValueError says where they do not fit.
    """
    common = type(J) is type(e) is np.ndarray and J.dtype is e.dtype is FLOAT
    if (
        common
        and J.shape[:-1] == e.shape != ()
        and isfinite(np.vdot(J, J))
        and isfinite(np.vdot(e, e))
    ):
        return J, e
    J, e = matrix(J), numbers("e", e)
    if e.shape[-1:] != J.shape[-2:-1]:
        m = J.shape[-2]
        raise ValueError(f"a J of {m} rows needs e of shape (..., {m}), not {e.shape}")
    common_batch("J and e", J.shape[:-2], e.shape[:-1])
    if not finite(e):
        raise ValueError("e is not finite")
    return J, e


def matrix(J: ArrayLike) -> Array:
    """Make an array of floats of J (..., m, n) alone."""
    J = numbers("J", J)
    if J.ndim < 2 or not J.shape[-1] or not J.shape[-2]:
        raise ValueError(f"J needs rows and columns, (..., m, n), not the shape {J.shape}")
    if not finite(J):
        raise ValueError("J is not finite")
    return J


def common_batch(what: str, *batches: tuple[int, ...]) -> tuple[int, ...]:
    """Return the batch that all of these fit into.

    ValueError gives the batches that do not fit together.
    """
    sizes = set(batches) - {()}
    if len(sizes) <= 1:  # the common case
        return sizes.pop() if sizes else ()
    try:
        return np.broadcast_shapes(*batches)
    except ValueError:
        each = " and ".join(map(str, dict.fromkeys(batches)))
        raise ValueError(f"the batches of {what} do not fit together: {each}") from None


def shown(value: object) -> str:
    """Show a value as a sentence has it.

    It is on one line and has at most `LONG` letters.
    """
    try:
        text = " ".join(repr(value).split())
    except Exception:  # a stranger's __repr__ may raise anything
        text = f"a {type(value).__name__}"
    return text if len(text) <= LONG else f"{text[: LONG - 20]} … {text[-15:]}"


def _all_real(array: Any) -> bool:
    return all(isinstance(value, Real) for value in array.flat)
