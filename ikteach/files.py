"""Files, read and checked whole, written whole or not at all.

Whoever reads a file of somebody else's learns in one bounded sentence why it is unfit, before
anything is made of it. Whoever writes one writes a draft, `.NAME.xxxxxxxx.part` in the same folder,
which gets the name in one step: until then the old file is there, and from then on the new one.
"""

import json
import os
import re
import reprlib
import secrets
import stat
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from errno import EINVAL, ENOSYS, ENOTSUP
from math import isfinite
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

Name = str | os.PathLike[str]
Result = TypeVar("Result")

DEEPEST = 60  # levels of lists and dictionaries in a file that we read
LEFT_BEHIND = 3600.0  # [s] a draft that nobody has touched for so long is nobody's
PATIENCE = 5.0  # [s] to wait for another process
ABANDONED = 2.0  # [s] without a change, after which a lock by name is taken for left behind

HALF = re.compile("[\ud800-\udfff]")  # half of a character beyond U+FFFF, which stands for none

# What other files begin with.
SIGNS = {
    b"\x1f\x8b": "a gzip archive; unpack it first",
    b"PK": "a zip archive or a spreadsheet; unpack it, or save the sheet as CSV",
    b"\xd0\xcf\x11\xe0": "a spreadsheet; save it as CSV",
    b"\x89PNG": "a picture",
    b"%PDF": "a PDF",
    b"RIFF": "a movie",
    b"GIF8": "a movie",
    b"HIERARCHY": "motion capture, a BVH file",
    b"<robot": "a robot, a URDF file",
    b"<?xml": "XML, as a URDF file is",
    b"<!--": "XML, as a URDF file is",
    b"<!DOCTYPE html": "a web page",
}

_short = reprlib.Repr()
_short.maxstring = _short.maxother = 150
_short.maxlong = 40


def quoted(value: Any) -> str:
    """Give `repr(value)`, shortened to fit into a sentence."""
    try:
        return bounded(_short.repr(str(value) if isinstance(value, Path) else value), 200)
    except Exception:  # of an object whose repr fails, or a number of too many digits
        return f"<{type(value).__name__}>"


def bounded(words: str, most: int = 400) -> str:
    """Shorten a text to `most` letters, leaving out its middle."""
    half = (most - 3) // 2
    short = words if len(words) <= most else f"{words[:half]} … {words[-half:]}"
    return whole_characters(short)


def whole_characters(text: str) -> str:
    """Replace half characters, which can be written nowhere."""
    return HALF.sub("?", text)


# Reading.


def read_text(path: Name, most: int) -> str:
    """Read a text file of at most `most` bytes.

    In UTF-8 or, with its mark, in UTF-16. ValueError says "it is …", for a sentence that begins
    with the file's name; OSError where it cannot be read at all.
    """
    return text_of(read_bytes(path, most))


def text_of(data: bytes) -> str:
    """Decode a text file; ValueError as `read_text`."""
    for sign, what in SIGNS.items():
        if data[:200].lstrip(b"\xef\xbb\xbf \t\r\n").startswith(sign):
            raise ValueError(f"it is {what}")
    wide = data.startswith((b"\xff\xfe", b"\xfe\xff"))  # "Unicode text" of a spreadsheet
    try:
        text = data.decode("utf-16" if wide else "utf-8-sig")
    except UnicodeDecodeError:
        raise ValueError("it is not text in UTF-8") from None
    if "\0" in text:
        raise ValueError("it is not text")
    return text


def read_bytes(path: Name, most: int) -> bytes:
    """Read a file; ValueError beyond `most` bytes, OSError."""
    path = Path(path)
    try:
        info, data = os.stat(path), b""
        if stat.S_ISREG(info.st_mode) and info.st_size <= most:  # a pipe would never end
            with _patiently(lambda: open(path, "rb")) as file:
                data = file.read(info.st_size)
    except (FileNotFoundError, ValueError):  # the latter of a name that no file can have
        raise FileNotFoundError(f"there is no file {quoted(path)}") from None
    except OSError as error:
        raise _said(error, path, "read") from None
    if stat.S_ISDIR(info.st_mode):
        raise IsADirectoryError(f"{bounded(path.name, 80)} cannot be read (it is a folder)")
    if not stat.S_ISREG(info.st_mode):
        raise OSError(f"{bounded(path.name, 80)} cannot be read (it is not an ordinary file)")
    if info.st_size > most:
        raise ValueError(f"it has {info.st_size / 2**20:,.0f} MB, more than {most / 2**20:,.0f}")
    return data


