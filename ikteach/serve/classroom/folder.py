"""The answers of a class as they come in: a folder of files that others write.

A student is a folder in it, with `predictions.json` in it or one below, as homes on a hub have, or
a file `NAME.json`. Nothing in there is trusted. Links are not followed, large files not read, and
what cannot be read just now, because it is half written, stands as it was before.
"""

import os
import stat
import sys
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any, NamedTuple

from ikteach.course.record import FILE, IN_CLASS, Entry, valid
from ikteach.files import bounded, json_of

LARGEST = 4 * 2**20  # bytes of a file of answers
STUDENTS, PLACES = 1000, 60  # folders that are looked into: in all, and of a student
KEYS, LONGEST = 300, 200  # answers of a kind, and letters of each text in them
LISTED = 20  # options of an order
FIELDS = {
    "predictions": ("answer", "result", "at"),
    "verdicts": ("passed", "sentence", "tries", "since", "at"),
}
LINK = "it is a link, and leads elsewhere"

Answers = dict[str, dict[str, Entry]]  # kind (of `FIELDS`) -> key -> entry
Place = tuple[str, ...]  # of a file: names of folders, and its own


class Seen(NamedTuple):
    """What is in a file.

    sign      changes when the file does
    answers   None where none were ever read
    counted   whether the student wants to be counted
    trouble   why it could not be read, or ""
    """

    sign: tuple[int, ...]
    answers: Answers | None = None
    counted: bool = True
    trouble: str = ""


class ClassFolder:
    """The answers in a folder; only what changed is read.

    reads  how many files were read until now
    """

    def __init__(self, folder: Path) -> None:
        if not folder.is_dir():
            raise NotADirectoryError(f"{folder} is not a folder")
        self.folder, self.reads = folder.resolve(), 0
        self._seen: dict[Place, Seen] = {}
        self.troubles: dict[str, str] = {}

    def look(self) -> dict[str, Answers]:
        """Read what has changed, and give {student: answers}.

        Of an answer in several files the newest counts. `troubles` says what could not be read.
        """
        self.troubles, found, left_out = {}, dict[str, Answers](), set[str]()
        known, self._seen = self._seen, {}
        for student, place, info in self._places():
            seen = self._seen[place] = self._read(place, info, known.get(place, Seen(())))
            if seen.trouble:
                self.troubles["/".join(place)] = seen.trouble
            if not seen.counted:
                left_out.add(student)
            if seen.answers is not None:
                _merge(found.setdefault(student, {kind: {} for kind in FIELDS}), seen.answers)
        return {name: answers for name, answers in found.items() if name not in left_out}

    def _places(self) -> Iterator[tuple[str, Place, os.stat_result]]:
        """Find the files: student, place, and what the system says of it."""
        for one in self._entries(self.folder, STUDENTS):
            if _is_folder(one):
                for place in self._of_student(one):
                    with suppress(OSError):  # most have none there
                        info = os.stat(self.folder.joinpath(*place), follow_symlinks=False)
                        yield one.name, place, info
            elif one.name.lower().endswith(".json"):
                with suppress(OSError):
                    yield one.name[:-5], (one.name,), one.stat(follow_symlinks=False)

    def _of_student(self, home: os.DirEntry[str]) -> Iterator[Place]:
        yield home.name, FILE
        for one in self._entries(Path(home.path), PLACES):
            if _is_folder(one):
                yield home.name, one.name, FILE

    def _entries(self, folder: Path, most: int) -> list[os.DirEntry[str]]:
        """List what is in a folder, without what is hidden."""
        try:
            with os.scandir(folder) as entries:
                seen = sorted((e for e in entries if e.name[0] != "."), key=lambda e: e.name)
        except OSError as error:
            self.troubles[folder.name] = f"it cannot be read ({error.strerror})"
            return []
        if len(seen) > most:
            self.troubles[folder.name] = f"{len(seen) - most} of its entries are left out"
        return seen[:most]

    def _read(self, place: Place, info: os.stat_result, before: Seen) -> Seen:
        """Read a file, unless it is as it was."""
        sign = info.st_mtime_ns, info.st_size, info.st_ino
        if sign == before.sign:
            return before
        self.reads += 1
        try:
            content = valid(json_of(open_within(self.folder, place)))
            if not content.keys() & (FIELDS.keys() | {"quiz", IN_CLASS}):
                raise ValueError("it holds no answers of this course")
            counted: Any = content.get(IN_CLASS, True)
            return Seen(sign, _kept(content), counted is not False)
        except (OSError, ValueError) as error:
            return before._replace(sign=sign, trouble=bounded(str(error), LONGEST))


def open_within(folder: Path, place: Place) -> bytes:
    """Read a file below a folder, through no link.

    OSError or ValueError says why it cannot be read, also of one that has more than `LARGEST`.
    """
    if sys.platform == "win32":  # has no way to open a file in an open folder
        path = folder.joinpath(*place)
        if path.resolve() != path:
            raise OSError(LINK)
        return _whole(os.open(path, os.O_RDONLY | os.O_BINARY))
    here = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    for i, name in enumerate(place, start=1):
        kind = os.O_NONBLOCK if i == len(place) else os.O_DIRECTORY
        try:
            there = os.open(name, os.O_RDONLY | os.O_NOFOLLOW | kind, dir_fd=here)
        except OSError as error:
            raise OSError(_reason(error, folder, place[:i])) from None
        finally:
            os.close(here)
        here = there
    return _whole(here)


def _reason(error: OSError, folder: Path, place: Place) -> str:
    link = os.path.islink(folder.joinpath(*place))
    return LINK if link else f"it cannot be read ({error.strerror})"


def _whole(opened: int) -> bytes:
    with os.fdopen(opened, "rb") as file:
        info = os.fstat(file.fileno())
        if not stat.S_ISREG(info.st_mode):  # a pipe would never end
            raise OSError("it is not an ordinary file")
        if info.st_size > LARGEST:
            raise ValueError(f"it has {info.st_size / 2**20:.0f} MB, more than {LARGEST >> 20}")
        return file.read(LARGEST)


def _kept(content: dict[str, Any]) -> Answers:
    """Keep of the answers what the page needs, bounded."""
    return {
        kind: {
            bounded(key, LONGEST): {name: _brief(entry.get(name)) for name in fields}
            for key, entry in list(content.get(kind, {}).items())[:KEYS]
        }
        for kind, fields in FIELDS.items()
    }


def _brief(value: Any) -> Any:
    if isinstance(value, str):
        return bounded(value, LONGEST)
    if isinstance(value, list):
        return [bounded(str(one), LONGEST) for one in value[:LISTED]]
    return value if isinstance(value, bool | int | float) else None


def _merge(into: Answers, new: Answers) -> None:
    for kind, entries in new.items():
        for key, entry in entries.items():
            old = into[kind].get(key)
            if old is None or str(old["at"] or "") <= str(entry["at"] or ""):
                into[kind][key] = entry


def _is_folder(entry: os.DirEntry[str]) -> bool:
    try:
        return entry.is_dir(follow_symlinks=False)
    except OSError:  # on a disk in a network, which has to ask
        return False
