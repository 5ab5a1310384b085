"""A session as two files: settings, figure and events in JSON, the numbers of every tick in CSV.

Both can be read by eye and by any program; `description` and `table` know their contents.
"""

import csv
import json
import os
import re
from contextlib import suppress
from pathlib import Path
from secrets import token_hex
from typing import Any

from ikteach.files import (
    bounded,
    drafted,
    publish,
    quoted,
    read_json,
    read_text,
    taken,
    write_whole,
)
from ikteach.formats import description
from ikteach.formats import table as numbers
from ikteach.motion.live.log import Log
from ikteach.motion.live.session import Session

FORMAT, VERSION = "ikteach session", 1
LARGEST_JSON = 64 * 2**20  # [bytes] of the JSON file


def save(
    path: str | os.PathLike[str], run: Log | Session, *, overwrite: bool = False
) -> tuple[Path, Path]:
    """Write the run to two files, and return both paths.

    They are <path>.json and <path>.csv. FileExistsError where one of them is there already, unless
    `overwrite`; ValueError for a run that could not be read back; OSError where nothing can be
    written. The new run is there from the moment on at which <path>.json is replaced, and until
    then the old one. If <path>.csv cannot be replaced, as another program has it open, the numbers
    stay in a file named <path>-xxxxxxxx.csv.
    """
    log = run.log() if isinstance(run, Session) else run
    description.check_writable(log)
    settings, table = _pair(path)
    if not settings.parent.is_dir():
        raise FileNotFoundError(f"there is no folder {quoted(settings.parent)} to save in")
    for file in (settings, table):
        if os.path.lexists(file) and not overwrite:
            raise taken(file)
    fresh = table.with_name(f"{table.stem[:50]}-{token_hex(4)}.csv")
    head = {"format": FORMAT, "version": VERSION, "numbers": table.name, "written": fresh.name}
    content = json.dumps(head | description.describe(log), indent=1, ensure_ascii=False) + "\n"
    before = _unsettled(settings)
    try:
        with drafted(fresh) as draft, draft.open("w", newline="", encoding="utf-8") as out:
            csv.writer(out).writerows(numbers.rows(log))
        if fresh.stat().st_size > numbers.LARGEST_TABLE or len(content.encode()) > LARGEST_JSON:
            raise ValueError(
                "the run is too large to be read back: save its last ticks, log(last=…)"
            )
        write_whole(settings, content, overwrite=overwrite)
    except BaseException:
        with suppress(OSError):
            fresh.unlink()
        raise
    with suppress(OSError):
        publish(fresh, table, overwrite=overwrite)
    with suppress(OSError):
        if before is not None:
            before.unlink()
    return settings, fresh if fresh.exists() else table


def load(path: str | os.PathLike[str]) -> Log:
    """Read the run that `save` has written.

    `path` is that of the JSON file, or without its ending. All of it is checked before anything is
    made of it. FileNotFoundError and ValueError say which file is missing, of another kind, or what
    in it is wrong; OSError where it cannot be read.
    """
    file, given = _described(path)
    try:
        rows = description.field(given, "rows", int)
        facts = description.log_facts(given)
        table = _table(file, given)
    except (ValueError, LookupError) as error:
        raise ValueError(f"{quoted(file.name)} is damaged: {bounded(str(error))}") from None
    try:
        return numbers.read_log(table, rows, facts)
    except FileNotFoundError:
        raise FileNotFoundError(
            f"{quoted(file.name)} has its numbers in {quoted(table)}, which is missing"
        ) from None
    except ValueError as error:
        raise ValueError(f"{quoted(table.name)} is damaged: {bounded(str(error))}") from None


def _pair(path: str | os.PathLike[str]) -> tuple[Path, Path]:
    path = Path(path)
    stem = path.with_suffix("") if path.suffix in (".json", ".csv") else path
    if not stem.name:
        raise ValueError(f"a session needs a file name, and {quoted(path)} has none")
    return stem.with_name(f"{stem.name}.json"), stem.with_name(f"{stem.name}.csv")


def _described(path: str | os.PathLike[str]) -> tuple[Path, dict[str, Any]]:
    """Read the JSON file that `path` means."""
    path = Path(path)
    file, _ = _pair(path)
    try:
        given = read_json(file, LARGEST_JSON)
    except FileNotFoundError:
        if os.path.isfile(path):
            raise ValueError(
                f"{quoted(path.name)} is not a session: {_other(path, file)}"
            ) from None
        raise FileNotFoundError(f"there is no session {quoted(file)}") from None
    except ValueError as error:
        raise ValueError(f"{quoted(file.name)} is not a session: {error}") from None
    name = quoted(file.name)
    if not isinstance(given, dict) or given.get("format") != FORMAT:
        raise ValueError(f"{name} is not a session: it does not say 'format': {FORMAT!r}")
    if given.get("version") != VERSION:
        version = quoted(given.get("version"))
        raise ValueError(f"{name} is of version {version}, and this reads {VERSION}")
    return file, given


def _other(path: Path, file: Path) -> str:
    """Say what a file is that has no settings beside it."""
    try:
        read_text(path, LARGEST_JSON)
    except ValueError as error:
        return str(error)
    return f"there is no {quoted(file.name)} beside it, which `save` would have written"


def _table(file: Path, given: dict[str, Any]) -> Path:
    """Find the table of numbers, beside the JSON file and nowhere else.

    `written` is its name until it gets the one that it keeps, `numbers`.
    """
    for name in (given.get("written", ""), description.field(given, "numbers", str)):
        if name == "" or not isinstance(name, str):
            continue
        if re.search(r"[/\\:\0]", name) or name in (".", "..") or len(name.encode()) > 255:
            raise ValueError(f"its numbers are in {quoted(name)}, which is no file beside it")
        table = file.with_name(name)
        if table.is_file():
            break
    else:
        if not name:
            raise ValueError("'numbers' is empty")
    return table


def _unsettled(settings: Path) -> Path | None:
    """Find the table of an earlier run that lacks its final name."""
    try:
        file, given = _described(settings)
        table = _table(file, given)
        return table if table.name == given.get("written") else None
    except (OSError, ValueError):
        return None
