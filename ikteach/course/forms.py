"""The one door for what an answer gives: each right form of it becomes one form.

Three numbers may come as a list, a column, a generator or a Series, in float32 or as fractions; a
name as a text or as the function of that name. A checker sees an array or a text; what fits no
form is a WrongError with a sentence.
"""

import inspect
from collections.abc import Callable, Iterator, Mapping, Sequence
from decimal import Decimal
from itertools import islice
from numbers import Real
from typing import Any, NamedTuple

import numpy as np

from ikteach.arrays import Array
from ikteach.files import bounded

AnswerShape = tuple[int, ...]
MOST_ITEMS = 100_000  # of an iterator
DIGITS = range(3, 18)  # that numbers in a sentence may have


class WrongError(Exception):
    """A wrong answer; the message says how, in one sentence."""


class NotYetError(Exception):
    """No answer yet; the message may say more."""


class Form(NamedTuple):
    """A form that is no array.

    wanted  in words, for "where … is wanted"
    read    gives the value in that form; TypeError if it has none
    """

    wanted: str
    read: Callable[[Any], Any]


def _truth(value: Any) -> bool:
    if isinstance(value, str) or np.size(value) != 1 or np.asarray(value).item() not in (0, 1):
        raise TypeError
    return bool(np.asarray(value).item())


def _name(value: Any) -> str:
    if isinstance(value, np.ndarray) and value.size == 1:
        value = value.item()
    text = value if isinstance(value, str) else value.__name__  # a function has one
    if not isinstance(text, str):
        raise TypeError
    return str.strip(text)  # of a text, whatever class it has


def _items(value: Any) -> list[Any]:
    if isinstance(value, str | bytes | Mapping | set | frozenset) or hasattr(value, "columns"):
        raise TypeError
    return list(islice(value, MOST_ITEMS))


TRUTH = Form("True or False", _truth)
NAME = Form("a name", _name)
NAMES = Form("a list of names", lambda value: [_name(one) for one in _items(value)])


def parts(*names: str) -> Form:
    """Want a sequence of so many things, such as a pair."""

    def read(value: Any) -> list[Any]:
        items = _items(value)
        if len(items) != len(names):
            raise TypeError
        return items

    return Form(f"{', '.join(names[:-1])} and {names[-1]} (in one list or tuple)", read)


def of_form(value: Any, wanted: AnswerShape | Form | None, said: str) -> Any:
    """Give the value back in the wanted form.

    As a finite float array where that is a shape; WrongError if it cannot be. `said` begins the
    sentence: "`f(x)` returned".
    """
    value = listed(value)
    if wanted is None:
        return value
    if isinstance(wanted, Form):
        try:
            return wanted.read(value)
        except Exception:  # whatever an object of the student's raises
            found = in_brief(value) if _plain(value) else kind(value)
            raise WrongError(f"{said} {found}, where {wanted.wanted} is wanted.") from None
    return _numbers(value, wanted, said)


def _numbers(value: Any, wanted: AnswerShape, said: str) -> Array:
    form = f"an array of shape {wanted}" if wanted else "one number"
    try:
        array = _array(value)
    except MemoryError:
        raise
    except Exception:  # whatever an object of the student's raises when it is to be an array
        raise WrongError(f"{said} {kind(value)}, where {form} is wanted.") from None
    if _long(array.shape) != _long(wanted):
        shape = f"an array of shape {array.shape}" if array.shape else "one number"
        raise WrongError(f"{said} {shape}, where {form} is wanted.")
    array = array.reshape(wanted).astype(float)
    if np.isnan(array).any():
        raise WrongError(f"{said} NaN, which is no number: what was divided by zero?")
    if np.isinf(array).any():
        raise WrongError(f"{said} an infinite number: what was divided by zero?")
    return array


def _long(shape: AnswerShape) -> AnswerShape:
    """Drop the ones of a shape: a column of n numbers is n numbers."""
    return tuple(n for n in shape if n != 1)


