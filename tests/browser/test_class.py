"""The page before a class, as the last row sees it and as a keyboard works it."""

import re
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pupils
import pytest
from playwright.sync_api import Browser, Page

from tests.browser.conftest import READY, ROOT, SHOTS, open_page

AXE = (ROOT / "tests/page/node_modules/axe-core/axe.min.js").read_text()
LOOK = "axe.run().then(({ violations, passes }) => [passes.length, violations.map(({ id }) => id)])"
LETTERS = """() => Math.min(...[...document.querySelectorAll("tbody th, tbody .number")]
  .map((one) => parseFloat(getComputedStyle(one).fontSize)))"""


@pytest.fixture
def page(browser: Browser, tmp_path: Path) -> Iterator[Page]:
    """The page of a class that has made half of its answers."""
    todo = pupils.steps(tmp_path, 1, pupils=8)
    for act in todo[: len(todo) // 2]:
        act()
    command = [sys.executable, "-u", "-m", "ikteach", "class", str(tmp_path), "--no-browser"]
    server = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    assert server.stdout is not None
    found = re.search(r"http\S+", server.stdout.readline())
    page, errors = open_page(browser, 1280, 720), list[str]()
    page.on("pageerror", lambda error: errors.append(str(error)))
    page.on("console", lambda m: errors.append(m.text) if m.type == "error" else None)
    try:
        assert found
        page.goto(found[0])
        page.wait_for_selector(".count", timeout=READY)
        yield page
        for act in todo[len(todo) // 2 :]:
            act()
        page.get_by_text("7 of 7 have answered").wait_for(timeout=READY)
        page.close()
        assert errors == []
    finally:
        server.send_signal(signal.SIGINT)
        assert server.wait(30) == 0


def test_answers_are_hidden_until_they_are_revealed_by_key_or_button(page: Page) -> None:
    assert "token" not in page.url
    page.get_by_label("What is shown").select_option("02.inward")
    main = page.locator("main")
    assert re.search(r"[1-7] of [1-7] have answered", main.inner_text())
    assert page.locator("table").count() == 0
    assert "dls" not in main.inner_text()  # of an answer
    page.screenshot(path=SHOTS / "class_hidden.png")
    page.keyboard.press("r")
    rows = page.locator("tbody tr")
    rows.first.wait_for(timeout=READY)
    assert rows.count() >= 4
    assert page.locator("[role=status]").inner_text() == "The answers are shown."
    assert page.evaluate(LETTERS) >= 720 / 25  # legible at eight times the height of the picture
    page.screenshot(path=SHOTS / "class_shown.png")
    page.get_by_role("button", name="Reveal").click()
    assert rows.count() == 0
    page.keyboard.press("r")
    page.keyboard.press("n")
    main.get_by_text(pupils.HOSTILE).first.wait_for(timeout=READY)
    page.keyboard.press("e")
    main.get_by_text("00.hand").wait_for(timeout=READY)
    page.get_by_label("What is shown").select_option("00.hand")
    main.get_by_text("have passed").wait_for(timeout=READY)
    page.evaluate(AXE)
    looked, faults = page.evaluate(LOOK)
    assert looked
    assert faults == []
    page.set_viewport_size({"width": 1920, "height": 1080})
    page.screenshot(path=SHOTS / "class_exercise.png")
    assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")
    assert page.title() == "The class"  # and not what the markup of one of them says
    page.keyboard.press("n")
    page.keyboard.press("e")
