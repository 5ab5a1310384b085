"""Chapter 9 as a person has it: nine panels whose controls act, in the session and in pixels."""

import re
import time
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from tests.browser.conftest import CANVAS, DRIVER, READY, Notebook, pixels

HEADER = ".jupyter-widget-Collapse-header"
LOOPS = (
    "sum('Live._run' in task.get_coro().__qualname__ "
    "for task in __import__('asyncio').all_tasks(bench._act.loop) if not task.done())"
)

IN_WORDS = "__import__('ikteach.motion.live.settings', fromlist=['x']).in_words"


@pytest.fixture(scope="module")
def bench(open_notebook: Any) -> Iterator[Notebook]:
    notebook = open_notebook("09_workbench.ipynb")
    notebook.run_figure("bench = Workbench()")
    yield notebook
    assert notebook.errors == []


def open_panel(bench: Notebook, title: str) -> None:
    header = bench.page.locator(HEADER).get_by_text(title, exact=True).first
    box = header.locator("xpath=ancestor::*[contains(@class,'jupyter-widget-Collapse')][1]/..")
    if "jupyter-widget-Collapse-open" not in (box.get_attribute("class") or ""):
        header.click()


def picture(bench: Notebook, name: str) -> np.ndarray:
    frames_settled(bench)
    return pixels(bench.shot(f"09_{name}", CANVAS))


def frames_settled(bench: Notebook) -> None:
    """Wait until what was sent has been drawn, and the browser has painted it."""
    bench.page.evaluate(
        "new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))"
    )
    time.sleep(0.3)


def changed(before: np.ndarray, after: np.ndarray) -> float:
    """The share of pixels that are not what they were."""
    if before.shape != after.shape:
        return 1.0
    return (abs(before - after).max(axis=-1) > 12).mean()


def control(name: str) -> str:
    return f"next(p.controls[{name!r}] for p in bench.panels.values() if {name!r} in p.controls)"


def slide(bench: Notebook, label: str, key: str = "End") -> None:
    handle = bench.page.locator(".widget-slider", has_text=label).locator(".noUi-handle").first
    handle.focus()
    bench.page.keyboard.press(key)


def choose(bench: Notebook, label: str, option: str) -> None:
    bench.page.get_by_label(label, exact=True).first.select_option(option)


def tick(bench: Notebook, label: str) -> None:
    bench.page.locator(".widget-checkbox", has_text=label).locator("input").first.click()


def still(bench: Notebook) -> None:
    """Pause, so that what changes in the picture is what the test does."""
    if bench.kernel("bench.playing"):
        bench.press("Pause")
        bench.settle("bench._task.done()", True)


def test_to_open_it_and_all_its_panels_logs_nothing(bench: Notebook) -> None:
    """Also where a slider's value is between two of its steps, as γ_max = π/4 is."""
    bench.frames(5)
    for title in ("Options of the methods", "Around the solver", "Speed", "Target position"):
        open_panel(bench, "Method" if "the" in title else title)
        open_panel(bench, title)
    frames_settled(bench)
    bench.shot("09_panels")
    assert bench.kernel("[str(event) for event in bench.session.events]") == []
    open_panel(bench, "Method")


def test_a_held_key_is_one_move_and_one_undo(bench: Notebook) -> None:
    still(bench)
    targets = "bench.session.targets.round(6).tolist()"
    before = bench.kernel(targets)
    bench.page.locator(".ikteach-stage").first.focus()
    bench.page.keyboard.press("Tab")
    for _ in range(8):  # the later ones are repeats
        bench.page.keyboard.down("ArrowUp")
        time.sleep(0.1)
    bench.page.keyboard.up("ArrowUp")
    bench.settle(f"{targets}[0][1] > {before[0][1]} + 0.1", True)
    frames_settled(bench)
    kinds = "[event.kind for event in bench.session.events if event.kind != 'pause']"
    assert bench.kernel(kinds) == ["target"]
    bench.page.keyboard.press("Escape")
    bench.settle(targets, before)
    bench.settle("bench.session.by_hand", False)
    bench.press("Play")
    bench.settle("bench.playing", True)


