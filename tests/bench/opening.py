"""From the click to a moving figure: JupyterLab and the lecture's page, in turns.

    python tests/bench/opening.py [rounds, 5 if not given]

Both show the workbench, from servers that run already, in a page and a kernel of their own. In
JupyterLab the cell of the figure is run as soon as it can be. The browser keeps what it has loaded
from the second round on. Trust it on a machine that does nothing else.
"""

import shutil
import statistics
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

from playwright.sync_api import Browser, Page, sync_playwright

sys.path.insert(0, str(Path(__file__).parents[2]))
from tests.browser.conftest import READY, ROOT, SHOWN, Lab, Notebook, open_browser, open_page
from tests.browser.test_lecture import Lecture


def main(rounds: int) -> None:
    """Start both servers, open pages in turns, and print the times."""
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as play:
        began = time.monotonic()
        browser = open_browser(play)
        shutil.copytree(ROOT / "notebooks", folder, dirs_exist_ok=True)
        lab = Lab(Path(folder))
        lab.wait()
        print(f"JupyterLab answers {time.monotonic() - began:.1f} s after its start")
        began = time.monotonic()
        lecture = Lecture(Path(folder) / "lecture", browser)
        print(f"the lecture answers {time.monotonic() - began:.1f} s after its start")
        try:
            ways: dict[str, Callable[[Page], Page]] = {
                "Lab": lambda page: in_lab(page, lab),
                "lecture": lambda page: in_lecture(page, lecture),
            }
            times: dict[str, list[float]] = {name: [] for name in ways}
            for _ in range(rounds):
                for name, way in ways.items():
                    times[name].append(opened(browser, way))
                    lab.stop_kernels()
        finally:
            lecture.stop()
            lab.stop()
    for name, one in times.items():
        later = f", then median {statistics.median(one[1:]):.1f} s" if one[1:] else ""
        print(f"{name}: first {one[0]:.1f} s{later}, click to moving figure")


def opened(browser: Browser, way: Callable[[Page], Page]) -> float:
    """The seconds until a second frame is on the screen."""
    page = open_page(browser, 1280, 900)
    began = time.monotonic()
    way(page).wait_for_function(
        f"document.querySelector('.ikteach-driver')?.dataset.shown && {SHOWN} >= 2",
        timeout=3 * READY,
    )
    seconds = time.monotonic() - began
    page.close(run_before_unload=True)
    return seconds


def in_lab(page: Page, lab: Lab) -> Page:
    """Chapter 9 in JupyterLab, its figure's cell run."""
    Notebook(page, lab, "09_workbench.ipynb").run_cell("bench = Workbench()")
    return page


def in_lecture(page: Page, lecture: Lecture) -> Page:
    """The first page of the lecture."""
    page.goto(lecture.address, wait_until="commit")
    return page


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 5)
