"""A session as two files: settings, figure and events in JSON, the numbers of every tick in CSV.

Both can be read by eye and by any program. Numbers are written so that the very same ones are read
back. The table has a row for each tick and method, in the order of both.
"""

import csv
import json
import math
import os
from collections.abc import Iterable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from ikteach.arrays import Array, frozen
from ikteach.body import Effectors, Joint, Tree
from ikteach.motion.log import Event, Log
from ikteach.motion.session import Session, in_words

FORMAT, VERSION = "ikteach session", 1
PER_TICK = ("tick", "time", "phase", "advance", "floor", "shown")  # columns before "method"
WHOLE = {"tick": int, "shown": str, "method": str, "capped": int}  # those that are not floats


def save(
    path: str | os.PathLike[str], run: Log | Session, *, overwrite: bool = False
) -> tuple[Path, Path]:
    """Write the run to <path>.json and <path>.csv, and return both paths.

    FileExistsError where one of them is there already, unless `overwrite`. Both are complete before
    either gets its name.
    """
    log = run.log() if isinstance(run, Session) else run
    settings, table = _pair(path)
    if not settings.parent.is_dir():
        raise FileNotFoundError(f"there is no folder {str(settings.parent)!r} to save in")
    for file in (settings, table):
        if file.exists() and not overwrite:
            raise FileExistsError(
                f"there is a file {str(file)!r} already; overwrite=True would replace it"
            )
    drafts = [file.with_name(f".{file.name}.part") for file in (table, settings)]
    try:
        with drafts[0].open("w", newline="", encoding="utf-8") as out:
            csv.writer(out).writerows(_rows(log))
        words = json.dumps(_settings(log, table.name), indent=1, ensure_ascii=False, default=str)
        drafts[1].write_text(words + "\n", encoding="utf-8")
        for draft, file in zip(drafts, (table, settings), strict=True):
            os.replace(draft, file)
    finally:
        for draft in drafts:
            draft.unlink(missing_ok=True)
    return settings, table


def load(path: str | os.PathLike[str]) -> Log:
    """The run that `save` has written; `path` is that of the JSON file, or without its ending.

    FileNotFoundError and ValueError say which file is missing or what in it is wrong.
    """
    file, _ = _pair(path)
    if not file.is_file():
        raise FileNotFoundError(f"there is no session {str(file)!r}")
    try:
        told = json.loads(file.read_text(encoding="utf-8"))
    except ValueError as error:  # not JSON, or not even text
        raise ValueError(f"{file.name!r} is not a session: it is not JSON ({error})") from None
    if not isinstance(told, dict) or told.get("format") != FORMAT:
        raise ValueError(f"{file.name!r} is not a session: it does not say 'format': {FORMAT!r}")
    if told.get("version") != VERSION:
        raise ValueError(
            f"{file.name!r} is of version {told.get('version')!r}, and this reads {VERSION}"
        )
    try:
        figure = _figure(told["figure"])
        facts = {
            "dt": float(told["dt"]),
            "events": tuple(Event(**event) for event in told["events"]),
            "settings": dict(told["settings"]),
            "dropped": {what: int(number) for what, number in told["dropped"].items()},
        }
        methods, rows = tuple(map(str, told["methods"])), int(told["rows"])
        table = file.with_name(Path(told["numbers"]).name)
    except KeyError as error:
        raise ValueError(f"{file.name!r} is damaged: {error} is missing") from None
    except (TypeError, ValueError, LookupError, AttributeError) as error:
        raise ValueError(f"{file.name!r} is damaged: {error}") from None
    if not table.is_file():
        raise FileNotFoundError(
            f"{file.name!r} has its numbers in {str(table)!r}, which is missing"
        )
    return _log(*figure, methods, _columns(table, _header(*figure), rows), table.name, facts)


def _pair(path: str | os.PathLike[str]) -> tuple[Path, Path]:
    path = Path(path)
    stem = path.with_suffix("") if path.suffix in (".json", ".csv") else path
    return stem.with_name(f"{stem.name}.json"), stem.with_name(f"{stem.name}.csv")


def _settings(log: Log, table: str) -> dict[str, Any]:
    """What stands in the JSON file."""
    return {
        "format": FORMAT,
        "version": VERSION,
        "numbers": table,
        "rows": len(log) * len(log.methods),
        "dt": log.dt,
        "methods": list(log.methods),
        "settings": in_words(log.settings),
        "dropped": dict(log.dropped),
        "events": [in_words(event._asdict()) for event in log.events],
        "figure": {
            "joints": list(_joints(log.tree)),
            "effectors": {
                name: [log.tree.names[joint], offset.tolist()]
                for name, joint, offset in zip(
                    log.effectors.names, log.effectors.joints, log.effectors.offsets, strict=True
                )
            },
        },
    }


def _joints(tree: Tree) -> Iterator[dict[str, Any]]:
    """The rows of the tree; a limit that is not there is null, for JSON has no infinity."""
    for j, name in enumerate(tree.names):
        parent = tree.names[tree.parents[j]] if tree.parents[j] >= 0 else None
        limits = {
            side: float(getattr(tree, side)[j]) if math.isfinite(getattr(tree, side)[j]) else None
            for side in ("lower", "upper")
        }
        yield {
            "name": name, "parent": parent, "offset": tree.offsets[j].tolist(),
            "axis": tree.axes[j].tolist(), "slide": bool(tree.slide[j]), **limits,
            "rest": float(tree.rest[j]), "mobility": float(tree.mobility[j]),
        }  # fmt: skip


