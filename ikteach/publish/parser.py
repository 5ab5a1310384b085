"""The command line of every command: options, and refusals in a sentence."""

import argparse
import difflib
from collections.abc import Iterable
from typing import Any

from ikteach.checks import shown


class RefusedError(Exception):
    """A refusal of a command; the message says why."""


class Parser(argparse.ArgumentParser):
    """A parser that asks whether another option was meant."""

    def parse_args(self, args: Any = None, namespace: Any = None) -> Any:
        """Read the command line, or end with exit code 2."""
        options, unknown = self.parse_known_args(args, namespace)
        if unknown:
            known = [name for action in self._actions for name in action.option_strings]
            self.error(f"there is no place for {shown(unknown[0])}{meant(unknown[0], known)}")
        return options


def meant(word: str, known: Iterable[str]) -> str:
    """Ask for the known word most like another.

    Empty if none is like it.
    """
    plain = {name.lstrip("-"): name for name in known}
    word = word.partition("=")[0].lstrip("-").lower()
    close = difflib.get_close_matches(word, plain, n=1, cutoff=0.75)
    return f"; did you mean {plain[close[0]]}?" if close else ""
