"""Stop a student's code that runs for too long, wherever the course runs."""

import signal
import sys
import threading
from collections.abc import Callable
from contextlib import AbstractContextManager
from time import monotonic  # by name, so that nobody can put another in its place
from types import CodeType, FrameType
from typing import Any, TypeVar

AGAIN = 0.1  # [s] until a timer that was swallowed by a bare `except:` comes again
AT_ONCE = 1e-4  # [s] the same, when it has been swallowed some times
SWALLOWED = 3  # times

OLD = sys.version_info < (3, 12)  # `while True: pass` in one line is then a line but once
SOUND = ("ikteach.", "numpy.")  # modules without such a line

F = TypeVar("F", bound=Callable[..., Any])

_shielded: set[CodeType] = set()


class TooLongError(BaseException):
    """The end of the time.

    Not an Exception, so that `except Exception:` does not swallow it.
    """


def shielded(function: F) -> F:
    """Let a function of ours end, whatever the time."""
    _shielded.add(function.__code__)
    return function


def deadline(seconds: float) -> AbstractContextManager[None]:
    """Raise TooLongError inside the block after some seconds.

    A timer's signal does it where there is one: in the main thread of a kernel on Linux or macOS.
    Elsewhere (Windows, another thread, Pyodide) each line of Python looks at the clock; what runs
    inside numpy is then not stopped before it returns, and a bare `except:` in a loop wins. Code
    that ends the process (`os._exit`) or takes the timer away is stopped by nobody.
    """
    return Timer(seconds) if _has_timer() else Tracer(seconds)


def _has_timer() -> bool:
    main = threading.current_thread() is threading.main_thread()
    return main and hasattr(signal, "setitimer") and sys.platform != "emscripten"


def _may_stop(frame: FrameType | None) -> bool:
    """Whether the code of this frame, and of all that called it, may be left where it is."""
    if frame is not None and frame.f_code.co_filename == __file__:
        return False
    while frame is not None:
        if frame.f_code in _shielded:
            return False
        frame = frame.f_back
    return True


class Timer:
    """A deadline by signal."""

    def __init__(self, seconds: float) -> None:
        self._seconds, self._rung = seconds, 0

    def __enter__(self) -> None:
        self._before = signal.signal(signal.SIGALRM, self._ring)
        signal.setitimer(signal.ITIMER_REAL, self._seconds, AGAIN)

    def __exit__(self, *_: object) -> None:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, self._before)

    def _ring(self, number: int, frame: FrameType | None) -> None:
        if not _may_stop(frame):
            return
        self._rung += 1
        if self._rung == SWALLOWED:  # so often that one comes between an `except:` and the next try
            signal.setitimer(signal.ITIMER_REAL, AT_ONCE, AT_ONCE)
        raise TooLongError


class Tracer:
    """A deadline by looking at the clock at every line."""

    def __init__(self, seconds: float) -> None:
        self._end = monotonic() + seconds

    def __enter__(self) -> None:
        self._before = sys.gettrace()
        sys.settrace(self._look)

    def __exit__(self, *_: object) -> None:
        sys.settrace(self._before)

    def _look(self, frame: FrameType, event: str, arg: Any) -> Any:
        if OLD and not str(frame.f_globals.get("__name__")).startswith(SOUND):
            frame.f_trace_opcodes = True
        if monotonic() > self._end and _may_stop(frame):
            raise TooLongError
        return self._look
