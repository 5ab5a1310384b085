"""Where figures stand at every width and zoom: nothing on a picture, nothing cut, nothing lost.

Each figure is made once, in one page that takes one size after another. A screenshot is left of
each size with a fault; IKTEACH_FULL=1 leaves one of every size.
"""

import base64
import os
import re
import signal
import subprocess
import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import nbformat
import pytest
from playwright.sync_api import Browser, CDPSession, Page

from tests.browser.conftest import DRIVER, READY, SHOTS, Lab, Notebook, open_page

SCENE, CHART, PLANES = f"{DRIVER}[data-frame]", ".ikteach-picture[src]", ".ikteach-plane"
FIGURES = {
    "00": ("from ikteach.view.chapters.figure import Poser as Made", "figures.human()", SCENE),
    "01": (
        "from ikteach.view.chapters.jacobian import ColumnPoser as Made",
        "figures.human()",
        SCENE,
    ),
    "02": ("from ikteach.view.chapters.singularity import BendBench as Made", "", SCENE),
    "03": ("from ikteach.view.chapters.transpose import slope_bench as Made", "", CHART),
    "04": ("from ikteach.view.chapters.pseudoinverse import CapPlayer as Made", "", SCENE),
    "05": ("from ikteach.view.chapters.dls import tradeoff_bench as Made", "", CHART),
    "06": ("from ikteach.view.chapters.sdls import spectrum_bench as Made", "", CHART),
    "07": ("from ikteach.view import GaitPlayer as Made", "", SCENE),
    "08": ("from ikteach.view.chapters.comparison import Race as Made", "", SCENE),
    "09": ("from ikteach.view import Workbench as Made", "", SCENE),
    "10": ("from ikteach.view.chapters.reach import Simulator as Made", "", SCENE),
    "svd": (
        "from ikteach.view.chapters.svd import SvdBench as Made",
        "['pseudoinverse', 'dls']",
        PLANES,
    ),
    "12": ("from ikteach.view.chapters.robots import robot_player as Made", "", SCENE),
    "11": ("from ikteach.view.chapters.beyond import WalksPlayer as Made", "", SCENE),
}
BESIDE = [name for name in FIGURES if FIGURES[name][2] != CHART and name != "01"]


class Size(NamedTuple):
    """A window: pixels of the screen, and the zoom of the page."""

    width: int
    height: int
    zoom: float = 1.0

    def __str__(self) -> str:
        return f"{self.width}x{self.height}@{self.zoom:g}"


SIZES = [
    Size(width, height, zoom)
    for width, height in ((1024, 768), (1280, 720), (1366, 648), (1920, 970), (2560, 1300))
    for zoom in (1.0, 1.5)
]
SMALL = [Size(390, 844), Size(820, 1180), Size(1280, 720)]
FIGURE = ".ikteach-figure:not(.ikteach-figure .ikteach-figure)"  # and no tool inside it
LAPTOP, PROJECTOR = Size(1366, 648), Size(1920, 970)


# What is wrong with where things stand in an element: sentences, none if all is well.
MEASURE = """(root) => {
  const seen = (e) => e.getClientRects().length && getComputedStyle(e).visibility !== "hidden" &&
    !e.closest(".jupyter-widget-Collapse-contents:not(.jupyter-widget-Collapse-open)");
  const all = (selector) => [...root.querySelectorAll(selector)].filter(seen);
  const named = (e) => `${e.tagName.toLowerCase()} “${(e.innerText || e.ariaLabel || e.alt ||
    e.className.toString()).trim().slice(0, 40)}”`;
  const pictures = all("canvas, .ikteach-picture, .ikteach-plane, .ikteach-curve img");
  if (!pictures.length) return ["no picture is seen"];
  const controls = all("button, input, select, .noUi-target, .widget-label, .widget-readout");
  const faults = [];
  const box = (e) => e.getBoundingClientRect();
  const meet = (a, b) => Math.min(a.right, b.right) - Math.max(a.left, b.left) > 1.5 &&
    Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top) > 1.5;
  const things = [...pictures, ...controls, ...all(".noUi-handle")].map((e) => [e, box(e)]);
  for (const [i, [a, first]] of things.entries())
    for (const [b, second] of things.slice(i + 1))
      if (!a.contains(b) && !b.contains(a) && meet(first, second))
        faults.push(`${named(a)} and ${named(b)} stand on each other`);
  for (const [e, rect] of things) {
    const cut = e.scrollWidth > e.clientWidth + 1 && e.matches("button, .widget-label");
    if (cut) faults.push(`${named(e)} is cut`);
    for (let up = e.parentElement; up; up = up.parentElement) {
      const clips = up.matches(".jp-OutputArea-output, body") ||
        getComputedStyle(up).overflowX !== "visible";
      if (clips && (box(up).right < rect.right - 1.5 || box(up).left > rect.left + 1.5))
        { faults.push(`${named(e)} is cut by ${up.className.toString().slice(-60)}`); break; }
    }
  }
  for (const track of all(".noUi-target, input[type=range]"))
    if (box(track).width < 40) faults.push(`a slider is ${box(track).width} pixels long`);
  for (const canvas of all(".jupyter-threejs canvas")) {
    const { width, height } = box(canvas), fine = devicePixelRatio;
    const wanted = getComputedStyle(canvas.parentElement).aspectRatio.split("/").map(Number);
    if (Math.abs(canvas.width - width * fine) > 2 || Math.abs(canvas.height - height * fine) > 2)
      faults.push(`${canvas.width} by ${canvas.height} pixels are drawn for ${width} by ${height}`);
    if (Math.abs(width / height / (wanted[0] / (wanted[1] ?? 1)) - 1) > 0.01)
      faults.push(`a picture of ${width} by ${height} is stretched`);
    if (height > innerHeight) faults.push("a picture is higher than the window");
  }
  return [...new Set(faults)];
}"""
SETTLED = """() => new Promise(done => {
  let frames = 6;
  const wait = () => --frames ? requestAnimationFrame(wait) : done();
  wait();
})"""


