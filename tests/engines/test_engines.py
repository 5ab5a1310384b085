"""The course in Firefox and in WebKit: a chapter runs, a target is dragged and moved by key.

They want the drivers of their distributions (packages firefox-esr, webkit2gtk-driver and xvfb) and
the extra `engines`: so they run in the full mode of `tests/run`.
"""

import json
import re
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.browser.conftest import DRIVER, SHOTS, Lab, course_in_lab
from tests.engines.engines import Engine, Firefox, Screen, WebKit, wait

pytestmark = pytest.mark.filterwarnings("ignore::DeprecationWarning")  # the drivers' own

ASK = """
const kernel = window.jupyterapp.shell.currentWidget.sessionContext.session.kernel;
window.answer = null;
kernel.requestExecute({ code: %s, store_history: false, user_expressions: { answer: %s } })
  .done.then(({ content }) => { window.answer = content; });
return true;
"""
UP = "\ue013"  # the arrow key
# Who does anything is no longer kept at the figure. (WebKit's driver presses no Shift by itself.)
ELSEWHERE = "document.dispatchEvent(new KeyboardEvent('keydown', { key: 'Shift' }))"
KERNEL = "return !!window.jupyterapp?.shell.currentWidget?.sessionContext?.session?.kernel"
SHOWN = f"+(document.querySelector('{DRIVER}')?.dataset.shown ?? 0)"
RUN = """
const { content } = window.jupyterapp.shell.currentWidget;
content.activeCellIndex = content.widgets.findIndex(
  cell => cell.model.type === "code" && cell.model.sharedModel.getSource().includes(%s));
window.jupyterapp.commands.execute("notebook:run-cell");
return content.activeCellIndex >= 0;
"""
# Where the middle of a target is, in pixels from the middle of the picture, for a focal length of 1
PLACE = """
import numpy as _np
from ikteach.view.stage.stage import picture_axes as _axes
_eye = _np.array(bench.scene.camera.position)
_x, _y, _z = (bench.session.targets[3] - _eye) @ _axes(
    _eye - bench.scene.renderer.controls[0].target)
"""
CANVAS = """
const canvas = document.querySelector(".jupyter-threejs canvas");
canvas.scrollIntoView({ block: "center" });
const { x, y, width, height } = canvas.getBoundingClientRect();
return [x + width / 2, y + height / 2, height / 2 / Math.tan(Math.PI / 8)];
"""


class Course:
    """The course in JupyterLab, in one engine."""

    def __init__(self, engine: Engine, lab: Lab) -> None:
        self.engine, self.lab = engine, lab

    def open(self, notebook: str, cell: str) -> None:
        """Open a notebook, run one cell of it, and wait until its figure is drawn."""
        self.lab.stop_kernels()
        self.engine.go(self.lab.url(notebook))
        wait(self.engine, KERNEL)
        wait(self.engine, RUN % json.dumps(cell))
        wait(self.engine, f"return {SHOWN} > 0")
        self.engine.run(ELSEWHERE)

    def ask(self, expression: str, code: str = "") -> Any:
        """Run code in the kernel, and give the value of an expression."""
        said = json.dumps(f"__import__('json').dumps({expression})")
        self.engine.run(ASK % (json.dumps(code), said))
        answer = wait(self.engine, "return window.answer")["user_expressions"]["answer"]
        assert answer["status"] == "ok", answer
        return json.loads(eval(answer["data"]["text/plain"]))

    def settle(self, expression: str) -> None:
        """Wait until the kernel says that this is true."""
        for _ in range(100):
            if self.ask(f"bool({expression})"):
                return
        pytest.fail(f"still not: {expression}")

    def target(self) -> tuple[float, float]:
        """Where the last target is in the view, in pixels."""
        x, y, z = self.ask("[float(_x), float(_y), float(_z)]", PLACE)
        across, down, focal = self.engine.run(CANVAS)
        return across + focal * x / -z, down - focal * y / -z

    def shot(self, name: str) -> None:
        """Keep a screenshot, by the engine's name."""
        SHOTS.mkdir(exist_ok=True)
        self.engine.shot(SHOTS / f"{type(self.engine).__name__.lower()}_{name}.png")


@pytest.fixture(scope="module")
def lab(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Lab]:
    with course_in_lab(tmp_path_factory.mktemp("course")) as lab:
        yield lab


@pytest.fixture(scope="module", params=[Firefox, WebKit], ids=["firefox", "webkit"])
def course(request: Any, lab: Lab, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Course]:
    screen = Screen()
    try:
        engine = request.param(tmp_path_factory.mktemp("engine"))
        try:
            yield Course(engine, lab)
        finally:
            engine.close()
    finally:
        screen.close()


def test_a_chapter_plays(course: Course) -> None:
    course.open("07_gait.ipynb", "player")
    before = course.engine.run(f"return {SHOWN}")
    wait(course.engine, f"return {SHOWN} >= {before + 30}")
    course.shot("gait")
    assert course.ask("player.status.wrong") == ""


def test_a_target_follows_mouse_and_keys(course: Course) -> None:
    course.open("09_workbench.ipynb", "bench = Workbench()")
    course.ask("None", "bench.pause()")
    x, y = course.target()
    course.engine.drag([(x, y), (x + 20, y - 10), (x + 40, y - 30)])
    course.settle("bench.session.by_hand")
    np.testing.assert_allclose(course.target(), (x + 40, y - 30), atol=1.5)
    course.shot("dragged")
    before = course.ask("bench.session.targets[3].tolist()")
    course.engine.press(UP)
    course.settle(f"bench.session.targets[3][1] > {before[1]}")


def test_a_page_of_the_lecture_opens(course: Course, tmp_path: Path) -> None:
    command = [sys.executable, "-u", "-m", "ikteach", "lecture", str(tmp_path), "--no-browser"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as server:
        try:
            lines = iter(server.stdout or ())
            found = (re.search(r"http://127\S+token=[\w-]+", line) for line in lines)
            course.engine.go(next(filter(None, found)).group())
            wait(course.engine, f"return {SHOWN} > 30")
            course.shot("lecture")
            end = "return document.documentElement.scrollWidth <= window.innerWidth"
            assert course.engine.run(end), "the page is cut at its right"
        finally:
            server.send_signal(signal.SIGINT)
