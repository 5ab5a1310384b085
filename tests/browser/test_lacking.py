"""Pages that cannot show a live figure, or fail: what is told in the cell, and what goes on."""

import json
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from html.parser import HTMLParser

import nbformat
import numpy as np
import pytest
from playwright.sync_api import Browser

from ikteach.view.widgets.lacking import LACKING, WIDGETS
from tests.browser.conftest import DRIVER, READY, Lab, Notebook, launch, open_page, pixels

PICTURES, STILL = ".ikteach-pictures", ".ikteach-still"
ERROR = "Click to show javascript error"
THREE = ["jupyter.extensions.jupyter-threejs", "jupyterlab-datawidgets"]
ANYWIDGET, IPYWIDGETS = "anywidget", "@jupyter-widgets/jupyterlab-manager"
FAILED, SCENE = ".ikteach-failed", f"{DRIVER}[data-frame]"
SESSION = "window.jupyterapp.shell.currentWidget.sessionContext.session"
CELL = """from ikteach import figures
from ikteach.view import GaitPlayer, Scene
from ikteach.view.webgl.targets import Targets
from ipywidgets import VBox
player = GaitPlayer()
player"""
ARM = """scene = Scene(*figures.planar_arm(3))
goal = Targets(scene, [[1.5, 1.5, 0]])
scene.show([0.4, 0.5, 0.6], goal.positions)
VBox([scene.widget, goal])"""


@contextmanager
def without(lab: Lab, *extensions: str) -> Iterator[None]:
    """The pages of this server get none of these extensions, as if they were not installed."""
    config = lab.folder / ".config" / "labconfig" / "page_config.json"
    config.parent.mkdir(parents=True, exist_ok=True)
    config.write_text(json.dumps({"disabledExtensions": dict.fromkeys(extensions, True)}))
    try:
        yield
    finally:
        config.unlink()


@pytest.fixture
def figure(lab: Lab) -> Iterator[Callable[[Browser], Notebook]]:
    """Open a notebook of one figure in a page of its own, and run it."""
    book = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(c) for c in (CELL, ARM)])
    book.metadata.kernelspec = {"name": "python3", "display_name": "Python 3"}
    nbformat.write(book, lab.folder / "lacking.ipynb")
    lab.stop_kernels()
    notebooks: list[Notebook] = []

    def open_one(browser: Browser) -> Notebook:
        notebooks.append(Notebook(open_page(browser), lab, "lacking.ipynb"))
        notebooks[-1].run_cell("player =")
        return notebooks[-1]

    yield open_one
    for notebook in notebooks:
        notebook.page.close()


def picture(notebook: Notebook, selector: str, shot: str) -> np.ndarray:
    """A still picture in the page, in which a figure is seen."""
    seen = pixels(notebook.shot(shot, f"{selector} img"))
    assert (abs(seen - seen[2, 2]).max(axis=-1) > 40).mean() > 0.02, "no figure is seen"
    return seen


def goes_on_in_pictures(notebook: Notebook, cause: str) -> None:
    """The cause is told, in place of an error, and the pictures follow what the kernel plays."""
    page = notebook.page
    page.wait_for_selector(f"{PICTURES} img[src]", timeout=READY)
    assert page.locator(f"{PICTURES} [role=alert]").inner_text() == LACKING[cause]
    assert not page.get_by_text(ERROR).locator("visible=true").count()
    first = picture(notebook, PICTURES, f"lacking_{cause}")
    notebook.frames(3)
    later = picture(notebook, PICTURES, f"lacking_{cause}")
    assert (abs(first - later).max(axis=-1) > 40).mean() > 0.001
    # The newest frame is seen, also where no other comes after it.
    notebook.press("Pause")
    notebook.settle("player._task.done()", True)
    sent = notebook.kernel("player.scene.driver.sent")
    newest = f"+document.querySelector('{DRIVER}').dataset.frame === {sent}"
    page.wait_for_function(newest, timeout=READY)
    assert notebook.kernel("player.status.wrong") == ""


