"""What every server of ours is told on the command line, and what must hold before it starts."""

import argparse
import errno
import importlib.util
import socket

from ikteach.publish.parser import shown


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
