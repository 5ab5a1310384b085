"""Every page of the lecture, alone and for a room: each has a figure, and it moves."""

import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Iterator

import numpy as np
import pytest
from playwright.sync_api import Browser, Page

from ikteach.serve.lecture import PAGES
from tests.browser.conftest import CANVAS, DRIVER, READY, SHOTS, SHOWN, open_page, pixels

NAMES = sorted(path.stem for path in PAGES.glob("*.ipynb"))
RESTS = {"simulator": ".ikteach-stage", "robot": ".noUi-handle"}  # until somebody moves this


@pytest.fixture(scope="module", params=["alone", "room"])
def render(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[str]:
    """The address of a page, with places for its name, of a lecture that only we can reach."""
    folder = tmp_path_factory.mktemp(request.param)
    room = ["--room"] if request.param == "room" else []
    command = [sys.executable, "-u", "-m", "ikteach", "lecture", str(folder), "--no-browser"]
    server = subprocess.Popen(
        [*command, *room, "--", "--Voila.ip=127.0.0.1"], stdout=subprocess.PIPE, text=True,
        env=os.environ | {"OPENBLAS_NUM_THREADS": "1", "JUPYTER_CONFIG_DIR": str(folder)},
    )  # fmt: skip
    assert server.stdout is not None
    try:
        said = iter(server.stdout)
        found = next(filter(None, (re.search(r":(\d+)/\?(token=[\w-]+)", line) for line in said)))
        yield f"http://127.0.0.1:{found[1]}/voila/render/{{}}.ipynb?{found[2]}"
    finally:
        server.send_signal(signal.SIGINT)
        server.wait(30)


def test_every_page_has_a_figure_that_moves(
    render: str, browser: Browser, request: pytest.FixtureRequest
) -> None:
    assert NAMES == ["gait", "race", "robot", "simulator", "walks", "workbench"]
    errors: list[str] = []
    pages = {name: open_page(browser, 1280, 720) for name in NAMES}
    for name, page in pages.items():
        page.on("pageerror", lambda error, name=name: errors.append(f"{name}: {error}"))
        page.goto(render.format(name), wait_until="commit")
    mode = request.node.callspec.params["render"]
    for name, page in pages.items():
        page.wait_for_selector(f"{DRIVER}[data-frame]", timeout=2 * READY)
        if name in RESTS:
            page.locator(RESTS[name]).first.focus()
            if name == "simulator":
                page.keyboard.press("Tab")  # to its cursor
        assert moves(page, f"lecture_{mode}_{name}", "ArrowUp" if name in RESTS else None), name
        page.close()
    assert errors == []


def moves(page: Page, shot: str, key: str | None) -> bool:
    """Whether a figure is drawn, and then drawn elsewhere."""

    def seen() -> np.ndarray:
        return pixels(page.locator(CANVAS).first.screenshot(path=SHOTS / f"{shot}.png"))

    first, end = seen(), time.monotonic() + 20
    assert (abs(first - first[0, 0]).max(axis=-1) > 60).mean() > 0.01, "hardly anything is drawn"
    while time.monotonic() < end:
        if key:
            page.keyboard.press(key)
        before = page.evaluate(SHOWN)
        page.wait_for_function(f"{SHOWN} >= {before + 8}", timeout=READY)
        if (abs(first - seen()).max(axis=-1) > 30).mean() > 0.005:
            return True
    return False
