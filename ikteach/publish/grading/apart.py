"""The process in which an answer that somebody has handed in runs; never in ours.

This module is what that process runs. It reads requests from its standard input and writes plain
data (`carried`). Each answer runs in a fork of its own where there are forks, with these bounds:

    memory, processor time, size of files, open files, processes   resource limits (not on Windows)
    environment and working directory                              empty, and a folder of its own
    files, other processes, network, foreign functions             an audit hook says no
    the rest of the machine                                        bubblewrap, where it is installed

The hook stops what Python asks for; who finds a hole in the interpreter is stopped by bubblewrap.
"""

import builtins
import contextlib
import os
import pickle
import struct
import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np

from ikteach.publish.grading.carried import packed

MORE_MEMORY = 2**30  # bytes beyond those that the imports have taken
PROCESSOR = 120  # [s] of an answer
WRITTEN = 2**20  # bytes of a file
LARGEST_REQUEST = 2**30  # bytes of a request
SIZE = struct.Struct(">Q")
SECRET = ("ikteach.course.solutions", "ikteach.course.exercises")
HIDDEN = [Path(__file__).parents[2] / "course" / name for name in ("solutions", "exercises")]
WRITING = os.O_WRONLY | os.O_RDWR | os.O_APPEND | os.O_CREAT | os.O_TRUNC
# What no answer needs, by the beginning of the event's name.
REFUSED = (
    "subprocess.", "os.system", "os.exec", "os.fork", "os.posix_spawn", "os.spawn", "os.startfile",
    "os.kill", "os.killpg", "os.remove", "os.rename", "os.rmdir", "os.mkdir", "os.link",
    "os.symlink", "os.truncate", "os.chmod", "os.chown", "os.chflags", "os.utime", "os.setxattr",
    "os.putenv", "shutil.", "socket.", "ctypes.", "signal.pthread_kill", "mmap.", "urllib.",
    "ftplib.", "smtplib.", "webbrowser.", "pty.", "winreg.", "msvcrt.", "tempfile.", "sqlite3.",
    "sys.addaudithook", "resource.", "syslog.", "fcntl.",
)  # fmt: skip


def send(stream: BinaryIO, data: bytes) -> None:
    """Write one message to an unbuffered stream."""
    left = memoryview(SIZE.pack(len(data)) + data)
    while left:
        left = left[stream.write(left) :]


def receive(stream: BinaryIO, most: int) -> bytes:
    """Read one message; EOFError, or ValueError if too long."""
    (size,) = SIZE.unpack(_read(stream, SIZE.size))
    if size > most:
        raise ValueError(f"a message of {size} bytes")
    return _read(stream, size)


def _read(stream: BinaryIO, size: int) -> bytes:
    parts = []
    while size > 0:
        part = stream.read(min(size, 2**20))
        if not part:
            raise EOFError
        parts.append(part)
        size -= len(part)
    return b"".join(parts)


def main() -> None:
    """Serve answers, each in a fork, until there are no more."""
    requests, replies = _streams()
    send(replies, b"ready")
    while True:
        try:
            source = receive(requests, LARGEST_REQUEST).decode()
        except EOFError:
            return
        if not hasattr(os, "fork"):
            _serve(source, requests, replies)
            return
        if child := os.fork():
            os.waitpid(child, 0)
            send(replies, b"ended")
        else:
            with contextlib.suppress(BaseException):
                _serve(source, requests, replies)
            os._exit(0)


def _streams() -> tuple[Any, Any]:
    """Take standard input and output for messages alone; what is printed goes nowhere."""
    # Unbuffered, so that a fork and its parent may read by turns.
    requests = os.fdopen(os.dup(0), "rb", buffering=0)
    replies = os.fdopen(os.dup(1), "wb", buffering=0)
    for number, way in ((0, os.O_RDONLY), (1, os.O_WRONLY), (2, os.O_WRONLY)):
        nowhere = os.open(os.devnull, way)
        os.dup2(nowhere, number)
        os.close(nowhere)
    return requests, replies


