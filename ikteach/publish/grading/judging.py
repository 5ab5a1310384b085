"""Judge an answer again from its source, in a process that cannot reach ours.

The check runs here, the answer there (`apart`): a check calls the answer through a pipe, and plain
data comes back. So an answer can neither change what judges it nor read what is wanted.
"""

import builtins
import os
import pickle
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from ikteach.course import checking
from ikteach.course.checking import Exercise, Verdict, find, judge
from ikteach.course.deadline import TooLongError
from ikteach.course.forms import WrongError
from ikteach.files import bounded
from ikteach.publish.grading.apart import (
    DONE,
    ENDED,
    INSTALLED,
    LARGEST_REPLY,
    READABLE,
    receive,
    send,
)
from ikteach.publish.grading.carried import unpacked
from ikteach.publish.parser import RefusedError

STARTING = 60.0  # [s] until Python runs and has its imports
PATIENCE = 3.0  # times the seconds of the exercise: a machine that judges a class is a busy one
SECRET = [INSTALLED / "course" / name for name in ("solutions", "exercises")]
# Where people keep what is theirs; of what lies there an answer sees Python and the packages.
PRIVATE = ["/home", "/media", "/mnt", "/root", "/run", "/srv", "/tmp", "/var", str(Path.home())]
MODULE = "ikteach.publish.grading.apart"

checking.OURS.add(__file__)  # no line of a student's


class Judging:
    """Judges answers, each in a process of its own.

    hidden  folders that no answer may see, where bubblewrap is installed: what was handed in
    walls   what stands between the answers and this machine, in words
    """

    def __init__(self, hidden: Path | None = None) -> None:
        self._hidden = [*SECRET, *([hidden] if hidden else [])]
        self._bubble = bubblewrap()
        self._process: Any = None
        self._late = self._asked = False
        self._folder = tempfile.mkdtemp(prefix="ikteach-answer-")

    @property
    def walls(self) -> str:
        """Say what keeps answers off this machine."""
        limits = "a process per answer, limits, an audit hook"
        if self._bubble:
            return f"{limits}; bubblewrap: files read-only and those of people hidden, no network"
        root = " and not as root, who has no limit of processes" if is_root() else ""
        return f"{limits}; no bubblewrap here, so grade strangers' answers in a container{root}"

    def __enter__(self) -> "Judging":
        return self

    def __exit__(self, *_: object) -> None:
        self._stop()
        shutil.rmtree(self._folder, ignore_errors=True)

    def verdict(self, key: str, source: str) -> Verdict:
        """Judge a source that binds `answer`; LookupError for the key."""
        task = find(key)
        task = task._replace(seconds=PATIENCE * task.seconds, drawn=None)
        with self._answer(task, source) as (answer, trouble):
            verdict = Verdict(key, False, trouble) if trouble else judge(task, answer)
        return verdict

    @contextmanager
    def _answer(self, task: Exercise, source: str) -> Iterator[tuple[Any, str]]:
        """Start the answer; give it, or why there is none."""
        if self._process is None:
            self._start()
        self._late = False
        watch = self._watch(task.seconds + 2)
        whole = False
        try:
            try:
                self._ask(source.encode("utf-8", "replace"))
                answer, trouble = self._reply("the answer"), ""
            except TooLongError:
                answer, trouble = None, f"It was stopped after {task.seconds:g} seconds."
            except BaseException as error:
                if isinstance(error, KeyboardInterrupt) and not _raised_there(error):
                    raise
                answer, trouble = None, f"Its cell cannot be run: {_told(error)}."
            yield answer, trouble
            with suppress(OSError, EOFError, ValueError, AttributeError):
                if not self._asked:  # else a part of a reply may be on its way
                    self._ask(DONE)
                    whole = receive(self._process.stdout, len(ENDED)) == ENDED
        finally:
            watch.cancel()
            if not whole:
                self._stop()

    def call(self, name: str, at: int, arguments: Any) -> Any:
        """Call a function of the answer."""
        self._ask(pickle.dumps((at, arguments)))
        return self._reply(name)

    def _ask(self, data: bytes) -> None:
        self._asked = True
        with suppress(OSError, AttributeError):  # it has ended: so will the reply
            send(self._process.stdin, data)

    def _reply(self, name: str) -> Any:
        """Read the outcome of a call: a value, or what was raised."""
        try:
            data = receive(self._process.stdout, LARGEST_REPLY)
            self._asked = False
            word, _, rest = data.partition(b" ")
            if word in (b"is", b"raised"):
                value = unpacked(rest, lambda name, at: Remote(self, name, at))
        except (OSError, EOFError, ValueError, AttributeError):
            word = b""
        if self._late:
            raise TooLongError
        if word == b"is":
            return value
        if word == b"changed":
            place = rest.decode("ascii", "replace")[:3]
            number = int(place) + 1 if place.isdigit() else 1
            raise WrongError(f"`{name}` changed its argument {number}: work on a copy of it.")
        if word == b"raised":
            raise _error(value)
        raise WrongError(
            f"`{name}` ended its process: by its own wish, or it took too much memory or too long."
        )

    def _start(self) -> None:
        environment = {"PYTHONPATH": str(INSTALLED.parent), "HOME": self._folder, "PATH": ""}
        environment |= {"LANG": "C.UTF-8", "PYTHONDONTWRITEBYTECODE": "1", "TMPDIR": self._folder}
        environment |= {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}
        if root := os.environ.get("SYSTEMROOT"):  # Windows starts nothing without it
            environment["SYSTEMROOT"] = root
        python = [sys.executable, "-s", "-P", "-m", MODULE]
        self._process = subprocess.Popen(
            [*self._walled(), *python],
            bufsize=0,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            cwd=self._folder,
            env=environment,
            start_new_session=True,
        )
        watch, word = self._watch(STARTING), b""
        with suppress(OSError, EOFError, ValueError):
            word = receive(self._process.stdout, 10)
        watch.cancel()
        if word != b"ready":  # no answer has run yet: nobody's mark may hang on this
            self._stop()
            raise RefusedError(f"No process for answers can be started with {sys.executable}.")

    def _watch(self, seconds: float) -> threading.Timer:
        watch = threading.Timer(seconds, self._too_late)
        watch.daemon = True
        watch.start()
        return watch

    def _walled(self) -> list[str]:
        if not self._bubble:
            return []
        walls = [self._bubble, "--ro-bind", "/", "/", "--dev", "/dev", "--proc", "/proc"]
        walls += ["--unshare-all", "--die-with-parent"]
        needed = sorted(
            {way(Path(one)) for one in READABLE for way in (Path.absolute, Path.resolve)}
        )
        private = {Path(one).resolve() for one in PRIVATE if os.path.isdir(one)} - {Path("/")}
        for folder in sorted(private):
            walls += ["--tmpfs", str(folder)]
        for path in needed:
            if not private.isdisjoint([path, *path.parents]):
                walls += ["--ro-bind", str(path), str(path)]
        for folder in (one.resolve() for one in self._hidden if one.is_dir()):
            if not any(one.is_relative_to(folder) for one in needed):
                walls += ["--tmpfs", str(folder)]
        return [*walls, "--bind", self._folder, self._folder, "--chdir", self._folder]

    def _too_late(self) -> None:
        self._late = True
        self._kill()

    def _kill(self) -> None:
        process = self._process
        if process is not None and process.poll() is None:
            with suppress(OSError):
                if hasattr(os, "killpg"):
                    os.killpg(process.pid, signal.SIGKILL)
                else:
                    process.kill()

    def _stop(self) -> None:
        """End the process; the next answer gets another, and an empty folder."""
        if self._process is not None:
            self._kill()
            self._process.wait()
            for stream in (self._process.stdin, self._process.stdout):
                with suppress(OSError):
                    stream.close()
            self._process = None


