"""What Binder does with this repository, repeated here: build it, start it, open its links.

    python -m binder.rehearse [--pip] [--every]

The steps are those of the recipe that repo2docker prints for a clean clone of what is committed.
They run in a new virtual environment instead of a container; then a Chromium opens the launch
links. Needs the extra `test`.
"""

import argparse
import json
import os
import secrets
import socket
import subprocess
import sys
import tempfile
import time
import urllib.error
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path, PurePosixPath
from typing import Any, NamedTuple

import psutil
from playwright.sync_api import Browser, Page, Route, sync_playwright

from binder import links
from binder.recipe import Build

PATIENCE = 120  # [s] how long an answer may take on a slow machine
MEMORY = 1024  # [MB] what mybinder.org promises
WALK = "7 gait"
HEADING = ".jp-NotebookPanel:not(.lm-mod-hidden) h1, #rendered_cells h1"
MOVES = "+(document.querySelector('.ikteach-driver')?.dataset.shown ?? 0) >= 10"  # frames


class Server:
    """The server of a build, started as BinderHub starts it."""

    def __init__(self, built: Build) -> None:
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            port = free.getsockname()[1]
        self.home, self.source = built.home, built.source
        self.token = secrets.token_urlsafe(16)
        self.address = f"http://127.0.0.1:{port}/user/rehearsal/"
        command = [built.environment["R2D_ENTRYPOINT"], "jupyter-lab", "--no-browser"]
        command += ["--ip=127.0.0.1", f"--port={port}"]
        for app in ("NotebookApp", "ServerApp"):
            command += [f"--{app}.base_url=/user/rehearsal/", f"--{app}.token={self.token}"]
            command += [f"--{app}.trust_xheaders=True"]
        if os.getuid() == 0:  # which nobody is on Binder
            command.append("--allow-root")
        self.log = self.home / ".server.log"
        with self.log.open("w") as log:
            self.process = subprocess.Popen(
                command, cwd=built.home, env=built.environment, stdout=log, stderr=log
            )

    def wait(self) -> None:
        """Until it answers."""
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end and self.process.poll() is None:
            try:
                self.ask("api/status")
                return
            except (urllib.error.URLError, ConnectionError):
                time.sleep(0.1)
        raise RuntimeError(f"the server did not start:\n{self.log.read_text()[-4000:]}")

    def ask(self, path: str, method: str = "GET", **headers: str) -> Any:
        """Ask for JSON; with the token, if no other headers are given."""
        headers = headers or {"Authorization": f"token {self.token}"}
        request = urllib.request.Request(self.address + path, headers=headers, method=method)
        with urllib.request.urlopen(request, timeout=PATIENCE) as answer:
            return json.loads(answer.read() or "null")

    def memory(self) -> float:
        """[MB] of the server and its kernels; what they share is counted once."""
        root = psutil.Process(self.process.pid)
        family = [root, *root.children(recursive=True)]
        return float(sum(one.memory_full_info().pss for one in family)) / 2**20

    def stop(self) -> None:
        """End it and its kernels, and, if a thread keeps them from ending, kill them."""
        if self.process.poll() is not None:
            return
        root = psutil.Process(self.process.pid)
        family = [root, *root.children(recursive=True)]
        self.process.terminate()
        for left in psutil.wait_procs(family, timeout=5)[1]:
            left.kill()
        self.process.wait()


