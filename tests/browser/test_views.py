"""One view of a figure, two, and four: each draws it, and takes its own mouse and keys."""

from collections.abc import Iterator
from typing import Any

import nbformat
import numpy as np
import pytest

from tests.browser.conftest import CANVAS, DRIVER, READY, Lab, Notebook, pixels
from tests.browser.test_layout import FIGURE, LAPTOP, Size, faults_at, resize

HUMAN = """from ikteach.body import figures
from ikteach.motion import gait, step
from ikteach.view import Scene
from ikteach.view.webgl.targets import Targets
tree, effectors = figures.human()
scene = Scene(tree, effectors, slot=None)
targets = Targets(scene, gait.walking.at(0.3), slot=None)
theta = tree.rest
def follow(*_):
    global theta
    for _ in range(6):
        theta = step(tree, theta, effectors, targets.positions, "dls").theta
    scene.show(theta, targets.positions)
targets.on_change(follow)
follow()
from ikteach.view.widgets.layout import Arranged
from ipywidgets import VBox
figure = VBox([Arranged([scene.widget], [targets])])
figure.add_class("ikteach-figure")
figure"""
FOOT, SIDE = 0, 2  # foot.l, and the number of the view
LABELS = ".ikteach-views > span"
EYES = "[[round(x, 4) for x in one.controlling.position] for one in scene.renderer.controls]"
ZOOMS = "[round(getattr(one.controlling, 'zoom', 1.0), 3) for one in scene.renderer.controls]"
SETTLED = "new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))"


@pytest.fixture(scope="module")
def scene(lab: Lab, open_notebook: Any) -> Iterator[Notebook]:
    book = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(HUMAN)])
    book.metadata.kernelspec = {"name": "python3", "display_name": "Python 3"}
    nbformat.write(book, lab.folder / "views.ipynb")
    notebook = open_notebook("views.ipynb")
    notebook.run_figure("scene = Scene")
    notebook.page.wait_for_selector("[data-ready]", timeout=READY, state="attached")
    yield notebook
    assert notebook.errors == []


def shirt(part: np.ndarray) -> np.ndarray:
    """Which pixels have the blue of the figure's shirt, in light or in shade."""
    blue = part[..., 2] - part[..., 0]
    return np.asarray((blue > 35) & (blue < 130))


def show(scene: Notebook, count: int) -> None:
    """Show so many views, and wait until the page does."""
    scene.kernel("None", f"scene.views = {count}")
    names = scene.page.locator(LABELS)
    scene.page.wait_for_function(
        f"document.querySelectorAll('{LABELS}').length === {count if count > 1 else 0}",
        timeout=READY,
    )
    assert names.count() == (count if count > 1 else 0)
    scene.page.evaluate(SETTLED)


def panes(scene: Notebook, count: int) -> list[dict[str, float]]:
    """Where each view is in the page [pixels]."""
    each = scene.page.locator(LABELS if count > 1 else CANVAS)
    boxes = [each.nth(i).bounding_box() for i in range(count)]
    assert all(boxes)
    return boxes  # type: ignore[return-value]


@pytest.mark.parametrize("count", [1, 2, 4])
def test_each_view_draws_the_figure(scene: Notebook, count: int) -> None:
    show(scene, count)
    whole = scene.page.locator(CANVAS).first.bounding_box()
    assert whole
    picture = pixels(scene.shot(f"views_{count}", CANVAS))
    sizes = []
    for box in panes(scene, count):
        left, top = round(box["x"] - whole["x"]), round(box["y"] - whole["y"])
        part = picture[top : top + int(box["height"]), left : left + int(box["width"])]
        figure = shirt(part)
        rows, columns = np.nonzero(figure)
        sizes.append(len(rows))
        # It stands about in the middle of its view, and not at the edge of it.
        assert 0.3 < np.median(columns) / part.shape[1] < 0.7
        assert 0.15 < np.median(rows) / part.shape[0] < 0.7
        border = np.concatenate([figure[[0, -1]].ravel(), figure[:, [0, -1]].ravel()])
        assert not border.any()
    assert min(sizes) > 200
    words = scene.page.locator(DRIVER).first.get_attribute("aria-label") or ""
    assert (f"{count} views: free" in words) == (count > 1)


