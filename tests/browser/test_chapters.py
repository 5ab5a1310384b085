"""Each chapter's live figure in a real browser: every slider to both ends, and never an empty view.

A chapter is a row of `CHAPTERS`: the notebook, words of the cell that makes the figure, the
expression that gives it in the kernel, and where its picture is. The figure has `controls`
{name: widget} and says what went wrong in `status.wrong`.
"""

import io
import time
from typing import Any, NamedTuple

import numpy as np
import pytest
from PIL import Image

from tests.browser.conftest import READY, Notebook

CANVAS = ".ikteach-scene canvas"
PICTURE = ".jp-OutputArea-output img"


class Chapter(NamedTuple):
    """A notebook and its live figure."""

    notebook: str
    cell: str
    figure: str
    picture: str


CHAPTERS = [
    Chapter("00_figure.ipynb", "Poser(figures.human())", "occupant('poser')", CANVAS),
    Chapter("01_jacobian.ipynb", "ColumnPoser(figures.human())", "occupant('columns')", CANVAS),
    Chapter("02_singularity.ipynb", "BendBench()", "occupant('bend')", CANVAS),
    Chapter("03_transpose.ipynb", "bench = slope_bench()", "bench", PICTURE),
    Chapter("04_pseudoinverse.ipynb", "player = CapPlayer()", "player", CANVAS),
    Chapter("05_dls.ipynb", "bench = tradeoff_bench()", "bench", PICTURE),
    Chapter("06_sdls.ipynb", "bench = spectrum_bench()", "bench", PICTURE),
    Chapter("08_comparison.ipynb", "race, walk = Race()", "race", CANVAS),
]
ENDS = """from ikteach.view.widgets.closing import occupant

def all_to(figure, which):
    "All sliders at once to one of their ends. (One by one, without a page: tests/view.)"
    for control in figure.controls.values():
        if hasattr(control, "min"):
            control.value = end(control, which)


def end(control, which):
    "The value at an end of a slider."
    value = (control.min, control.max)[which]
    return control.base**value if hasattr(control, "base") else value
"""


@pytest.mark.parametrize("chapter", CHAPTERS, ids=lambda chapter: chapter.notebook[:2])
def test_sliders_to_both_ends_and_by_keys(open_notebook: Any, chapter: Chapter) -> None:
    notebook = open_notebook(chapter.notebook)
    notebook.run_cell(chapter.cell)
    notebook.page.wait_for_selector(chapter.picture, timeout=READY)
    figure = chapter.figure
    wait_for_picture(notebook, chapter)
    notebook.shot(f"{chapter.notebook[:2]}_live")
    notebook.kernel("None", ENDS)
    for which in (0, 1):
        notebook.kernel("None", f"all_to({figure}, {which})")
        wait_for_picture(notebook, chapter)
        notebook.shot(f"{chapter.notebook[:2]}_end_{which}")
    by_keys(notebook, figure)
    assert notebook.kernel(f"{figure}.status.wrong") == ""
    assert notebook.errors == []


def by_keys(notebook: Notebook, figure: str) -> None:
    """The first slider that is seen goes to its ends by Home and End."""
    handle = notebook.page.locator(".jp-OutputArea .noUi-handle:visible").first
    for key, end in ("Home", 0), ("End", 1):
        handle.focus()
        notebook.page.keyboard.press(key)
        at_end = f"c.value == end(c, {end}) for c in {figure}.controls.values()"
        until(lambda at_end=at_end: notebook.kernel(f"any({at_end} if hasattr(c, 'min'))"))


def until(holds: Any) -> None:
    limit = time.monotonic() + 20
    while not holds():
        assert time.monotonic() < limit
        time.sleep(0.05)


def wait_for_picture(notebook: Notebook, chapter: Chapter) -> None:
    """Wait until the picture shows something: other colours than those of its corners and edges."""
    until(lambda: something(notebook.page.locator(chapter.picture).first.screenshot(timeout=READY)))


def something(png: bytes) -> bool:
    picture = np.asarray(Image.open(io.BytesIO(png)).convert("RGB")).astype(int)
    return bool((abs(picture - picture[2, 2]).max(axis=-1) > 40).mean() > 0.005)
