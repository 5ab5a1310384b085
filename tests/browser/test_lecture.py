"""The lecture's pages as a room sees them: no notebook, no code, no other server."""

import os
import re
import signal
import subprocess
import sys
import time
import urllib.error
import urllib.request
from collections.abc import Iterator
from pathlib import Path
from urllib.parse import urlsplit

import pytest
from playwright.sync_api import Browser, Page, Request, Route

from tests.browser.conftest import CANVAS, DRIVER, READY, SHOTS, SHOWN, open_page, pixels

KERNEL = r'"kernelId": ?"([\w-]+)"'


# Ask the page's kernel to run code, then something harmless, and say what was answered.
INTRUDE = """([kernel, token]) => new Promise((done, failed) => {
  const url = `ws://${location.host}/api/kernels/${kernel}/channels?${token}&session_id=intruder`;
  const socket = new WebSocket(url, "v1.kernel.websocket.jupyter.org"), answers = [];
  const bytes = value => new TextEncoder().encode(value), text = p => new TextDecoder().decode(p);
  socket.binaryType = "arraybuffer";
  const ask = (msg_type, content) => {
    const header = { msg_id: msg_type, msg_type, session: "intruder", username: "", version: "5" };
    const json = [header, {}, {}, content].map(part => JSON.stringify(part));
    const parts = ["shell", ...json].map(bytes);
    const at = [8 * (parts.length + 2)];
    for (const part of parts) at.push(at.at(-1) + part.length);
    const numbers = BigUint64Array.from([at.length, ...at].map(BigInt));
    socket.send(new Blob([numbers, ...parts]));
  };
  socket.onmessage = ({ data }) => {
    const n = Number(new BigUint64Array(data.slice(0, 8))[0]);
    const at = [...new BigUint64Array(data.slice(8, 8 * (n + 1)))].map(Number);
    const [channel, header, parent] = [0, 1, 2].map(i => text(data.slice(at[i], at[i + 1])));
    if (channel === "shell" && JSON.parse(parent).session === "intruder")
      answers.push(JSON.parse(header).msg_type);
    if (answers.includes("kernel_info_reply")) { socket.close(); done(answers); }
  };
  socket.onclose = ({ code }) => failed(`closed with ${code}`);
  socket.onopen = () => {
    ask("execute_request", { code: "1", silent: false, store_history: false, user_expressions: {},
                             allow_stdin: false });
    ask("kernel_info_request", {});
  };
})"""


class Lecture:
    """`python -m ikteach lecture` and one page of it, in which nothing from elsewhere is let in."""

    def __init__(self, folder: Path, browser: Browser) -> None:
        command = [sys.executable, "-u", "-m", "ikteach", "lecture", str(folder), "--no-browser"]
        environment = os.environ | {"OPENBLAS_NUM_THREADS": "1", "JUPYTER_CONFIG_DIR": str(folder)}
        self.server = subprocess.Popen(
            command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True
        )
        assert self.server.stdout is not None
        said = ""
        while not (found := re.search(r"(http://127\S+)\?(token=[\w-]+)", said)):
            said = self.server.stdout.readline()
            assert said, "the server has ended"
        self.address, self.site, self.token = found.group(0, 1, 2)
        self.errors: list[str] = []
        self.outside: list[str] = []
        self.page = open_page(browser, 1280, 720)
        self.page.on("pageerror", lambda error: self.errors.append(str(error)))
        self.page.on("console", lambda m: self.errors.append(m.text) if m.type == "error" else None)
        self.page.route("**/*", self._let_in)

    def _let_in(self, route: Route, request: Request) -> None:
        if urlsplit(request.url).netloc in (urlsplit(self.site).netloc, ""):
            route.continue_()
        else:
            self.outside.append(request.url)
            route.abort()

    def opened(self, name: str) -> Page:
        """Wait until the page of that name has a figure that is drawn."""
        self.page.wait_for_url(f"**/voila/render/{name}.ipynb*")
        self.page.wait_for_selector(f"{DRIVER}[data-frame]", timeout=2 * READY)
        return self.page

    def kernel(self) -> str:
        return str(self.page.evaluate(
            "JSON.parse(document.getElementById('jupyter-config-data').textContent).kernelId"
        ))  # fmt: skip

    def lives(self, kernel: str) -> bool:
        try:
            urllib.request.urlopen(f"{self.site}api/kernels/{kernel}?{self.token}").close()
        except urllib.error.HTTPError as error:
            return error.code != 404
        return True

    def shot(self, name: str, selector: str = "body") -> bytes:
        SHOTS.mkdir(exist_ok=True)
        return self.page.locator(selector).first.screenshot(path=SHOTS / f"{name}.png")

    def stop(self) -> int:
        self.page.close()
        self.server.send_signal(signal.SIGINT)
        return self.server.wait(30)


