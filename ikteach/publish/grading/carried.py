"""What an answer gives, carried from its process to the one that judges as plain data.

Never as objects: whoever unpickles what a stranger has pickled runs the stranger's code. Numbers,
arrays of numbers, texts, lists and dictionaries arrive; of anything else its kind alone.
"""

import base64
import json
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from decimal import Decimal
from itertools import islice
from numbers import Real
from typing import Any

import numpy as np

MOST_ITEMS = 100_001  # of an iterator; one more than an answer may have
DEEPEST = 20  # levels of lists
LARGEST_ARRAY = 2_000_000  # numbers
DTYPE = re.compile(r"[<>|=][biufc]\d{1,2}")


def packed(value: Any, functions: list[Callable[..., Any]]) -> bytes:
    """Write a value as JSON; functions are appended and numbered."""
    return json.dumps(_plain(value, functions, 0)).encode()


def unpacked(data: bytes, function: Callable[[str, int], Any]) -> Any:
    """Read what `packed` has written, or raise ValueError.

    function  makes of a name and a number what stands for a function
    """
    try:
        return _made(json.loads(data), function, 0)
    except (TypeError, KeyError, IndexError, OverflowError, RecursionError) as error:
        raise ValueError("it has a form that is not ours") from error


def _plain(value: Any, functions: list[Callable[..., Any]], depth: int) -> Any:
    if value is None or type(value) in (bool, float, str):
        return value
    if depth > DEEPEST:
        return {"other": "nest of lists"}
    if isinstance(value, int):
        return {"other": "huge number"} if abs(value) > 1e300 else int(value)
    if isinstance(value, str):
        return str.__str__(value)
    if isinstance(value, Real | Decimal):
        return float(value)
    if value is ...:
        return {"dots": 1}
    if callable(value):
        functions.append(value)
        name = getattr(value, "__name__", "")
        return {"function": name if isinstance(name, str) else "", "at": len(functions) - 1}
    if isinstance(value, Mapping):
        pairs = list(islice(value.items(), MOST_ITEMS))
        return {"pairs": [[_plain(one, functions, depth + 1) for one in pair] for pair in pairs]}
    if isinstance(value, list | tuple | Iterator):
        items = islice(value, MOST_ITEMS)
        return {"items": [_plain(one, functions, depth + 1) for one in items]}
    return _array(value, functions, depth)


def _array(value: Any, functions: list[Callable[..., Any]], depth: int) -> Any:
    """Write an array, a Series, or whatever becomes one."""
    if isinstance(value, set | frozenset | bytes):
        return {"other": type(value).__name__}
    if (
        not hasattr(value, "__array__")
        and isinstance(value, Iterable)
        and hasattr(value, "__len__")
    ):
        return _plain(list(islice(value, MOST_ITEMS)), functions, depth + 1)  # keys of a dictionary
    array = np.asarray(value)
    if array.size > LARGEST_ARRAY or array.dtype.kind in "mMV":
        return {"other": type(value).__name__}
    if array.dtype.kind not in "biufc":  # texts, fractions
        items = array.tolist()
        return (
            {"other": type(value).__name__}
            if items is value
            else _plain(items, functions, depth + 1)
        )
    data = base64.b64encode(np.ascontiguousarray(array).tobytes()).decode()
    return {"array": data, "dtype": array.dtype.str, "shape": list(array.shape)}


def _made(plain: Any, function: Callable[[str, int], Any], depth: int) -> Any:
    if not isinstance(plain, dict):
        if isinstance(plain, list) or depth > DEEPEST + 2:
            raise ValueError("it has a form that is not ours")
        return plain
    match plain:
        case {"items": [*items]}:
            return [_made(one, function, depth + 1) for one in items]
        case {"pairs": [*pairs]}:
            made = [[_made(one, function, depth + 1) for one in pair] for pair in pairs]
            return dict(made)
        case {"array": str(data), "dtype": str(dtype), "shape": [*shape]} if DTYPE.fullmatch(dtype):
            return np.frombuffer(base64.b64decode(data), dtype).reshape(_whole(shape)).copy()
        case {"function": str(name), "at": int(at)}:
            return function(name[:60], at)
        case {"dots": _}:
            return ...
        case {"other": str(kind)}:
            return type(re.sub(r"[^\w ]", "", kind)[:60] or "thing", (), {})()
    raise ValueError("it has a form that is not ours")


def _whole(shape: Sequence[Any]) -> tuple[int, ...]:
    return tuple(map(int, shape))
