"""What a student has answered, in one file beside the notebook: `predictions.json`.

The file is read anew before each writing and replaced in one step, by one kernel after the other.
One that cannot be read is set aside, never overwritten; where nothing can be written, answers live
in memory and the course goes on.
"""

import json
import os
from datetime import UTC, datetime
from pathlib import Path
from threading import RLock
from typing import Any

from ikteach import files
from ikteach.course.notice import Notice

FILE = "predictions.json"
IN_CLASS = "in class"  # in the file: false of who is not to be counted before the class
ANSWER_KINDS = ("predictions", "verdicts", "quiz")
KEPT = "your answers are kept until the kernel stops."
LARGEST_ANSWERS = 50 * 2**20  # bytes of a file of answers; an exported log may be in it
MOST_ANSWERS = 5000  # answers of a kind
FIELDS = 100  # of an answer
LONGEST_FIELD = 2000  # letters of a field
LONGEST_SOURCE_FIELD = 20_000  # letters of an answer's source, kept whole or not at all

Entry = dict[str, Any]
Answers = dict[str, dict[str, Entry]]  # kind (one of ANSWER_KINDS) -> key -> entry

_lock = RLock()  # widgets may call from another thread
_unsaved: dict[Path, Answers] = {}  # what could not be written, per folder
_folder: Path | None = None


def home() -> Path:
    """Return the folder of the answers, the notebook's.

    It is the one in which the kernel was when it was first asked, wherever cells go later.
    """
    global _folder
    if _folder is None:
        try:
            _folder = Path.cwd()
        except OSError:  # it was removed under us
            return Path()
    return _folder


def entries(kind: str) -> dict[str, Entry]:
    """Read a copy of the entries of this kind, {key: entry}."""
    with _lock:
        answers, _ = _read(home())
        return answers.get(kind, {})


def entry(kind: str, key: str) -> Entry:
    """Read the entry of this key, empty if missing."""
    return entries(kind).get(key, {})


def store(kind: str, key: str, *, again: bool = False, **fields: Any) -> str:
    """Add these fields under the key, at once.

    Returns a sentence if something is amiss, else ''. `again` counts this as another try, in the
    field `tries`; the first was made at `since`.
    """
    folder = home()
    with _lock:
        try:
            with files.alone(folder / FILE):
                answers, trouble = _read(folder, set_aside=True)
                known = _add(answers, kind, key, fields, again)
                if not trouble or not os.path.lexists(folder / FILE):
                    files.write_whole(folder / FILE, _json(answers), overwrite=True)
                    _unsaved.pop(folder, None)
                    return trouble
        except OSError as error:
            answers, _ = _read(folder)
            known, trouble = _add(answers, kind, key, fields, again), f"{error}: {KEPT}"
        _unsaved.setdefault(folder, {}).setdefault(kind, {})[key] = known
        return trouble


def show_in_class(on: bool = True) -> Notice:
    """Choose whether the class's page may count your answers.

    It is kept with the answers: see `python -m ikteach class`. Nothing else changes.
    """
    folder = home()
    with _lock:
        try:
            with files.alone(folder / FILE):
                answers, trouble = _read(folder, set_aside=True)
                if trouble and os.path.lexists(folder / FILE):
                    raise OSError(trouble)
                content = answers | {IN_CLASS: bool(on)}
                files.write_whole(folder / FILE, _json(content), overwrite=True)
        except OSError as error:
            return Notice(f"Not changed: {error}.", "bad")
    counted = "are counted" if on else "are left out"
    return Notice(f"On the page before the class your answers {counted}. {trouble}".strip(), "good")


