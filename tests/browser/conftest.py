"""A real JupyterLab and a real Chromium. What a test leaves to be looked at is in tests/shots."""

import io
import json
import os
import secrets
import shutil
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

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import Browser, BrowserType, Error, Page, sync_playwright

ROOT = Path(__file__).parents[2]
SHOTS = ROOT / "tests" / "shots"
FLAGS = [
    "--headless=new",
    "--no-sandbox",
    "--disable-gpu",
    "--enable-unsafe-swiftshader",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--no-first-run",
    "--disable-quic",
    "--disable-default-apps",
    "--disable-extensions",
]
CANVAS = ".jupyter-threejs canvas"
DRIVER = ".ikteach-driver"
SHOWN = f"+document.querySelector('{DRIVER}').dataset.shown"  # frames that have been drawn
READY = 40_000  # [ms] how long a page may take on a slow machine before the test gives up


class Lab:
    """JupyterLab on a folder, with what a test wants to ask of it."""

    def __init__(self, folder: Path) -> None:
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            self.port = free.getsockname()[1]
        self.folder, self.token = folder, secrets.token_hex(8)
        command = [sys.executable, "-m", "jupyterlab", "--no-browser", "--allow-root"]
        command += [f"--ServerApp.port={self.port}", "--ServerApp.port_retries=0"]
        command += [f"--ServerApp.root_dir={folder}", "--LabApp.expose_app_in_browser=True"]
        command += ["--ServerApp.jpserver_extensions={'ikteach.serve.extension': True}"]
        command += [f"--IdentityProvider.token={self.token}", "--LabApp.news_url=None"]
        command += ["--LabApp.check_for_updates_class=jupyterlab.NeverCheckForUpdate"]
        environment = os.environ | {
            "OPENBLAS_NUM_THREADS": "1",
            "JUPYTER_CONFIG_DIR": str(folder / ".config"),
            "JUPYTER_CONFIG_PATH": str(ROOT / "ikteach" / "serve" / "lab"),
            "JUPYTERLAB_SETTINGS_DIR": str(folder / ".settings"),
            "JUPYTERLAB_WORKSPACES_DIR": str(folder / ".workspaces"),
        }
        self.log = (folder / "lab.log").open("w")
        self.server = subprocess.Popen(command, env=environment, stdout=self.log, stderr=self.log)

    def wait(self) -> None:
        end = time.monotonic() + READY / 1000
        while time.monotonic() < end:
            try:
                self.ask("status")
                return
            except (urllib.error.URLError, ConnectionError):
                time.sleep(0.2)
        raise RuntimeError((self.folder / "lab.log").read_text()[-2000:])

    def ask(self, path: str, method: str = "GET") -> Any:
        url = f"http://127.0.0.1:{self.port}/api/{path}?token={self.token}"
        with urllib.request.urlopen(urllib.request.Request(url, method=method)) as answer:
            text = answer.read()
        return json.loads(text) if text else None

    def url(self, notebook: str) -> str:
        return f"http://127.0.0.1:{self.port}/lab/tree/{notebook}?token={self.token}&reset"

    def stop_kernels(self) -> None:
        for session in self.ask("sessions"):
            self.ask(f"sessions/{session['id']}", "DELETE")

    def stop(self) -> None:
        self.server.terminate()
        self.server.wait(30)
        self.log.close()