@cache
def devtools(page: Page) -> CDPSession:
    """What sets sizes of the page; they hold for as long as it lives."""
    return page.context.new_cdp_session(page)


def resize(page: Page, size: Size) -> None:
    """Give the page a window of this size, as a browser does at this zoom."""
    width, height = round(size.width / size.zoom), round(size.height / size.zoom)
    metrics = {"width": width, "height": height, "deviceScaleFactor": size.zoom, "mobile": False}
    devtools(page).send("Emulation.setDeviceMetricsOverride", metrics)
    page.wait_for_function(f"innerWidth === {width}", timeout=READY)
    page.evaluate(SETTLED)


def faults_at(page: Page, selector: str, sizes: list[Size], shots: str) -> list[str]:
    """Say what is wrong with an element at these sizes."""
    found = []
    for size in sizes:
        resize(page, size)
        one = page.locator(selector).last
        one.evaluate("one => one.scrollIntoView({ block: 'start' })")
        page.evaluate(SETTLED)
        faults = one.evaluate(MEASURE)
        if faults or os.environ.get("IKTEACH_FULL") == "1":
            shoot(page, f"layout_{shots}_{size.width}_{size.zoom:g}")
        found += [f"{size}: {fault}" for fault in faults]
    return found


def shoot(page: Page, name: str) -> None:
    """Take a screenshot as it is; Playwright's own would first put its size of the window back."""
    SHOTS.mkdir(exist_ok=True)
    shot = devtools(page).send("Page.captureScreenshot", {"format": "png"})["data"]
    (SHOTS / f"{name}.png").write_bytes(base64.b64decode(shot))


@pytest.fixture(scope="module")
def figures(open_notebook: Any, lab: Lab) -> Iterator[Notebook]:
    cells = [nbformat.v4.new_code_cell("from ikteach.body import figures")]
    for name, (get, arguments, _) in FIGURES.items():
        cell = f"# {name}\n{get}\nmade = Made({arguments})\nmade"
        cells.append(nbformat.v4.new_code_cell(cell))
    book = nbformat.v4.new_notebook(cells=cells)
    book.metadata.kernelspec = {"name": "python3", "display_name": "Python 3"}
    nbformat.write(book, lab.folder / "layout.ipynb")
    notebook = open_notebook("layout.ipynb")
    notebook.run_cell("from ikteach.body")
    yield notebook
    assert notebook.errors == []


@pytest.fixture(scope="module")
def made(figures: Notebook, request: pytest.FixtureRequest) -> Iterator[str]:
    """Make a figure; it stands still, and ends with the last of its tests."""
    name = request.param
    resize(figures.page, LAPTOP)
    figures.run_cell(f"# {name}")
    figures.page.wait_for_selector(FIGURES[name][2], timeout=READY)
    figures.kernel("None", "getattr(getattr(made, 'player', made), 'pause', int)()")
    yield name
    figures.kernel("None", "made.close()")
    figures.command("notebook:clear-all-cell-outputs")


@pytest.mark.parametrize("made", FIGURES, indirect=True, scope="module")
def test_nothing_stands_on_anything_and_nothing_is_cut(figures: Notebook, made: str) -> None:
    assert faults_at(figures.page, FIGURE, SIZES, made) == []