def _array(value: Any) -> Array:
    """Make an array of real numbers; TypeError of what is none."""
    if isinstance(value, str | bytes):  # a text may be long
        raise TypeError
    if isinstance(value, list | tuple):
        value = [_single(one) for one in value]
    array = np.asarray(value)
    if array.dtype.kind == "O":  # fractions, decimals, whole numbers beyond 64 bits
        if not all(isinstance(one, Real | Decimal) for one in array.flat):
            raise TypeError
        array = array.astype(float)
    if array.dtype.kind == "c" and not array.imag.any():
        array = array.real
    if array.dtype.kind not in "biuf":  # text, complex numbers, dates
        raise TypeError
    return array


def _single(value: Any) -> Any:
    """Take a number out of an array in which it is alone."""
    return value.item() if isinstance(value, np.ndarray) and value.size == 1 else value


def listed(value: Any) -> Any:
    """Make a list of what can be gone through but once."""
    if inspect.iscoroutine(value):
        value.close()  # nobody waits for it
    if not isinstance(value, Iterator):
        return value
    items = list(islice(value, MOST_ITEMS + 1))
    if len(items) > MOST_ITEMS:
        raise WrongError(f"{kind(value).capitalize()} of yours has no end.")
    return items


# ---- numbers in sentences


def numbers_apart(*values: Any) -> list[str]:
    """Write numbers so that those that differ look different."""
    arrays = [np.asarray(value, float) for value in values]
    texts: list[str] = []
    for digits in DIGITS:
        texts = [_written(array, digits) for array in arrays]
        pairs = [(i, j) for i in range(len(texts)) for j in range(i)]
        if all(texts[i] != texts[j] or np.array_equal(arrays[i], arrays[j]) for i, j in pairs):
            break
    return texts


def _written(array: Array, digits: int) -> str:
    if array.ndim == 0:
        return f"{float(array):.{digits}g}"
    size = abs(array).max(initial=0.0)
    small = 10.0 ** (np.floor(np.log10(size)) - digits) if size else 1.0  # rounding of the others
    return f"[{', '.join(f'{0.0 if abs(x) < small else float(x):.{digits}g}' for x in array.flat)}]"


def agree(found: Any, wanted: Any, sentence: str, *, near: float = 1e-4, size: float = 0.0) -> None:
    """Raise WrongError unless two numbers or arrays are equal.

    Up to `near` times the largest number that is wanted, or times `size` where that is larger; this
    lets float32 and differences pass. In the sentence {found} and {wanted} become the numbers,
    written so that they differ; of many numbers the one that differs most, with its place.
    """
    found, wanted = np.asarray(found, float), np.asarray(wanted, float)
    far = abs(found - wanted)
    if far.max(initial=0.0) <= near * max(abs(wanted).max(initial=0.0), size):
        return
    where = ""
    if wanted.size > 4:
        place = np.unravel_index(far.argmax(), far.shape)
        where = f" (entry {', '.join(str(i + 1) for i in place)})"
        found, wanted = found[place], wanted[place]
    texts = numbers_apart(found, wanted)
    raise WrongError(sentence.format(found=texts[0] + where, wanted=texts[1]))


# ---- words for a sentence


def in_brief(value: Any) -> str:
    """Tell a value in few words, for a sentence."""
    if isinstance(value, np.ndarray) and value.size > 4:
        return f"array {value.shape}"
    if isinstance(value, np.ndarray | float):
        return np.array2string(np.asarray(value), precision=3, separator=", ", threshold=6)
    text = repr(value)
    return text if len(text) <= 40 else kind(value)


def _plain(value: Any) -> bool:
    return isinstance(value, str | int | float | np.generic | None)


def kind(value: Any) -> str:
    """Name its type with an article: "a list"."""
    return article(type_name(value))


def type_name(value: Any) -> str:
    """Name its type, the true one, whatever its class says."""
    return bounded(type.__dict__["__name__"].__get__(type(value)) or "nameless type", 60)


def article(name: str) -> str:
    """Put a or an before a name."""
    return f"{'an' if name[0] in 'aeiouAEIOU' else 'a'} {name}"


def same(before: Any, after: Any) -> bool:
    """Tell whether an argument is as it was, if possible."""
    if hasattr(before, "equals"):  # a table
        return bool(before.equals(after))
    if isinstance(before, np.ndarray | Sequence) and not isinstance(before, str):
        try:
            a, b = np.asarray(before), np.asarray(after)
            return a.shape == b.shape and bool(np.all((a == b) | ((a != a) & (b != b))))  # NaN too
        except Exception:  # it is no longer made of numbers
            return False
    return True
