"""Chapter 10's simulator by the keyboard alone: in pixels, in words and in state."""

import json
import time
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from tests.browser.conftest import CANVAS, DRIVER, READY, Notebook, pixels

STATUS = ".ikteach-cursor"
RED, WHITE, SKIN = [213, 94, 0], [255, 255, 255], [217, 165, 126]
SESSION = "player.session"
HAND = f"{SESSION}.standing[{SESSION}.method]"


@pytest.fixture(scope="module")
def reach(open_notebook: Any) -> Iterator[Notebook]:
    notebook = open_notebook("10_reach.ipynb")
    notebook.run_figure("player = Simulator()")
    notebook.page.wait_for_selector(".ikteach-stage", timeout=READY)
    yield notebook
    assert notebook.errors == []


def take_hold(reach: Notebook) -> None:
    """Go to the picture with the keyboard, and on to its one target."""
    stage = reach.page.locator(".ikteach-stage").first
    stage.evaluate("stage => stage.blur()")
    stage.focus()
    reach.page.keyboard.press("Tab")


def press(reach: Notebook, key: str, times: int, axis: int, to: float) -> None:
    """Press a key so often, and see that it has brought the cursor's coordinate there."""
    for _ in range(times):
        reach.page.keyboard.press(key)
    reach.settle(f"round(float({SESSION}.cursor[{axis}]), 6)", to)
    drawn(reach)


def drawn(reach: Notebook) -> None:
    """Wait until the page has drawn what the kernel has sent by now."""
    sent = reach.kernel("player.scene.driver.sent")
    reach.page.wait_for_function(
        f"+document.querySelector('{DRIVER}').dataset.frame >= {sent}", timeout=READY
    )


def share(picture: np.ndarray, colour: list[int], at: np.ndarray, radius: int = 30) -> float:
    """The share of a colour, however shaded, around a pixel of the picture."""
    x, y = at.round().astype(int)
    part = picture[max(y - radius, 0) : y + radius, max(x - radius, 0) : x + radius]
    length = np.linalg.norm(part, axis=-1)
    hue = np.array(colour) / np.linalg.norm(colour)
    return float(((part @ hue > 0.99 * length) & (length > 110)).mean())


def place(reach: Notebook, picture: np.ndarray) -> np.ndarray:
    """The pixel of the picture at which the cursor is seen."""
    centre = "player.scene.stage.extent.centre.tolist()"
    eye, cursor, at = map(
        np.array,
        reach.kernel(f"[player.scene.camera.position, {SESSION}.cursor.tolist(), {centre}]"),
    )
    back = (eye - at) / np.linalg.norm(eye - at)
    right = np.cross([0, 1, 0], back)
    right /= np.linalg.norm(right)
    x, y, z = np.array([right, np.cross(back, right), back]) @ (cursor - eye)
    height, width = picture.shape[:2]
    half = height / 2 / np.tan(np.radians(45 / 2))
    return np.array([width / 2 + half * x / -z, height / 2 - half * y / -z])


def word(reach: Notebook, words: str) -> None:
    reach.page.wait_for_selector(f"{STATUS} >> text={words}", timeout=READY)


def test_a_white_cursor_the_hand_arrives_and_is_seen_there(reach: Notebook) -> None:
    reach.settle(f"{HAND}.arrived is not None", True)
    drawn(reach)
    word(reach, "white")
    word(reach, "within reach of the right arm")
    picture = pixels(reach.shot("10_white", CANVAS))
    at = place(reach, picture)
    assert share(picture, WHITE, at, 8) > 0.5
    assert share(picture, SKIN, at) > 0.04
    reach.shot("10_page")


def test_out_of_reach_it_is_red_and_the_arm_goes_back_to_rest(reach: Notebook) -> None:
    take_hold(reach)
    press(reach, "ArrowLeft", 12, 0, -0.95)
    press(reach, "ArrowUp", 6, 1, 0.55)
    reach.settle(f"{SESSION}.within", False)
    word(reach, "red")
    word(reach, "out of reach of every package")
    reach.settle(f"{HAND}.words", "does not answer: at rest")
    rest = f"abs({SESSION}.theta - {SESSION}.tree.rest)"
    assert reach.kernel(f"float({rest}[{SESSION}.body.arm('r')].max())") < 1e-9
    drawn(reach)
    picture = pixels(reach.shot("10_red", CANVAS))
    at = place(reach, picture)
    assert share(picture, RED, at, 8) > 0.5
    assert share(picture, SKIN, at) == 0


def test_back_within_reach_it_is_white_and_the_hand_comes(reach: Notebook) -> None:
    take_hold(reach)
    press(reach, "ArrowRight", 12, 0, -0.35)
    press(reach, "ArrowDown", 6, 1, 0.25)
    reach.settle(f"{SESSION}.within", True)
    word(reach, "white")
    reach.settle(f"{HAND}.words.startswith('arrived')", True)
    drawn(reach)
    picture = pixels(reach.shot("10_white_again", CANVAS))
    assert share(picture, SKIN, place(reach, picture)) > 0.04