def text_of(html: str) -> str:
    """The text of some HTML."""
    parts: list[str] = []
    parser = HTMLParser()
    parser.handle_data = parts.append  # type: ignore[method-assign]
    parser.feed(html)
    return "".join(parts)


def test_a_browser_without_webgl(figure: Callable[[Browser], Notebook], browser: Browser) -> None:
    blind = launch(browser.browser_type, "--disable-3d-apis")
    try:
        goes_on_in_pictures(figure(blind), "webgl")
    finally:
        blind.close()


def test_a_server_without_pythreejs(
    figure: Callable[[Browser], Notebook], browser: Browser, lab: Lab
) -> None:
    with without(lab, *THREE):
        goes_on_in_pictures(figure(browser), "pythreejs")


@pytest.mark.parametrize("more", [[], [IPYWIDGETS]], ids=["anywidget", "ipywidgets"])
def test_a_server_without_widgets(
    figure: Callable[[Browser], Notebook], browser: Browser, lab: Lab, more: list[str]
) -> None:
    """Nothing of ours runs in the page: what is told has come with the output."""
    with without(lab, *THREE, ANYWIDGET, *more):
        notebook = figure(browser)
        words = notebook.page.locator(f"{STILL} p").locator("visible=true").first
        words.wait_for(timeout=READY)
        assert words.inner_text() == text_of(WIDGETS)
        errors = notebook.page.locator(".ikteach-scene").get_by_text(ERROR)
        assert not errors.locator("visible=true").count()
        picture(notebook, STILL, f"lacking_{'ipywidgets' if more else 'anywidget'}")


def test_a_whole_page_hears_nothing_of_it_and_what_fails_in_it_is_told_once(
    figure: Callable[[Browser], Notebook], browser: Browser
) -> None:
    notebook = figure(browser)
    page = notebook.page
    page.wait_for_selector(SCENE, timeout=READY)
    page.wait_for_selector(STILL, state="attached", timeout=READY)
    notebook.frames(190)  # longer than any of them waits
    assert not page.locator(f"{STILL}, {PICTURES}").locator("visible=true").count()
    # What fails stops nothing else.
    notebook.kernel("None", "player.close()")
    notebook.run_cell("scene =")
    page.wait_for_selector(".ikteach-stage", timeout=READY)
    page.wait_for_selector(SCENE, timeout=READY)
    for values in "[]", "[None]", "[[1.25, 1.0, 0.0]]":  # first a target that is not there
        notebook.kernel("None", f"goal.values = {values}")
    box = page.get_by_label("hand x", exact=True)
    page.wait_for_function("box => box.value === '1.25'", arg=box.element_handle(), timeout=READY)
    assert page.locator(FAILED).count() == 1
    assert page.locator(FAILED).inner_text().startswith("This did not work in the page")
    # Frames that are none, and then one.
    for odd in "{'frame': 1}", "{'frame': 1}, buffers=[b'123']", "{}", "{'picture': 1}":
        notebook.kernel("None", f"scene.driver.send({odd})")
    notebook.kernel("None", "scene.show([0.4, 0.5, 1.6], goal.positions)")
    notebook.settle("scene.driver.sent > 0", True)
    sent = notebook.kernel("scene.driver.sent")
    newest = f"+document.querySelector('{DRIVER}').dataset.frame === {sent}"
    page.wait_for_function(newest, timeout=READY)
    assert page.locator(FAILED).count() == 1
    # A kernel that has gone.
    page.evaluate(f"{SESSION}.kernel.restart()")
    page.locator(".ikteach-stage").focus()
    for key in "Tab", "ArrowUp":
        page.keyboard.press(key)
    page.wait_for_selector(f"{FAILED} >> text=its kernel has ended", timeout=READY)
    page.wait_for_function(f"{SESSION}?.kernel?.status === 'idle'", timeout=READY)
    notebook.run_cell("player =")
    page.wait_for_selector(SCENE, timeout=READY)
    notebook.frames(5)
    assert notebook.errors == []