@pytest.fixture(scope="module")
def lecture(browser: Browser, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Lecture]:
    lecture = Lecture(tmp_path_factory.mktemp("lecture"), browser)
    lecture.page.goto(lecture.address, wait_until="commit")
    yield lecture
    assert lecture.stop() == 0
    assert lecture.outside == []
    assert lecture.errors == []


def drawn(page: Page, more: int) -> None:
    """Wait until so many more frames have been drawn."""
    before = page.evaluate(SHOWN)
    page.wait_for_function(f"{SHOWN} >= {before + more}", timeout=READY)


def test_the_first_page_is_the_workbench_and_the_figure_moves(lecture: Lecture) -> None:
    page = lecture.opened("workbench")
    drawn(page, 10)
    first = pixels(lecture.shot("lecture_workbench", CANVAS))
    assert (abs(first - first[0, 0]).max(axis=-1) > 60).mean() > 0.05, "hardly anything is drawn"
    end, moved = time.monotonic() + 20, 0.0
    while moved < 0.005:  # a pose may be much as the one before
        assert time.monotonic() < end, f"only {moved:.1%} of the picture has moved"
        drawn(page, 8)
        second = pixels(lecture.shot("lecture_moves", CANVAS))
        moved = (abs(first - second).max(axis=-1) > 30).mean()
    assert page.locator(".jp-InputArea-editor").count() == 0  # no code
    page.screenshot(path=SHOTS / "lecture_1280.png")


def test_controls_act(lecture: Lecture) -> None:
    page = lecture.opened("workbench")
    page.get_by_role("button", name="transpose", exact=True).first.click()
    page.wait_for_selector(f"{DRIVER}[aria-label*='by transpose']", timeout=READY)
    page.get_by_role("button", name="Pause", exact=True).click()
    page.get_by_role("button", name="Play", exact=True).wait_for()
    before = pixels(lecture.shot("lecture_three_quarter", CANVAS))
    page.locator(".jupyter-widget-Collapse-header").get_by_text("View", exact=True).click()
    page.get_by_label("View", exact=True).first.select_option("front")
    end = time.monotonic() + 20
    while time.monotonic() < end:
        after = pixels(lecture.shot("lecture_front", CANVAS))
        if before.shape == after.shape and (before != after).any(axis=-1).mean() > 0.05:
            return
    pytest.fail("the picture is what it was")


def test_the_words_are_below_and_the_link_leads_to_the_simulator(lecture: Lecture) -> None:
    page = lecture.opened("workbench")
    page.get_by_role("link", name="keys").click()
    page.get_by_text("What to try.").wait_for()
    lecture.shot("lecture_words", "[id='cell-id=words']")
    gone = lecture.kernel()
    assert lecture.lives(gone)
    page.get_by_role("link", name="Simulator").click()
    lecture.opened("simulator")
    assert lecture.lives(lecture.kernel())
    assert not lecture.lives(gone)


