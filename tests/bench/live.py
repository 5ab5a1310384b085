"""How live the scene is: chapter 7 in a real JupyterLab and a headless Chromium.

    python tests/bench/live.py [seconds to run before the slider is moved, 120 if not given]

Reports poses shown a second, the frames under way, and the time from a key on the speed slider to
the first pose drawn that knows of it. Trust it on a machine that does nothing else.
"""

import statistics
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2]))
from tests.browser.conftest import Notebook, lab_and_page

DRIVER = "document.querySelector('.ikteach-driver').dataset"
MOVES = 40

# Press an arrow on the focused slider and resolve with the milliseconds until the pose is drawn.
MOVE = f"""key => new Promise(done => {{
  const before = +{DRIVER}.change, began = performance.now();
  const handle = document.activeElement;
  handle.dispatchEvent(new KeyboardEvent("keydown", {{ key, bubbles: true, cancelable: true }}));
  const look = () => +{DRIVER}.change > before
    ? done(performance.now() - began)
    : performance.now() - began > 5000 ? done(NaN) : requestAnimationFrame(look);
  look();
}})"""


def main(seconds: float) -> None:
    """Start everything, let it run, move the slider, and print what came of it."""
    with lab_and_page() as (lab, page):
        notebook = Notebook(page, lab, "07_gait.ipynb")
        began = time.monotonic()
        notebook.run_figure("player = GaitPlayer()")
        print(f"first pose {time.monotonic() - began:.1f} s after the cell was run")
        measure(notebook, seconds)


def measure(notebook: Notebook, seconds: float) -> None:
    """Print the rate over the run, then the delays after it."""
    page = notebook.page
    look = f"[+{DRIVER}.shown, +{DRIVER}.frame, performance.now() / 1000]"
    page.wait_for_timeout(3000)
    start = page.evaluate(look)
    ahead = []
    while page.evaluate("performance.now() / 1000") - start[2] < seconds:
        page.wait_for_timeout(1000)
        drawn = page.evaluate(look)[1]
        ahead.append(notebook.kernel("player.scene.driver.sent") - drawn)
    end = page.evaluate(look)
    time_run = end[2] - start[2]
    print(f"{(end[0] - start[0]) / time_run:.1f} poses shown a second, "
          f"{(end[1] - start[1]) / time_run:.1f} sent, over {time_run:.0f} s")  # fmt: skip
    third = max(1, len(ahead) // 3)
    print(f"frames under way: {statistics.mean(ahead[:third]):.1f} in the first third, "
          f"{statistics.mean(ahead[-third:]):.1f} in the last")  # fmt: skip
    page.locator(".widget-slider", has_text="speed ω").locator(".noUi-handle").focus()
    delays = []
    for i in range(MOVES):
        delays.append(page.evaluate(MOVE, "ArrowRight" if i % 2 == 0 else "ArrowLeft"))
        page.wait_for_timeout(150 + 37 * (i % 5))
    lost = sum(delay != delay for delay in delays)
    delays = sorted(delay for delay in delays if delay == delay)
    print(f"slider to pose: median {statistics.median(delays):.0f} ms, "
          f"95 % {delays[int(0.95 * len(delays))]:.0f} ms, {lost} of {MOVES} lost")  # fmt: skip
    print(f"errors in the page: {notebook.errors or 'none'}")


if __name__ == "__main__":
    main(float(sys.argv[1]) if len(sys.argv) > 1 else 120)