def test_method(bench: Notebook) -> None:
    bench.frames(10)
    open_panel(bench, "Method")
    for method in ("transpose", "pseudoinverse", "sdls", "mix", "dls"):
        bench.press(method)
        bench.settle("bench.session.method", method)
        bench.frames(2)
    open_panel(bench, "Options of the methods")
    methods = f"{IN_WORDS}(bench.session.methods)"

    def option(method: str, name: str) -> str:  # None until the slide has come to the kernel
        return f"getattr({methods}[{method!r}], 'get', {{}}.get)({name!r})"

    slide(bench, "dls: damping")
    bench.settle(f"round({option('dls', 'damping')} or 0, 3)", 1.0)
    slide(bench, "transpose: gain")
    bench.settle(option("transpose", "gain"), 2.0)
    slide(bench, "pseudoinverse: cutoff")
    bench.settle(option("pseudoinverse", "cutoff"), 0.5)
    slide(bench, "sdls: γ_max", "Home")
    bench.settle(f"round({option('sdls', 'max_angle')} or 0, 4)", 0.0524)
    bench.press("soft")
    bench.settle(f"{methods}['sdls']['clamp']", "soft")
    open_panel(bench, "Mix: a method per effector")
    choose(bench, "hand.l", "transpose")
    bench.settle(f"{methods}['mix']['hand.l']", "transpose")
    open_panel(bench, "Around the solver")
    bench.press("equal")
    bench.settle("round(bench.session.caps['dls'], 4)", 0.1745)
    slide(bench, "equal cap")
    bench.settle("round(bench.session.caps['dls'], 4)", 1.5708)
    bench.press("each author's own")
    bench.settle(
        "[round(bench.session.caps['dls'], 4), bench.session.caps['sdls']]", [0.7854, None]
    )
    options = f"{IN_WORDS}(bench.session.options)"
    bench.press("per_chain")
    bench.settle(f"{options}['cap']", "per_chain")
    bench.press("clip")
    bench.settle(f"{options}['limits']", "clip")
    tick(bench, "clamp errors")
    bench.settle(f"round({options}['max_error'], 3)", 0.4)
    slide(bench, "error clamp")
    bench.settle(f"{options}['max_error']", 1.0)
    assert bench.kernel("bench.status.wrong") == ""


def test_motion_and_motion_control(bench: Notebook) -> None:
    still(bench)
    before = picture(bench, "walking")
    open_panel(bench, "Motion")
    bench.press("running")
    bench.settle("bench.session.gait.name", "running")
    bench.press("Step")
    bench.settle("bench._task.done()", True)
    assert changed(before, picture(bench, "running")) > 0.01
    bench.press("walking")
    bench.settle("bench.session.gait.name", "walking")
    open_panel(bench, "Motion control")
    tick(bench, "moving forward")
    bench.settle("bench.session.gait.forward", True)
    tick(bench, "wounded")
    bench.settle("sorted(bench.session.gait.wound)", ["ankle.r", "hip.bend.r", "knee.r"])
    choose(bench, "Joint", "elbow.l")
    bench.settle(f"{control('mobility')}.value", 1.0)
    slide(bench, "mobility", "Home")
    bench.settle("bench.session.gait.wound.get('elbow.l')", 0.0)
    before = picture(bench, "drawn_before")
    slide(bench, "drawn + [°]", "End")
    bench.settle("float(bench.wounds.plus.max().round(4))", 1.0472)
    slide(bench, "drawn ×", "Home")
    bench.settle("float(bench.wounds.times.min())", 0.0)
    assert changed(before, picture(bench, "drawn_after")) > 0.005
    bench.press("Heal all")
    bench.settle("[bench.session.gait.wound, float(bench.wounds.plus.max())]", [{}, 0.0])