class Notebook:
    """One notebook open in one page."""

    def __init__(self, page: Page, lab: Lab, name: str) -> None:
        self.page, self.lab, self.name = page, lab, name
        self.errors: list[str] = []
        page.on("pageerror", lambda error: self.errors.append(str(error)))
        page.on("console", self._heard)
        page.goto(lab.url(name))
        self._wait()

    def reload(self) -> None:
        """Load the page anew, as F5 does."""
        self.page.reload()
        self._wait()

    def _wait(self) -> None:
        """Wait for the notebook, its menu and its kernel."""
        page = self.page
        page.wait_for_selector(".jp-Notebook .jp-CodeCell", timeout=READY)
        page.wait_for_function(
            "window.jupyterapp?.commands.hasCommand('notebook:run-all-cells')", timeout=READY
        )
        page.wait_for_function(
            "window.jupyterapp.shell.currentWidget?.sessionContext?.session?.kernel", timeout=READY
        )

    def _heard(self, message: Any) -> None:
        if message.type == "error":
            self.errors.append(message.text)

    def command(self, name: str) -> None:
        self.page.evaluate("name => window.jupyterapp.commands.execute(name)", name)

    def run_all(self) -> None:
        self.command("notebook:run-all-cells")

    def kernel(self, expression: str, code: str = "") -> Any:
        """Run code in the notebook's kernel, then give the value of a Python expression."""
        answer = self.page.evaluate(ASK, [code, f"__import__('json').dumps({expression})"])
        assert answer["status"] == "ok", answer
        return json.loads(eval(answer["data"]["text/plain"]))

    def run_cell(self, cell: str) -> None:
        """Run the cell whose source has this text in it."""
        self.page.locator(".jp-CodeCell", has_text=cell).first.locator(".cm-content").click()
        self.command("notebook:run-cell")

    def run_figure(self, cell: str) -> None:
        """Run the cell with this text in it, and wait until its figure is drawn."""
        self.run_cell(cell)
        self.page.wait_for_selector(f"{DRIVER}[data-frame]", timeout=READY)
        self.page.keyboard.press("Shift")  # who does anything is no longer kept at the figure

    def press(self, button: str) -> None:
        self.page.get_by_role("button", name=button, exact=True).click()

    def settle(self, expression: str, wanted: Any) -> None:
        """Wait until the kernel says so, or fail with what it says."""
        end, said = time.monotonic() + 20, None
        while time.monotonic() < end:
            said = self.kernel(expression)
            if said == wanted:
                return
            time.sleep(0.1)
        pytest.fail(f"{expression} is {said!r}, not {wanted!r}")

    def frames(self, more: int) -> None:
        """Wait until so many more frames have been drawn."""
        before = self.page.evaluate(SHOWN)
        self.page.wait_for_function(f"{SHOWN} >= {before + more}", timeout=READY)

    def shot(self, name: str, selector: str | None = None) -> bytes:
        """A screenshot of the page, or of one element, kept in tests/shots to be looked at."""
        SHOTS.mkdir(exist_ok=True)
        target = self.page.locator(selector).first if selector else self.page
        return target.screenshot(path=SHOTS / f"{name}.png", timeout=READY)


ASK = """async ([code, expression]) => {
  const kernel = window.jupyterapp.shell.currentWidget.sessionContext.session.kernel;
  const future = kernel.requestExecute(
    { code, store_history: false, user_expressions: { answer: expression } });
  const reply = (await future.done).content;
  return reply.status === "ok" ? reply.user_expressions.answer : reply;
}"""


def pixels(png: bytes) -> np.ndarray:
    """Red, green and blue of a picture, (height, width, 3)."""
    return np.asarray(Image.open(io.BytesIO(png)).convert("RGB")).astype(int)


def open_browser(play: Any) -> Browser:
    """The system's Chromium where there is one, else the one that Playwright has installed."""
    return launch(play.chromium)


def launch(chromium: BrowserType, *flags: str) -> Browser:
    """The same, with more flags for it."""
    system = next(filter(None, map(shutil.which, ("chromium", "chromium-browser"))), None)
    return chromium.launch(executable_path=system, args=[*FLAGS, *flags], headless=True)


def open_page(browser: Browser, width: int = 1440, height: int = 1100) -> Page:
    """An empty page, of a profile of its own."""
    page = browser.new_page(viewport={"width": width, "height": height})
    # pythreejs notes every frame in the console. Where nobody looks that costs nothing, but
    # Playwright looks: each note would be sent from process to process to process.
    page.add_init_script("console.debug = () => {}")
    return page


@contextmanager
def course_in_lab(folder: Path) -> Iterator[Lab]:
    """JupyterLab on a copy of the course."""
    shutil.copytree(ROOT / "notebooks", folder, dirs_exist_ok=True)
    lab = Lab(folder)
    try:
        lab.wait()
        yield lab
        lab.stop_kernels()
    finally:
        lab.stop()


@contextmanager
def lab_and_page() -> Iterator[tuple[Lab, Page]]:
    """The course in JupyterLab and an empty page, for a bench."""
    with (
        tempfile.TemporaryDirectory() as folder,
        course_in_lab(Path(folder)) as lab,
        sync_playwright() as play,
    ):
        yield lab, open_page(open_browser(play))


@pytest.fixture(scope="session")
def lab(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Lab]:
    with course_in_lab(tmp_path_factory.mktemp("course")) as lab:
        yield lab


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    with sync_playwright() as play:
        try:
            browser = open_browser(play)
        except Error as error:
            pytest.fail(f"no Chromium to test with; see CONTRIBUTING.md: {error}")
        yield browser
        browser.close()


@pytest.fixture(scope="session")
def open_notebook(lab: Lab, browser: Browser) -> Iterator[Any]:
    """Open a notebook of the course in a page and a kernel of its own."""
    pages: list[Page] = []

    def open_one(name: str) -> Notebook:
        lab.stop_kernels()
        while pages:  # a page that is left open goes on drawing
            pages.pop().close()
        pages.append(open_page(browser))
        return Notebook(pages[-1], lab, name)

    yield open_one
    for page in pages:
        page.close()
