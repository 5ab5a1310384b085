"""The bench of circle and ellipse, and the buttons of what to try, by mouse and by keys."""

from typing import Any

import numpy as np
import pytest

from tests.browser.conftest import READY, Notebook

BENCH = "display(svd := SvdBench())"


@pytest.fixture(scope="module")
def chapter(open_notebook: Any) -> Notebook:
    notebook = open_notebook("02_singularity.ipynb")
    notebook.run_cell(BENCH)
    notebook.page.locator(".ikteach-knob").wait_for(timeout=READY)
    return notebook


def test_the_point_is_dragged_and_moved_by_keys(chapter: Notebook) -> None:
    page, knob = chapter.page, chapter.page.locator(".ikteach-knob")
    knob.scroll_into_view_if_needed()
    box = page.locator(".ikteach-plane").first.bounding_box()
    at = knob.bounding_box()
    assert box
    assert at
    page.mouse.move(at["x"] + at["width"] / 2, at["y"] + at["height"] / 2)
    page.mouse.down()
    page.mouse.move(box["x"] + 0.2 * box["width"], box["y"] + 0.5 * box["height"], steps=5)
    page.mouse.up()
    chapter.settle("round(svd.controls['x'].value, 1)", -0.9)
    chapter.settle("round(svd.controls['y'].value, 1)", 0.0)
    before = chapter.kernel("svd.controls['y'].value")
    knob.focus()
    page.keyboard.press("ArrowUp")
    chapter.settle(f"round(svd.controls['y'].value - {before}, 3)", 0.05)
    page.keyboard.press("Shift+ArrowUp")
    chapter.settle(f"round(svd.controls['y'].value - {before}, 3)", 0.055)
    said = knob.get_attribute("aria-valuetext")
    assert said == chapter.kernel("svd.held.said")
    assert "σ₁" in (page.locator(".ikteach-plane").first.get_attribute("aria-label") or "")
    chapter.shot("02_svd")
    assert chapter.errors == []


def test_show_me_sets_the_figure_by_key(chapter: Notebook) -> None:
    button = chapter.page.get_by_role("button", name="Show me 3").last
    button.focus()
    chapter.page.keyboard.press("Enter")
    chapter.settle("svd.controls['bend'].value", 0)
    chapter.shot("02_svd_straight")
    assert "σ₂ = 0.000" in chapter.kernel("svd.words")
    chapter.page.get_by_role("status").get_by_text("The figure is set as in 3.").last.wait_for(
        timeout=READY
    )
    assert chapter.kernel("svd.status.wrong") == ""
    assert chapter.errors == []


def test_a_hand_is_pulled_by_keys_and_the_sliders_follow(open_notebook: Any) -> None:
    notebook = open_notebook("00_figure.ipynb")
    notebook.run_figure("Poser(figures.human())")
    before = notebook.kernel("poser.targets.positions[3].tolist()")
    notebook.page.locator(".ikteach-stage").first.focus()
    for _ in range(4):  # to the left hand; a straight limb is not bent by pulling along it
        notebook.page.keyboard.press("Tab")
    for _ in range(4):
        notebook.page.keyboard.press("ArrowRight")
    notebook.settle(f"bool(poser.targets.positions[3][0] > {before[0]} + 0.1)", True)
    assert notebook.kernel("sum(bool(c.value) for c in poser.controls.values())") > 0
    notebook.page.wait_for_timeout(500)  # what the page makes of their values comes back by now
    assert notebook.kernel("any(c.value % 1 for c in poser.controls.values())")  # between steps
    notebook.shot("00_pulled")
    assert notebook.kernel("poser.status.wrong") == ""
    assert notebook.errors == []


def test_a_path_is_drawn_by_mouse_and_set_by_keys(open_notebook: Any) -> None:
    notebook = open_notebook("11_beyond.ipynb")
    page = notebook.page
    notebook.run_cell("GaitPlayer(pad=True)")
    plane = page.locator(".ikteach-plane")
    plane.wait_for(timeout=READY)
    plane.scroll_into_view_if_needed()
    box = plane.bounding_box()
    assert box
    x, y, size = box["x"], box["y"], box["width"]
    page.mouse.move(x + 0.72 * size, y + 0.4 * size)
    page.mouse.down()
    for share in np.linspace(0, 2 * np.pi, 30):
        across, up = 0.64 + 0.08 * np.cos(share), 0.4 - 0.08 * np.sin(share)
        page.mouse.move(x + across * size, y + up * size)
    page.mouse.up()
    notebook.settle("drawer.session.gait.name", "drawn")
    at = notebook.kernel("drawer.motion.pad.seen(drawer.motion.pad.points).tolist()")
    half = notebook.kernel("drawer.motion.pad.plane.half")
    middle = np.mean(at, axis=0) / half
    assert middle == pytest.approx([2 * 0.64 - 1, 1 - 2 * 0.4], abs=0.03)
    notebook.shot("11_drawn")
    knob = page.locator(".ikteach-knob")
    knob.focus()
    for key in ("Enter", "ArrowRight", "ArrowRight", "Enter", "ArrowUp", "Enter", "Backspace"):
        page.keyboard.press(key)
    notebook.settle("len(drawer.motion.pad.points)", 2)
    assert knob.get_attribute("aria-valuetext") == notebook.kernel("drawer.motion.pad.plane.said")
    notebook.press("Go along them")
    notebook.settle("drawer.motion.pad.status.said.startswith('hand.l goes along')", True)
    notebook.kernel("None", "drawer.session.undo(); drawer.report()")
    notebook.settle("len(drawer.motion.pad.points) > 60", True)
    assert notebook.kernel("drawer.status.wrong + drawer.motion.pad.status.wrong") == ""
    assert notebook.errors == []
