"""The site: built, handed out by a plain web server, and opened with every other place shut.

The tests reach no registry of Python packages compiled for the browser (tests/tools/pyodide.py):
what needs numpy is not run here. Everything before it is: the kernel starts, `import ikteach` in a
notebook as it was committed brings our wheel and all that it names, widgets live, WebGL draws.
"""

import functools
import http.server
import json
import threading
import zipfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Browser, Page, Route

from ikteach import __main__ as cli
from ikteach.publish import site, wheels
from ikteach.publish.delivery import chapters, course_files
from tests.browser.conftest import READY, ROOT, SHOTS, open_page
from tests.tools import pyodide

NOTEBOOKS = ROOT / "notebooks"
START = 150_000  # [ms] what a kernel may take to start on a slow machine
LITE = "jupyter-lite.json"


class Handler(http.server.SimpleHTTPRequestHandler):
    """A web server for files; JupyterLab's page lets the tests call its commands."""

    protocol_version = "HTTP/1.1"

    def log_message(self, *_: Any) -> None: ...

    def do_GET(self) -> None:
        if self.path.partition("?")[0] != f"/{LITE}":
            return super().do_GET()
        config = json.loads(Path(self.directory, LITE).read_text())
        config["jupyter-config-data"]["exposeAppInBrowser"] = True
        data = json.dumps(config).encode()
        self.send_response(200)
        self.send_header("Content-Type", "application/json")
        self.send_header("Content-Length", str(len(data)))
        self.end_headers()
        self.wfile.write(data)


def serve(folder: Path) -> http.server.ThreadingHTTPServer:
    handler = functools.partial(Handler, directory=str(folder))
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    return server


