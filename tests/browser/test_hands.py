"""Every hand: what is run comes into view, a wheel scrolls, keys do all, readers hear of it."""

import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Browser, Page

from tests.browser.conftest import CANVAS, DRIVER, READY, ROOT, Lab, Notebook, open_page
from tests.browser.test_lecture import Lecture

LAPTOP = {"width": 1366, "height": 768}
STAGE = ".ikteach-stage"
PANEL = ".jp-WindowedPanel-outer"
FIGURES = {
    "00_figure.ipynb": "Poser(figures.human())",
    "07_gait.ipynb": "player = GaitPlayer()",
    "09_workbench.ipynb": "bench = Workbench()",
}
TOUCHED = "Unable to preventDefault inside passive"  # what pythreejs says of each finger
CAMERA = "[round(x, 3) for x in {}.scene.camera.position]"
WHOLE = "one => one.getBoundingClientRect().bottom <= innerHeight"
FOCUS = """() => {
  const { activeElement: one } = document;
  const label = one.getAttribute("aria-label") ?? one.textContent;
  return one.matches(".ikteach-stage") ? "picture" : `${one.role ?? ""} ${label}`.trim();
}"""


@pytest.fixture(scope="session")
def axe() -> str:
    """The script of axe-core, which npm brings."""
    return (ROOT / "tests/page/node_modules/axe-core/axe.min.js").read_text()


def faults(page: Page, axe: str, part: str) -> list[str]:
    """What axe finds in a part of the page: the rule, and the first place."""
    page.evaluate(axe)
    found = page.evaluate(f"axe.run({part!r})")
    assert found["passes"]  # it has looked
    return [f"{one['id']}: {one['nodes'][0]['html'][:120]}" for one in found["violations"]]


def tab_to(notebook: Notebook, name: str, *, key: str = "Tab", most: int = 90) -> None:
    """Press Tab until what has this name has the focus."""
    seen = []
    for _ in range(most):
        seen.append(str(notebook.page.evaluate(FOCUS))[:60])
        if seen[-1] == name or seen[-1].endswith(f" {name}"):
            return
        notebook.page.keyboard.press(key)
    pytest.fail(f"{name} is not among {seen}")


def run_as_a_student(notebook: Notebook, cell: str) -> None:
    """Run what stands above, click into the cell, and press Shift and Enter."""
    page = notebook.page
    code = page.locator(".jp-CodeCell", has_text=cell).first
    code.locator(".cm-content").click()
    notebook.command("notebook:run-all-above")
    notebook.settle("1", 1)
    code.locator(".cm-content").click()
    page.keyboard.press("Shift+Enter")
    page.wait_for_selector(f"{DRIVER}[data-frame]", timeout=READY)


def settled(of: Callable[[], Any]) -> Any:
    """A value, once it stays the same for half a second; the last one, if it never does."""
    value, since, end = of(), time.monotonic(), time.monotonic() + 15
    while time.monotonic() < min(since + 0.5, end):
        time.sleep(0.1)
        if (new := of()) != value:
            value, since = new, time.monotonic()
    return value


def box(notebook: Notebook, selector: str) -> tuple[int, int]:
    """Where the first such element begins and ends, from top to bottom [pixels]."""
    code = "one => [one.getBoundingClientRect().top, one.getBoundingClientRect().bottom]"
    top, bottom = notebook.page.locator(selector).first.evaluate(code)
    return round(top), round(bottom)


def is_in_view(notebook: Notebook, selector: str) -> bool:
    top, bottom = settled(lambda: box(notebook, selector))
    low, high = box(notebook, PANEL)
    return low - 1 <= top < bottom <= high + 1


@pytest.fixture(scope="module")
def opened(open_notebook: Any) -> Callable[[str, str], Notebook]:
    """Open a chapter as a laptop shows it, and run its figure."""

    def open_one(name: str, figure: str) -> Notebook:
        notebook = open_notebook(name)
        notebook.page.set_viewport_size(LAPTOP)
        run_as_a_student(notebook, figure)
        return notebook

    return open_one


@pytest.fixture(scope="module")
def figure(opened: Any) -> Notebook:
    return opened("00_figure.ipynb", FIGURES["00_figure.ipynb"])


def test_the_figure_is_in_view_after_its_cell(figure: Notebook) -> None:
    assert is_in_view(figure, CANVAS)
    figure.shot("hands_00")


@pytest.fixture(scope="module")
def gait(opened: Any, figure: Notebook) -> Iterator[Notebook]:
    notebook = opened("07_gait.ipynb", FIGURES["07_gait.ipynb"])
    yield notebook
    assert [error for error in notebook.errors if not error.startswith(TOUCHED)] == []


