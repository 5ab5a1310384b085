"""The answers of a class: `python -m ikteach collect FOLDER` makes one table of many files.

A file is what `export` has written, or a student's `predictions.json`. The student is the file's
name, or for files in folders the name of the outermost one, as a learning platform hands them out.
Nothing is changed, and nothing is passed over in silence: what cannot be read is named.
"""

import os
import re
import sys
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import pandas as pd

from ikteach.course.questions import written
from ikteach.course.record import ANSWER_KINDS, LARGEST_ANSWERS, valid
from ikteach.files import bounded, read_json, whole_characters, write_whole
from ikteach.publish.parser import Parser, RefusedError

UNTOLD = {"source", "seen"}  # of a verdict: text to judge it again by, and marks for hints
NAMES = dict(zip(ANSWER_KINDS, ("prediction", "exercise", "quiz"), strict=True))
SKIPPED = 3  # the exit code when all went well, but for files that were left out
COLUMNS = 200  # of a log, and of the table
SAID = 8  # answers that the summary names
# Where a spreadsheet takes a text for a formula: at its beginning, and after what may begin a cell.
FORMULA = re.compile(r"(^|(?<=[\t\r\n;]))(?=\s*[=+\-@＝＋－＠])|^(?=[\t\r\n])")
NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?")
LEADING = ["student", "file", "kind", "key", "answer", "result", "right", "tries", "late", "at"]


class Collected(NamedTuple):
    """The answers that were found.

    table    a row for each student, file, kind and key: `LEADING`, then whatever else was recorded;
             `right` is None for a number that was predicted, and where no result was shown
    logs     the exported logs, one below the other, with student and file in front
    skipped  {file: why it, or its log, was left out}
    """

    table: pd.DataFrame
    logs: pd.DataFrame
    skipped: dict[str, str]


def collect(folder: Path) -> Collected:
    """Read every file of answers in the folder and below."""
    if not folder.is_dir():
        raise NotADirectoryError(f"{folder} is not a folder")
    rows: list[dict[str, Any]] = []
    logs: list[pd.DataFrame] = []
    skipped: dict[str, str] = {}
    for path, hindrance in files_of(folder, (".json", ".zip")):
        name = path.relative_to(folder)
        student = name.parts[0] if len(name.parts) > 1 else name.stem
        who = {"student": whole_characters(student), "file": whole_characters(str(name))}
        try:
            if hindrance:
                raise ValueError(hindrance)
            content = valid(read_json(path, LARGEST_ANSWERS))
            if not content.keys() & set(ANSWER_KINDS):
                raise ValueError("it holds no answers of this course")
            found = [row | who for row in _rows(content)]
        except (OSError, ValueError) as error:
            skipped[str(name)] = f"skipped: {bounded(str(error))}"
            continue
        rows += found
        try:
            log = _log(content.get("log"))
        except ValueError as error:
            skipped[str(name)] = f"its answers are in the table, its log is not: {error}"
        else:
            if log is not None:
                logs.append(pd.concat([pd.DataFrame(who, index=log.index), log], axis=1))
    table = pd.DataFrame(rows, columns=[*LEADING, *_others(rows)], dtype=object)
    together = pd.concat(logs, ignore_index=True) if logs else pd.DataFrame()
    return Collected(table, together, skipped)


def summarise(table: pd.DataFrame) -> pd.DataFrame:
    """Summarise the answers, a row per question.

    How many answered, how many are right, their answers. Of a student who handed in several files
    the newest answer counts.
    """
    in_time = table.sort_values("at", kind="stable", na_position="first")
    newest = in_time.drop_duplicates(["student", "kind", "key"], keep="last")
    rows = {}
    for (key, kind), group in newest.groupby(["key", "kind"]):
        judged = group["right"].dropna().astype(float)
        share = f"{judged.mean():.0%}" if len(judged) else "–"
        answered = len(group) if kind == "exercise" else group["answer"].count()
        rows[key, kind] = {"answered": answered, "right": share, "said": _said(group["answer"])}
    index = pd.MultiIndex.from_tuples(list(rows), names=["key", "kind"])
    return pd.DataFrame(list(rows.values()), index=index if rows else None)


