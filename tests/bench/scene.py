"""How live the scene is with one figure and with four: a real JupyterLab, a headless Chromium.

    python tests/bench/scene.py [seconds of each run, 10 if not given]

Reports poses drawn a second when 30 and 60 are asked, without and with every layer, and what each
costs; the time from a move of the mouse that drags a target to the first pose drawn that was solved
for it; and that a page which could not draw for a while goes on with the newest frame; then the
poses a second of one figure in one view, two and four. Trust it on a machine that does nothing
else. The bars: one figure 30 and 50, four figures 20, one in any number of views 30; 60 ms; 1
message.
"""

import statistics
import sys
import time
from pathlib import Path

import nbformat

sys.path.insert(0, str(Path(__file__).parents[2]))
from tests.browser.conftest import READY, Notebook, lab_and_page

DRIVER = "document.querySelector('.ikteach-driver').dataset"
MOVES = 40
CELL = """import asyncio
import numpy as np
from ikteach.body import figures, forward, jacobian, locate
from ikteach.motion import gait, step
from ikteach.solvers.singularity import ellipsoid
from ikteach.view import Scene
from ikteach.view.stage.layers import LAYERS
from ikteach.view.webgl.targets import Targets
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

# What the page notes by itself: calls to draw, messages of widgets, and for each move of a pointer
# that holds something the time to the first drawn pose that knows of it.
NOTE = f"""
window.noted = {{ calls: 0, messages: 0, delays: [], began: null }};
for (const name of ["drawElements", "drawArrays"])
  for (const {{ prototype }} of [WebGLRenderingContext, WebGL2RenderingContext]) {{
    const draw = prototype[name];
    prototype[name] = function (...all) {{ noted.calls++; return draw.apply(this, all); }};
  }}
window.WebSocket = class extends WebSocket {{
  constructor(...all) {{
    super(...all);
    this.addEventListener("message", ({{ data }}) => {{
      const words = typeof data === "string" ? data : new TextDecoder().decode(data);
      if (/"msg_type": ?"(\\w+)"/.exec(words)?.[1] === "comm_msg") noted.messages++;
    }});
  }}
}};
window.addEventListener("pointermove", (event) => {{
  if (event.buttons && noted.began === null) noted.began = [event.timeStamp, +{DRIVER}.change];
}}, true);
new MutationObserver(() => {{
  if (noted.began === null || !(+{DRIVER}.change > noted.began[1])) return;
  noted.delays.push(performance.now() - noted.began[0]);
  noted.began = null;
}}).observe(document, {{ subtree: true, attributes: true, attributeFilter: ["data-change"] }});
"""
VIEWS = "several = build(1); several"
AT = """
from ikteach.view.stage.stage import picture_axes
eye = np.array(scene.camera.position)
back = eye - scene.stage.extent.centre
seen = (targets.positions[3] + scene.stage.places[0] - eye) @ picture_axes(back)
spot = (seen[:2] / -seen[2]).tolist()
"""


def main(seconds: float) -> None:
    """Start everything, and print what one figure and four figures reach."""
    with lab_and_page() as (lab, page):
        counts = ["build(1)", "build(4)"]
        cells = [nbformat.v4.new_code_cell(cell) for cell in (CELL, *counts, VIEWS)]
        book = nbformat.v4.new_notebook(cells=cells)
        book.metadata.kernelspec = {"name": "python3", "display_name": "Python 3"}
        nbformat.write(book, lab.folder / "scene.ipynb")
        page.add_init_script(NOTE)
        notebook = Notebook(page, lab, "scene.ipynb")
        notebook.run_cell("import asyncio")
        for cell in counts:
            began = time.monotonic()
            notebook.run_figure(cell)
            page.wait_for_selector(".ikteach-stage", timeout=READY)
            print(f"{cell}: shown after {time.monotonic() - began:.1f} s")
            drag(notebook)
            for asked in (30, 60):
                rate(notebook, seconds, asked, "plain")
            notebook.kernel("None", "[scene.switch(layer) for layer in LAYERS]")
            for asked in (30, 60):
                rate(notebook, seconds, asked, "every layer")
            stop(notebook)
            page.locator(".jp-OutputArea-output").first.evaluate("one => one.remove()")
        notebook.run_figure(VIEWS)
        page.wait_for_selector(".ikteach-stage", timeout=READY)
        for views in (1, 2, 4):
            notebook.kernel("None", f"scene.views = {views}")
            for asked in (30, 60):
                rate(notebook, seconds, asked, f"views: {views}")
        print(f"errors in the page: {notebook.errors or 'none'}")


def rate(notebook: Notebook, seconds: float, asked: int, what: str) -> None:
    """Print how many poses a second are drawn, by how many calls and messages."""
    page = notebook.page
    look = f"[+{DRIVER}.shown, performance.now() / 1000, noted.calls, noted.messages]"
    page.wait_for_timeout(2000)
    notebook.kernel("None", f"walking = asyncio.ensure_future(walk({seconds + 3}, {asked}))")
    page.wait_for_timeout(1500)
    sent, start = notebook.kernel("scene.driver.sent"), page.evaluate(look)
    page.wait_for_timeout(1000 * seconds)
    sent, end = notebook.kernel("scene.driver.sent") - sent, page.evaluate(look)
    shown, passed, calls, messages = (b - a for a, b in zip(start, end, strict=True))
    print(f"    {what}, {asked} asked: {shown / passed:.1f} poses drawn a second, "
          f"{calls / shown:.0f} calls a pose, {messages / sent:.2f} messages a frame")  # fmt: skip
    notebook.kernel("walking.cancel()")


def drag(notebook: Notebook) -> None:
    """Drag a target with the mouse, and print the time from its moves to the poses."""
    page = notebook.page
    page.locator(".ikteach-stage").first.scroll_into_view_if_needed()
    across, up = notebook.kernel("spot", AT)
    box = page.locator(".ikteach-stage canvas").first.bounding_box()
    assert box
    focal = box["height"] / 2 / 0.41421356
    x, y = box["x"] + box["width"] / 2 + focal * across, box["y"] + box["height"] / 2 - focal * up
    page.mouse.move(x, y)
    page.mouse.down()
    page.evaluate("noted.delays = []")
    for i in range(MOVES):
        page.mouse.move(x - 3 * (i % 7) - 1, y - 4 * (i % 5) - 2 * (i % 2))
        page.wait_for_timeout(90 + 17 * (i % 5))
    page.mouse.up()
    page.wait_for_timeout(1000)
    delays = sorted(page.evaluate("noted.delays"))
    print(f"    mouse to pose: median {statistics.median(delays):.0f} ms, "
          f"95 % {delays[int(0.95 * len(delays))]:.0f} ms, of {len(delays)} moves")  # fmt: skip


def stop(notebook: Notebook) -> None:
    """Let the page do nothing for 3 s, and print how old what it draws then is."""
    page = notebook.page
    notebook.kernel("None", "walking = asyncio.ensure_future(walk(12))")
    page.wait_for_timeout(1500)
    sent = notebook.kernel("scene.driver.sent")
    page.evaluate("const end = performance.now() + 3000; while (performance.now() < end);")
    page.wait_for_timeout(300)
    drawn, now = page.evaluate(f"+{DRIVER}.frame"), notebook.kernel("scene.driver.sent")
    print(f"    the page stood still for 3 s: {now - sent} frames sent since, "
          f"the one that is drawn 0.3 s later is {now - drawn} old")  # fmt: skip
    notebook.kernel("walking.cancel()")


if __name__ == "__main__":
    main(float(sys.argv[1]) if len(sys.argv) > 1 else 10)
