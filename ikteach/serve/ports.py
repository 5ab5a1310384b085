"""Options that every server of ours takes, and what must hold before it starts."""

import argparse
import errno
import importlib.util
import socket

from ikteach.checks import shown
from ikteach.publish.parser import RefusedError


def options(
    parser: argparse.ArgumentParser, argv: list[str]
) -> tuple[argparse.Namespace, list[str]]:
    """Read the options of `parser` and of every server.

    Give them, and the words after `--`, which are for the server's own program.
    """
    parser.add_argument("--no-browser", action="store_true", help="print the address only")
    parser.add_argument("--port", metavar="N", type=port_number, help="use exactly this port")
    split = argv.index("--") if "--" in argv else len(argv)
    return parser.parse_args(argv[:split]), argv[split + 1 :]


def port_number(text: str) -> int:
    """Read a port from the command line."""
    if not (text.isascii() and text.isdecimal() and len(text) < 6 and 1 <= int(text) <= 65535):
        raise argparse.ArgumentTypeError(f"{shown(text)} is not a port; ports are 1 to 65535")
    return int(text)


def check_server(server: str, module: str, extra: str, port: int | None) -> None:
    """Refuse a server that lacks its package or port.

    module, extra  its module, and the extra of this package with which it is installed
    """
    if importlib.util.find_spec(module) is None:
        install = f"pip install 'ikteach[{extra}]'"
        raise RefusedError(f"{server} is not installed. Install it with: {install}")
    if port is None:
        return
    try:
        socket.create_server(("127.0.0.1", port)).close()
    except OSError as error:
        taken = error.errno == errno.EADDRINUSE
        reason = str(error.strerror).partition(" (")[0]  # without the address that was tried
        problem = "is taken" if taken else f"cannot be used ({reason})"
        other = f"leave out --port to let {server} find a free one, or name another."
        raise RefusedError(f"Port {port} {problem}; {other}") from None