def test_chapter_7_is_in_view_after_its_cell(gait: Notebook) -> None:
    assert is_in_view(gait, CANVAS)
    gait.shot("hands_07")


def scrolled(notebook: Notebook) -> float:
    return float(settled(lambda: notebook.page.locator(PANEL).evaluate("one => one.scrollTop")))


def test_the_wheel_scrolls_until_the_picture_is_chosen(gait: Notebook) -> None:
    page, camera = gait.page, CAMERA.format("player")
    page.evaluate("document.activeElement.blur()")
    left, top, *_ = page.locator(CANVAS).bounding_box().values()
    page.mouse.move(left + 60, top + 200)
    at, before = scrolled(gait), gait.kernel(camera)
    page.mouse.wheel(0, 60)
    assert scrolled(gait) == at + 60
    assert gait.kernel(camera) == before
    page.mouse.wheel(0, -60)
    assert scrolled(gait) == at
    page.keyboard.down("Control")
    page.mouse.wheel(0, 60)
    page.keyboard.up("Control")
    assert scrolled(gait) == at
    gait.settle(f"{camera} != {before}", True)
    page.mouse.click(left + 60, top + 200)
    near = gait.kernel(camera)
    page.mouse.wheel(0, 60)
    assert scrolled(gait) == at
    gait.settle(f"{camera} != {near}", True)
    page.mouse.dblclick(left + 60, top + 200)
    gait.settle(camera, before)


def test_zoom_has_ends_and_a_way_back(gait: Notebook) -> None:
    before = gait.kernel("player.scene.cameras.distance")
    gait.page.locator(STAGE).first.focus()
    for key, end in ("+", "minDistance"), ("-", "maxDistance"):
        for _ in range(60):
            gait.page.keyboard.press(key)
        far = f"round(player.scene.cameras.distance / player.scene.renderer.controls[0].{end}, 2)"
        gait.settle(far, 1.0)
        gait.page.get_by_role("button", name="View back").click()
        gait.settle(f"round(player.scene.cameras.distance - {before}, 6)", 0.0)
        gait.page.locator(STAGE).first.focus()


def swipe(page: Page, x: float, y: float) -> None:
    """Put a finger there, move it up, and lift it."""
    devtools = page.context.new_cdp_session(page)
    devtools.send("Emulation.setTouchEmulationEnabled", {"enabled": True})
    places = [{"x": x, "y": y - 12 * i} for i in range(10)]
    for kind, touches in [
        ("touchStart", places[:1]),
        *[("touchMove", [place]) for place in places],
        ("touchEnd", []),
    ]:
        devtools.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": touches})
        time.sleep(0.03)
    devtools.send("Emulation.setTouchEmulationEnabled", {"enabled": False})


def test_a_finger_scrolls_until_the_picture_is_chosen(gait: Notebook) -> None:
    page, camera = gait.page, CAMERA.format("player")
    page.evaluate("document.activeElement.blur()")
    left, top, *_ = page.locator(CANVAS).bounding_box().values()
    before, at = gait.kernel(camera), scrolled(gait)
    swipe(page, left + 60, top + 300)
    assert scrolled(gait) > at + 50
    assert gait.kernel(camera) == before
    page.locator(PANEL).evaluate("(one, top) => { one.scrollTop = top; }", at)
    page.locator(STAGE).first.focus()
    swipe(page, left + 60, top + 300)
    assert scrolled(gait) == at
    gait.settle(f"{camera} != {before}", True)
    page.keyboard.press("Home")
    gait.settle(camera, before)


