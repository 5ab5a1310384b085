"""What Binder does with this repository, repeated here: build it, start it, open its links.

    python -m binder.rehearse [--pip] [--all]

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
from pathlib import Path
from typing import Any

import psutil
from playwright.sync_api import Browser, Page, Route, sync_playwright

from binder import links
from binder.recipe import Build, clone, recipe

PATIENCE = 120_000  # [ms] how long a page may take on a slow machine
MEMORY = 1024  # [MB] what mybinder.org promises
FIRST = "lab/tree/notebooks/00_figure.ipynb"
WALKING = "lab/tree/notebooks/07_gait.ipynb"
MOVING = "+(document.querySelector('.ikteach-driver')?.dataset.shown ?? 0) >= 10"


def build(folder: Path, pip: bool = False) -> Iterator[tuple[str, Build]]:
    """Build in a new folder what is committed; say of each step what was done."""
    source = folder / "ikteach"
    clone(links.ROOT, source)
    python, layers = recipe(source)
    built = Build(folder, python)
    yield f"{built.python}, where Binder has Python {python}", built
    for step in built.follow(layers, source, pip):
        yield step, built


class Server:
    """The server of a build, started as BinderHub starts it."""

    def __init__(self, built: Build) -> None:
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            self.port = free.getsockname()[1]
        self.token = secrets.token_urlsafe(16)
        self.base = f"http://127.0.0.1:{self.port}/user/ikteach-rehearsal/"
        options = {"base_url": "/user/ikteach-rehearsal/", "token": self.token}
        options["trust_xheaders"] = "True"
        command = [built.environment["R2D_ENTRYPOINT"], "jupyter-lab", "--no-browser"]
        command += ["--ip=127.0.0.1", f"--port={self.port}"]
        for app in ("NotebookApp", "ServerApp"):
            command += [f"--{app}.{name}={value}" for name, value in options.items()]
        if os.getuid() == 0:  # which nobody is on Binder
            command.append("--allow-root")
        self.log = (built.home / ".server.log").open("w+")
        self.process = subprocess.Popen(
            command, cwd=built.home, env=built.environment, stdout=self.log, stderr=self.log
        )

    def wait(self) -> None:
        """Until it answers."""
        end = time.monotonic() + PATIENCE / 1000
        while time.monotonic() < end and self.process.poll() is None:
            try:
                self.ask("api/status")
                return
            except (urllib.error.URLError, ConnectionError):
                time.sleep(0.1)
        self.log.seek(0)
        raise RuntimeError(f"the server did not start:\n{self.log.read()[-4000:]}")

    def ask(self, path: str, method: str = "GET") -> Any:
        """The answer to a request, from JSON."""
        headers = {"Authorization": f"token {self.token}"}
        request = urllib.request.Request(self.base + path, headers=headers, method=method)
        with urllib.request.urlopen(request, timeout=PATIENCE / 1000) as answer:
            return json.loads(answer.read() or "null")

    def memory(self) -> float:
        """[MB] of the server and its kernels; what they share is counted once."""
        root = psutil.Process(self.process.pid)
        family = [root, *root.children(recursive=True)]
        return sum(one.memory_full_info().pss for one in family) / 2**20

    def stop(self) -> None:
        """End it and its kernels."""
        self.process.terminate()
        self.process.wait(30)
        self.log.close()


@contextmanager
def serving(built: Build) -> Iterator[Server]:
    """A server that ends with the block."""
    server = Server(built)
    try:
        server.wait()
        yield server
    finally:
        server.stop()


class Visit:
    """One launch link, opened in a page that lets nothing in from elsewhere."""

    def __init__(self, browser: Browser, server: Server, link: str) -> None:
        self.wrong: list[str] = []
        self.page: Page = browser.new_page(viewport={"width": 1440, "height": 1000})
        self.page.set_default_timeout(PATIENCE)
        self.page.on("pageerror", lambda error: self.wrong.append(str(error)))
        self.page.on("console", lambda said: said.type == "error" and self.wrong.append(said.text))
        self._server = server
        self.page.route("**/*", self._guard)
        self._start = time.monotonic()
        joint = "&" if "?" in link else "?"
        address = f"{server.base}{link}{joint}reset&token={server.token}"
        self.page.goto(address, wait_until="commit")

    def _guard(self, route: Route) -> None:
        inside = route.request.url.startswith((self._server.base, "data:", "blob:"))
        if not inside:
            self.wrong.append(f"asks for {route.request.url}")
        (route.continue_ if inside else route.abort)()

    def heading(self) -> str:
        """The first heading of the notebook, once it is there."""
        return self.page.locator("h1:visible").first.inner_text().removesuffix("¶")

    def run(self, cell: str) -> None:
        """Run the cell with this text by keys, as a student does."""
        self.page.locator(".jp-CodeCell", has_text=cell).first.locator(".cm-content").click()
        self.page.keyboard.press("Control+Enter")

    def until(self, condition: str = MOVING) -> float:
        """[s] from the click until that holds in the page."""
        self.page.wait_for_function(condition)
        return time.monotonic() - self._start

    def end(self) -> None:
        """Close the page; it must have had no errors and asked for nothing from elsewhere."""
        self.page.close()
        for kernel in self._server.ask("api/kernels"):
            self._server.ask(f"api/kernels/{kernel['id']}", "DELETE")
        if self.wrong:
            raise RuntimeError("\n".join(self.wrong))
