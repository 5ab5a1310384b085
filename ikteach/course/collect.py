"""The answers of a class: `python -m ikteach collect FOLDER` makes one table of many files.

A file is what `export` has written, or a student's `predictions.json`. The student is the file's
name, or for files in folders the name of the outermost one, as a learning platform hands them out.
Nothing is changed, and nothing is passed over in silence: what cannot be read is named.
"""

import argparse
import json
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import pandas as pd

from ikteach.course.questions import words
from ikteach.course.record import KINDS

NAMES = dict(zip(KINDS, ("prediction", "exercise", "quiz"), strict=True))
FIRST = ["student", "file", "kind", "key", "answer", "result", "right", "tries", "late", "at"]


class Collected(NamedTuple):
    """What was found.

    table    a row for each student, file, kind and key: `FIRST`, then whatever else was recorded;
             `right` is None for a number that was predicted, and where no result was shown
    logs     the exported logs, one below the other, with student and file in front
    skipped  {file: why it, or its log, was left out}
    """

    table: pd.DataFrame
    logs: pd.DataFrame
    skipped: dict[str, str]


def collect(folder: Path) -> Collected:
    """Read every file of answers in the folder and the folders in it."""
    if not folder.is_dir():
        raise NotADirectoryError(f"{folder} is not a folder")
    rows: list[dict[str, Any]] = []
    logs: list[pd.DataFrame] = []
    skipped: dict[str, str] = {}
    for path in _files(folder):
        name = path.relative_to(folder)
        who = {"student": name.parts[0] if len(name.parts) > 1 else name.stem, "file": str(name)}
        try:
            content = _content(path)
            found = [row | who for row in _rows(content)]
        except ValueError as error:
            skipped[str(name)] = str(error)
            continue
        rows += found
        try:
            log = _log(content.get("log"))
        except ValueError as error:
            skipped[str(name)] = f"its answers are in the table, its log is not: {error}"
        else:
            if log is not None:
                logs.append(pd.concat([pd.DataFrame(who, index=log.index), log], axis=1))
    table = pd.DataFrame(rows, columns=[*FIRST, *_others(rows)])
    together = pd.concat(logs, ignore_index=True) if logs else pd.DataFrame()
    return Collected(table, together, skipped)


def summary(table: pd.DataFrame) -> pd.DataFrame:
    """A row for each question: how many answered, how many are right, what they said.

    Of a student who handed in several files the newest answer counts.
    """
    newest = table.sort_values("at", kind="stable").drop_duplicates(
        ["student", "kind", "key"], keep="last"
    )
    rows = {}
    for (key, kind), group in newest.groupby(["key", "kind"]):
        judged = group["right"].dropna().astype(float)
        share = f"{judged.mean():.0%}" if len(judged) else "–"
        answered = len(group) if kind == "exercise" else group["answer"].count()
        rows[key, kind] = {"answered": answered, "right": share, "said": _said(group["answer"])}
    index = pd.MultiIndex.from_tuples(list(rows), names=["key", "kind"])
    return pd.DataFrame(list(rows.values()), index=index if rows else None)


def main(argv: list[str]) -> int:
    """`python -m ikteach collect FOLDER`; the exit code."""
    parser = argparse.ArgumentParser(
        prog="python -m ikteach collect",
        description="One table of all predictions, checks and quiz answers in FOLDER: files that "
        "`export` wrote, or predictions.json.",
        allow_abbrev=False,
    )
    parser.add_argument("folder", metavar="FOLDER", type=Path)
    parser.add_argument("--table", metavar="CSV", type=Path, help="write the table there")
    parser.add_argument("--logs", metavar="CSV", type=Path, help="write the exported logs there")
    options = parser.parse_args(argv)
    outputs = {path: name for name in ("table", "logs") if (path := getattr(options, name))}
    for path in outputs:
        if path.exists():
            return _refuse(f"{path} exists already and was left alone; name another file.")
    try:
        found = collect(options.folder.expanduser())
    except NotADirectoryError as error:
        return _refuse(f"{error}.")
    for name, why in found.skipped.items():
        print(f"{name}: {why}", file=sys.stderr)
    if found.table.empty:
        return _refuse(f"There are no answers in {options.folder}.")
    count = found.table[["student", "file"]].nunique()
    print(f"{len(found.table)} answers of {count['student']} students in {count['file']} files")
    print(summary(found.table).to_string())
    for path, name in outputs.items():
        getattr(found, name).to_csv(path, index=False)
        print(f"written: {path}")
    return 0


def _refuse(sentence: str) -> int:
    print(sentence, file=sys.stderr)
    return 1


def _files(folder: Path) -> Iterator[Path]:
    for path in sorted(folder.rglob("*")):
        hidden = any(part.startswith(".") for part in path.relative_to(folder).parts)
        if path.suffix.lower() in (".json", ".zip") and path.is_file() and not hidden:
            yield path


def _content(path: Path) -> dict[str, Any]:
    if path.suffix.lower() == ".zip":
        raise ValueError("skipped: unpack it first")
    try:
        content = json.loads(path.read_text(encoding="utf-8-sig"))
    except OSError as error:
        raise ValueError(f"skipped: it cannot be read ({error.strerror})") from None
    except (ValueError, RecursionError):
        raise ValueError("skipped: it is damaged, or no JSON") from None
    if not isinstance(content, dict) or not content.keys() & set(KINDS):
        raise ValueError("skipped: it holds no answers of this course")
    return content


def _rows(content: dict[str, Any]) -> Iterator[dict[str, Any]]:
    for kind in KINDS:
        group = content.get(kind, {})
        if not (isinstance(group, dict) and all(isinstance(one, dict) for one in group.values())):
            raise ValueError(f"skipped: its {kind} have a form that is not ours")
        for key, entry in group.items():
            fields = {name: _cell(value) for name, value in entry.items()}
            yield fields | {"kind": NAMES[kind], "key": key, "right": _right(kind, entry)}


def _right(kind: str, entry: dict[str, Any]) -> bool | None:
    if kind == "predictions":
        answer, result = entry.get("answer"), entry.get("result")
        number = isinstance(result, int | float)
        return None if answer is None or result is None or number else bool(answer == result)
    right = entry.get("passed" if kind == "verdicts" else "right")
    return right if isinstance(right, bool) else None


def _cell(value: Any) -> Any:
    """A value as it stands in a cell of the table."""
    if isinstance(value, list):
        return words(value)
    return str(value) if isinstance(value, dict) else value


def _others(rows: list[dict[str, Any]]) -> list[str]:
    """What was recorded beside the usual, in the order in which it turns up."""
    return [name for name in dict.fromkeys(n for row in rows for n in row) if name not in FIRST]


def _log(log: Any) -> pd.DataFrame | None:
    if log is None:
        return None
    try:
        return pd.DataFrame(log["data"], columns=log["columns"])
    except (KeyError, TypeError, ValueError):
        raise ValueError("it has a form that is not ours") from None


def _said(answers: pd.Series) -> str:
    """The answers, the most frequent first; the median of numbers."""
    known = answers.dropna()
    if known.empty:
        return ""
    if all(isinstance(one, int | float) and not isinstance(one, bool) for one in known):
        return f"median {known.median():.4g}"
    counts = known.astype(str).value_counts().sort_index()
    counts = counts.sort_values(ascending=False, kind="stable")  # ties in the alphabet's order
    return ", ".join(f"{answer} {count}" for answer, count in counts.items())
