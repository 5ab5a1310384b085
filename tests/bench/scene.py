"""How live the scene is with one figure and with four: a real JupyterLab, a headless Chromium.

    python tests/bench/scene.py [seconds of each run, 10 if not given]

Reports poses drawn a second when 60 are asked, without and with every layer, and the time from a
pointer's move on a target to the first pose drawn that was solved for it. Trust it on a machine
that does nothing else.
"""

import statistics
import sys
import tempfile
from pathlib import Path

import nbformat
from playwright.sync_api import sync_playwright

sys.path.insert(0, str(Path(__file__).parents[2]))
from tests.browser.conftest import READY, Lab, Notebook, open_browser

DRIVER = "document.querySelector('.ikteach-driver').dataset"
MOVES = 40
CELL = """import asyncio
import numpy as np
from ikteach.body import figures, forward, jacobian, locate
from ikteach.motion import gait, step
from ikteach.solvers.singularity import ellipsoid
from ikteach.view import Scene
from ikteach.view.stage import LAYERS
from ikteach.view.targets import Targets
tree, effectors = figures.human()
methods = ["transpose", "pseudoinverse", "dls", "sdls"]
scenes = []
def build(count):
    global scene, targets, theta, change
    if scenes:
        scenes.pop().close()
    shown = methods[2:3] if count == 1 else methods
    names, width = ([""], 540) if count == 1 else (shown, 900)
    scene = Scene(tree, effectors, names=names, width=width)
    scenes.append(scene)
    targets = Targets(scene, gait.walking.at(0.3))
    theta, change = np.tile(tree.rest, (count, 1)), 0
    def follow(*_):
        global change
        change += 1
        solve(shown, targets.positions)
    targets.on_change(follow)
    follow()
    return scene.widget
def solve(shown, goal):
    for i, method in enumerate(shown):
        theta[i] = step(tree, theta[i], effectors, goal, method).theta
    J = jacobian(tree, forward(tree, theta[0]), effectors)[9:]
    scene.show(theta, goal, effector=3, columns=J, ellipsoid=ellipsoid(J), change=change)
async def walk(seconds, rate=60):
    loop = asyncio.get_running_loop()
    end, due, t = loop.time() + seconds, loop.time(), 0.0
    shown = methods[2:3] if len(theta) == 1 else methods
    while loop.time() < end:
        due = max(due + 1 / rate, loop.time() - 1 / rate)
        await asyncio.sleep(max(due - loop.time(), 0.001))
        t += 8 / rate
        if scene.driver.ready:
            solve(shown, gait.walking.at(t))"""

# Move the pointer over the stage, and resolve with the milliseconds until a pose knows of it.
MOVE = f"""([x, y]) => new Promise(done => {{
  const before = +{DRIVER}.change, began = performance.now();
  const stage = document.querySelector(".ikteach-stage");
  stage.dispatchEvent(new PointerEvent("pointermove", {{
    clientX: x, clientY: y, pointerId: window.pointer, pointerType: "mouse", buttons: 1 }}));
  const look = () => +{DRIVER}.change > before
    ? done(performance.now() - began)
    : performance.now() - began > 5000 ? done(NaN) : requestAnimationFrame(look);
  look();
}})"""
CATCH = """() => document.querySelector(".ikteach-stage").addEventListener(
  "pointerdown", event => { window.pointer = event.pointerId; }, true)"""
AT = """
from ikteach.view.stage import picture_axes
eye = np.array(scene.camera.position)
seen = (targets.positions[3] + scene.stage.places[0] - eye) @ picture_axes(eye)
spot = (seen[:2] / -seen[2]).tolist()
"""


def main(seconds: float) -> None:
    """Start everything, and print what one figure and four figures reach."""
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as play:
        counts = ["build(1)", "build(4)"]
        cells = [nbformat.v4.new_code_cell(cell) for cell in (CELL, *counts)]
        book = nbformat.v4.new_notebook(cells=cells)
        book.metadata.kernelspec = {"name": "python3", "display_name": "Python 3"}
        nbformat.write(book, Path(folder) / "scene.ipynb")
        lab = Lab(Path(folder))
        try:
            lab.wait()
            page = open_browser(play).new_page(viewport={"width": 1440, "height": 1100})
            notebook = Notebook(page, lab, "scene.ipynb")
            notebook.run_cell("import asyncio")
            for cell in counts:
                notebook.run_cell(cell)
                page.wait_for_selector(".ikteach-driver[data-frame]", timeout=READY)
                page.wait_for_selector(".ikteach-stage", timeout=READY)
                page.wait_for_timeout(1000)
                print(cell, end=": ")
                drag(notebook)
                rate(notebook, seconds, "plain")
                notebook.kernel("None", "[scene.switch(layer) for layer in LAYERS]")
                page.wait_for_timeout(3000)
                rate(notebook, seconds, "every layer")
                page.locator(".jp-OutputArea-output").first.evaluate("one => one.remove()")
            print(f"errors in the page: {notebook.errors or 'none'}")
        finally:
            lab.stop_kernels()
            lab.stop()


def rate(notebook: Notebook, seconds: float, what: str) -> None:
    """Print how many poses a second are drawn while the kernel asks for 60."""
    page = notebook.page
    look = f"[+{DRIVER}.shown, +{DRIVER}.frame, performance.now() / 1000]"
    notebook.kernel("None", f"walking = asyncio.ensure_future(walk({seconds + 3}))")
    page.wait_for_timeout(1500)
    start = page.evaluate(look)
    page.wait_for_timeout(1000 * seconds)
    end = page.evaluate(look)
    drawn, sent = ((end[i] - start[i]) / (end[2] - start[2]) for i in (0, 1))
    print(f"    {what}: {drawn:.1f} poses drawn a second of {sent:.1f} sent")
    page.wait_for_timeout(2500)


def drag(notebook: Notebook) -> None:
    """Take hold of a target and print the delays of its moves."""
    page = notebook.page
    page.locator(".ikteach-stage").first.scroll_into_view_if_needed()
    across, up = notebook.kernel("spot", AT)
    box = page.locator(".ikteach-stage canvas").first.bounding_box()
    assert box
    focal = box["height"] / 2 / 0.41421356
    x, y = box["x"] + box["width"] / 2 + focal * across, box["y"] + box["height"] / 2 - focal * up
    page.evaluate(CATCH)
    page.mouse.move(x, y)
    page.mouse.down()
    delays = []
    for i in range(MOVES):
        delays.append(page.evaluate(MOVE, [x - 3 * (i % 7), y - 4 * (i % 5) - 2 * (i % 2)]))
        page.wait_for_timeout(60 + 17 * (i % 5))
    page.mouse.up()
    lost = sum(delay != delay for delay in delays)
    delays = sorted(delay for delay in delays if delay == delay)
    print(f"mouse to pose: median {statistics.median(delays):.0f} ms, "
          f"95 % {delays[int(0.95 * len(delays))]:.0f} ms, {lost} of {MOVES} lost")  # fmt: skip


if __name__ == "__main__":
    main(float(sys.argv[1]) if len(sys.argv) > 1 else 10)