def test_a_key_moves_the_cursor_and_the_arm_follows(lecture: Lecture) -> None:
    page = lecture.opened("simulator")
    page.wait_for_selector(f"{DRIVER}[aria-label*='The hand: arrived']", timeout=READY)
    before = pixels(lecture.shot("lecture_low", CANVAS))
    page.locator(".ikteach-stage").first.focus()
    for key in ("Tab", "ArrowUp", "ArrowUp", "ArrowUp"):
        page.keyboard.press(key)
    page.wait_for_selector(f"{DRIVER}[aria-label*='y 0.40']", timeout=READY)
    page.wait_for_selector(f"{DRIVER}[aria-label*='The hand: arrived']", timeout=READY)
    drawn(page, 0)
    after = pixels(lecture.shot("lecture_high", CANVAS))
    skin = [217, 165, 126]

    def height(picture):  # of the skin that is seen left of the body: the arm's
        length = ((picture**2).sum(axis=-1)) ** 0.5
        alike = picture @ skin > 0.99 * length * sum(c * c for c in skin) ** 0.5
        rows, _ = (alike & (length > 110))[:, 100:235].nonzero()
        return rows.mean()

    assert height(after) < height(before) - 10
    page.set_viewport_size({"width": 1920, "height": 1080})
    page.screenshot(path=SHOTS / "lecture_1920.png")


def test_a_second_visitor_has_a_kernel_of_their_own(lecture: Lecture) -> None:
    lecture.opened("simulator")
    url = f"{lecture.site}voila/render/simulator.ipynb?{lecture.token}"
    with urllib.request.urlopen(url) as answer:
        text = ""
        while not (found := re.search(KERNEL, text)):
            text += answer.readline().decode()
        assert found[1] != lecture.kernel()
        assert lecture.lives(found[1])


def test_a_visitor_cannot_run_code(lecture: Lecture) -> None:
    page = lecture.opened("simulator")
    assert page.evaluate(INTRUDE, [lecture.kernel(), lecture.token]) == ["kernel_info_reply"]


STATE = "speed=12.3&view=front&method=sdls&motion=run"
HOSTILE = "&meth=<img src=x onerror=alert(1)>&step_frequency=99"


def test_an_address_opens_a_state_and_a_link_leads_back_to_it(lecture: Lecture) -> None:
    page = lecture.page
    gait = f"{lecture.site}voila/render/gait.ipynb"
    page.goto(f"{gait}?{lecture.token}&{STATE}{HOSTILE}", wait_until="commit")
    page.wait_for_selector(f"{DRIVER}[aria-label*='running by sdls']", timeout=2 * READY)
    told = page.locator(".ikteach-status [role=alert]", has_text="Not set").inner_text()
    assert "no control 'meth'; did you mean 'method'? And step_frequency must be a number" in told
    assert "from 0.1 to 3, not '99'. The rest is set." in told
    page.locator(".ikteach-stage").first.focus()
    page.keyboard.press("l")
    link = page.get_by_label("Link to this")
    link.wait_for(timeout=READY)
    assert link.input_value() == f"{gait}?method=sdls&view=front&motion=running&speed=12.3"
    assert link.evaluate("one => one.selectionEnd - one.selectionStart === one.value.length")
    page.screenshot(path=SHOTS / "lecture_link.png")
    page.keyboard.press("Escape")
    assert page.evaluate("document.activeElement.classList.contains('ikteach-stage')")
    page.get_by_role("button", name="Link to this").click()
    link.wait_for(timeout=READY)


def test_without_the_token_nobody_gets_in(lecture: Lecture) -> None:
    with urllib.request.urlopen(f"{lecture.site}voila/render/workbench.ipynb") as answer:
        assert urlsplit(answer.url).path == "/login"
    for path in ("voila/tree", "voila/api/contents", "voila/files/workbench.ipynb"):
        with pytest.raises(urllib.error.HTTPError, match=r"40[34]"):
            urllib.request.urlopen(f"{lecture.site}{path}?{lecture.token}")