@pytest.fixture(scope="module")
def distribution(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return pyodide.distribution(tmp_path_factory.mktemp("pyodide") / "full")


@pytest.fixture(scope="module")
def built(distribution: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The site, built with Pyodide fetched from an address."""
    folder = tmp_path_factory.mktemp("site") / "course"
    server = serve(distribution)
    try:
        where = f"http://127.0.0.1:{server.server_port}"
        assert cli.main(["site", str(folder), "--pyodide", where]) == 0
    finally:
        server.shutdown()
        server.server_close()
    return folder


class Lite:
    """A chapter open in the site."""

    def __init__(self, browser: Browser, folder: Path, name: str) -> None:
        self.server = serve(folder)
        self.address = f"http://127.0.0.1:{self.server.server_port}/"
        self.outside: list[str] = []
        self.errors: list[str] = []
        self.page: Page = open_page(browser, 1440, 1000)
        self.page.context.route("**/*", self._let_through)
        self.page.on("pageerror", lambda error: self.errors.append(str(error)))
        self.page.on("console", self._heard)
        self.page.on("response", self._answered)
        self.page.goto(self.address)
        self.page.get_by_role("link", name=chapters(NOTEBOOKS)[name]).click()
        self.page.wait_for_selector(".jp-Notebook .jp-CodeCell", timeout=READY)
        ready = "window.jupyterapp?.shell.currentWidget?.sessionContext?.session?.kernel"
        self.page.wait_for_function(ready, timeout=START)

    def _let_through(self, route: Route) -> None:
        if route.request.url.startswith(self.address):
            route.continue_()
        else:
            self.outside.append(route.request.url)
            route.abort()

    def _heard(self, message: Any) -> None:
        if message.type == "error" and not message.text.startswith("Failed to load resource"):
            self.errors.append(message.text)

    def _answered(self, answer: Any) -> None:
        # JupyterLab looks for each file that a traceback names: that is no fault of the site.
        looked_up = "/api/resolvePath", "/api/contents/lib"
        if answer.status >= 400 and not any(part in answer.url for part in looked_up):
            self.errors.append(f"{answer.status} {answer.url}")

    def command(self, name: str) -> None:
        self.page.evaluate("name => window.jupyterapp.commands.execute(name)", name)

    def run(self, code: str) -> str:
        """What code prints in the notebook's kernel; the error, should it fail."""
        return str(self.page.evaluate(RUN, code))

    def show(self, code: str) -> None:
        """Put code into the last cell of the notebook and run it."""
        self.page.evaluate(SHOW, code)

    def close(self) -> None:
        self.page.close()
        self.server.shutdown()
        self.server.server_close()


RUN = """async (code) => {
  const kernel = window.jupyterapp.shell.currentWidget.sessionContext.session.kernel;
  const future = kernel.requestExecute({ code, store_history: false });
  let said = "";
  future.onIOPub = ({ content, header }) => {
    if (header.msg_type === "stream") said += content.text;
    if (header.msg_type === "error") said += `${content.ename}: ${content.evalue}`;
  };
  await future.done;
  return said;
}"""
SHOW = """async (code) => {
  const { content } = window.jupyterapp.shell.currentWidget;
  content.activeCellIndex = content.widgets.length - 1;
  await window.jupyterapp.commands.execute("notebook:insert-cell-below");
  content.activeCell.model.sharedModel.setSource(code);
  await window.jupyterapp.commands.execute("notebook:run-cell");
}"""


@pytest.fixture(scope="module")
def lite(built: Path, browser: Browser) -> Iterator[Lite]:
    lite = Lite(browser, built, "00_figure.ipynb")
    yield lite
    lite.close()


def test_the_site_holds_all_that_its_lock_file_names(built: Path, distribution: Path) -> None:
    place = built / "static" / "pyodide"
    packages = json.loads((place / site.LOCK).read_text())["packages"]
    for one in packages.values():
        assert wheels.digest((place / one["file_name"]).read_bytes()) == one["sha256"]
        assert {wheels.canonicalize_name(name) for name in one["depends"]} <= set(packages)
    assert {"numpy", "pandas", "matplotlib", "ipywidgets", "pythreejs", "anywidget"} == set(
        packages["ikteach"]["depends"]
    )
    assert packages["ikteach"]["imports"] == ["ikteach"]
    with zipfile.ZipFile(place / packages["ikteach"]["file_name"]) as wheel:
        assert not [name for name in wheel.namelist() if "solutions" in name]
    config = (built / LITE).read_text()
    assert "://" not in config.replace("http://www.w3.org", "")
    assert '"pyodideUrl": "./static/pyodide/pyodide.mjs"' in config
    for script in (built / "extensions").glob("**/package.json"):
        assert "\\\\" not in json.loads(script.read_text())["jupyterlab"]["_build"]["load"]


def test_notebooks_are_in_the_site_as_they_were_committed(built: Path) -> None:
    for name in course_files(NOTEBOOKS):
        there, here = ((place / name).read_bytes() for place in (built / "files", NOTEBOOKS))
        assert there == here or json.loads(there) == json.loads(here)  # keys may be in order


def test_only_a_folder_of_our_own_making_is_replaced(built: Path, tmp_path: Path) -> None:
    assert site.hindrance(built) == ""
    assert site.hindrance(tmp_path / "new") == site.hindrance(tmp_path) == ""
    mine = tmp_path / "mine.txt"
    mine.touch()
    assert "left alone" in site.hindrance(tmp_path)
    assert "is a file" in site.hindrance(mine)
    added = built / "CNAME"
    added.touch()
    try:
        assert "CNAME" in site.hindrance(built)
    finally:
        added.unlink()


def test_what_is_missing_is_said_and_nothing_is_left_behind(
    distribution: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    def told(where: str | Path) -> str:
        assert cli.main(["site", str(tmp_path / "room" / "site"), "--pyodide", str(where)]) == 1
        said = capsys.readouterr().err
        assert said.count("\n") == 1
        assert not list((tmp_path / "room").iterdir())
        return said

    assert "pyodide-lock.json of Pyodide cannot be had from" in told(tmp_path / "none")
    assert "refused" in told("http://127.0.0.1:1")
    part = tmp_path / "part"
    part.mkdir()
    for name in (site.LOCK, *site.CORE):
        (part / name).symlink_to(distribution / name)
    assert "take Pyodide's full distribution" in told(part)
    for wheel in distribution.glob("*.whl"):
        (part / wheel.name).symlink_to(wheel)
    (part / "pyodide.mjs").unlink()
    assert "pyodide.mjs is missing" in told(part)
    (part / "pyodide.mjs").write_text('version="0.1"')
    assert "which the kernel here needs" in told(part)


def test_a_chapter_opens_as_it_is_and_finds_our_package(lite: Lite) -> None:
    names = lite.page.locator(".jp-DirListing-itemText").all_inner_texts()
    assert [name for name in names if name.endswith(".ipynb")] == sorted(chapters(NOTEBOOKS))
    lite.page.wait_for_function(
        "window.jupyterapp.shell.currentWidget.sessionContext.session.kernel.info", timeout=START
    )
    # Before any cell has named it, the package is not there; the first cell brings it.
    assert lite.run("import importlib.util as u; print(u.find_spec('ikteach'))") == "None\n"
    lite.page.locator(".jp-CodeCell .cm-content").first.click()
    lite.command("notebook:run-cell")
    lite.page.get_by_text("No module named 'numpy'").first.wait_for(timeout=START)
    assert lite.run("import importlib.metadata as m; print(m.version('ikteach'))") == "0.1.0\n"


def test_the_kernel_has_no_threads_and_our_code_knows(lite: Lite) -> None:
    assert "can't start new thread" in lite.run("import threading as t; t.Thread().start()")
    # The deadline of a check stops an endless loop without a signal.
    said = lite.run(f"""{ROOMS}
from ikteach.course.deadline import TooLongError, Tracer, deadline
def answer():
    while True:
        pass
try:
    with deadline(0.2):
        answer()
except TooLongError:
    print(isinstance(deadline(1), Tracer))
""")
    assert said == "True\n"


# The rooms that need numpy are only names here, and numpy is a name with its types.
ROOMS = """import sys, types
from unittest.mock import MagicMock
if "numpy" not in sys.modules:
    kinds = {name: type(name, (), {}) for name in ("ndarray", "generic")}
    sys.modules["numpy"] = MagicMock(**kinds)
    sys.modules["numpy.typing"] = sys.modules["numpy"].typing
for room in ("ikteach", "ikteach.view", "ikteach.course"):
    if room not in sys.modules:
        module = sys.modules[room] = types.ModuleType(room)
        module.__path__ = ["/lib/python3.14/site-packages/" + room.replace(".", "/")]
"""


def test_answers_are_kept_in_the_browser(lite: Lite) -> None:
    said = lite.run(f"""{ROOMS}
from ikteach.course import record
print(record.store("quiz", "00.x", answer="yes"))
print(record.store("quiz", "00.y", answer="no"))
print(sorted(record.entries("quiz")), record.entry("quiz", "00.x")["answer"])
""")
    assert said == "\n\n['00.x', '00.y'] yes\n"


def test_widgets_live_and_webgl_draws(lite: Lite) -> None:
    """An ipywidgets slider moves a pythreejs box; its words are an anywidget of ours."""
    lite.show(f"""{ROOMS}
import asyncio, ipywidgets as widgets, pythreejs as three
from ikteach.view.widgets.status import Status

status, slider = Status(), widgets.IntSlider(description="Turn", max=90)
box = three.Mesh(three.BoxBufferGeometry(1, 1, 1), three.MeshBasicMaterial(color="#0072b2"))
camera = three.PerspectiveCamera(position=[1, 1, 3], aspect=1)
camera.lookAt([0, 0, 0])
scene = three.Scene(children=[box, camera])
view = three.Renderer(scene=scene, camera=camera, width=200, height=200)

async def follow(change):
    await asyncio.sleep(0.01)
    box.position = [change["new"] / 90, 0, 0]
    status.say(f"turned to {{change['new']}}")

slider.observe(lambda change: asyncio.ensure_future(follow(change)), "value")
widgets.VBox([view, slider, status])""")
    page = lite.page
    picture = page.locator(".jp-OutputArea canvas").last
    picture.wait_for(timeout=READY)
    handle = page.get_by_role("slider").last
    handle.focus()
    before = picture.screenshot()
    for _ in range(5):
        page.keyboard.press("ArrowRight")
    page.get_by_text("turned to 5").last.wait_for(timeout=READY)
    page.keyboard.press("End")
    page.get_by_text("turned to 90").last.wait_for(timeout=READY)
    page.wait_for_timeout(300)
    assert picture.screenshot() != before
    SHOTS.mkdir(exist_ok=True)
    page.screenshot(path=SHOTS / "site.png")


def test_nothing_was_asked_of_any_other_place(lite: Lite) -> None:
    assert lite.outside == []
    assert lite.errors == []