def _figure(told: dict[str, Any]) -> tuple[Tree, Effectors]:
    rows = []
    for joint in told["joints"]:
        known = {name: value for name, value in joint.items() if value is not None}
        rows.append(Joint(**known))
    axes = frozen([row.axis for row in rows])  # the very numbers, not those of a second division
    tree = replace(Tree.of(rows), axes=axes)
    return tree, Effectors.of(tree, {name: tuple(at) for name, at in told["effectors"].items()})


def _header(tree: Tree, effectors: Effectors) -> list[str]:
    return [
        *PER_TICK,
        *(f"target.{name}.{axis}" for name in effectors.names for axis in "xyz"),
        "method",
        "capped",
        *(f"error.{name}" for name in effectors.names),
        *(f"theta.{name}" for name in tree.names),
        *(f"held.{name}" for name in tree.names),
    ]


def _rows(log: Log) -> Iterator[Iterable[Any]]:
    """The header and the rows; a float goes out as its repr, from which it comes back exactly."""
    yield _header(log.tree, log.effectors)
    for t in range(len(log)):
        tick = [getattr(log, what)[t].item() for what in PER_TICK[:-1]]
        tick += [log.methods[log.shown[t]], *log.targets[t].ravel().tolist()]
        for i, method in enumerate(log.methods):
            yield [
                *tick, method, int(log.capped[t, i]), *log.error[t, i].tolist(),
                *log.theta[t, i].tolist(), *log.held[t, i].astype(int).tolist(),
            ]  # fmt: skip


def _columns(table: Path, header: list[str], rows: int) -> dict[str, list[Any]]:
    """The columns of the table, each as the type that it has."""
    columns: dict[str, list[Any]] = {name: [] for name in header}
    types = [WHOLE.get(name, int if name.startswith("held.") else float) for name in header]
    try:
        with table.open(newline="", encoding="utf-8") as lines:
            reader = csv.reader(lines)
            found = next(reader, [])
            if missing := [name for name in header if name not in found]:
                raise ValueError(f"it has no column {missing[0]!r}")
            places = [found.index(name) for name in header]
            for row in reader:
                if len(row) != len(found):
                    raise ValueError(
                        f"line {reader.line_num} has {len(row)} entries in place of {len(found)}"
                    )
                for name, place, kind in zip(header, places, types, strict=True):
                    columns[name].append(_entry(row[place], kind, name, reader.line_num))
    except UnicodeDecodeError:
        raise ValueError(f"{table.name!r} is damaged: it is not text") from None
    except (ValueError, csv.Error) as error:
        raise ValueError(f"{table.name!r} is damaged: {error}") from None
    if len(columns["tick"]) != rows:
        raise ValueError(
            f"{table.name!r} is damaged: it has {len(columns['tick'])} rows in place of {rows}"
        )
    return columns


def _entry(text: str, kind: Any, column: str, line: int) -> Any:
    try:
        value = kind(text)
    except ValueError:
        value = math.nan
    if kind is not str and not math.isfinite(value):
        raise ValueError(f"{column!r} in line {line} is {text!r}, not a finite number")
    return value


def _log(
    tree: Tree, effectors: Effectors, methods: tuple[str, ...], columns: dict[str, list[Any]],
    table: str, facts: dict[str, Any],
) -> Log:  # fmt: skip
    """The log of these columns, whose rows must be every method of every tick in turn."""
    m, n, k = len(methods), len(tree), len(effectors)
    T = len(columns["method"]) // max(m, 1)
    if columns["method"] != list(methods) * T:
        raise ValueError(f"{table!r} is damaged: its methods are not {', '.join(methods)} in turn")
    if stranger := set(columns["shown"]) - set(methods):
        raise ValueError(f"{table!r} is damaged: it shows {stranger.pop()!r}, which is no method")

    def all_of(prefix: str, shape: tuple[int, ...]) -> Array:
        names = [name for name in columns if name.startswith(prefix)]
        return np.array([columns[name] for name in names]).T.reshape(T, m, *shape)

    def per_tick(name: str) -> Any:
        return np.array(columns[name]).reshape(T, m)[:, 0]

    place = {name: i for i, name in enumerate(methods)}
    shown = np.array([place[name] for name in columns["shown"]], dtype=np.int64)
    return Log(
        tree, effectors, methods=methods,
        tick=per_tick("tick").astype(np.int64),
        **{name: per_tick(name).astype(float) for name in PER_TICK[1:-1]},
        shown=shown.reshape(T, m)[:, 0],
        targets=all_of("target.", (k, 3))[:, 0].astype(float),
        theta=all_of("theta.", (n,)).astype(float), error=all_of("error.", (k,)).astype(float),
        capped=np.array(columns["capped"], dtype=bool).reshape(T, m),
        held=all_of("held.", (n,)).astype(bool), **facts,
    )  # fmt: skip