def test_the_head_follows_the_cursor_up(reach: Notebook) -> None:
    nod = f"float({SESSION}.theta[{SESSION}.body.neck])"
    before, low = reach.kernel(nod), pixels(reach.shot("10_head_low", CANVAS))
    take_hold(reach)
    press(reach, "Numpad8", 8, 1, 0.65)
    reach.settle(f"{HAND}.words.startswith('arrived')", True)
    drawn(reach)
    assert reach.kernel(nod) < before - 0.3  # the neck's angle grows downward
    high = pixels(reach.shot("10_head_high", CANVAS))
    head = np.s_[60:150, 205:300]  # the figure's; the hand stays out of it
    assert (abs(low[head] - high[head]).max(axis=-1) > 40).mean() > 0.1


def test_depth_and_keypad(reach: Notebook) -> None:
    cursor = f"{SESSION}.cursor.round(6).tolist()"
    take_hold(reach)
    for key, way, axis in [
        ("PageDown", "PageUp", 2), ("Numpad3", "Numpad9", 2), ("Numpad4", "Numpad6", 0),
    ]:  # fmt: skip
        before = reach.kernel(cursor)
        for pressed, far in ((key, 0.1), (way, 0.0)):
            for _ in range(2):
                reach.page.keyboard.press(pressed)
            moved = f"(abs({SESSION}.cursor - {before}).round(6)).tolist()"
            reach.settle(moved, [far if i == axis else 0.0 for i in range(3)])


def test_methods_and_the_middle_by_keyboard(reach: Notebook) -> None:
    """In the middle no package answers; without packages a hand comes."""
    take_hold(reach)
    press(reach, "ArrowRight", 7, 0, 0.0)
    word(reach, "in the middle")
    button = reach.page.get_by_role("button", name="dls", exact=True).first
    button.focus()
    reach.page.keyboard.press("Enter")
    reach.settle(f"{SESSION}.method", "dls")
    word(reach, "together")
    reach.settle(f"{HAND}.arrived is not None", True)
    reach.page.wait_for_selector("table.ikteach-table >> text=dls (shown)", timeout=READY)
    rows = reach.page.locator("table.ikteach-table").first.locator("tbody tr")
    assert rows.count() == 6
    reach.shot("10_middle")


def test_a_new_size_of_the_window_changes_nothing_else(reach: Notebook) -> None:
    reach.settle(f"{SESSION}.settled", True)
    reach.settle("player._task.done()", True)
    state = (
        f"[{SESSION}.theta.tolist(), {SESSION}.cursor.tolist(), {SESSION}.ticks, "
        f"{SESSION}.method, player.playing, list(player.scene.camera.position)]"
    )
    before = reach.kernel(state)
    for width in (900, 1440):
        reach.page.set_viewport_size({"width": width, "height": 1100})
        reach.page.wait_for_function(f"window.innerWidth === {width}")
        time.sleep(0.3)  # whoever hears of it has had the time to act
        assert json.dumps(reach.kernel(state)) == json.dumps(before)


def test_an_oscillation_is_said_and_an_error_is_told_once(reach: Notebook) -> None:
    cramer = reach.page.get_by_role("button", name="cramer", exact=True).first
    cramer.focus()
    reach.page.keyboard.press("Enter")
    reach.settle(f"{SESSION}.method", "cramer")
    reach.kernel("None", f"{SESSION}.put([0.4, -0.2, 0.3]); player.play(); player.wake()")
    reach.settle(f"{HAND}.words.startswith('oscillates')", True)
    reach.page.wait_for_selector("table.ikteach-table >> text=oscillates", timeout=READY)
    broken = "from dataclasses import replace\nfrom ikteach.motion.reach.ways import WAYS\n"
    broken += "bad = replace(WAYS['dls'], solver=lambda J, e: J[..., 0, :] * float('nan'))\n"
    broken += f"{SESSION}.ways['dls'] = bad; {SESSION}.put([0.3, 0.4, 0.4]); player.wake()"
    reach.kernel("None", broken)
    alert = reach.page.locator(".ikteach-status [role=alert]:not(:empty)")
    alert.wait_for(timeout=READY)
    assert "not finite" in alert.inner_text()
    assert "<lambda>" in alert.inner_text()
    assert alert.count() == 1
    reach.kernel("None", f"{SESSION}.ways['dls'] = WAYS['dls']")
    play = reach.page.get_by_role("button", name="Play", exact=True).first
    play.focus()
    reach.page.keyboard.press("Enter")
    ticks = reach.kernel(f"{SESSION}.ticks")
    reach.settle(f"{SESSION}.ticks > {ticks}", True)
    assert alert.count() == 0