def _serve(source: str, requests: BinaryIO, replies: BinaryIO) -> None:
    """Bind the answer of the source, then answer calls of it."""
    functions: list[Callable[..., Any]] = []
    names: dict[str, Any] = {"__name__": "__main__"}
    sys.argv = [""]
    _limit()
    sys.addaudithook(guard(os.getcwd()))

    def bind() -> Any:
        exec(compile(source, "<answer>", "exec"), names)
        if "answer" not in names:
            raise NameError("it binds no answer")
        return names["answer"]

    send(replies, _tried(bind, functions))
    while (request := pickle.loads(receive(requests, LARGEST_REQUEST))) is not None:
        at, arguments = request
        given = pickle.loads(pickle.dumps(arguments))
        reply = _tried(partial(functions[at], *given), functions)
        changed = [
            i for i, pair in enumerate(zip(arguments, given, strict=True)) if not unchanged(*pair)
        ]
        send(replies, b"changed %d" % changed[0] if changed else reply)


def _tried(act: Callable[[], Any], functions: list[Callable[..., Any]]) -> bytes:
    """Give the outcome, or what was raised, as a message."""
    try:
        return b"is " + packed(act(), functions)
    except BaseException as error:
        known = [kind for kind in type(error).__mro__ if vars(builtins).get(kind.__name__) is kind]
        try:
            said = str(error)[:1000]
        except BaseException:
            said = ""
        return b"raised " + packed([type(error).__name__, known[0].__name__, said], [])


def unchanged(before: Any, after: Any) -> bool:
    """Tell whether an argument is as it was."""
    if hasattr(before, "equals"):
        return bool(before.equals(after))
    return bool(np.array_equal(before, after, equal_nan=np.asarray(before).dtype.kind == "f"))


def _limit() -> None:
    """Bound what this process may take."""
    try:
        import resource
    except ImportError:  # Windows
        return
    taken = 0
    with contextlib.suppress(OSError, ValueError):
        pages = int(Path("/proc/self/statm").read_text().split()[0])
        taken = pages * resource.getpagesize()
    for what, most in (
        ("RLIMIT_AS", taken + MORE_MEMORY),
        ("RLIMIT_CPU", PROCESSOR),
        ("RLIMIT_FSIZE", WRITTEN),
        ("RLIMIT_NOFILE", 64),
        ("RLIMIT_NPROC", 0),
        ("RLIMIT_CORE", 0),
    ):
        with contextlib.suppress(OSError, ValueError, AttributeError):
            number = getattr(resource, what)
            hard = resource.getrlimit(number)[1]
            most = most if hard == resource.RLIM_INFINITY else min(most, hard)
            resource.setrlimit(number, (most, most))


def guard(home: str) -> Callable[[str, tuple[Any, ...]], None]:
    """Make the hook that refuses all files outside of `home`.

    Everything that it uses is bound here, where an answer cannot put another in its place.
    """
    hidden = tuple(os.path.realpath(folder) for folder in HIDDEN)
    real, text, error, start = os.path.realpath, os.fsdecode, PermissionError, str.startswith
    writing, refused, secret = WRITING, REFUSED, SECRET
    is_a, kinds = isinstance, (str, bytes)

    def look(event: str, arguments: tuple[Any, ...]) -> None:
        if start(event, refused):
            raise error(f"an answer may not do this ({event})")
        if event == "import" and start(arguments[0], secret):
            raise error("an answer may not read the solutions")
        if event == "open" and is_a(arguments[0], kinds):
            place, way = real(text(arguments[0])), arguments[2]
            if start(place, hidden):
                raise error("an answer may not read the solutions")
            if way & writing and not start(place, home):
                raise error("an answer may not write files")

    return look


if __name__ == "__main__":
    main()