class Visit:
    """A launch link, opened in a page that lets nothing in from elsewhere and hears of errors."""

    def __init__(self, browser: Browser, server: Server, link: str) -> None:
        self.server, self.wrong = server, list[str]()
        self.page: Page = browser.new_page(viewport={"width": 1440, "height": 1000})
        self.page.set_default_timeout(1000 * PATIENCE)
        self.page.on("pageerror", lambda error: self.wrong.append(str(error)))
        self.page.on("console", lambda m: self.wrong.append(m.text) if m.type == "error" else None)
        self.page.route("**/*", self._guard)
        self.clicked = time.monotonic()
        address = f"{server.address}{link}{'&' if '?' in link else '?'}token={server.token}"
        self.page.goto(address, wait_until="commit")

    def _guard(self, route: Route) -> None:
        if route.request.url.startswith((self.server.address, "data:", "blob:")):
            route.continue_()
        else:
            self.wrong.append(f"it asks for {route.request.url}")
            route.abort()

    def heading(self) -> str:
        """Wait for the first heading."""
        return self.page.locator(HEADING).first.inner_text().removesuffix("¶").strip()

    def run(self, cell: str) -> None:
        """Run the cell with this text by keys, as soon as the kernel is there."""
        self.page.locator("#jp-main-statusbar", has_text="| Idle").wait_for()
        self.page.locator(".jp-CodeCell", has_text=cell).first.locator(".cm-content").click()
        self.page.keyboard.press("Control+Enter")

    def moving(self) -> float:
        """[s] from the click until a figure has moved."""
        self.page.wait_for_function(MOVES)
        moved = time.monotonic() - self.clicked
        self.page.locator(".jupyter-threejs canvas").first.scroll_into_view_if_needed()
        return moved

    def close(self, shot: Path) -> None:
        """Leave a picture, and the server as if the next link had one of its own."""
        shot.parent.mkdir(exist_ok=True)
        self.page.screenshot(path=shot)
        self.page.close()
        for kernel in self.server.ask("api/kernels"):
            self.server.ask(f"api/kernels/{kernel['id']}", "DELETE")
        for workspace in self.server.ask("lab/api/workspaces")["workspaces"]["ids"]:
            self.server.ask(f"lab/api/workspaces/{workspace}", "DELETE")


@contextmanager
def serving(built: Build) -> Iterator[Server]:
    """Start a server that ends with the block."""
    server = Server(built)
    try:
        server.wait()
        yield server
    finally:
        server.stop()


class Seen(NamedTuple):
    """What a link opened: its first heading, when it was there, and when a figure had moved [s]."""

    link: str
    heading: str
    opened: float
    moved: float | None
    memory: float

    def __str__(self) -> str:
        moved = "" if self.moved is None else f", a moving figure after {self.moved:.1f} s"
        return (
            f"{self.link}: {self.heading!r} after {self.opened:.1f} s{moved}, "
            f"{self.memory:.0f} of {MEMORY} MB"
        )


def look(browser: Browser, server: Server, shots: Path, every: bool = False) -> Iterator[Seen]:
    """Open the links, every one or one of each kind, and say what was seen and when."""
    lab, pages = links.chapters(), links.lecture()
    for name in lab if every else (WALK,):
        yield visit(browser, server, lab[name], shots, "player = GaitPlayer()" * (name == WALK))
    for name in pages if every else ("workbench",):
        yield visit(browser, server, pages[name], shots)
    # A hub's link: what nbgitpuller is asked on a student's own server.
    pull = links.pull(server.source.as_uri(), next(iter(lab.values())))
    yield visit(browser, server, pull, shots)


def visit(browser: Browser, server: Server, link: str, shots: Path, cell: str = "") -> Seen:
    """Open a link, run a cell if one is named, and say what was seen.

    There must be no error in the page, which asks nothing of anybody else; Voilà's must move.
    """
    page = Visit(browser, server, link)
    try:
        heading, opened = page.heading(), time.monotonic() - page.clicked
        if cell:
            page.run(cell)
        moved = page.moving() if cell or link.startswith("voila") else None
        seen = Seen(link, heading, opened, moved, server.memory())
    finally:
        page.close(shots / f"binder_{PurePosixPath(link.partition('?')[0]).stem}.png")
    if page.wrong:
        raise RuntimeError(f"{link}: " + "; ".join(page.wrong))
    return seen


def main(argv: list[str] | None = None) -> int:
    """Rehearse, and print each step with its time."""
    parser = argparse.ArgumentParser(description="Build, start and open as Binder does.")
    parser.add_argument("--pip", action="store_true", help="install by pip, as Binder does; slow")
    parser.add_argument("--every", action="store_true", help="open every link in the browser")
    options = parser.parse_args(argv)
    from tests.browser.conftest import SHOTS, open_browser

    with tempfile.TemporaryDirectory() as folder, sync_playwright() as play:
        since = time.monotonic()
        built = Build(Path(folder))
        for step in built.steps(options.pip):
            print(f"{time.monotonic() - since:6.1f} s  {step}", flush=True)
            since = time.monotonic()
        with serving(built) as server:
            print(f"{time.monotonic() - since:6.1f} s  the server answers", flush=True)
            for seen in look(open_browser(play), server, SHOTS, options.every):
                print(seen, flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