def test_view(bench: Notebook) -> None:
    still(bench)
    open_panel(bench, "View")
    before = picture(bench, "view")
    choose(bench, "View", "side")
    bench.settle("list(bench.scene.cameras.current.position)[0] > 2", True)
    assert changed(before, picture(bench, "view_side")) > 0.03
    bench.press("orthographic")
    bench.settle("bench.scene.cameras.orthographic", True)
    parallel = picture(bench, "view_parallel")
    bench.press("perspective")
    choose(bench, "View", "three-quarter")
    choose(bench, "J and ellipsoid of", "hand.l")
    bench.settle("bench.view.values['effector']", "hand.l")
    assert changed(before, parallel) > 0.03
    layers = bench.kernel("[name for name in bench.scene.layers]")
    layers.remove("recorded skeleton")  # of a motion that is none; test_workbench.py of chapters
    for layer in [*layers, "targets"]:
        was = picture(bench, "layer_before")
        tick(bench, layer)
        if layer in ("footprints", "trails"):
            for _ in range(4):
                bench.press("Step")
            bench.settle("bench._task.done()", True)
        else:
            time.sleep(0.3)
        assert changed(was, picture(bench, f"layer_{layer.replace(' ', '_')}")) > 0.0005, layer
        tick(bench, layer)
        bench.settle("any(bench.scene.layers.values())", False)
    tick(bench, "dark")
    bench.settle("bench.scene.dark", True)
    assert picture(bench, "dark")[2, 2].max() < 60
    tick(bench, "dark")
    bench.settle("bench.scene.dark", False)


def test_object(bench: Notebook) -> None:
    still(bench)
    open_panel(bench, "Object")
    at = "[round(x, 2) for x in bench.scene.cameras.current.position]"
    for label in ("turn [°]", "tilt [°]", "zoom", "move right", "move up"):
        was, before = bench.kernel(at), picture(bench, "object")
        slide(bench, label, "End")
        bench.settle(f"{at} != {was}", True)
        assert changed(before, picture(bench, "object_moved")) > 0.005, label
    bench.press("As it was")
    bench.settle(f"{control('zoom')}.value", 1.0)
    ball = bench.page.locator(".ikteach-ball").first
    ball.focus()
    was = bench.kernel(at)
    bench.page.keyboard.press("ArrowLeft")
    bench.settle(f"{at} != {was}", True)
    was, box = bench.kernel(at), ball.bounding_box()
    assert box
    bench.page.mouse.move(box["x"] + 60, box["y"] + 60)
    bench.page.mouse.down()
    bench.page.mouse.move(box["x"] + 90, box["y"] + 70, steps=4)
    bench.page.mouse.up()
    bench.settle(f"{at} != {was}", True)
    bench.press("As it was")


def test_speed_and_target_position(bench: Notebook) -> None:
    for title, rows in {
        "Speed": {
            "speed ω": ("speed", 20.0), "step frequency": ("step_frequency", 3.0),
            "slowdown": ("slowdown", 10),
        },
        "Target position": {
            "left foot z swing": ("back_z_leg", 0.8), "right foot z swing": ("front_z_leg", 0.8),
            "left foot y": ("back_y_leg", -0.4), "right foot y": ("front_y_leg", -0.4),
            "hands z swing": ("hand_z", 1.2), "right hand y": ("back_y_hand", 1.0),
            "left hand y": ("front_y_hand", 1.0),
        },
    }.items():  # fmt: skip
        open_panel(bench, title)
        for label, (parameter, end) in rows.items():
            slide(bench, label)
            bench.settle(f"bench.session.gait.{parameter}", end)
    open_panel(bench, "Motion")
    bench.press("running")
    bench.settle("bench.session.gait.speed", 9.0)
    bench.press("walking")
    bench.settle("[bench.session.gait.slowdown, bench.session.gait.speed]", [1, 5.6])


