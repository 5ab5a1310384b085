"""What must hold before a server is started, in sentences."""

import argparse
import errno
import importlib.util
import socket


def port_number(text: str) -> int:
    """A port from the command line."""
    if not (text.isdecimal() and 1 <= int(text) <= 65535):
        raise argparse.ArgumentTypeError(f"{text!r} is not a port; ports are 1 to 65535")
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
