"""The description of a session in its JSON file: readable by every reader, read checked."""

import math
from collections import Counter
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from ikteach.arrays import frozen
from ikteach.body import Effectors, Joint, Tree
from ikteach.files import HALF, jsonable, quoted
from ikteach.motion.live.log import Event, Log
from ikteach.motion.live.settings import in_words

LONGEST_NAME = 200  # letters of a name
MOST_NAMES = {"method": 200, "effector": 1000, "joint": 2000}  # of each in a file
JSON_KINDS: dict[type, str] = {
    dict: "names with their values",
    list: "a list",
    str: "text",
    bool: "true or false",
    float: "a number",
    int: "a whole number",
}
EVENT = {"run": int, "tick": int, "time": float, "kind": str, "what": dict}


def describe(log: Log) -> dict[str, Any]:
    """Describe all of a run but its numbers."""
    return {
        "rows": len(log) * len(log.methods),
        "dt": log.dt,
        "methods": list(log.methods),
        "settings": jsonable(in_words(log.settings)),
        "dropped": dict(log.dropped),
        "events": [jsonable(in_words(event._asdict())) for event in log.events],
        "figure": {
            "joints": list(_joints(log.tree)),
            "effectors": _ends(log, 1),
            "directions": _ends(log, 0),
        },
    }


def _ends(log: Log, w: int) -> dict[str, list[Any]]:
    """Write the effectors that are points (w = 1), or directions (w = 0)."""
    ends = log.effectors
    each = zip(ends.names, ends.joints.tolist(), ends.offsets.tolist(), ends.w, strict=True)
    return {name: [log.tree.names[joint], at] for name, joint, at, one in each if one == w}


def _joints(tree: Tree) -> Iterator[dict[str, Any]]:
    """Write the rows of the tree; an infinite limit is null in JSON."""
    for j, name in enumerate(tree.names):
        parent = tree.names[tree.parents[j]] if tree.parents[j] >= 0 else None
        limits = {
            side: float(getattr(tree, side)[j]) if math.isfinite(getattr(tree, side)[j]) else None
            for side in ("lower", "upper")
        }
        yield {
            "name": name,
            "parent": parent,
            "offset": tree.offsets[j].tolist(),
            "axis": tree.axes[j].tolist(),
            "slide": bool(tree.slide[j]),
            **limits,
            "rest": float(tree.rest[j]),
            "mobility": float(tree.mobility[j]),
        }


def log_facts(given: dict[str, Any]) -> dict[str, Any]:
    """Read what `Log` needs beside numbers, or raise ValueError."""
    tree, effectors = _figure(field(given, "figure", dict))
    dt = field(given, "dt", float)
    if dt <= 0:
        raise ValueError(f"'dt' is {dt}, and must be more than 0")
    return {
        "tree": tree,
        "effectors": effectors,
        "dt": dt,
        "methods": names("method", field(given, "methods", list)),
        "events": tuple(map(_event, field(given, "events", list))),
        "settings": field(given, "settings", dict),
        "dropped": _dropped(field(given, "dropped", dict)),
    }


def check_writable(log: Log) -> None:
    """Refuse by ValueError what could not be read back."""
    names("method", list(log.methods))
    names("effector", list(log.effectors.names))
    names("joint", list(log.tree.names))
    numbers = (log.time, log.phase, log.advance, log.floor, log.targets, log.theta, log.error)
    if not all(np.isfinite(array).all() for array in numbers) or not 0 < log.dt < math.inf:
        raise ValueError("the run holds numbers that are not finite, or a dt that is not positive")


def _of_kind(value: Any, kind: type, what: str) -> Any:
    if kind is float and type(value) is int:
        value = float(value)
    if type(value) is not kind:
        raise ValueError(f"{what} is {quoted(value)}, not {JSON_KINDS[kind]}")
    return value


def field(given: dict[str, Any], name: str, kind: type, of: str = "") -> Any:
    """Give the value of that name and kind, or refuse."""
    if name not in given:
        raise ValueError(f"{name!r}{of} is missing")
    return _of_kind(given[name], kind, f"{name!r}{of}")


def names(what: str, names: list[Any]) -> tuple[str, ...]:
    """Check that each name is text, and there once."""
    if not 0 < len(names) <= MOST_NAMES[what]:
        raise ValueError(
            f"there are {len(names)} {what}s, and from 1 to {MOST_NAMES[what]:,} can be"
        )
    for name in names:
        if not (isinstance(name, str) and 0 < len(name) <= LONGEST_NAME) or HALF.search(name):
            raise ValueError(
                f"{quoted(name)} is no name of a {what}: text of up to {LONGEST_NAME} letters"
            )
    if twice := [name for name, count in Counter(names).items() if count > 1]:
        raise ValueError(f"there are two {what}s called {quoted(twice[0])}")
    return tuple(names)


def _vector(value: Any, what: str) -> tuple[float, ...]:
    if len(_of_kind(value, list, what)) != 3:
        raise ValueError(f"{what} is {quoted(value)}, not three numbers")
    return tuple(_of_kind(one, float, what) for one in value)


def _event(given: Any) -> Event:
    of = " of an event"
    given = _of_kind(given, dict, "an event")
    event = Event(*(field(given, name, kind, of) for name, kind in EVENT.items()))
    if event.run < 0 or event.tick < 0:
        raise ValueError(f"'run' and 'tick'{of} must not be negative")
    return event


def _dropped(given: dict[str, Any]) -> dict[str, int]:
    dropped = {what: field(given, what, int, " in 'dropped'") for what in ("ticks", "events")}
    if min(dropped.values()) < 0:
        raise ValueError("the numbers in 'dropped' must not be negative")
    return dropped


def _joint(given: Any) -> Joint:
    name = field(_of_kind(given, dict, "a joint"), "name", str, " of a joint")
    of = f" of {quoted(name)}"
    limits = {
        side: field(given, side, float, of)
        for side in ("lower", "upper")
        if given.get(side, 0.0) is not None
    }
    parent = None if given.get("parent", "") is None else field(given, "parent", str, of)
    return Joint(
        name,
        parent,
        offset=_vector(given.get("offset"), f"'offset'{of}"),
        axis=_vector(given.get("axis"), f"'axis'{of}"),
        slide=field(given, "slide", bool, of),
        rest=field(given, "rest", float, of),
        mobility=field(given, "mobility", float, of),
        **limits,
    )


def _figure(given: dict[str, Any]) -> tuple[Tree, Effectors]:
    of = " of the figure"
    rows = [_joint(one) for one in field(given, "joints", list, of)]
    points = field(given, "effectors", dict, of)
    given = {"directions": {}} | given  # which files of the first version do not have
    directions = field(given, "directions", dict, of)
    names("joint", [row.name for row in rows])
    names("effector", [*points, *directions])
    tree = Tree.of(rows)
    for name, point in [*points.items(), *directions.items()]:
        if len(_of_kind(point, list, f"effector {quoted(name)}")) != 2:
            raise ValueError(
                f"effector {quoted(name)} is {quoted(point)}, not a joint and an offset"
            )
        _of_kind(point[0], str, f"the joint of effector {quoted(name)}")
        _vector(point[1], f"the offset of effector {quoted(name)}")
    # The very numbers of a unit axis, not those of a second division.
    axes = np.array([row.axis for row in rows])
    same = abs(axes - tree.axes).max(axis=1, keepdims=True) < 1e-9
    tree = replace(tree, axes=frozen(np.where(same, axes, tree.axes)))
    both = ({name: tuple(at) for name, at in one.items()} for one in (points, directions))
    return tree, Effectors.of(tree, next(both), directions=next(both))
