"""Front ends that cannot show a live figure: what is told in the cell, and what is seen there."""

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
CELL = "from ikteach.view import GaitPlayer\nplayer = GaitPlayer()\nplayer"


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
    book = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(CELL)])
    book.metadata.kernelspec = {"name": "python3", "display_name": "Python 3"}
    nbformat.write(book, lab.folder / "lacking.ipynb")
    lab.stop_kernels()
    notebooks: list[Notebook] = []

    def open_one(browser: Browser) -> Notebook:
        notebooks.append(Notebook(open_page(browser), lab, "lacking.ipynb"))
        notebooks[-1].run_cell("GaitPlayer")
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


def test_a_whole_page_hears_nothing_of_it(
    figure: Callable[[Browser], Notebook], browser: Browser
) -> None:
    notebook = figure(browser)
    notebook.page.wait_for_selector(f"{DRIVER}[data-frame]", timeout=READY)
    notebook.page.wait_for_selector(STILL, state="attached", timeout=READY)
    notebook.frames(200)  # longer than any of them waits
    assert not notebook.page.locator(f"{STILL}, {PICTURES}").locator("visible=true").count()
    assert notebook.errors == []
