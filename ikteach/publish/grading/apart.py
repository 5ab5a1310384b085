"""The process in which an answer that somebody has handed in runs; never in ours.

This module is what that process runs. It reads requests from its standard input and writes plain
data (`carried`). Each answer runs in a fork of its own where there are forks, and speaks with the
judge only through the process that has forked it, which passes on one reply to each request. So an
answer leaves nothing behind for the next one. It is bounded:

    memory, processor time, size of files, open files, processes   resource limits (not on Windows)
    environment and working directory                              empty, and a folder of its own
    files, other processes, network, foreign functions             an audit hook says no
    the rest of the machine                                        bubblewrap, where it is installed

The hook stops what Python asks for; who finds a hole in the interpreter is stopped by bubblewrap.
"""

import builtins
import contextlib
import ctypes
import importlib
import os
import pickle
import signal
import struct
import sys
from collections.abc import Callable, Iterable
from functools import partial
from itertools import count
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np

from ikteach.publish.grading.carried import packed

MORE_MEMORY = 2**30  # bytes beyond those that the imports have taken
PROCESSOR = 120  # [s] of an answer
WRITTEN = 2**20  # bytes of a file
MOST_WRITTEN = 50  # files and folders
LARGEST_REQUEST = 2**30  # bytes of a request
LARGEST_REPLY = 2**23  # bytes
SIZE = struct.Struct(">Q")
DONE, ENDED, GONE = b"", b"ended", b"gone"  # the judge is; the answer has; before it replied
INSTALLED = Path(__file__).parents[2]
# What an answer may read: Python, the packages, and what these need.
READABLE = [sys.prefix, sys.base_prefix, str(INSTALLED), str(Path(np.__file__).parents[1])]
DEVICES = ("/dev/null/", "/dev/urandom/", "/usr/share/zoneinfo/")
SECRET = ("ikteach.course.solutions", "ikteach.course.exercises")
STARTING = "_posixsubprocess"  # starts programs, and the hook is not asked
# Nothing that has this in its path; the last three would hide it.
HIDDEN = ("/course/solutions/", "/course/exercises/", "/../", "/./", "//")
WRITING = os.O_WRONLY | os.O_RDWR | os.O_APPEND | os.O_CREAT | os.O_TRUNC
FILES = ("open", "os.listdir", "os.scandir", "os.mkdir")
# What else an answer may do, by the beginning of the event's name: a list of what it may not do
# would have holes.
ALLOWED = (
    "array.", "builtins.", "code.", "compile", "exec", "function.", "glob.", "import", "marshal.",
    "object.", "os.chdir", "os.walk", "pathlib.", "pickle.find_class", "sys._getframe",
    "sys.excepthook", "sys.unraisablehook", "time.", "_thread.",
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
    with contextlib.suppress(EOFError):
        while True:
            source = receive(requests, LARGEST_REQUEST).decode()
            if not hasattr(os, "fork"):  # Windows: the judge starts another process for the next
                return _serve(source, requests, replies)
            _serve_in_a_fork(source, requests, replies)
            send(replies, ENDED)


def _serve_in_a_fork(source: str, requests: BinaryIO, replies: BinaryIO) -> None:
    """Pass on requests and replies by turns until the judge is done."""
    theirs, ours = _pipe(), _pipe()
    if not (child := os.fork()):
        for stream in (requests, replies, theirs[1], ours[0]):
            stream.close()
        _end_with_parent()
        with contextlib.suppress(BaseException):
            _serve(source, theirs[0], ours[1])
        os._exit(0)
    theirs[0].close()
    ours[1].close()
    try:
        send(replies, _reply(ours[0]))
        while (request := receive(requests, LARGEST_REQUEST)) != DONE:
            with contextlib.suppress(OSError):  # it has ended: so will the reply
                send(theirs[1], request)
            send(replies, _reply(ours[0]))
    finally:
        os.kill(child, signal.SIGKILL)
        os.waitpid(child, 0)
        theirs[1].close()
        ours[0].close()


def _pipe() -> tuple[Any, Any]:
    """Make a pipe, unbuffered: what reads and what writes."""
    reads, writes = os.pipe()
    return os.fdopen(reads, "rb", buffering=0), os.fdopen(writes, "wb", buffering=0)


def _reply(stream: BinaryIO) -> bytes:
    try:
        return receive(stream, LARGEST_REPLY)
    except (OSError, EOFError, ValueError):
        return GONE


def _end_with_parent() -> None:
    """Have Linux kill this process with its parent, also where it has left the session."""
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(1, signal.SIGKILL)  # PR_SET_PDEATHSIG


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
    _start_no_programs()
    sys.addaudithook(guard(os.getcwd()))

    def bind() -> Any:
        exec(compile(source, "<answer>", "exec"), names)
        if "answer" not in names:
            raise NameError("it binds no answer")
        return names["answer"]

    send(replies, _tried(bind, functions))
    while (request := receive(requests, LARGEST_REQUEST)) != DONE:
        at, arguments = pickle.loads(request)
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


def _start_no_programs() -> None:
    """Leave `subprocess` to be imported, and take away what it starts programs with."""
    with contextlib.suppress(ImportError):  # Windows
        subprocess: Any = importlib.import_module("subprocess")
        starting: Any = importlib.import_module(STARTING)
        starting.fork_exec = subprocess._fork_exec = None


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
    """Make the hook that refuses what no answer needs.

    Everything that it uses is bound here, where an answer cannot put another in its place; and of
    a path it looks at the letters alone, as the functions of `os.path` can be changed.
    """
    own = _letters([home])
    read = own + _letters(READABLE) + DEVICES
    listed = read + _letters(sys.path)
    written = own + DEVICES[:1]
    files, hidden, allowed, secret = FILES, HIDDEN, ALLOWED, (*SECRET, STARTING)
    writing, writes, most, after = WRITING, count(1), MOST_WRITTEN, next
    error, kind, word, encoded, number = PermissionError, type, str, bytes, int
    start, lower, turned, text = str.startswith, str.lower, str.replace, bytes.decode

    def look(event: str, arguments: tuple[Any, ...]) -> None:
        if event in files:
            place = arguments[0]
            if kind(place) is number:  # it is open already
                return
            if kind(place) is encoded:
                place = text(place, "utf-8", "surrogateescape")
            place = turned(lower(place), "\\", "/") + "/" if kind(place) is word else ""
            write = event == "os.mkdir" or (event == "open" and arguments[2] & writing)
            if write and after(writes) > most:
                raise error("an answer may not write so many files")
            if not start(place, written if write else read if event == "open" else listed):
                raise error(f"an answer may not {'write' if write else 'read'} files")
            for part in hidden:
                if part in place:
                    raise error("an answer may not read the solutions")
        elif event == "import" and start(arguments[0], secret):
            raise error(f"an answer may not import {arguments[0]}")
        elif event == "object.__getattr__" and kind(arguments[1]) is word:
            if arguments[1] == "tb_frame":  # it may be one of this function, with its names
                raise error("an answer may not look at frames of errors")
        elif not start(event, allowed):
            raise error(f"an answer may not do this ({event})")

    return look


def _letters(folders: Iterable[str]) -> tuple[str, ...]:
    """Write folders as `look` compares them: as they are called, and as they are."""
    ways = {way(one) for one in folders for way in (os.path.abspath, os.path.realpath)}
    return tuple(f"{one.lower().replace(os.sep, '/').rstrip('/')}/" for one in ways)


if __name__ == "__main__":
    main()
