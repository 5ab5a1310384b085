"""A chapter that was saved after its cells ran twice: the page is loaded anew, and all is there."""

import shutil
from typing import Any

import pytest

from tests.browser.conftest import READY, Lab, Notebook
from tests.browser.test_chapters import CHAPTERS, ENDS, Chapter, by_keys, wait_for_picture

NAME = "reload.ipynb"  # a copy, for it is saved with its output
WIDGETS = [".ikteach-question", ".jp-OutputArea .noUi-handle"]
RESTART = """async () => {
  const { session } = window.jupyterapp.shell.currentWidget.sessionContext;
  await session.kernel.restart();
  await session.kernel.info;
}"""
LOST = ["Error displaying widget", "Click to show javascript error", "Loading widget"]
A_FIGURE, A_PICTURE = CHAPTERS[0], CHAPTERS[3]


@pytest.mark.parametrize("chapter", [A_FIGURE, A_PICTURE], ids=lambda chapter: chapter.notebook[:2])
def test_all_is_there_after_a_reload(open_notebook: Any, lab: Lab, chapter: Chapter) -> None:
    shutil.copy(lab.folder / chapter.notebook, lab.folder / NAME)
    notebook: Notebook = open_notebook(NAME)
    page = notebook.page
    for _ in range(2):
        notebook.run_all()  # and wait until it is done
    wait_for_picture(notebook, chapter)
    before = {what: page.locator(what).count() for what in WIDGETS}
    assert all(before.values())
    notebook.command("docmanager:save")
    notebook.reload()
    for what, number in before.items():
        there = f"document.querySelectorAll({what!r}).length === {number}"
        page.wait_for_function(there, timeout=READY)
    wait_for_picture(notebook, chapter)
    notebook.shot(f"reload_{chapter.notebook[:2]}")
    for words in LOST:
        assert not page.get_by_text(words).locator("visible=true").count(), words
    notebook.kernel("None", ENDS)
    by_keys(notebook, chapter.figure)
    assert notebook.errors == []
    start_anew(notebook)


def start_anew(notebook: Notebook) -> None:
    """After a kernel was started anew, a page that is loaded shows stills, and what to run."""
    page = notebook.page
    page.evaluate(RESTART)
    notebook.reload()
    page.locator(".ikteach-still img").first.wait_for(timeout=READY)
    assert page.locator(".jp-OutputArea p", has_text="Run All Cells").count() >= 1
    for words in LOST:
        assert not page.get_by_text(words).locator("visible=true").count(), words
