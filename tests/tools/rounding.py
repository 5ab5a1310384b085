"""Another processor, played: what numpy's linear algebra returns, with its last bits moved.

A library of linear algebra rounds as its processor does. What is said of a run must not depend on
that: tests and notebooks run with `moved` too.
"""

from collections.abc import Callable
from typing import Any

import numpy as np

DECOMPOSITIONS = ("svd", "svdvals", "solve", "inv", "pinv")
BIT = np.finfo(float).eps


def moved(function: Callable[..., Any], rng: np.random.Generator) -> Callable[..., Any]:
    """The function, each number that it returns moved by at most a bit of its last place."""

    def move(array: Any) -> Any:
        return array * (1 + BIT * rng.choice([-1, 0, 1], size=np.shape(array)))

    def other(*args: Any, **options: Any) -> Any:
        found = function(*args, **options)
        return type(found)(*map(move, found)) if isinstance(found, tuple) else move(found)

    return other


def move_all(seed: int = 1) -> dict[str, Callable[..., Any]]:
    """{name: `moved` version} of each function of `numpy.linalg` that the package solves with."""
    rng = np.random.default_rng(seed)
    return {name: moved(getattr(np.linalg, name), rng) for name in DECOMPOSITIONS}
