"""Scene, handles and targets as a student has them: in a real JupyterLab, by mouse and by keys."""

import io
import shutil
import time
from collections.abc import Iterator
from typing import Any

import nbformat
import numpy as np
import pytest
from PIL import Image

from ikteach.formats import urdf
from ikteach.view.stage.layers import LAYERS
from tests.browser.conftest import CANVAS, DRIVER, READY, Lab, Notebook, pixels

FRAME = f"+(document.querySelector('{DRIVER}').dataset.frame ?? -1)"
SAID = ".ikteach-said[role=status]"
HAND = 3  # hand.l
TWO_FRAMES = "new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))"

ALONE = """from ikteach.body import figures
from ikteach.view import Scene
alone = Scene(*figures.planar_arm(3))
alone.show([0.4, 0.5, 0.6], [[1.5, 1.5, 0]])
alone.widget"""
SIZES = """() => new Promise(done => {
  const sizes = new Set();
  function look(frames) {
    const { width, height } = document.querySelector(".ikteach-stage").getBoundingClientRect();
    sizes.add(`${width} by ${height}`);
    if (frames) requestAnimationFrame(() => look(frames - 1)); else done([...sizes]);
  }
  look(20);
})"""
HUMAN = """import numpy as np
from ikteach.body import figures, forward, jacobian, locate
from ikteach.motion import gait, step
from ikteach.solvers.singularity import ellipsoid
from ikteach.view import Scene
from ikteach.view.webgl.targets import Targets
from ipywidgets import VBox
tree, effectors = figures.human()
scene = Scene(tree, effectors)
targets = Targets(scene, gait.walking.at(0.3))
theta = tree.rest
def follow(*_):
    global theta
    for _ in range(6):
        theta = step(tree, theta, effectors, targets.positions, "dls").theta
    draw()
def draw():
    global hand
    frames = forward(tree, theta)
    hand = locate(frames, effectors)[3]
    J = jacobian(tree, frames, effectors)[9:]
    scene.show(theta, targets.positions, effector=3, columns=J, ellipsoid=ellipsoid(J),
               reach=[((0.23, 0.37, 0), 0.1, 0.7)],
               skeletons=[[[(0, -0.9, 0.1), (0, 0.7, 0.1)]]])
targets.on_change(follow)
follow()
VBox([scene.widget, targets])"""
FOUR = """scene.close(); targets.close()
four = Scene(tree, effectors, names=["transpose", "pseudoinverse", "dls", "sdls"], width=900)
four.show(theta, targets.positions)
four"""
ARM = """four.close()
arm = figures.planar_arm(3)
plane = Scene(*arm, dark=True)
goal = Targets(plane, [[1.5, 1.5, 0]])
def draw(*_):
    plane.show([0.4, 0.5, 0.6], goal.positions)
goal.on_change(draw)
draw()
plane.widget"""

WAYS = """plane.close()
from ikteach.body import Effectors
from ikteach.formats.urdf import read_urdf
robot = read_urdf("arm7.urdf").tree
last = robot.names[-1]
ends = Effectors.of(robot, {"grip": (last, (0, 0, 0.1))}, directions={
    "grip.up": (last, (0, 0.3, 0)), "grip.ahead": (last, (0, 0, 0.3))})
pose = robot.rest + 0.4
seven = Scene(robot, ends)
aim = Targets(seven, locate(forward(robot, pose), ends))
def look(*_):
    global pose, tips
    for _ in range(30):
        pose = step(robot, pose, ends, aim.positions, "dls").theta
    seven.show(pose, aim.positions)
    tips = seven.now.targets[0]
aim.on_change(look)
look()
VBox([seven.widget, aim])"""


@pytest.fixture(scope="module")
def opened(lab: Lab, open_notebook: Any) -> Iterator[Notebook]:
    cells = [nbformat.v4.new_code_cell(cell) for cell in (ALONE, HUMAN, FOUR, ARM, WAYS)]
    shutil.copy(urdf.ARM, lab.folder)
    book = nbformat.v4.new_notebook(cells=cells)
    book.metadata.kernelspec = {"name": "python3", "display_name": "Python 3"}
    nbformat.write(book, lab.folder / "scene.ipynb")
    notebook = open_notebook("scene.ipynb")
    notebook.run_figure("alone = Scene")
    notebook.page.wait_for_selector(".ikteach-stage", timeout=READY)
    yield notebook
    assert notebook.errors == []


