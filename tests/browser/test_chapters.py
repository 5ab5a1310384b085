"""Each chapter's live figure in a real browser: every slider to both ends, and never an empty view.

A chapter is a row of `CHAPTERS`: the notebook, words of the cell that makes the figure, the
expression that gives it in the kernel, and where its picture is. The figure has `controls`
{name: widget} and says what went wrong in `_alert`.
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
    Chapter("00_figure.ipynb", "Poser(figures.human())", "_B._living['poser']", CANVAS),
    Chapter("01_jacobian.ipynb", "ColumnPoser(figures.human())", "_B._living['columns']", CANVAS),
    Chapter("02_singularity.ipynb", "BendBench()", "_B._living['bend']", CANVAS),
    Chapter("03_transpose.ipynb", "bench = slope_bench()", "bench", PICTURE),
    Chapter("04_pseudoinverse.ipynb", "player = CapPlayer()", "player", CANVAS),
    Chapter("05_dls.ipynb", "bench = tradeoff_bench()", "bench", PICTURE),
    Chapter("06_sdls.ipynb", "bench = spectrum_bench()", "bench", PICTURE),
    Chapter("08_comparison.ipynb", "race = Race()", "race", CANVAS),
]
IN_KERNEL = "from ikteach.view.bench import Bench as _B"


@pytest.mark.parametrize("chapter", CHAPTERS, ids=lambda chapter: chapter.notebook[:2])
def test_every_slider_to_both_ends(open_notebook: Any, chapter: Chapter) -> None:
    notebook = open_notebook(chapter.notebook)
    notebook.run_cell(chapter.cell)
    notebook.page.wait_for_selector(chapter.picture, timeout=READY)
    figure = chapter.figure
    ends = notebook.kernel(
        f"{{name: [c.value, c.min, c.max] for name, c in {figure}.controls.items()"
        " if hasattr(c, 'min')}",
        IN_KERNEL,
    )
    assert ends
    wait_for_picture(notebook, chapter)
    notebook.shot(f"{chapter.notebook[:2]}_live")
    logs = set(notebook.kernel(f"[n for n, c in {figure}.controls.items() if hasattr(c, 'base')]"))
    for name, (was, *both) in ends.items():
        control = f"{figure}.controls['{name}']"
        for end in both:
            notebook.kernel("None", f"{control}.value = {10.0**end if name in logs else end}")
            assert notebook.kernel(f"{figure}._alert.value") == ""
        wait_for_picture(notebook, chapter)
        notebook.kernel("None", f"{control}.value = {was}")
    by_keys(notebook, figure)
    assert notebook.errors == []


def by_keys(notebook: Notebook, figure: str) -> None:
    """The first slider that is seen goes to its ends by Home and End."""
    handle = notebook.page.locator(".jp-OutputArea .noUi-handle:visible").first
    for key, end in ("Home", "min"), ("End", "max"):
        handle.focus()
        notebook.page.keyboard.press(key)
        until(
            lambda end=end: notebook.kernel(
                f"any(c.value == c.{end} or getattr(c, 'base', 10)**c.{end} == c.value"
                f" for c in {figure}.controls.values() if hasattr(c, 'min'))"
            )
        )


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