def test_chapter_7_by_keys_alone(gait: Notebook) -> None:
    page, keys = gait.page, gait.page.keyboard
    page.evaluate("document.querySelector('.jp-Cell:has(.ikteach-stage)').focus()")
    tab_to(gait, "picture")
    keys.press("Space")
    gait.settle("player.playing", False)
    ticks = gait.kernel("player.session.ticks")
    keys.press(".")
    gait.settle("player.session.ticks", ticks + 1)
    for digit, method in ("1", "transpose"), ("2", "pseudoinverse"), ("4", "sdls"), ("3", "dls"):
        keys.press(digit)
        gait.settle("player.session.method", method)
    keys.press("s")
    page.locator("button", has_text="Time ½×").wait_for(timeout=READY)
    keys.press("d")
    page.wait_for_function(
        "document.querySelector('.ikteach-far:not([hidden])')?.innerText.includes('cm')",
        timeout=READY,
    )
    gait.shot("hands_07_distances")
    keys.press("d")
    page.locator(".ikteach-far").wait_for(state="hidden", timeout=READY)
    before = page.locator(CANVAS).first.evaluate("one => one.clientWidth")
    keys.press("f")
    page.wait_for_function("document.fullscreenElement !== null", timeout=READY)
    wide = settled(lambda: page.locator(CANVAS).first.evaluate("one => one.clientWidth"))
    assert wide == LAPTOP["width"]
    assert gait.page.locator(CANVAS).first.evaluate(WHOLE)
    gait.shot("hands_07_full")
    keys.press("f")
    page.wait_for_function("document.fullscreenElement === null", timeout=READY)
    assert settled(lambda: page.locator(CANVAS).first.evaluate("one => one.clientWidth")) == before
    with page.expect_download(timeout=READY) as saved:
        keys.press("p")
    assert Path(saved.value.path()).read_bytes().startswith(b"\x89PNG")
    tab_to(gait, "Distances")
    keys.press("Enter")
    page.wait_for_function("document.activeElement.ariaPressed === 'true'", timeout=READY)
    tab_to(gait, "Play")
    keys.press("Space")
    gait.settle("player.playing", True)
    tab_to(gait, "running")
    keys.press("Enter")
    gait.settle("player.session.gait.name", "running")
    tab_to(gait, "Hands")
    assert page.evaluate("document.activeElement.ariaExpanded") == "false"
    keys.press("Enter")
    page.wait_for_function("document.activeElement.ariaExpanded === 'true'", timeout=READY)
    tab_to(gait, "right hand y [m]")
    keys.press("End")
    gait.settle("player.session.gait.back_y_hand", 1.0)
    assert page.evaluate("document.activeElement.ariaValueText") == "1.00"
    gait.shot("hands_07_keys")


def test_axe_finds_nothing_in_chapter_7(gait: Notebook, axe: str) -> None:
    assert faults(gait.page, axe, ".jp-OutputArea-child:has(.ikteach-stage)") == []


def test_forced_colours_show_what_is_chosen(gait: Notebook) -> None:
    def colours(button: str) -> list[str]:
        one = gait.page.get_by_role("button", name=button, exact=True)
        code = "one => [getComputedStyle(one).backgroundColor, one.getAttribute('aria-pressed')]"
        return list(one.evaluate(code))

    gait.page.emulate_media(forced_colors="active")
    chosen, other = colours("dls"), colours("sdls")
    assert (chosen[1], other[1]) == ("true", "false")
    assert chosen[0] != other[0]
    handle = gait.page.locator(".noUi-handle").first
    assert handle.evaluate("one => getComputedStyle(one).borderTopStyle") == "solid"
    gait.shot("hands_07_forced")
    gait.page.emulate_media(forced_colors="none")


def test_the_next_day_a_still_and_what_to_run(gait: Notebook, lab: Lab, browser: Browser) -> None:
    """Saved with its outputs, and opened when its kernel has ended."""
    gait.command("docmanager:save")
    lab.stop_kernels()
    page = open_page(browser, **LAPTOP)
    page.goto(lab.url(gait.name))
    still = page.locator(".ikteach-still img").first
    page.wait_for_selector(".jp-Notebook .jp-CodeCell", timeout=READY)
    page.wait_for_function(
        "window.jupyterapp?.commands.hasCommand('notebook:run-all-cells')", timeout=READY
    )
    page.locator(".jp-CodeCell", has_text=FIGURES[gait.name]).first.scroll_into_view_if_needed()
    still.wait_for(timeout=READY)
    still.scroll_into_view_if_needed()
    assert still.evaluate("one => one.naturalWidth") > 400
    assert page.locator(".jp-OutputArea p", has_text="Run All Cells").count() >= 1
    assert page.get_by_text("model not found").count() == 0
    page.screenshot(path=ROOT / "tests" / "shots" / "hands_next_day.png")
    page.close()


@pytest.fixture(scope="module")
def bench(opened: Any, gait: Notebook) -> Iterator[Notebook]:
    notebook = opened("09_workbench.ipynb", FIGURES["09_workbench.ipynb"])
    yield notebook
    assert notebook.errors == []


def test_the_workbench_is_in_view_and_opening_it_logs_nothing(bench: Notebook, axe: str) -> None:
    assert is_in_view(bench, CANVAS)
    bench.frames(10)
    assert bench.kernel("[str(event) for event in bench.session.events]") == []
    assert faults(bench.page, axe, ".jp-OutputArea-child:has(.ikteach-stage)") == []