def test_a_scene_that_is_alone_in_its_cell_keeps_its_size(opened: Notebook) -> None:
    assert opened.page.evaluate(SIZES) == ["540 by 480"]


@pytest.fixture(scope="module")
def scene(opened: Notebook) -> Notebook:
    opened.kernel("None", "alone.close()")
    opened.command("notebook:clear-all-cell-outputs")
    opened.run_figure("scene = Scene")
    opened.page.wait_for_selector(".ikteach-stage", timeout=READY)
    return opened


def shown(scene: Notebook, code: str) -> None:
    """Run code in the kernel, and wait until the page has drawn the newest frame after it."""
    scene.kernel("None", code)
    sent = scene.kernel("scene.driver.sent")
    scene.page.wait_for_function(f"{FRAME} >= {sent}", timeout=READY)


def picture(scene: Notebook, name: str) -> np.ndarray:
    """The canvas, once what has been drawn is on the screen."""
    scene.page.evaluate(TWO_FRAMES)
    return pixels(scene.shot(name, CANVAS))


def differ(one: np.ndarray, other: np.ndarray) -> float:
    """The share of pixels that are not alike."""
    return float((abs(one - other).max(axis=-1) > 24).mean())


def where(
    scene: Notebook, target: int, name: str = "scene", at: str = "targets.positions"
) -> list[float]:
    """Where the middle of a target is in the page, in pixels."""
    code = f"""
import numpy as _np
from ikteach.view.stage.stage import picture_axes as _axes
_eye = _np.array({name}.camera.position)
_x, _y, _z = (_np.array({at}[{target}]) - _eye) @ _axes(
    _eye - {name}.renderer.controls[0].target)
"""
    x, y, z = scene.kernel("[float(_x), float(_y), float(_z)]", code)
    scene.page.locator(CANVAS).first.scroll_into_view_if_needed()
    box = scene.page.locator(CANVAS).first.bounding_box()
    assert box
    focal = box["height"] / 2 / np.tan(np.radians(22.5))
    across, down = focal * x / -z, -focal * y / -z
    return [box["x"] + box["width"] / 2 + across, box["y"] + box["height"] / 2 + down]


def position(target: int) -> str:
    return f"targets.positions[{target}].round(6).tolist()"


def drag(scene: Notebook, x: float, y: float, across: float, up: float) -> None:
    mouse = scene.page.mouse
    mouse.move(x, y)
    mouse.down()
    for part in np.linspace(0, 1, 9)[1:]:
        mouse.move(x + across * part, y - up * part)
        scene.page.wait_for_timeout(20)


def test_every_layer_is_seen_and_goes_again(scene: Notebook) -> None:
    before = plain = picture(scene, "scene_plain")
    # Trails and prints need a past: the hands have come a way, the feet have turned round.
    swing = "[scene.show(tree.rest + 0.5 * np.sin(i / 5), targets.positions) for i in range(40)]"
    for layer in LAYERS:
        past = swing if layer in ("trails", "footprints") else ""
        shown(scene, f"scene.switch({layer!r})\n{past}\ndraw()")
        name, end = f"scene_{layer.replace(' ', '_')}", time.monotonic() + 20
        while differ(before, after := picture(scene, name)) <= 0.0005:
            assert time.monotonic() < end, layer  # its objects are on their way
        before = after
    shown(scene, f"[scene.switch(layer, False) for layer in {list(LAYERS)}]\ndraw()")
    assert differ(plain, picture(scene, "scene_plain_again")) < 0.002


