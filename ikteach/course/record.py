"""What a student has answered, in one file beside the notebook: `predictions.json`.

The file is read anew before each writing and replaced in one step. One that cannot be read is set
aside, never overwritten; where nothing can be written, answers live in memory and the course goes
on.
"""

import json
import os
from datetime import UTC, datetime
from pathlib import Path
from threading import RLock
from typing import Any

from ikteach.course.notice import Notice

FILE = "predictions.json"
KINDS = ("predictions", "verdicts", "quiz")
KEPT = "your answers are kept until the kernel stops."

Entry = dict[str, Any]
Answers = dict[str, dict[str, Entry]]  # kind (one of KINDS) -> key -> entry

_lock = RLock()  # widgets may call from another thread
_unsaved: dict[Path, Answers] = {}  # what could not be written, per folder


def entries(kind: str) -> dict[str, Entry]:
    """Key -> entry of all that is known of this kind here; changing it changes nothing."""
    with _lock:
        answers, _ = _read(Path.cwd())
        return answers.get(kind, {})


def entry(kind: str, key: str) -> Entry:
    """What is known under this key; empty if nothing is."""
    return entries(kind).get(key, {})


def store(kind: str, key: str, **fields: Any) -> str:
    """Add these fields under the key, at once; a sentence if something is amiss, else ''."""
    folder = Path.cwd()
    with _lock:
        answers, trouble = _read(folder, set_aside=True)
        fields["at"] = datetime.now(UTC).isoformat(timespec="seconds")
        known = answers.setdefault(kind, {})
        known[key] = known.get(key, {}) | fields
        if not trouble or not _exists(folder / FILE):
            try:
                _write(folder / FILE, answers)
                _unsaved.pop(folder, None)
                return trouble
            except OSError as error:
                trouble = f"{trouble} {_unwritable(error)}".strip()
        mine = _unsaved.setdefault(folder, {}).setdefault(kind, {})
        mine[key] = known[key]
        return trouble


def export(path: str | os.PathLike[str], log: Any = None, *, overwrite: bool = False) -> Notice:
    """Write predictions, verdicts and quiz answers, and a `log` (a DataFrame), to one JSON file.

    A file that exists is left alone unless `overwrite`. Returns a sentence about what was done.
    `pandas.read_json(io.StringIO(json.dumps(file["log"])), orient="split")` gives the log back.
    """
    target = Path(path)
    if log is not None and not hasattr(log, "to_json"):
        return Notice(f"Nothing written: `log` must be a DataFrame, not {log!r}.", "bad")
    if target.resolve() == (Path.cwd() / FILE).resolve():
        return Notice(f"Nothing written: {FILE} is where your answers live; name another.", "bad")
    if _exists(target) and not overwrite:
        hint = f"`export({str(path)!r}, …, overwrite=True)` replaces it"
        return Notice(f"{path} exists already and was left alone: {hint}.", "bad")
    with _lock:
        answers, trouble = _read(Path.cwd())
    table = None if log is None else json.loads(log.to_json(orient="split", index=False))
    try:
        _write(target, {**{kind: answers.get(kind, {}) for kind in KINDS}, "log": table})
    except OSError as error:
        return Notice(f"{path} could not be written: {error.strerror or error}.", "bad")
    counts = ", ".join(f"{len(answers.get(kind, {}))} {kind}" for kind in KINDS)
    rows = f", a log of {len(log)} rows" if log is not None else ""
    return Notice(f"Written to {path}: {counts}{rows}. {trouble}".strip(), "good")


def _read(folder: Path, *, set_aside: bool = False) -> tuple[Answers, str]:
    """The answers of the file and of memory, and a sentence if the file is no good."""
    path, answers, trouble = folder / FILE, {}, ""
    try:
        answers = _valid(json.loads(path.read_text(encoding="utf-8")))
    except FileNotFoundError:
        pass
    except ValueError:  # not JSON, not UTF-8, or JSON of something else
        trouble = _set_aside(path) if set_aside else f"{FILE} is damaged and was left out."
    except OSError as error:
        trouble = f"{FILE} cannot be read ({error.strerror}): {KEPT}"
    for kind, known in _unsaved.get(folder, {}).items():
        answers.setdefault(kind, {}).update(known)
    return answers, trouble


def _valid(answers: Any) -> Answers:
    """The answers if they have the form that we write; ValueError if not."""
    if not isinstance(answers, dict):
        raise ValueError
    for group in answers.values():
        if not (isinstance(group, dict) and all(isinstance(one, dict) for one in group.values())):
            raise ValueError
    return answers


def _set_aside(path: Path) -> str:
    """Give a damaged file another name, so that it can be looked at, and say so."""
    names = (path.with_name(f"{path.stem}.damaged-{i}{path.suffix}") for i in range(1, 1000))
    beside = next(name for name in names if not _exists(name))
    try:
        os.rename(path, beside)
    except OSError as error:
        return f"{FILE} is damaged and cannot be set aside ({error.strerror}): {KEPT}"
    return f"{FILE} was damaged; it is now {beside.name}, and a new one was begun."


def _unwritable(error: OSError) -> str:
    return f"{FILE} cannot be written ({error.strerror or error}): {KEPT}"


def _exists(path: Path) -> bool:
    return os.path.lexists(path)


def _write(path: Path, content: Any) -> None:
    """Replace the file in one step: after a crash there is the old one or the new, never half."""
    draft = path.with_name(f".{path.name}.{os.getpid()}")
    try:
        draft.write_text(json.dumps(content, indent=1, ensure_ascii=False), encoding="utf-8")
        os.replace(draft, path)
    finally:
        draft.unlink(missing_ok=True)