def main(argv: list[str]) -> int:
    """Collect the answers; give the exit code."""
    parser = Parser(
        prog="python -m ikteach collect",
        description="One table of all predictions, checks and quiz answers in FOLDER: files that "
        "`export` wrote, or predictions.json.",
        epilog="Exit code: 0 if all was read, 3 if files were left out, which are named, 1 if "
        "there was nothing to read or a table could not be written.",
        allow_abbrev=False,
    )
    parser.add_argument("folder", metavar="FOLDER", type=Path)
    parser.add_argument("--table", metavar="CSV", type=Path, help="write the table there")
    parser.add_argument("--logs", metavar="CSV", type=Path, help="write the exported logs there")
    options = parser.parse_args(argv)
    outputs = {name: path for name in ("table", "logs") if (path := getattr(options, name))}
    for path in outputs.values():
        if os.path.lexists(path):
            raise RefusedError(f"{path} exists already and was left alone; name another file.")
    if len(set(map(os.path.realpath, outputs.values()))) < len(outputs):
        raise RefusedError("The table and the logs need two files.")
    try:
        found = collect(options.folder.expanduser())
    except NotADirectoryError as error:
        raise RefusedError(f"{error}.") from None
    for name, why in found.skipped.items():
        print(shown_text(f"{name}: {why}"), file=sys.stderr)
    if found.table.empty:
        raise RefusedError(f"There are no answers in {options.folder}.")
    count = found.table[["student", "file"]].nunique()
    print(f"{len(found.table)} answers of {count['student']} students in {count['file']} files")
    print(shown_text(summarise(found.table).to_string()))
    for name, path in outputs.items():
        try:
            write_whole(path, harmless(getattr(found, name)).to_csv(index=False))
        except OSError as error:
            raise RefusedError(f"{error}.") from None
        print(f"written: {path}")
    return SKIPPED if found.skipped else 0


def harmless(table: pd.DataFrame) -> pd.DataFrame:
    """Make a table in which nothing is a spreadsheet's formula.

    An apostrophe stands before each text that would be one. Numbers stay as they are, and so do
    texts that are one, such as "-0.5".
    """
    return table.rename(columns=_text).map(_text)


def _text(cell: Any) -> Any:
    if not isinstance(cell, str) or NUMBER.fullmatch(cell):
        return cell
    return FORMULA.sub("'", cell)


def shown_text(text: str) -> str:
    """Make of a text what a terminal may show."""
    return "".join(one if one.isprintable() or one == "\n" else "�" for one in text)


def files_of(folder: Path, endings: tuple[str, ...]) -> Iterator[tuple[Path, str]]:
    """Find the files with these endings, with any hindrance."""
    unreadable: list[OSError] = []
    for place, folders, names in os.walk(folder, onerror=unreadable.append):
        folders[:] = sorted(name for name in folders if not name.startswith("."))
        for name in sorted(names):
            path = Path(place, name)
            if name.startswith(".") or path.suffix.lower() not in endings:
                continue
            link = "it is a link, and leads elsewhere" if path.is_symlink() else ""
            packed = "unpack it first" if path.suffix.lower() == ".zip" else ""
            yield path, link or packed
        for name in folders:
            if os.path.islink(os.path.join(place, name)):
                yield Path(place, name), "it is a link, and leads elsewhere"
    for error in unreadable:
        yield Path(error.filename), f"it cannot be read ({error.strerror})"


def _rows(content: dict[str, Any]) -> Iterator[dict[str, Any]]:
    for kind in ANSWER_KINDS:
        for key, entry in content.get(kind, {}).items():
            told = ((name, value) for name, value in entry.items() if name not in UNTOLD)
            fields = {bounded(name, 60): _cell(value) for name, value in told}
            yield fields | {"kind": NAMES[kind], "key": key, "right": _right(kind, entry)}


def _right(kind: str, entry: dict[str, Any]) -> bool | None:
    if kind == "predictions":
        answer, result = entry.get("answer"), entry.get("result")
        number = isinstance(result, int | float)
        return None if answer is None or result is None or number else bool(answer == result)
    right = entry.get("passed" if kind == "verdicts" else "right")
    return right if isinstance(right, bool) else None


def _cell(value: Any) -> Any:
    """Make a value fit for a cell of the table."""
    if isinstance(value, list | str):
        return written(value)
    return bounded(str(value)) if isinstance(value, dict) else value


def _others(rows: list[dict[str, Any]]) -> list[str]:
    """List further fields that were recorded, in order of appearance."""
    names = dict.fromkeys(name for row in rows for name in row)
    return [name for name in names if name not in LEADING][:COLUMNS]


def _log(log: Any) -> pd.DataFrame | None:
    """Tabulate an exported log; ValueError if it has another form."""
    if log is None:
        return None
    match log:
        case {"columns": [*columns], "data": [*data]} if len(columns) <= COLUMNS:
            names = [str(name) for name in columns]
            of_its_own = set(names) - {"student", "file"}
            if len(of_its_own) == len(names) and all(map(partial(_fills, len(names)), data)):
                return pd.DataFrame([list(map(_cell, row)) for row in data], columns=names)
    raise ValueError("it has a form that is not ours")


def _fills(width: int, row: Any) -> bool:
    return isinstance(row, list) and len(row) == width


def _said(answers: pd.Series) -> str:
    """Tell the answers, the most frequent first, or their median."""
    known = answers.dropna()
    if known.empty:
        return ""
    if all(isinstance(one, int | float) and not isinstance(one, bool) for one in known):
        return f"median {known.astype(float).median():.4g}"
    counts = known.map(lambda answer: bounded(str(answer), 60)).value_counts().sort_index()
    counts = counts.sort_values(ascending=False, kind="stable")  # ties in the alphabet's order
    more = [f"and {len(counts) - SAID} other answers"] if len(counts) > SAID else []
    return ", ".join([f"{answer} {count}" for answer, count in counts[:SAID].items()] + more)