class Remote:
    """Stands here for a function of an answer, which runs there."""

    def __init__(self, judging: Judging, name: str, at: int) -> None:
        self._judging, self._at = judging, at
        self.__name__ = name or "answer"

    def __call__(self, *arguments: Any) -> Any:
        """Call it there."""
        return self._judging.call(self.__name__, self._at, arguments)


def is_root() -> bool:
    """Tell whether limits of processes do not count here."""
    return getattr(os, "geteuid", lambda: 1)() == 0


def bubblewrap() -> str:
    """Find the program bwrap; '' where it cannot be used."""
    program = shutil.which("bwrap") or ""
    if program:
        tried = [program, "--ro-bind", "/", "/", "--dev", "/dev", "--proc", "/proc"]
        done = subprocess.run([*tried, "--unshare-all", "true"], capture_output=True, check=False)
        program = program if done.returncode == 0 else ""
    return program


def _error(value: Any) -> BaseException:
    """Make of a name, a kind and words the exception that was raised there."""
    match value:
        case [str(name), str(base), str(words)]:
            kind = vars(builtins).get(base)
            if isinstance(kind, type) and issubclass(kind, BaseException):
                with suppress(Exception):
                    made: BaseException = type(bounded(name, 60), (kind,), {})(words)
                    return made
            return Exception(f"{name}: {words}")
    return Exception("something that has no name")


def _raised_there(error: BaseException) -> bool:
    return type(error) is not KeyboardInterrupt


def _told(error: BaseException) -> str:
    words = str(error).strip().rstrip(".")
    told = words if isinstance(error, WrongError) else f"{type(error).__name__}: {words}"
    return bounded(" ".join(told.split()), 300)
