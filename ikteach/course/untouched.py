"""Run a student's code, and leave the session as it was before."""

import builtins
import io
import math
import os
import random
import sys
import time
import warnings
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from types import ModuleType
from typing import Any

import numpy as np

from ikteach.course.deadline import shielded

# What is put back if an answer has put something else in its place; and our own, but the figures.
MODULES = (builtins, math, random, time, np, np.linalg, np.random)
FIGURES = "ikteach.view"
PRINTED = 10_000  # letters that a check may print


@contextmanager
def restoring() -> Iterator[None]:
    """Restore, when the block ends, the session as it was.

    That is the working directory, the environment, the import path, the streams, the states of
    random numbers, numpy's way of printing and the recursion limit. What is printed in the block is
    passed on, up to `PRINTED` letters.
    """
    streams, path = (sys.stdin, sys.stdout, sys.stderr), list(sys.path)
    environment, limit = dict(os.environ), sys.getrecursionlimit()
    chance, numpys = random.getstate(), np.random.get_state()  # noqa: NPY002  of any age
    folder = None
    with suppress(OSError):  # of one that is gone
        folder = os.getcwd()
    sys.stdout, sys.stderr = Bounded(sys.stdout), Bounded(sys.stderr)
    try:
        with np.printoptions():
            yield
    finally:
        sys.setrecursionlimit(limit)
        sys.stdin, sys.stdout, sys.stderr = streams
        sys.path[:] = path
        if dict(os.environ) != environment:
            os.environ.clear()
            os.environ.update(environment)
        if folder is not None:
            with suppress(OSError):
                os.chdir(folder)
        random.setstate(chance)
        np.random.set_state(numpys)  # noqa: NPY002


class Unpatched:
    """Restores names of `MODULES` and ours, numpy's errors and warnings.

    So that whoever judges what the block has made finds `numpy` as it was.
    """

    @shielded
    def __enter__(self) -> None:
        self._inside = ExitStack()
        self._inside.enter_context(np.errstate(all="ignore"))
        self._inside.enter_context(warnings.catch_warnings())
        warnings.simplefilter("ignore")
        self._names = [(vars(module), dict(vars(module))) for module in (*MODULES, *_ours())]
        if (shell := ipython()) is not None:
            shell.ask_exit = _leave  # exit() would end the kernel

    @shielded
    def __exit__(self, *_: object) -> None:
        for now, before in self._names:
            for name, value in before.items():
                if now.get(name) is not value:
                    now[name] = value
        if (shell := ipython()) is not None:
            vars(shell).pop("ask_exit", None)
        self._inside.close()


def ipython() -> Any:
    """Return the IPython in which this runs, or None."""
    module = sys.modules.get("IPython")
    return module.get_ipython() if module is not None else None


def _ours() -> list[ModuleType]:
    """List the modules that judge, and those that a check compares with."""
    names = [n for n in sys.modules if n.startswith("ikteach.") and not n.startswith(FIGURES)]
    return [sys.modules[name] for name in names]


def _leave() -> None:
    raise SystemExit


class Bounded(io.TextIOBase):
    """Passes text on until it becomes too much."""

    def __init__(self, to: Any) -> None:
        self._to, self._left = to, PRINTED

    def write(self, text: str) -> int:
        """Pass on as much as may be printed; drop more."""
        if self._left > 0 and self._to is not None:
            self._to.write(text[: self._left])
            self._left -= len(text)
            if self._left <= 0:
                self._to.write(" … (what else it prints is left out)\n")
        return len(text)

    def flush(self) -> None:
        """Pass that on too."""
        if self._to is not None:
            self._to.flush()
