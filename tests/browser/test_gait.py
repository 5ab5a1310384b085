"""Chapter 7 as a student has it: a walking figure whose controls act, in pixels and in state."""

import time
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from tests.browser.conftest import CANVAS, DRIVER, READY, SHOWN, Notebook, pixels


@pytest.fixture(scope="module")
def gait(open_notebook: Any) -> Iterator[Notebook]:
    notebook = open_notebook("07_gait.ipynb")
    notebook.run_figure("player = GaitPlayer()")
    yield notebook
    assert notebook.errors == []


@pytest.fixture(autouse=True)
def fresh(gait: Notebook) -> None:
    """Each test finds the player walking by dls, with nothing changed."""
    if gait.kernel("player.playing") is False:
        gait.press("Play")


def test_a_figure_is_seen(gait: Notebook) -> None:
    gait.frames(10)
    picture = pixels(gait.shot("07_walking", CANVAS))
    colours = {
        "shirt": [95, 143, 180], "skin": [217, 165, 126], "trousers": [74, 85, 104],
    }  # fmt: skip
    for name, colour in colours.items():  # shaded: the hue is looked for, not the very colour
        hue = np.array(colour) / np.linalg.norm(colour)
        length = np.linalg.norm(picture, axis=-1)
        alike = (picture @ hue > 0.985 * length) & (length > 60) & (length < 330)
        assert alike.mean() > 0.004, f"no {name} in the picture"


def test_it_moves_and_pause_stops_it(gait: Notebook) -> None:
    gait.frames(3)
    first = pixels(gait.shot("07_moves_1", CANVAS))
    gait.frames(8)
    second = pixels(gait.shot("07_moves_2", CANVAS))
    assert (abs(first - second).max(axis=-1) > 30).mean() > 0.005
    gait.press("Pause")
    gait.settle("player._task.done()", True)
    time.sleep(1.5)  # what is under way is drawn
    third = pixels(gait.shot("07_paused_1", CANVAS))
    time.sleep(0.5)
    assert (third == pixels(gait.shot("07_paused_2", CANVAS))).all()
    before = gait.page.evaluate(SHOWN)
    gait.press("Step")
    gait.page.wait_for_function(f"{SHOWN} > {before}", timeout=READY)
    time.sleep(0.5)
    assert (third != pixels(gait.shot("07_stepped", CANVAS))).any()


@pytest.mark.parametrize("method", ["transpose", "pseudoinverse", "sdls", "dls"])
def test_methods(gait: Notebook, method: str) -> None:
    gait.press(method)
    gait.settle("player.session.method", method)
    gait.page.wait_for_selector(f"table.ikteach-table >> text={method} (shown)", timeout=READY)
    gait.page.wait_for_selector(f"{DRIVER}[aria-label*='by {method}']", timeout=READY)
    gait.shot(f"07_{method}")


def test_motions(gait: Notebook) -> None:
    gait.press("running")
    gait.settle("player.session.gait.name", "running")
    gait.page.wait_for_selector(f"{DRIVER}[aria-label*='running']", timeout=READY)
    assert gait.kernel("player.controls['back_y_leg'].value") == -1.1
    gait.frames(20)
    gait.shot("07_running")
    gait.press("walking")
    gait.settle("player.session.gait.name", "walking")


@pytest.mark.parametrize(
    ("box", "state"),
    [
        ("wounded", "bool(player.session.gait.wound)"),
        ("moving forward", "player.session.gait.forward"),
    ],
)
def test_boxes(gait: Notebook, box: str, state: str) -> None:
    gait.page.get_by_role("checkbox", name=box).check()
    gait.settle(state, True)
    if box == "moving forward":
        gone = gait.kernel("player.session.advance")
        gait.frames(5)
        assert gait.kernel("player.session.advance") > gone
    gait.page.get_by_role("checkbox", name=box).uncheck()
    gait.settle(state, False)


@pytest.mark.parametrize(
    ("panel", "label", "parameter"),
    [
        ("Speed", "speed ω", "speed"),
        ("Speed", "step frequency", "step_frequency"),
        ("Speed", "slowdown", "slowdown"),
        ("Steps", "left foot z", "back_z_leg"),
        ("Steps", "right foot z", "front_z_leg"),
        ("Steps", "left foot y", "back_y_leg"),
        ("Steps", "right foot y", "front_y_leg"),
        ("Hands", "hands z", "hand_z"),
        ("Hands", "right hand y", "back_y_hand"),
        ("Hands", "left hand y", "front_y_hand"),
    ],
)
def test_sliders_by_keyboard_to_both_ends(
    gait: Notebook, panel: str, label: str, parameter: str
) -> None:
    title = gait.page.locator(".jupyter-widget-Collapse-header", has_text=panel)
    slider = gait.page.locator(".widget-slider", has_text=label).locator(".noUi-handle")
    if not slider.is_visible():
        title.click()
    value = f"player.session.gait.{parameter}"
    was = gait.kernel(value)
    control = f"player.controls['{parameter}']"
    ends = gait.kernel(f"[{control}.min, {control}.max]")
    for key, end in zip(("Home", "End"), ends, strict=True):
        slider.focus()
        gait.page.keyboard.press(key)
        gait.settle(value, end)
        gait.frames(2)
    gait.kernel("None", f"{control}.value = {was}")
    gait.settle(value, was)
    assert gait.kernel("player.status.wrong") == ""