def read_json(path: Name, most: int) -> Any:
    """Read a JSON file of at most `most` bytes.

    NaN and Infinity come as text. All its numbers are finite, its texts can be written again, and
    it is not nested deeper than `DEEPEST`. ValueError says "it is …", OSError as `read_text`.
    """
    return json_of(read_bytes(path, most))


def json_of(data: bytes) -> Any:
    """Decode a JSON file; all as `read_json` says."""
    text = text_of(data)
    try:
        content = json.loads(text, parse_constant=str, parse_float=_number, parse_int=_whole)
    except json.JSONDecodeError as error:
        raise ValueError(f"it is not JSON (line {error.lineno}: {error.msg})") from None
    except RecursionError:
        raise ValueError("it is damaged: it is nested too deep") from None
    _check_sound(content)
    return content


def _number(digits: str) -> float:
    if not isfinite(number := float(digits)):
        raise ValueError(f"it is damaged: {quoted(digits)} is too large for a number")
    return number


def _whole(digits: str) -> int:
    _number(digits)
    return int(digits)


def _check_sound(content: Any) -> None:
    level = [content]
    for _ in range(DEEPEST):
        inside: list[Any] = []
        for value in level:
            if isinstance(value, dict):
                inside += [*value.keys(), *value.values()]
            elif isinstance(value, list):
                inside += value
            elif isinstance(value, str) and HALF.search(value):
                raise ValueError(f"it is damaged: {ascii(value)[:60]} has half a character")
        if not (level := inside):
            return
    raise ValueError("it is damaged: it is nested too deep")


# Writing.


def jsonable(value: Any) -> Any:
    """Make a value that every reader of JSON reads.

    Without NaN, and in Python's own types. Arrays become lists, and anything unknown to JSON
    becomes a text of at most 400 letters.
    """
    if isinstance(value, np.ndarray | np.generic):
        value = value.tolist()
    if isinstance(value, dict):
        return {bounded(str(name)): jsonable(one) for name, one in value.items()}
    if isinstance(value, list | tuple):
        return [jsonable(one) for one in value]
    if isinstance(value, bool) or value is None:
        return value
    if isinstance(value, int | float) and abs(value) < 1e300:  # neither NaN nor infinite
        return value
    try:
        text = str(value)
        return whole_characters(text) if isinstance(value, str) else bounded(text)
    except Exception:  # an object that cannot be told in words
        return quoted(value)


def write_whole(path: Name, content: str | bytes, *, overwrite: bool = False) -> None:
    """Write a file in one step; FileExistsError unless `overwrite`."""
    with drafted(path, overwrite=overwrite) as draft:
        draft.write_bytes(content.encode() if isinstance(content, str) else content)


@contextmanager
def drafted(path: Name, *, overwrite: bool = False) -> Iterator[Path]:
    """Give a draft that becomes `path` when the block ends.

    Otherwise it is removed. FileExistsError if there is a file of that name, unless `overwrite`;
    OSError if it cannot be written, and then the old one is as it was.
    """
    path = Path(os.path.realpath(path))  # of a link, what it leads to
    draft = path.with_name(f".{path.name[:50]}.{secrets.token_hex(4)}.part")
    try:
        _check_place(path, overwrite)
        _sweep(path)
        os.close(os.open(draft, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o666))
        yield draft
        publish(draft, path, overwrite=overwrite)
    except OSError as error:
        if error.errno is None or error.filename not in (None, str(draft), str(path)):
            raise  # it is a sentence already, or not about this file
        raise _said(error, path, "written") from None
    finally:
        with suppress(OSError):
            draft.unlink()


def taken(path: Path) -> FileExistsError:
    """Say that there is such a file."""
    return FileExistsError(
        f"there is a file {quoted(path)} already; overwrite=True would replace it"
    )


def _check_place(path: Path, overwrite: bool) -> None:
    if not path.parent.is_dir():
        raise FileNotFoundError(f"there is no folder {quoted(path.parent)} to write in")
    if os.path.lexists(path):
        if not overwrite:
            raise taken(path)
        if not path.is_file():
            raise IsADirectoryError(f"{path.name} cannot be written (it is not an ordinary file)")
        if not os.access(path, os.W_OK):
            raise PermissionError(f"{path.name} cannot be written (it is read-only)")


