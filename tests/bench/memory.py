"""What a long run of the workbench leaves behind: a real JupyterLab, a headless Chromium.

    python tests/bench/memory.py [minutes, 30 if not given] [--fast]

Reports how the kernel's memory grows once it is warm, and which loops and threads are left when the
cell has been run again, after quit, and when the notebook has been closed. `--fast` lets the ticks
of so many minutes pass without waiting for the clock; the page draws what it can of them.
"""

import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2]))
from tests.browser.conftest import Notebook, lab_and_page

RATE = 30  # ticks of a second
WARM = 4000  # ticks: the record holds 3,000
TOLD = 10  # times that the memory is reported
CELL = "bench = Workbench()"
WATCH = """
import asyncio, gc, threading
from pathlib import Path
from time import monotonic
import psutil
from ipywidgets.widgets.widget import _instances
from ikteach.view.chapters import workbench
from ikteach.view.live import live
def loops():
    tasks = asyncio.all_tasks(bench._act.loop)
    return sum("Live._run" in task.get_coro().__qualname__ for task in tasks)
def left():
    more = threading.active_count() - threads
    return f"{loops()} loops, {more} threads more, {len(_instances)} widgets"
def memory():
    gc.collect()
    return [bench.session.ticks, psutil.Process().memory_info().rss / 1e6]
async def watch():
    while True:
        Path("left.txt").write_text(left())
        await asyncio.sleep(0.5)
threads = threading.active_count()
watching = asyncio.ensure_future(watch())
"""
# Always late, and so no tick is waited for; but curves and words come as often as if it were not.
FAST = "live.monotonic = lambda: 1000 * monotonic(); live.Live.SELDOM = 1"


def main(minutes: float, fast: bool) -> None:
    """Let it run, then end it in every way, and print what is left."""
    with lab_and_page() as (lab, page):
        notebook = Notebook(page, lab, "09_workbench.ipynb")
        run_cell(notebook)
        notebook.kernel("None", WATCH + (FAST if fast else ""))
        grow(notebook, round(minutes * 60 * RATE))
        notebook.kernel("None", "live.monotonic = monotonic")
        left(notebook, "playing")
        run_cell(notebook)
        left(notebook, "after the cell was run again")
        notebook.press("Quit")
        left(notebook, "after quit")
        run_cell(notebook)
        page.goto("about:blank")
        time.sleep(14)  # longer than `driver.PATIENCE`
        print("notebook closed:", (lab.folder / "left.txt").read_text())
        print(f"errors in the page: {notebook.errors or 'none'}")


def run_cell(notebook: Notebook) -> None:
    """Run the cell of the workbench, and wait for its picture."""
    notebook.page.evaluate("document.querySelector('.ikteach-driver')?.remove()")
    notebook.run_figure(CELL)


def left(notebook: Notebook, when: str) -> None:
    """Print what runs in the kernel."""
    notebook.page.wait_for_timeout(3000)
    print(f"{when}: {notebook.kernel('left()')}")


def grow(notebook: Notebook, ticks: int) -> None:
    """Print memory against ticks."""
    began = time.monotonic()
    first = reach(notebook, WARM)
    for i in range(1, TOLD + 1):
        tick, now = reach(notebook, WARM + i * ticks / TOLD)
        heap = notebook.page.evaluate("performance.memory.usedJSHeapSize / 1e6")
        print(f"{tick:7.0f} ticks, {time.monotonic() - began:5.0f} s: {now:.1f} MB, "
              f"{now - first[1]:+.1f} since warm; page {heap:.0f} MB", flush=True)  # fmt: skip


def reach(notebook: Notebook, ticks: float) -> list[float]:
    """Wait for so many ticks; the ticks that there are, and the kernel's memory [MB]."""
    while (now := notebook.kernel("memory()"))[0] < ticks:
        notebook.page.wait_for_timeout(2000)
    return now


if __name__ == "__main__":
    numbers = [float(one) for one in sys.argv[1:] if one != "--fast"]
    main(*(numbers or [30.0]), "--fast" in sys.argv)