def test_reset(gait: Notebook) -> None:
    gait.frames(5)
    gait.press("Pause")
    gait.press("Reset")
    gait.settle("[player.session.ticks, player.session.time]", [0, 0.0])


def test_view(gait: Notebook) -> None:
    gait.press("Pause")
    gait.settle("player._task.done()", True)
    before = pixels(gait.shot("07_three_quarter", CANVAS))
    gait.page.get_by_label("View", exact=True).select_option("side")
    gait.settle("list(player.scene.camera.position)[0] > 2", True)
    time.sleep(0.5)
    assert (before != pixels(gait.shot("07_side", CANVAS))).mean() > 0.05
    gait.page.get_by_label("View", exact=True).select_option("three-quarter")


def test_curves_and_table_are_alive_and_have_words(gait: Notebook) -> None:
    strips = gait.page.locator(".ikteach-strips")
    drawn = int(strips.get_attribute("data-drawn") or 0)
    gait.page.wait_for_function(
        "was => +document.querySelector('.ikteach-strips').dataset.drawn > was + 5", arg=drawn
    )
    gait.page.wait_for_function(
        "document.querySelector('.ikteach-strips').ariaLabel.includes('transpose')", timeout=READY
    )
    rows = gait.page.locator("table.ikteach-table tbody tr")
    rows.nth(3).wait_for(timeout=READY)
    assert rows.count() == 4
    blue, orange = (0, 114, 178), (230, 159, 0)

    def least() -> float:  # share of the pixels that a line has
        plot = pixels(gait.shot("07_curves", ".ikteach-strips"))
        return min((abs(plot - colour).max(axis=-1) < 60).mean() for colour in (blue, orange))

    end = time.monotonic() + 20  # the lines grow for ten seconds
    while least() < 0.002:
        assert time.monotonic() < end, "hardly any line of one colour"


def test_one_message_a_frame_and_no_queue(gait: Notebook) -> None:
    count = """
import ikteach.view.webgl.driver as _d
counted = {"frames": 0, "all": 0}
def counting(send=player.scene.driver.send):
    def run(*args, **kwargs):
        counted["frames"] += 1
        return send(*args, **kwargs)
    return run
player.scene.driver.send = counting()
"""
    before = gait.kernel("player.scene.driver.sent", count)
    for _ in range(4):
        gait.frames(15)
        ahead = gait.kernel("[player.scene.driver.sent - player.scene.driver.drawn, _d.AHEAD]")
        assert ahead[0] <= ahead[1]
    sent, counted = gait.kernel("[player.scene.driver.sent, counted['frames']]")
    assert sent - before >= counted > 0
    gait.kernel("None", "del player.scene.driver.send")


def test_an_error_is_told_once_and_the_session_goes_on(gait: Notebook) -> None:
    gait.kernel("None", "player.session.methods['dls'] = lambda J, e: J[0] * float('nan')")
    alert = gait.page.locator(".ikteach-status [role=alert]:not(:empty)")
    alert.wait_for(timeout=READY)
    assert "not finite" in alert.inner_text()
    assert alert.count() == 1
    gait.shot("07_error")
    gait.kernel("None", "from ikteach import dls\nplayer.session.methods['dls'] = dls")
    gait.press("Play")
    gait.frames(5)
    assert alert.count() == 0


def test_running_the_cell_again_leaves_one_loop(gait: Notebook) -> None:
    loops = (
        "sum(task.get_coro().__qualname__.endswith('Live._run') "
        "for task in __import__('asyncio').all_tasks(player._act.loop) if not task.done())"
    )
    old = gait.kernel("player.scene.driver.model_id")
    gait.run_cell("player = GaitPlayer()")
    gait.settle(f"player.scene.driver.model_id != {old!r}", True)
    gait.page.wait_for_selector(f"{DRIVER}[data-frame]", timeout=READY)
    gait.frames(10)
    assert gait.kernel(loops) == 1
    gait.kernel("None", "player.close()")
    gait.settle(loops, 0)
    gait.run_cell("player = GaitPlayer()")
    gait.page.wait_for_selector(f"{DRIVER}[data-frame]", timeout=READY)


def test_nobody_looks_no_loop_runs(gait: Notebook) -> None:
    gait.frames(5)
    gait.kernel("None", "import ikteach.view.webgl.driver as _d; _d.PATIENCE = 0.5")
    gait.command("notebook:clear-all-cell-outputs")
    gait.settle("player._task.done()", True)
    gait.run_cell("player = GaitPlayer()")
    gait.page.wait_for_selector(f"{DRIVER}[data-frame]", timeout=READY)
    gait.frames(5)