def test_a_drag_in_the_side_view_stays_in_its_plane(scene: Notebook) -> None:
    show(scene, 4)
    box = panes(scene, 4)[SIDE]
    # Parallel, from the left: z goes to the left of the picture, and y up.
    camera = f"scene.renderer.controls[{SIDE}].controlling"
    half, (_, y, z) = scene.kernel(f"[{camera}.top, list(scene.stage.extent.centre)]")
    metre = box["height"] / 2 / half
    before = np.array(scene.kernel("targets.positions.tolist()"))
    eyes = scene.kernel(EYES)
    x_pixel = box["x"] + box["width"] / 2 - metre * (before[FOOT, 2] - z)
    y_pixel = box["y"] + box["height"] / 2 - metre * (before[FOOT, 1] - y)
    mouse = scene.page.mouse
    mouse.move(x_pixel, y_pixel)
    mouse.down()
    for part in np.linspace(0, 1, 9)[1:]:
        mouse.move(x_pixel + 30 * part, y_pixel - 24 * part)
        scene.page.wait_for_timeout(20)
    mouse.up()
    wanted = f"bool(abs(targets.positions[{FOOT}, 2] - {before[FOOT, 2] - 30 / metre}) < 0.02)"
    scene.settle(wanted, True)
    after = np.array(scene.kernel("targets.positions.tolist()"))
    assert abs(after[FOOT, 0] - before[FOOT, 0]) < 1e-6  # as a frame has it, in single precision
    assert after[FOOT, 1] == pytest.approx(before[FOOT, 1] + 24 / metre, abs=0.02)
    assert (after[1:] == before[1:]).all()
    assert scene.kernel(EYES) == eyes
    assert scene.kernel("scene.driver.view") == SIDE
    scene.kernel("None", "targets.undo()")


def test_keys_go_from_view_to_view_and_act_on_one(scene: Notebook) -> None:
    page = scene.page
    show(scene, 1)
    page.locator(".ikteach-stage").blur()  # no target is chosen any more
    page.locator(".ikteach-stage").focus()
    for count in (2, 4):
        page.keyboard.press("v")
        scene.settle("scene.views", count)
    page.wait_for_function(f"document.querySelectorAll('{LABELS}').length === 4", timeout=READY)
    chosen = scene.kernel("scene.driver.view")
    for i in range(1, 5):
        page.keyboard.press("n")
        scene.settle("scene.driver.view", (chosen + i) % 4)
    for _ in range((SIDE - chosen) % 4):
        page.keyboard.press("n")
    scene.settle("scene.driver.view", SIDE)
    assert "▸ side" in page.locator(LABELS).all_inner_texts()
    heard = page.locator(".ikteach-unseen[role=status]").inner_text()
    assert heard == "Keys act on the view side."
    before = scene.kernel(EYES)
    page.keyboard.press("ArrowRight")
    scene.settle(f"({EYES})[{SIDE}] != {before[SIDE]}", True)
    after = scene.kernel(EYES)
    others = [i for i in range(4) if i != SIDE]
    assert [after[i] for i in others] == [before[i] for i in others]
    page.wait_for_selector(f"{LABELS} >> text=side, turned", timeout=READY)
    page.keyboard.press("0")
    scene.settle(EYES, before)
    page.wait_for_function(
        f"[...document.querySelectorAll('{LABELS}')].every(one => !/turned/.test(one.innerText))",
        timeout=READY,
    )


def test_the_pointer_acts_on_the_view_under_it(scene: Notebook) -> None:
    page = scene.page
    show(scene, 4)
    box, top = panes(scene, 4)[3], 3
    before, zooms = scene.kernel(EYES), scene.kernel(ZOOMS)
    page.locator(".ikteach-stage").focus()
    page.mouse.move(box["x"] + 20, box["y"] + box["height"] - 20)
    page.mouse.wheel(0, 120)
    scene.settle(f"({ZOOMS})[{top}] < {zooms[top]}", True)
    assert scene.kernel(ZOOMS)[:top] == zooms[:top]
    page.mouse.down()
    page.mouse.move(box["x"] + 60, box["y"] + box["height"] - 40, steps=4)
    page.mouse.up()
    scene.settle(f"({EYES})[{top}] != {before[top]}", True)
    assert scene.kernel(EYES)[:top] == before[:top]
    assert scene.kernel("scene.driver.view") == top
    page.keyboard.press("0")
    scene.settle(f"({EYES})[{top}]", before[top])


@pytest.mark.parametrize("count", [2, 4])
def test_views_have_room_at_every_width(scene: Notebook, count: int) -> None:
    show(scene, count)
    sizes = [LAPTOP, Size(911, 700), Size(1024, 768, 1.5), Size(1920, 970)]
    assert faults_at(scene.page, FIGURE, sizes, f"views_{count}") == []
    resize(scene.page, Size(1440, 1100))
    for width, below in (("420px", count == 2), ("", False)):
        scene.page.locator(FIGURE).evaluate("(one, width) => { one.style.width = width; }", width)
        scene.page.evaluate(SETTLED)
        first, second = panes(scene, count)[:2]
        assert (second["y"] > first["y"] + 1) == below, "where it is narrow two views are stacked"