@pytest.mark.parametrize("made", BESIDE, indirect=True, scope="module")
def test_picture_and_numbers_are_seen_together(figures: Notebook, made: str) -> None:
    """On a small laptop, with the list of files open: the picture, and beside it what acts."""
    page = figures.page
    resize(page, LAPTOP)
    page.locator(".ikteach-arranged").last.evaluate("one => one.scrollIntoView()")
    page.evaluate(SETTLED)
    view = page.locator(".jp-NotebookPanel:visible .jp-WindowedPanel-outer").bounding_box()
    picture = page.locator(
        f"{CANVAS_OF} canvas:visible, .ikteach-plane:visible"
    ).last.bounding_box()
    control = page.locator(".ikteach-beside :is(.noUi-handle, button)").first.bounding_box()
    assert view is not None
    assert picture is not None
    assert control is not None
    assert picture["y"] + picture["height"] <= view["y"] + view["height"]
    assert control["x"] >= picture["x"] + picture["width"]
    assert control["y"] <= view["y"] + view["height"]


@pytest.mark.parametrize("made", ["09"], indirect=True, scope="module")
def test_a_target_is_under_the_pointer_after_a_resize(figures: Notebook, made: str) -> None:
    page = figures.page
    figures.kernel("None", "made.session.by_hand = True; made.acted()")
    for size in (Size(1280, 720), Size(1366, 648, 1.25)):
        resize(page, size)
        canvas = page.locator(f"{CANVAS_OF} canvas").last
        canvas.scroll_into_view_if_needed()
        page.evaluate(SETTLED)
        box = canvas.bounding_box()
        assert box
        across, up = figures.kernel("spot_of(made)", SPOT)
        x = box["x"] + (1 + across) / 2 * box["width"]
        y = box["y"] + (1 - up) / 2 * box["height"]
        page.mouse.move(x, y)
        page.mouse.down()
        page.mouse.move(x - 30, y - 20, steps=4)
        page.mouse.up()
        figures.settle(f"near(made, {across - 60 / box['width']}, {up + 40 / box['height']})", True)


CANVAS_OF = ".ikteach-scene .jupyter-threejs"
# Where the last target is in the picture, −1 to 1 from left to right and from below to above.
SPOT = """
import numpy as np
from ikteach.view.stage.stage import FIELD, picture_axes

def spot_of(bench):
    camera, centre = bench.scene.camera, bench.scene.stage.extent.centre
    eye = np.array(camera.position)
    x, y, z = (bench.session.targets[-1] - eye) @ picture_axes(eye - centre)
    half = np.tan(np.radians(FIELD) / 2)
    return [float(x / -z / half / camera.aspect), float(y / -z / half)]

def near(bench, across, up):
    return bool(np.allclose(spot_of(bench), [across, up], atol=0.01))
"""


@pytest.fixture(scope="module")
def lecture(tmp_path_factory: pytest.TempPathFactory, browser: Browser) -> Iterator[Any]:
    """Open pages of a lecture."""
    folder: Path = tmp_path_factory.mktemp("lecture")
    command = [sys.executable, "-u", "-m", "ikteach", "lecture", str(folder), "--no-browser"]
    environment = os.environ | {"OPENBLAS_NUM_THREADS": "1", "JUPYTER_CONFIG_DIR": str(folder)}
    server = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=environment)
    assert server.stdout is not None
    page = open_page(browser, PROJECTOR.width, PROJECTOR.height)
    try:
        said = iter(server.stdout)
        found = next(filter(None, (re.search(r":(\d+)/\?(token=[\w-]+)", line) for line in said)))

        def open_one(name: str) -> Page:
            page.goto(f"http://127.0.0.1:{found[1]}/voila/render/{name}.ipynb?{found[2]}")
            page.wait_for_selector(f"{DRIVER}[data-frame]", timeout=2 * READY)
            pause = page.get_by_role("button", name="Pause")
            if pause.count():
                pause.click()
            return page

        yield open_one
    finally:
        page.close()
        server.send_signal(signal.SIGINT)
        server.wait(30)


@pytest.mark.parametrize("name", ["workbench", "race"])
def test_a_lecture_is_whole_and_its_end_is_reached(lecture: Any, name: str) -> None:
    page: Page = lecture(name)
    found = []
    for size in (PROJECTOR, *SMALL):
        found += faults_at(page, FIGURE, [size], f"lecture_{name}")
        page.mouse.move(5, 5)
        page.mouse.wheel(0, 20_000)
        page.evaluate(SETTLED)
        end = page.locator("#rendered_cells .jp-Cell").last.evaluate(
            "one => { const { bottom, right } = one.getBoundingClientRect();"
            " return bottom <= innerHeight && right <= innerWidth; }"
        )
        if not end:
            found.append(f"{size}: the end is out of reach")
    assert found == []
