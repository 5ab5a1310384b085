"""Stop a student's code that runs for too long, wherever the course runs."""

import signal
import sys
import threading
import time
from contextlib import AbstractContextManager
from types import FrameType
from typing import Any

AGAIN = 0.1  # [s] until a timer that was swallowed by a bare `except:` comes again


class TooLongError(BaseException):
    """The time is over. Not an Exception, so that `except Exception:` does not swallow it."""


def deadline(seconds: float) -> AbstractContextManager[None]:
    """Raise TooLongError inside the block once it has run for so long.

    A timer's signal does it where there is one: in the main thread of a kernel on Linux or macOS.
    Elsewhere (Windows, another thread, Pyodide) each line of Python looks at the clock; what runs
    inside numpy is then not stopped before it returns, and a bare `except:` in a loop wins.
    """
    return Timer(seconds) if _has_timer() else Tracer(seconds)


def _has_timer() -> bool:
    main = threading.current_thread() is threading.main_thread()
    return main and hasattr(signal, "setitimer") and sys.platform != "emscripten"


class Timer:
    """A deadline by signal."""

    def __init__(self, seconds: float) -> None:
        self._seconds = seconds

    def __enter__(self) -> None:
        self._before = signal.signal(signal.SIGALRM, self._ring)
        signal.setitimer(signal.ITIMER_REAL, self._seconds, AGAIN)

    def __exit__(self, *_: object) -> None:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, self._before)

    def _ring(self, number: int, frame: FrameType | None) -> None:
        if frame is None or frame.f_code.co_filename != __file__:  # not while it is taken down
            raise TooLongError


class Tracer:
    """A deadline by looking at the clock at every line."""

    def __init__(self, seconds: float) -> None:
        self._end = time.monotonic() + seconds

    def __enter__(self) -> None:
        self._before = sys.gettrace()
        sys.settrace(self._look)

    def __exit__(self, *_: object) -> None:
        sys.settrace(self._before)

    def _look(self, frame: FrameType, event: str, arg: Any) -> Any:
        if time.monotonic() > self._end and frame.f_code.co_filename != __file__:
            raise TooLongError
        return self._look
