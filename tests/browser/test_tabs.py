"""One kernel and its pages: two that look at once, one that comes again, none any more."""

import shutil
import time
from collections.abc import Iterator
from typing import Any

import pytest
from playwright.sync_api import Browser

from tests.browser.conftest import DRIVER, READY, Lab, Notebook, open_page
from tests.browser.test_workbench import LOOPS

NAME = "tabs.ipynb"  # a copy, for it is saved with its output
FRAME = f"+document.querySelector('{DRIVER}').dataset.frame"
WATCH = f"""
import asyncio, pathlib
from ikteach.view.webgl import driver
driver.PATIENCE = 1.0
async def watch():
    while True:
        pathlib.Path("loops").write_text(str({LOOPS}))
        await asyncio.sleep(0.2)
watching = asyncio.ensure_future(watch())
"""


@pytest.fixture(scope="module")
def first(lab: Lab, open_notebook: Any) -> Iterator[Notebook]:
    """A page in which the workbench has played, in a notebook that has been saved with it."""
    shutil.copy(lab.folder / "09_workbench.ipynb", lab.folder / NAME)
    notebook = open_notebook(NAME)
    notebook.run_figure("bench = Workbench()")
    notebook.press("Pause")  # the second page has enough to do
    notebook.settle("bench._task.done()", True)
    notebook.command("docmanager:save")
    yield notebook
    assert notebook.errors == []


@pytest.fixture(scope="module")
def second(first: Notebook, lab: Lab, browser: Browser) -> Iterator[Notebook]:
    """Another page with the same notebook, on the same kernel: it shows the pose without a cell."""
    notebook = Notebook(open_page(browser), lab, NAME)
    notebook.page.wait_for_selector(f"{DRIVER}[data-frame]", timeout=2 * READY)
    yield notebook
    notebook.page.close()
    assert notebook.errors == []


def test_two_tabs_show_the_same(first: Notebook, second: Notebook) -> None:
    assert len(first.lab.ask("kernels")) == 1
    second.press("Play")
    for page in first, second:
        page.frames(5)
    first.press("Pause")
    second.settle("[bench.playing, bench._task.done()]", [False, True])
    second.page.get_by_role("button", name="Play", exact=True).first.wait_for(timeout=READY)
    first.press("sdls")
    second.settle("bench.session.method", "sdls")
    second.page.wait_for_selector("button.mod-active >> text=sdls", timeout=READY)
    sent = first.kernel("bench.scene.driver.sent")
    for page in first, second:
        page.page.wait_for_function(f"{FRAME} >= {sent}", timeout=READY)
    first.press("Play")
    for page in first, second:
        page.frames(5)
    assert first.kernel(LOOPS) == 1
    assert first.kernel("bench.status.wrong") == ""


def test_a_page_that_comes_later_can_run_the_cell_again(first: Notebook, second: Notebook) -> None:
    run_again(second)  # it has shown what went on without that
    gone = first.page.locator(DRIVER).first
    gone.wait_for(state="detached", timeout=READY)  # the other page shows no dead picture


def test_a_reloaded_page_goes_on_when_the_cell_is_run_again(
    first: Notebook, second: Notebook
) -> None:
    second.command("docmanager:save")  # else Lab looks for the figure of before, in vain
    second.reload()
    run_again(second)


def run_again(page: Notebook) -> None:
    """Run the cell, and see that there is a new figure, which moves, and one loop."""
    old = page.kernel("bench.scene.driver.model_id")
    page.run_cell("bench = Workbench()")
    page.settle(f"bench.scene.driver.model_id != {old!r} and bench.scene.driver.seen", True)
    page.frames(5)
    assert page.kernel(LOOPS) == 1


def test_no_loop_is_left_when_the_notebook_is_closed(first: Notebook, second: Notebook) -> None:
    second.kernel("None", WATCH)
    said = second.lab.folder / "loops"
    for page in first, second:
        page.page.goto("about:blank")
    end = time.monotonic() + READY / 1000
    while not said.exists() or said.read_text() != "0":
        assert time.monotonic() < end, "the loop runs on"
        time.sleep(0.2)
    assert len(second.lab.ask("kernels")) == 1  # and the kernel is still there