def publish(draft: Path, path: Path, *, overwrite: bool) -> None:
    """Give the draft its name, in one step.

    The errors are those of `drafted`.
    """
    file = os.open(draft, os.O_RDWR)
    try:
        os.fsync(file)  # a full disk in the network is told of only here
    except OSError as error:
        if error.errno not in (EINVAL, ENOSYS, ENOTSUP):
            raise
    finally:
        os.close(file)
    if overwrite:
        if path.exists():
            with suppress(OSError):
                os.chmod(draft, stat.S_IMODE(path.stat().st_mode))
        _patiently(lambda: os.replace(draft, path))
        return
    try:
        if sys.platform == "win32":
            os.rename(draft, path)  # refuses where there is one
        else:
            os.link(draft, path)
            os.unlink(draft)
    except FileExistsError:
        raise taken(path) from None
    except OSError:  # no links on this disk
        if os.path.lexists(path):
            raise taken(path) from None
        os.replace(draft, path)


def _sweep(path: Path) -> None:
    """Remove drafts of this file whose writer was ended long ago."""
    begins = f".{path.name[:50]}."
    with suppress(OSError):
        for entry in os.scandir(path.parent):
            if entry.name.startswith(begins) and entry.name.endswith(".part"):
                with suppress(OSError):
                    if time.time() - entry.stat().st_mtime > LEFT_BEHIND:
                        os.unlink(entry)


def _patiently(act: Callable[[], Result]) -> Result:
    """Do it; on Windows again for a while, where another program has the file open just now."""
    end = time.monotonic() + 1.0
    while True:
        try:
            return act()
        except PermissionError:
            if sys.platform != "win32" or time.monotonic() > end:
                raise
            time.sleep(0.01)


def _said(error: OSError, path: Path, done: str) -> OSError:
    """Make the same error, of Python's own kind, with a sentence."""
    kind = next(one for one in type(error).__mro__ if one.__module__ == "builtins")
    assert issubclass(kind, OSError)
    return kind(f"{bounded(path.name, 80)} cannot be {done} ({error.strerror or error})")


# Taking turns.


@contextmanager
def alone(path: Name) -> Iterator[None]:
    """Let one process after the other change `path`.

    Each must ask here. TimeoutError if another one does not come to an end; OSError if nothing can
    be written there. The lock is the system's, so that it ends with whoever holds it; where there
    is none (in the browser, on some disks in a network), it is a file that only one can make.
    """
    path = Path(path)
    lock = path.with_name(f".{path.name}.lock")
    try:
        file = os.open(lock, os.O_CREAT | os.O_RDWR, 0o666)
    except OSError as error:
        raise _said(error, path, "written") from None
    try:
        system = _wait(lambda: _lock(file), path)
        made = lock.with_suffix(".made")
        if not system:
            watch = _Watch(made)
            _wait(watch.make, path)
        try:
            yield
        finally:
            if system:
                _unlock(file)
            else:
                with suppress(OSError):
                    made.unlink()
    finally:
        os.close(file)


def _wait(act: Callable[[], Result], path: Path) -> Result:
    """Try until no other process is in the way."""
    end = time.monotonic() + PATIENCE
    while True:
        try:
            return act()
        except (BlockingIOError, FileExistsError):
            if time.monotonic() > end:
                raise TimeoutError(
                    f"{path.name} cannot be written (another notebook holds it)"
                ) from None
            time.sleep(0.002)


def _lock(file: int) -> bool:
    """Lock an open file; False where the system has no locks, BlockingIOError if it is locked."""
    try:
        if sys.platform == "win32":
            import msvcrt

            os.lseek(file, 0, os.SEEK_SET)
            msvcrt.locking(file, msvcrt.LK_NBLCK, 1)
        else:
            import fcntl

            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        raise
    except PermissionError:  # Windows says so
        raise BlockingIOError from None
    except (OSError, ImportError, AttributeError):
        return False
    return True


def _unlock(file: int) -> None:
    if sys.platform == "win32":
        import msvcrt

        os.lseek(file, 0, os.SEEK_SET)
        msvcrt.locking(file, msvcrt.LK_UNLCK, 1)
    else:
        import fcntl

        fcntl.flock(file, fcntl.LOCK_UN)


class _Watch:
    """Makes a file that only one can make, and removes one that was left behind by a kill.

    That it was is seen by its not changing while we look: the clocks of two machines may differ.
    """

    def __init__(self, made: Path) -> None:
        self._made, self._seen, self._since = made, 0, time.monotonic()

    def make(self) -> None:
        try:
            os.close(os.open(self._made, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o666))
        except FileExistsError:
            with suppress(OSError):
                if (seen := self._made.stat().st_mtime_ns) != self._seen:
                    self._seen, self._since = seen, time.monotonic()
                elif time.monotonic() - self._since > ABANDONED:
                    self._made.unlink()
            raise