def test_a_drag_moves_target_and_hand_and_not_the_camera(scene: Notebook) -> None:
    x, y = where(scene, HAND)
    before = np.array(scene.kernel("targets.positions.tolist()"))
    hand = np.array(scene.kernel("hand.tolist()"))
    eye = scene.kernel("list(scene.camera.position)")
    drag(scene, x, y, -60, 50)
    scene.shot("scene_drag")
    scene.page.mouse.up()
    scene.settle(f"bool(targets.positions[{HAND}, 1] > {before[HAND, 1] + 0.1})", True)
    after = np.array(scene.kernel("targets.positions.tolist()"))
    assert (after[:HAND] == before[:HAND]).all()
    new_hand = np.array(scene.kernel("hand.tolist()"))
    goal = after[HAND]
    assert np.linalg.norm(new_hand - goal) < np.linalg.norm(hand - goal)
    # The pointer is where it was put, and what was moved is under it.
    assert np.hypot(*(np.array(where(scene, HAND)) - [x - 60, y - 50])) < 3
    assert scene.kernel("list(scene.camera.position)") == eye
    # Beside a target the same drag turns the camera.
    corner = scene.page.locator(CANVAS).first.bounding_box()
    assert corner
    drag(scene, corner["x"] + 30, corner["y"] + 30, 40, 0)
    scene.page.mouse.up()
    scene.settle(f"list(scene.camera.position) != {eye}", True)
    scene.kernel("None", "scene.look_from('three-quarter')")


def test_escape_takes_a_whole_drag_back(scene: Notebook) -> None:
    was = scene.kernel(position(HAND))
    x, y = where(scene, HAND)
    drag(scene, x, y, 40, 30)
    scene.page.mouse.up()
    scene.settle(f"{position(HAND)} != {was}", True)
    scene.page.keyboard.press("Escape")
    scene.settle(position(HAND), was)
    scene.page.wait_for_selector(f"{SAID} >> text=Taken back", timeout=READY)


def test_a_finger_drags_too(scene: Notebook) -> None:
    was = scene.kernel(position(HAND))
    eye = scene.kernel("list(scene.camera.position)")
    x, y = where(scene, HAND)
    finger = scene.page.context.new_cdp_session(scene.page)
    for kind, step in [("touchStart", 0), *(("touchMove", step) for step in range(1, 7))]:
        points = [{"x": x - 6 * step, "y": y - 4 * step}]
        finger.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})
        scene.page.wait_for_timeout(20)
    finger.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})
    finger.detach()
    scene.settle(f"bool(targets.positions[{HAND}, 1] > {was[1] + 0.02})", True)
    assert np.hypot(*(np.array(where(scene, HAND)) - [x - 36, y - 24])) < 3
    assert scene.kernel("list(scene.camera.position)") == eye
    scene.kernel("None", "targets.undo()")
    scene.settle(position(HAND), was)


def test_by_keyboard_alone(scene: Notebook) -> None:
    page = scene.page
    page.locator(".ikteach-stage").focus()
    page.locator(".ikteach-stage").evaluate("stage => stage.blur()")
    page.locator(".ikteach-stage").focus()
    page.wait_for_selector(f"{SAID} >> text=Arrows turn the camera", timeout=READY)
    plain = picture(scene, "scene_unchosen")
    for name in ("foot.l", "foot.r", "hand.r"):
        page.keyboard.press("Tab")
        page.wait_for_selector(f"{SAID} >> text={name} chosen", timeout=READY)
    assert differ(plain, picture(scene, "scene_chosen")) > 0.0005  # the ring
    scene.settle("targets.handles.chosen", 2)
    x, y, z = scene.kernel(position(2))
    keys = {"ArrowUp": (0, 1, 0), "ArrowRight": (1, 0, 0), "PageUp": (0, 0, -1)}
    for key, way in keys.items():
        page.keyboard.press(key)
        x, y, z = x + 0.05 * way[0], y + 0.05 * way[1], z + 0.05 * way[2]
        scene.settle(f"bool(abs(targets.positions[2] - {[x, y, z]}).max() < 1e-4)", True)
    page.keyboard.press("Shift+ArrowDown")
    scene.settle(f"bool(abs(targets.positions[2] - {[x, y - 0.005, z]}).max() < 1e-4)", True)
    page.keyboard.press("Escape")
    scene.settle(f"bool(abs(targets.positions[2] - {[x, y, z]}).max() < 1e-4)", True)
    page.keyboard.press("Shift+Tab")
    page.wait_for_selector(f"{SAID} >> text=foot.r chosen", timeout=READY)
    for _ in range(3):
        page.keyboard.press("Tab")  # hand.r, hand.l, and out of the picture
    page.wait_for_function("!document.activeElement.matches('.ikteach-stage')", timeout=READY)
    scene.settle("targets.handles.chosen", -1)