def test_a_target_is_dragged_and_the_table_says_so(bench: Notebook) -> None:
    still(bench)
    bench.press("Reset")
    open_panel(bench, "Target position")
    bench.settle("bench.session.ticks", 0)
    box = bench.page.locator("input[type=number][aria-label='hand.l y']")
    box.fill("0.4")
    box.press("Enter")
    bench.settle("[bench.session.by_hand, bench.session.targets[3].tolist()[1]]", [True, 0.4])
    box.fill("99")
    box.press("Enter")
    alert = bench.page.locator(".ikteach-alert[role=alert]:not(:empty)")
    alert.wait_for(timeout=READY)
    assert "goes from" in alert.inner_text()
    assert bench.kernel("bench.session.targets[3].tolist()[1]") == 0.4
    bench.press("Play")
    bench.frames(20)
    near = bench.kernel("float(bench.session.error[3])")
    assert near < 0.3
    bench.page.locator(".ikteach-stage").first.focus()
    for _ in range(4):
        bench.page.keyboard.press("Tab")
    before = bench.kernel("bench.session.targets.tolist()")
    bench.page.keyboard.press("ArrowDown")
    bench.settle(f"bench.session.targets.tolist() != {before}", True)
    bench.page.keyboard.press("Escape")
    bench.settle(f"bench.session.targets.tolist() == {before}", True)
    bench.page.wait_for_function(
        "document.querySelector('.ikteach-driver').textContent.includes('by hand')", timeout=READY
    )
    bench.press("Undo")
    assert bench.kernel("bench.status.wrong") == ""


def test_look_back_and_back_to_now(bench: Notebook) -> None:
    bench.frames(10)
    bench.press("Look back")
    bench.settle("bench.replay is not None and not bench.playing", True)
    name = re.compile(r"^\s*Tick(?!s)")
    bench.page.locator(".widget-slider", has_text=name).locator(".noUi-handle").focus()
    before = picture(bench, "replay_start")
    bench.page.keyboard.press("End")
    bench.settle("bench.replay.at == len(bench.replay.run) - 1", True)
    assert changed(before, picture(bench, "replay_end")) > 0.002
    bench.press("Back to now")
    bench.settle("bench.replay is None", True)


def test_figures_of_all_methods(bench: Notebook) -> None:
    open_panel(bench, "View")
    for figures in ("all, overlaid", "all, side by side", "one and a ghost", "one figure"):
        choose(bench, "Figures", figures)
        bench.settle("bench.figures", figures)
        bench.page.wait_for_selector(f"{DRIVER}[data-frame]", timeout=READY)
        bench.settle("bench.scene.driver.seen", True)
        frames_settled(bench)
        bench.shot(f"09_{figures.split(',')[-1].strip().replace(' ', '_')}", ".ikteach-scene")
    assert bench.kernel("bench.status.wrong") == ""


def test_an_error_is_told_once_and_the_session_goes_on(bench: Notebook) -> None:
    bench.kernel("None", "bench.session.methods['sdls'] = lambda J, e: J[0] * float('nan')")
    bench.press("Play") if not bench.kernel("bench.playing") else None
    alert = bench.page.locator(".ikteach-status [role=alert]:not(:empty)").first
    alert.wait_for(timeout=READY)
    assert "not finite" in alert.inner_text()
    bench.kernel("None", "from ikteach import sdls\nbench.session.use('sdls', sdls)")
    bench.press("Play")
    bench.frames(5)
    bench.settle("bench.status.wrong", "")


def test_quit_stops_every_loop_and_says_so(bench: Notebook) -> None:
    bench.press("Quit")
    bench.settle(LOOPS, 0)
    said = bench.page.locator(".ikteach-status [role=status]", has_text="The workbench has ended")
    said.wait_for(timeout=READY)
    bench.shot("09_quit")
    assert bench.errors == []
    bench.run_cell("bench = Workbench()")
    bench.page.wait_for_selector(f"{DRIVER}[data-frame]", timeout=READY)
    bench.frames(5)
    assert bench.kernel(LOOPS) == 1
