"""The table of a session: a row for each tick and method, in the order of both, as CSV.

Numbers are written so that the very same ones are read back. A table that a spreadsheet has saved
again is read too: with another delimiter, decimal commas, a byte order mark, TRUE for 1, empty
lines at the end.
"""

import csv
import io
import math
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np

from ikteach.body import Effectors, Tree
from ikteach.files import quoted, read_text
from ikteach.motion.live.log import Log

PER_TICK = ("tick", "time", "phase", "advance", "floor", "shown")  # columns before "method"
LARGEST_TABLE = 512 * 2**20  # [bytes]
LAST_TICK = 2**53  # a float still counts them
DELIMITERS = ",;\t"  # of our own tables, and of spreadsheets in other languages
TRUTH = {"TRUE": 1.0, "FALSE": 0.0}  # as spreadsheets like to write
WORDS = ("method", "shown")  # columns of text

# What the numbers of a column must be, by the first part of its name; NaN is none of these.
Rule = tuple[Callable[[float], bool], str]
RULES: dict[str, Rule] = {
    "tick": (lambda x: x.is_integer() and 0 <= x <= LAST_TICK, "a whole number from 0 on"),
    "capped": (lambda x: x in (0, 1), "0 or 1"),
    "held": (lambda x: x in (0, 1), "0 or 1"),
    "error": (lambda x: 0 <= x < math.inf, "a distance"),
}
ANY: Rule = (math.isfinite, "a finite number")


def header(tree: Tree, effectors: Effectors) -> list[str]:
    """Name the columns."""
    return [
        *PER_TICK,
        *(f"target.{name}.{axis}" for name in effectors.names for axis in "xyz"),
        "method",
        "capped",
        *(f"error.{name}" for name in effectors.names),
        *(f"theta.{name}" for name in tree.names),
        *(f"held.{name}" for name in tree.names),
    ]


def rows(log: Log) -> Iterator[Iterable[Any]]:
    """Give the header and the rows.

    A float goes out as its repr, which gives the same float.
    """
    yield header(log.tree, log.effectors)
    for t in range(len(log)):
        tick = [getattr(log, what)[t].item() for what in PER_TICK[:-1]]
        tick += [log.methods[log.shown[t]], *log.targets[t].ravel().tolist()]
        for i, method in enumerate(log.methods):
            yield [
                *tick,
                method,
                int(log.capped[t, i]),
                *log.error[t, i].tolist(),
                *log.theta[t, i].tolist(),
                *log.held[t, i].astype(int).tolist(),
            ]


def _columns(table: Path, names: list[str], count: int) -> dict[str, list[Any]]:
    """Read the columns: text for methods, and finite numbers."""
    text = read_text(table, LARGEST_TABLE)
    if text[:4].lower() == "sep=":  # a spreadsheet tells of its delimiter
        text = text[text.find("\n") + 1 :]
    delimiter, found = _first_line(text, names)
    if missing := [name for name in names if name not in found]:
        begins = f"; it begins with {quoted(text[:60])}" if text else "; it is empty"
        raise ValueError(f"it has no column {quoted(missing[0])}{begins}")
    if len(found) > len(names) + 1000:
        raise ValueError(f"it has {len(found):,} columns in place of {len(names)}")
    if twice := {name for name in names if found.count(name) > 1}:
        raise ValueError(f"it has two columns {quoted(min(twice))}")
    columns: dict[str, list[Any]] = {name: [] for name in names}
    places = [
        (columns[name], found.index(name), name, *RULES.get(name.partition(".")[0], ANY))
        for name in names
    ]
    reader = csv.reader(io.StringIO(text, newline=""), delimiter=delimiter)
    try:
        next(reader)
        for row in reader:
            if not any(row):
                continue
            while len(row) > len(found) and not row[-1]:
                row.pop()
            if len(row) != len(found):
                where = f"line {reader.line_num}"
                raise ValueError(f"{where} has {len(row)} entries in place of {len(found)}")
            for column, place, name, holds, wanted in places:
                if name in WORDS:
                    column.append(row[place])
                elif holds(number := _number(row[place], delimiter)):
                    column.append(number)
                else:
                    where = f"{quoted(name)} in line {reader.line_num}"
                    raise ValueError(f"{where} is {quoted(row[place])}, not {wanted}")
            if len(columns["tick"]) > count:
                break
    except csv.Error:
        raise ValueError(f"line {reader.line_num} is no line of a table") from None
    if (rows := len(columns["tick"])) != count:
        raise ValueError(f"it has {'more' if rows > count else rows} rows in place of {count}")
    return columns


def _first_line(text: str, names: list[str]) -> tuple[str, list[str]]:
    """Find the delimiter that fits the first line, and its names."""
    lines = {}
    for delimiter in DELIMITERS:
        with suppress(csv.Error):
            reader = csv.reader(io.StringIO(text, newline=""), delimiter=delimiter)
            lines[delimiter] = next(reader, [])
    known = set(names)
    best = max(lines, key=lambda delimiter: len(known & set(lines[delimiter])), default=",")
    return best, lines.get(best, [])


def _number(text: str, delimiter: str) -> float:
    """Read the number in a cell; NaN where there is none."""
    try:
        return float(text)
    except ValueError:
        if delimiter != "," and "." not in text:  # a decimal comma
            with suppress(ValueError):
                return float(text.replace(",", "."))
        return TRUTH.get(text.strip().upper(), math.nan)


def read_log(table: Path, rows: int, facts: dict[str, Any]) -> Log:
    """Read the log of these facts from its table.

    Its rows must be every method of every tick in turn. ValueError says what in the table is wrong,
    for a sentence that begins with its name.
    """
    methods, tree, effectors = facts["methods"], facts["tree"], facts["effectors"]
    m, n, k = len(methods), len(tree), len(effectors)
    columns = _columns(table, header(tree, effectors), rows)
    T = len(columns["method"]) // m
    if columns["method"] != list(methods) * T:
        raise ValueError(f"its methods are not {', '.join(methods)} in turn")
    if stranger := set(columns["shown"]) - set(methods):
        raise ValueError(f"it shows {quoted(min(stranger))}, which is no method")

    def all_of(prefix: str, shape: tuple[int, ...], kind: Any = float) -> Any:
        names = [name for name in columns if name.startswith(prefix)]
        return np.array([columns[name] for name in names], dtype=kind).T.reshape(T, m, *shape)

    def per_tick(name: str, kind: Any = float) -> Any:
        values = np.array(columns[name], dtype=kind).reshape(T, m)
        if (values != values[:, :1]).any():
            raise ValueError(f"the methods of one tick differ in {quoted(name)}")
        return values[:, 0]

    place = {name: i for i, name in enumerate(methods)}
    columns["shown"] = [place[name] for name in columns["shown"]]
    tick, targets = per_tick("tick", np.int64), all_of("target.", (k, 3))
    if (np.diff(tick) <= 0).any():
        raise ValueError("its ticks do not ascend")
    if (targets != targets[:, :1]).any():
        raise ValueError("the methods of one tick differ in their targets")
    return Log(
        tick=tick,
        **{name: per_tick(name) for name in PER_TICK[1:-1]},
        shown=per_tick("shown", np.int64),
        targets=targets[:, 0],
        theta=all_of("theta.", (n,)),
        error=all_of("error.", (k,)),
        capped=np.array(columns["capped"], dtype=bool).reshape(T, m),
        held=all_of("held.", (n,), bool),
        **facts,
    )