def test_keys_turn_the_camera_when_no_target_is_chosen(scene: Notebook) -> None:
    scene.page.locator(".ikteach-stage").focus()
    angle = scene.kernel("scene.cameras.angles[0]")
    scene.page.keyboard.press("ArrowRight")
    scene.settle(f"bool(abs(scene.cameras.angles[0] - {angle} - 5.73) < 0.1)", True)
    scene.kernel("None", "scene.look_from('three-quarter')")


def test_sliders_boxes_and_handles_agree(scene: Notebook) -> None:
    page = scene.page
    box = page.get_by_label("hand.l y", exact=True)
    slider = page.get_by_label("hand.l y slider", exact=True)
    slider.focus()
    page.keyboard.press("End")
    high = scene.kernel(f"targets.high[{HAND}][1]")
    scene.settle(f"targets.positions[{HAND}, 1]", high)
    page.wait_for_function("([box, high]) => +box.value === high",
                           arg=[box.element_handle(), round(high, 2)], timeout=READY)  # fmt: skip
    box.fill("0.25")
    box.press("Enter")
    scene.settle(f"targets.positions[{HAND}, 1]", 0.25)
    page.wait_for_function("slider => slider.valueAsNumber === 0.25 || slider.value === '0.25'",
                           arg=slider.element_handle(), timeout=READY)  # fmt: skip
    x, y = where(scene, HAND)  # the handle is where the number says
    drag(scene, x, y, 30, 0)
    page.mouse.up()
    scene.settle(f"bool(targets.positions[{HAND}, 0] == 0.8)", False)
    now = scene.kernel(position(HAND))
    page.wait_for_function("([box, y]) => Math.abs(+box.value - y) < 0.006",
                           arg=[box.element_handle(), now[1]], timeout=READY)  # fmt: skip


def test_a_number_outside_its_range_is_refused_with_the_range(scene: Notebook) -> None:
    box = scene.page.get_by_label("hand.r y", exact=True)
    was = scene.kernel("targets.positions.tolist()")
    shows = box.input_value()
    box.fill("9")
    box.press("Enter")
    alert = scene.page.locator(".ikteach-alert[role=alert]")
    scene.page.wait_for_selector(".ikteach-alert >> text=Nothing was changed", timeout=READY)
    assert "goes from -1.70 to 1.30 m; 9 is not" in alert.inner_text()
    assert scene.kernel("targets.positions.tolist()") == was
    scene.page.wait_for_function("([box, text]) => box.value === text",
                                 arg=[box.element_handle(), shows], timeout=READY)  # fmt: skip
    scene.shot("scene_refused")
    scene.page.get_by_role("button", name="Undo").click()
    scene.settle(f"targets.positions.tolist() != {was}", True)
    assert alert.inner_text() == ""


def test_sides_projection_and_dark(scene: Notebook) -> None:
    plain = picture(scene, "scene_three_quarter")
    for side in ("front", "side", "top"):
        scene.kernel("None", f"scene.look_from({side!r})")
        scene.page.wait_for_timeout(150)
        assert differ(plain, picture(scene, f"scene_{side}")) > 0.05, side
    scene.kernel("None", "scene.look_from('three-quarter')\nscene.cameras.orthographic = True")
    scene.page.wait_for_timeout(150)
    parallel = picture(scene, "scene_parallel")
    assert 0.01 < differ(plain, parallel) < 0.5
    shown(scene, "scene.cameras.orthographic = False\nscene.dark = True\nfollow()")
    scene.page.wait_for_timeout(150)
    dark = picture(scene, "scene_dark")
    assert np.median(dark) < 40 < 200 < np.median(plain)