def test_the_workbench_by_keys_alone(bench: Notebook) -> None:
    page, keys = bench.page, bench.page.keyboard
    page.evaluate("document.querySelector('.jp-Cell:has(.ikteach-stage)').focus()")
    tab_to(bench, "picture")
    keys.press("Space")
    bench.settle("bench.playing", False)
    targets = "bench.session.targets.round(6).tolist()"
    keys.press("Tab")  # the first target
    before = bench.kernel(targets)
    keys.press("ArrowUp")
    bench.settle(f"{targets} != {before}", True)
    first = bench.kernel(targets)
    keys.press("ArrowUp")
    bench.settle(f"{targets} != {first}", True)
    keys.press("Escape")
    bench.settle(targets, first)
    tab_to(bench, "Undo", key="Shift+Tab")
    keys.press("Enter")
    bench.settle(targets, before)
    tab_to(bench, "View")
    keys.press("Enter")
    tab_to(bench, "One iteration, magnified")
    keys.press("Enter")
    tab_to(bench, "Stop the clock and look")
    keys.press("Enter")
    bench.settle("bench.glass.tick is not None", True)
    picture = ".ikteach-picture[alt]:visible"
    assert is_in_view(bench, picture)
    assert is_in_view(bench, CANVAS)  # the stopped figure, beside it
    bench.shot("hands_09_glass")


def targets_seen(bench: Notebook) -> list[list[float]]:
    return list(bench.kernel("bench.session.targets.round(4).tolist()"))


def grasp(bench: Notebook) -> tuple[float, float]:
    """A place of the picture where a target can be taken hold of [pixels]."""
    left, top, wide, high = bench.page.locator(CANVAS).bounding_box().values()
    for y in range(int(top) + 100, int(top + high) - 60, 12):
        for x in range(int(left) + 40, int(left + wide) - 40, 12):
            bench.page.mouse.move(x, y)
            if holds(bench):
                return x, y
    pytest.fail("no target is under the mouse anywhere")


def holds(bench: Notebook) -> bool:
    code = "one => one.style.cursor === 'grab'"
    return bool(bench.page.locator(STAGE).first.evaluate(code))


def test_a_drag_is_one_event_and_ends_at_the_rim(bench: Notebook) -> None:
    page = bench.page
    bench.press("Reset")
    bench.settle("bench.session.ticks", 0)
    before, events = targets_seen(bench), "[e.kind for e in bench.session.events].count('target')"
    count = bench.kernel(events)
    x, y = grasp(bench)
    page.mouse.down()
    page.mouse.move(x + 20, y + 10, steps=5)
    page.mouse.up()
    bench.settle(events, count + 1)
    once = settled(lambda: targets_seen(bench))
    page.mouse.move(x + 20, y + 10)
    page.mouse.down()
    left, _, wide, _ = page.locator(CANVAS).bounding_box().values()
    page.mouse.move(left + wide + 200, y + 10, steps=8)
    page.mouse.up()
    bench.settle(events, count + 2)
    assert settled(lambda: targets_seen(bench)) != once
    bench.shot("hands_09_rim")
    page.mouse.move(left + wide - 0.02 * wide, y + 10)
    assert holds(bench)  # it is still in the picture, and can be fetched back
    bench.press("Undo")
    bench.settle("bench.session.targets.round(4).tolist()", once)
    bench.press("Undo")
    bench.settle("bench.session.targets.round(4).tolist()", before)


def test_a_replay_comes_into_view_under_the_stopped_figure(bench: Notebook) -> None:
    if not bench.kernel("bench.playing"):
        bench.press("Play")
    bench.frames(20)
    bench.press("Look back")
    bench.settle("bench.replay is not None", True)
    slider = "[aria-label='Tick']"
    bench.page.locator(slider).wait_for(timeout=READY)
    assert is_in_view(bench, slider)
    assert is_in_view(bench, CANVAS)
    bench.shot("hands_09_replay")
    bench.press("Back to now")


def test_nothing_moves_by_itself_where_a_reader_wants_that(bench: Notebook) -> None:
    bench.page.emulate_media(reduced_motion="reduce")
    bench.run_cell("bench = Workbench()")
    bench.settle("bench.scene.driver.seen", True)
    bench.settle("bench.playing", False)
    bench.press("Play")
    bench.settle("bench.playing", True)
    bench.page.emulate_media(reduced_motion="no-preference")


def test_axe_finds_nothing_in_the_lecture_and_it_begins_again(
    tmp_path: Path, browser: Browser, axe: str
) -> None:
    lecture = Lecture(tmp_path, browser)
    try:
        lecture.page.goto(lecture.address)
        page = lecture.opened("workbench")
        page.wait_for_selector(STAGE, timeout=READY)
        assert faults(page, axe, "#rendered_cells") == []
        assert page.get_by_role("button", name="Quit").count() == 0
        page.get_by_role("button", name="sdls", exact=True).click()
        page.wait_for_selector(f"{DRIVER}[aria-label*='by sdls']", timeout=READY)
        page.get_by_role("button", name="Begin again").click()
        page.wait_for_selector(f"{DRIVER}[aria-label*='by dls']", timeout=READY)
        assert lecture.errors == []
    finally:
        lecture.stop()
