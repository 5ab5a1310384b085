"""The scheme of points: a point an exercise, or what a TOML file says.

title = "Inverse kinematics"   # the column's name
default = 1                    # points of an exercise that is not named; 0: only those named

[points]
"05" = 2        # each exercise of chapter 5
"00.hand" = 0.5
"""

import importlib
import math
import tomllib
from collections.abc import Iterable
from pathlib import Path
from typing import Any, NamedTuple

from ikteach.course import exercises
from ikteach.course.checking import EXERCISES
from ikteach.files import bounded, quoted, read_text
from ikteach.names import unknown
from ikteach.publish.parser import RefusedError

LARGEST_SCHEME = 2**20  # bytes of a file


class Scheme(NamedTuple):
    """Points of each exercise that counts, {key: points}; a title."""

    points: dict[str, float]
    title: str = "ikteach"

    @property
    def total(self) -> float:
        """Add all points."""
        return added(self.points.values())


def added(points: Iterable[float]) -> float:
    """Add points as people do: three times 0.1 is 0.3."""
    return round(math.fsum(points), 6)


def every_exercise() -> list[str]:
    """List the keys of all exercises of the course."""
    for path in sorted(Path(next(iter(exercises.__path__))).glob("ch*.py")):
        importlib.import_module(f"{exercises.__name__}.{path.stem}")
    return sorted(key for key in EXERCISES if key[:2].isdigit())


def read_scheme(path: Path | None) -> Scheme:
    """Read a scheme, or raise RefusedError with what is wrong."""
    keys = every_exercise()
    if path is None:
        return Scheme(dict.fromkeys(keys, 1.0))
    try:
        content = tomllib.loads(read_text(path, LARGEST_SCHEME))
    except (OSError, ValueError) as error:
        raise RefusedError(f"{path}: {bounded(str(error))}.") from None
    given = content.get("points", {})
    for name in content:
        if name not in ("title", "default", "points"):
            raise RefusedError(
                f"{path}: {unknown('setting', name, ['title', 'default', 'points'])}"
            )
    if not isinstance(given, dict):
        raise RefusedError(f"{path}: [points] must be a table, exercise = points.")
    for key in given:
        if key not in {*keys, *(one[:2] for one in keys)}:
            raise RefusedError(f"{path}: {unknown('exercise', key, keys)}")
    default = _number(path, "default", content.get("default", 1))
    worth = {key: _number(path, key, value) for key, value in given.items()}
    points = {key: worth.get(key, worth.get(key[:2], default)) for key in keys}
    if not any(points.values()):
        raise RefusedError(f"{path}: no exercise is worth anything.")
    title = content.get("title", "ikteach")
    if not isinstance(title, str) or not title.strip():
        raise RefusedError(f"{path}: title must be a text, not {quoted(title)}.")
    return Scheme({key: value for key, value in points.items() if value}, title.strip())


def _number(path: Path, name: str, value: Any) -> float:
    number = isinstance(value, int | float) and not isinstance(value, bool)
    if not number or not math.isfinite(value) or value < 0:
        raise RefusedError(f"{path}: {name} must be a number from 0 on, not {quoted(value)}.")
    return float(value)