def test_four_figures_in_one_picture(scene: Notebook) -> None:
    scene.run_cell("four = Scene")
    scene.page.wait_for_selector(f"{DRIVER}[data-frame]", timeout=READY)
    assert scene.page.locator(CANVAS).count() == 1
    seen = picture(scene, "scene_four")
    length = np.linalg.norm(seen, axis=-1)
    for colour in ([0, 114, 178], [230, 159, 0], [213, 94, 0], [0, 158, 115]):
        hue = np.array(colour) / np.linalg.norm(colour)
        alike = (seen @ hue > 0.985 * length) & (length > 60)
        assert alike.mean() > 0.002, f"no figure in {colour}"


def test_a_planar_arm_is_dragged_in_its_plane(scene: Notebook) -> None:
    scene.run_cell("arm = figures")
    scene.page.wait_for_selector(f"{DRIVER}[data-frame]", timeout=READY)
    scene.page.wait_for_selector(".ikteach-stage", timeout=READY)
    assert np.median(picture(scene, "scene_arm")) < 40
    x, y = where(scene, 0, "plane", "goal.positions")
    drag(scene, x, y, -80, 20)
    scene.page.mouse.up()
    scene.settle("bool(goal.positions[0, 0] < 1.2)", True)
    assert scene.kernel("goal.positions[0, 2]") == 0
    scene.shot("scene_arm_dragged", CANVAS)


def test_the_output_holds_a_picture_for_places_without_a_kernel(scene: Notebook) -> None:
    bundle = "plane._repr_mimebundle_()"
    assert scene.kernel(f"sorted({bundle})") == [
        "application/vnd.jupyter.widget-view+json", "image/png", "text/html", "text/plain",
    ]  # fmt: skip
    png = bytes(scene.kernel(f"list({bundle}['image/png'])"))
    assert Image.open(io.BytesIO(png)).size == (540, 480)


def test_a_direction_is_turned_by_mouse_keys_and_numbers(scene: Notebook) -> None:
    page = scene.page
    scene.run_cell("seven = Scene")
    page.wait_for_selector(f"{DRIVER}[data-frame]", timeout=READY)
    page.wait_for_selector(".ikteach-stage", timeout=READY)
    scene.settle("seven.driver.drawn >= 0 or seven.driver.seen", True)
    was = np.array(scene.kernel("aim.positions.tolist()"))
    x, y = where(scene, 1, "seven", "tips")
    drag(scene, x, y, 50, -25)
    page.mouse.up()
    scene.settle(f"bool(abs(aim.positions[1] - {was[1].tolist()}).max() > 0.02)", True)
    sent = scene.kernel("seven.driver.sent")
    page.wait_for_function(f"{FRAME} >= {sent}", timeout=READY)
    turned = np.array(scene.kernel("aim.positions.tolist()"))
    assert np.linalg.norm(turned[1]) == pytest.approx(0.3)
    np.testing.assert_array_equal(turned[[0, 2]], was[[0, 2]])
    page.wait_for_selector(f"{SAID} >> text=grip.up: points to x", timeout=READY)
    scene.shot("scene_directions", CANVAS)
    page.keyboard.press("ArrowUp")
    scene.settle(f"aim.positions[1].tolist() != {turned[1].tolist()}", True)
    assert scene.kernel("float(np.linalg.norm(aim.positions[1]))") == pytest.approx(0.3)
    page.keyboard.press("Escape")
    scene.settle(f"bool(abs(aim.positions[1] - {turned[1].tolist()}).max() < 1e-6)", True)
    box = page.get_by_label("grip.ahead z", exact=True)
    box.fill("-0.18")
    box.press("Enter")
    scene.settle("round(float(aim.positions[2, 2]), 6)", -0.18)
    assert scene.kernel("float(np.linalg.norm(aim.positions[2, :2]))") == pytest.approx(0.24)
    box.fill("0.4")
    box.press("Enter")
    page.wait_for_selector(".ikteach-alert >> text=goes from -0.30 to 0.30 m", timeout=READY)
    scene.shot("scene_directions_page")
