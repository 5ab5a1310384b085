"""The question bank: numeric questions with variants, and the course's own exit questions.

Each family is a function of a generator of random numbers: it draws a question, and the package's
own functions answer it. Beside the answer stand the values that wrong beliefs give, each with what
to say about it. The same seed makes the same questions.
"""

import importlib
import zlib
from collections.abc import Callable, Mapping
from typing import NamedTuple

import numpy as np

VARIANTS = 10  # of each family
SHARE = 0.01  # of a value by which what a student types may be off
APART = 4  # margins between an answer and a wrong one: less, and other numbers are drawn
DRAWS = 1000  # of a family, until it is given up
MODULES = ("bodies", "methods", "motions")


class Numeric(NamedTuple):
    """A question whose answer is a number.

    unit   of the answer, told in the question; empty where it has none
    why    how the answer is found
    wrong  {what to say: the value that a wrong belief gives}
    """

    text: str
    answer: float
    unit: str
    why: str
    wrong: Mapping[str, float]

    def margin(self, value: float) -> float:
        """Return how far what is typed may be off."""
        return SHARE * abs(value or self.answer)

    @property
    def clear(self) -> bool:
        """Whether no value is near another, nor the answer 0."""
        values = np.array([self.answer, *self.wrong.values()])
        margins = np.array([self.margin(value) for value in values])
        apart = abs(values[:, None] - values) > APART * np.maximum(margins[:, None], margins)
        return bool(
            self.answer
            and np.isfinite(values).all()
            and (apart | np.eye(len(values), dtype=bool)).all()
        )


Family = Callable[[np.random.Generator], Numeric]
FAMILIES: dict[str, Family] = {}


def family(name: str) -> Callable[[Family], Family]:
    """Enter a family, by chapter and name."""

    def enter(function: Family) -> Family:
        FAMILIES[name] = function
        return function

    return enter


def families() -> dict[str, Family]:
    """Return all families, by chapter and name."""
    for module in MODULES:
        importlib.import_module(f"{__name__}.{module}")
    return {name: FAMILIES[name] for name in sorted(FAMILIES, key=lambda n: (n[0].isdigit(), n))}


def draw_variants(name: str, count: int = VARIANTS, seed: int = 0) -> list[Numeric]:
    """Draw questions of a family, no two alike.

    LookupError if it has not so many.
    """
    rng = np.random.default_rng([zlib.crc32(name.encode()), seed])
    found: dict[str, Numeric] = {}
    for _ in range(DRAWS):
        question = families()[name](rng)
        if question.clear:
            found.setdefault(question.text, question)
        if len(found) == count:
            return list(found.values())
    raise LookupError(f"The family {name} has no {count} questions that differ.")


def on_grid(rng: np.random.Generator, low: float, high: float, step: float) -> float:
    """Draw a number of a grid, which is printed whole."""
    return round(low + step * int(rng.integers(0, round((high - low) / step) + 1)), 10)
