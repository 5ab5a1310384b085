"""The page before a class, for whoever has its address: on this machine alone, and only to read."""

import asyncio
import secrets
from collections.abc import Callable
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

from tornado.httpserver import HTTPServer
from tornado.netutil import bind_sockets
from tornado.web import Application, HTTPError, RequestHandler

from ikteach.view.widgets.page import script

HERE = Path(__file__).parent
LOCAL = "127.0.0.1"
PORT, TRIED = 8867, 50  # the first port, and how many after it are tried
SAFE = {
    "Content-Security-Policy": "default-src 'none'; script-src 'self'; style-src 'self'; "
    "connect-src 'self'; img-src data:; base-uri 'none'; form-action 'none'; "
    "frame-ancestors 'none'",
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cache-Control": "no-store",
    "Cross-Origin-Resource-Policy": "same-origin",
}
STRANGER = "Open the address that `python -m ikteach class` has printed, with its token."
Count = Callable[[bool], dict[str, Any]]  # whether names are asked for -> what the page shows


class Guarded(RequestHandler):
    """Answers who has the token, and nobody else."""

    def set_default_headers(self) -> None:
        """Have browsers keep the page to itself."""
        for name, value in SAFE.items():
            self.set_header(name, value)

    def prepare(self) -> None:
        """Refuse strangers.

        And a page of elsewhere whose name leads to this machine.
        """
        host = urlsplit(f"//{self.request.host}").hostname
        if host not in (LOCAL, "localhost"):
            raise HTTPError(403, "This page is at 127.0.0.1 and nowhere else.")
        given = self.get_query_argument("token", None) or self.get_cookie(self.cookie, "")
        if not secrets.compare_digest(str(given).encode(), self.settings["token"].encode()):
            raise HTTPError(403, STRANGER)

    @property
    def cookie(self) -> str:
        """The name of the cookie; other ports have theirs."""
        return f"ikteach-class-{self.settings['port']}"

    def write_error(self, status_code: int, **about: Any) -> None:
        """Say why in a sentence, without a page."""
        said = getattr(about.get("exc_info", (None, None))[1], "log_message", None)
        self.set_header("Content-Type", "text/plain; charset=utf-8")
        self.finish(said or self._reason)


class Entrance(Guarded):
    """The page; the token goes from its address into a cookie."""

    def get(self) -> None:
        """Send the page, once its address has no token."""
        if self.get_query_argument("token", None):
            token = self.settings["token"]
            self.set_cookie(self.cookie, token, httponly=True, samesite="Strict")
            self.redirect("/")
        else:
            self.finish((HERE / "page.html").read_bytes())


class Asset(Guarded):
    """The script or the style sheet of the page."""

    def get(self, name: str) -> None:
        """Send it."""
        if name == "page.js":
            self.set_header("Content-Type", "text/javascript; charset=utf-8")
            self.finish(script("serve/classroom/page.js"))
        else:
            self.set_header("Content-Type", "text/css; charset=utf-8")
            self.finish((HERE / "page.css").read_bytes())


class CountsNow(Guarded):
    """The counts of this moment."""

    def get(self) -> None:
        """Send them, with names where they are asked for."""
        self.finish(self.settings["count"](self.get_query_argument("names", "") == "1"))


class ClassServer:
    """Serves the page at a port of this machine.

    count    gives what the page shows
    port     None for the first that is free
    address  of the page, with its token
    """

    def __init__(self, count: Count, port: int | None) -> None:
        self._sockets, self.port = _bind(port)
        self.token = secrets.token_urlsafe(16)
        self.address = f"http://{LOCAL}:{self.port}/?token={self.token}"
        pages = [(r"/", Entrance), (r"/(page\.js|page\.css)", Asset), (r"/now", CountsNow)]
        self._application = Application(
            pages, token=self.token, port=self.port, count=count, log_function=lambda _: None
        )

    async def serve(self) -> None:
        """Serve until it is cancelled."""
        server = HTTPServer(self._application, max_body_size=0, idle_connection_timeout=60)
        server.add_sockets(self._sockets)
        try:
            await asyncio.Event().wait()
        finally:
            server.stop()


def _bind(port: int | None) -> tuple[list[Any], int]:
    """Take a port, the given one or the first that is free."""
    for one in [port] if port else range(PORT, PORT + TRIED):
        try:
            return bind_sockets(one, LOCAL), one
        except OSError:
            continue
    raise OSError(f"no port from {PORT} to {PORT + TRIED - 1} is free")
