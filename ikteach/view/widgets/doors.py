"""Doors of widgets: they refuse with the culprit's name, and say what is allowed."""

import os
from collections.abc import Callable, Iterable, Mapping
from numbers import Real
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from ikteach.body import Effectors, Tree
from ikteach.body.figures import Figure
from ikteach.checks import count, shown

T = TypeVar("T")
WIDEST = 8192  # pixels that a picture may have at a side


def a(kind: type[T], name: str, value: Any) -> T:
    """Give back a value of this kind.

    TypeError names a value of another kind.
    """
    if not isinstance(value, kind):
        what = kind.__name__ if kind.__name__.endswith("s") else f"a {kind.__name__}"
        raise TypeError(f"{name} must be {what}, not {shown(value)}")
    return value


def has(name: str, value: Any, what: str, *parts: str) -> None:
    """Refuse a value without these parts.

    TypeError says that it must be `what`, which has them.
    """
    if isinstance(value, type) or not all(hasattr(value, part) for part in parts):
        raise TypeError(f"{name} must be {what}, not {shown(value)}")


def body(tree: Any, effectors: Any) -> Figure:
    """Check a tree and the effectors on it.

    TypeError or ValueError names the fault.
    """
    a(Tree, "the tree", tree), a(Effectors, "the effectors", effectors)
    if effectors.carried.shape[-1] != len(tree):
        joints = effectors.carried.shape[-1]
        raise ValueError(f"these effectors are of a tree of {joints} joints, not of {len(tree)}")
    return Figure(tree, effectors)


def figure(value: Any) -> Figure:
    """Check a figure, or the pair of its parts.

    TypeError or ValueError names the fault.
    """
    if not (isinstance(value, tuple) and len(value) == 2):
        raise TypeError(
            "a figure is its tree and its effectors, as figures.human() gives them, not "
            f"{'a Tree alone' if isinstance(value, Tree) else shown(value)}"
        )
    return body(*value)


def scene(
    tree: Any, effectors: Any, names: Any, apart: Any, width: Any, height: Any
) -> tuple[int, int]:
    """Check the parts of a scene.

    Gives its width and height [pixels].
    """
    body(tree, effectors)
    if not texts("the names of the figures", names):
        raise ValueError("a scene needs at least one figure")
    if apart is not None:
        within("apart", apart, 0, np.inf)
    return tuple(  # type: ignore[return-value]
        count(name, size, most=WIDEST) for name, size in (("width", width), ("height", height))
    )


def within(name: str, value: Any, low: float, high: float) -> float:
    """Check one finite number from low to high.

    Gives it as a float; ValueError names a value that is none.
    """
    real = isinstance(value, Real) and not isinstance(value, bool | np.bool_)
    if not (real and low <= value <= high and value < np.inf):
        allowed = f"{low:g} or more" if high == np.inf else f"from {low:g} to {high:g}"
        what = "a finite number" if low == -np.inf else f"a number, {allowed}"
        raise ValueError(f"{name} must be {what}, not {shown(value)}")
    return float(value)


def text(name: str, value: Any) -> str:
    """Check a text.

    TypeError names a value that is none.
    """
    if not isinstance(value, str):
        raise TypeError(f"{name} must be text, not {shown(value)}")
    return value


def texts(name: str, values: Any) -> list[str]:
    """Check a list of texts, and not one text.

    TypeError names a value that is none.
    """
    if isinstance(values, str) or not isinstance(values, Iterable):
        raise TypeError(f"{name} must be a list of texts, not {shown(values)}")
    return [text(f"each of {name}", value) for value in values]


def folder(value: Any) -> Path:
    """Check a folder, by its path.

    TypeError names a value that is none.
    """
    if not isinstance(value, str | os.PathLike):
        raise TypeError(f"folder must be a path, not {shown(value)}")
    return Path(value)


def named(name: str, values: Any, door: Callable[[str, Any], object]) -> dict[str, Any]:
    """Check a {text: value} whose values pass a door.

    TypeError names a key that is no text; the door names a value that does not pass.
    """
    if not isinstance(values, Mapping):
        raise TypeError(f"{name} must be a {{name: …}}, not {shown(values)}")
    for key, value in values.items():
        door(f"{text(f'each name of {name}', key)!r} of {name}", value)
    return dict(values)
