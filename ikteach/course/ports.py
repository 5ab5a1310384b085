"""What every server of ours is told on the command line, and what must hold before it starts."""

import argparse
import difflib
import errno
import importlib.util
import socket
from collections.abc import Iterable
from typing import Any


class Parser(argparse.ArgumentParser):
    """A parser that asks, of an option that it does not know, whether another was meant."""

    def parse_args(self, args: Any = None, namespace: Any = None) -> Any:
        """Read the command line, or end with a sentence and exit code 2."""
        options, unknown = self.parse_known_args(args, namespace)
        if unknown:
            known = [name for action in self._actions for name in action.option_strings]
            self.error(f"there is no place for {shown(unknown[0])}{meant(unknown[0], known)}")
        return options


def meant(word: str, known: Iterable[str]) -> str:
    """Ask for the known word that is most like another, or say nothing."""
    plain = {name.lstrip("-"): name for name in known}
    word = word.partition("=")[0].lstrip("-").lower()
    close = difflib.get_close_matches(word, plain, n=1, cutoff=0.75)
    return f"; did you mean {plain[close[0]]}?" if close else ""


def shown(word: str) -> str:
    """Quote a word of the command line, shortened."""
    return repr(word if len(word) <= 60 else f"{word[:59]}…")


def parse(parser: argparse.ArgumentParser, argv: list[str]) -> tuple[argparse.Namespace, list[str]]:
    """The options of `parser` and those of every server; and what the server's own program gets.

    The latter is what follows `--`.
    """
    parser.add_argument("--no-browser", action="store_true", help="print the address only")
    parser.add_argument("--port", metavar="N", type=port_number, help="use exactly this port")
    split = argv.index("--") if "--" in argv else len(argv)
    return parser.parse_args(argv[:split]), argv[split + 1 :]


def port_number(text: str) -> int:
    """A port from the command line."""
    if not (text.isascii() and text.isdecimal() and len(text) < 6 and 1 <= int(text) <= 65535):
        raise argparse.ArgumentTypeError(f"{shown(text)} is not a port; ports are 1 to 65535")
    return int(text)


def hindrance(server: str, module: str, extra: str, port: int | None) -> str:
    """Why `server` cannot be started, in a sentence; empty if nothing is known to hinder it.

    module, extra  that it is, and the extra of this package with which it is installed
    """
    if importlib.util.find_spec(module) is None:
        return f"{server} is not installed. Install it with: pip install 'ikteach[{extra}]'"
    if port is None:
        return ""
    try:
        socket.create_server(("127.0.0.1", port)).close()
    except OSError as error:
        taken = error.errno == errno.EADDRINUSE
        reason = str(error.strerror).partition(" (")[0]  # without the address that was tried
        problem = "is taken" if taken else f"cannot be used ({reason})"
        other = f"leave out --port to let {server} find a free one, or name another."
        return f"Port {port} {problem}; {other}"
    return ""