def export(path: str | os.PathLike[str], log: Any = None, *, overwrite: bool = False) -> Notice:
    """Write all answers, and a `log`, to a JSON file.

    A file that exists is left alone unless `overwrite`. Returns a sentence about the outcome.
    `pandas.read_json(io.StringIO(json.dumps(file["log"])), orient="split")` gives the log back.
    """
    target = Path(path)
    if log is not None and not hasattr(log, "to_json"):
        what = files.quoted(log)
        return Notice(f"Nothing written: `log` must be a DataFrame, not {what}.", "bad")
    if os.path.realpath(target) == os.path.realpath(home() / FILE):
        return Notice(f"Nothing written: {FILE} is where your answers live; name another.", "bad")
    with _lock:
        answers, trouble = _read(home())
    try:
        table = None if log is None else json.loads(log.to_json(orient="split", index=False))
    except (ValueError, OverflowError, RecursionError) as error:
        why = files.bounded(str(error))
        return Notice(f"Nothing written: `log` cannot be put into a file ({why}).", "bad")
    content = {**{kind: answers.get(kind, {}) for kind in ANSWER_KINDS}, "log": table}
    counted: Any = answers.get(IN_CLASS, True)
    content |= {} if counted else {IN_CLASS: False}
    try:
        files.write_whole(target, _json(content), overwrite=overwrite)
    except FileExistsError:
        hint = f"`export({str(path)!r}, …, overwrite=True)` replaces it"
        return Notice(f"{path} exists already and was left alone: {hint}.", "bad")
    except OSError as error:
        return Notice(f"{files.bounded(str(path))} could not be written: {error}.", "bad")
    counts = ", ".join(f"{len(answers.get(kind, {}))} {kind}" for kind in ANSWER_KINDS)
    rows = f", a log of {len(log)} rows" if log is not None else ""
    return Notice(f"Written to {path}: {counts}{rows}. {trouble}".strip(), "good")


def valid(answers: Any) -> Answers:
    """Check that answers have our form, or raise ValueError."""
    if not isinstance(answers, dict):
        raise ValueError("it holds no answers of this course")
    for kind in ANSWER_KINDS:
        group = answers.get(kind, {})
        if not isinstance(group, dict) or len(group) > MOST_ANSWERS:
            raise ValueError(f"its {kind} have a form that is not ours")
        for key, one in group.items():
            if not isinstance(one, dict) or len(one) > FIELDS or not _fit(one):
                raise ValueError(f"its {kind} have a form that is not ours, at {files.quoted(key)}")
    return answers


def _fit(entry: Entry) -> bool:
    tries = entry.get("tries", 0)
    return type(tries) is int and tries >= 0 and isinstance(entry.get("at", ""), str)


def _add(answers: Answers, kind: str, key: str, fields: Entry, again: bool) -> Entry:
    """Put the fields into the answers, and give the entry that they are now in."""
    group = answers.setdefault(kind, {})
    known = group.get(key, {})
    now = datetime.now(UTC).isoformat(timespec="seconds")
    first = {"since": known.get("since", now)}
    tries = first | {"tries": known.get("tries", 0) + 1} if again else {}
    new = {name: _brief(name, files.jsonable(value)) for name, value in fields.items()}
    group[key] = known | new | tries | {"at": now}
    return group[key]


def _brief(name: str, value: Any) -> Any:
    """Shorten what a file written anew at each answer cannot hold."""
    text = value if isinstance(value, str) else json.dumps(value)
    most = LONGEST_SOURCE_FIELD if name == "source" else LONGEST_FIELD
    return value if len(text) <= most else files.bounded(text, most)


def _read(folder: Path, *, set_aside: bool = False) -> tuple[Answers, str]:
    """Read the answers of the file and of memory, and any trouble."""
    path, answers, trouble = folder / FILE, {}, ""
    try:
        answers = valid(files.read_json(path, LARGEST_ANSWERS))
    except FileNotFoundError:
        pass
    except ValueError:  # not JSON, not UTF-8, or JSON of something else
        trouble = _set_aside(path) if set_aside else f"{FILE} is damaged and was left out."
    except OSError as error:
        trouble = f"{error}: {KEPT}"
    for kind, known in _unsaved.get(folder, {}).items():
        answers.setdefault(kind, {}).update(known)
    return answers, trouble


def _set_aside(path: Path) -> str:
    """Give a damaged file another name, so that it can be looked at, and say so."""
    names = (path.with_name(f"{path.stem}.damaged-{i}{path.suffix}") for i in range(1, 1000))
    beside = next(name for name in names if not os.path.lexists(name))
    try:
        os.rename(path, beside)
    except OSError as error:
        return f"{FILE} is damaged and cannot be set aside ({error.strerror}): {KEPT}"
    return f"{FILE} was damaged; it is now {beside.name}, and a new one was begun."


def _json(content: Any) -> str:
    return json.dumps(content, indent=1, ensure_ascii=False, allow_nan=False)
