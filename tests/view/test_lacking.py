"""What is told where a live figure cannot be shown, and the pictures that stand for it."""

import asyncio
import base64
import io
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from ikteach import figures
from ikteach.view import GaitPlayer, Poser, Scene
from ikteach.view.chapters.pseudoinverse import CapPlayer
from ikteach.view.chapters.transpose import slope_bench
from ikteach.view.webgl.driver import Driver
from ikteach.view.widgets.lacking import LACKING, PYTHREEJS, WIDGETS

TEACHING = Path(__file__).parents[2] / "TEACHING.md"


def shown(scene: Scene) -> Scene:
    """The scene, with something in it."""
    scene.show(scene.tree.rest, np.zeros((1, 3)))
    return scene


MAKERS: list[Callable[[], Any]] = [
    lambda: shown(Scene(*figures.planar_arm(3))), lambda: Poser(figures.planar_arm(3)), slope_bench,
    GaitPlayer, CapPlayer,
]  # fmt: skip


@pytest.mark.parametrize("make", MAKERS, ids=["scene", "poser", "bench", "player", "caps"])
def test_what_a_cell_gives_has_picture_and_reason_for_every_front_end(make: Any) -> None:
    figure = make()
    bundle = figure._repr_mimebundle_()
    html = bundle["text/html"]
    assert type(html) is str  # what else is a str, marimo takes for an object
    assert WIDGETS in html
    assert f"data:image/png;base64,{base64.b64encode(bundle['image/png']).decode()}" in html
    assert len(bundle["image/png"]) > 1000
    assert bundle["text/plain"]
    holder = getattr(figure, "player", figure)
    note = getattr(holder, "note", None) or holder.scene.note
    assert html in note.widget.value
    figure.close()


def test_a_scene_that_shows_nothing_yet_has_no_broken_picture() -> None:
    scene = Scene(*figures.planar_arm(3))
    bundle = scene._repr_mimebundle_()
    assert "image/png" not in bundle
    assert "<img" not in bundle["text/html"]
    scene.close()


def test_the_reason_names_what_mends_it_and_teaching_has_it() -> None:
    assert f"pip install {PYTHREEJS}" in LACKING["pythreejs"]
    assert f"pip install ipywidgets anywidget {PYTHREEJS}" in WIDGETS
    table = TEACHING.read_text(encoding="utf-8").partition("## If something is wrong")[2]
    for words in (
        "The figure cannot be shown in 3-D", "the server of this page lacks pythreejs",
        "no WebGL", "This is a still picture",
    ):  # fmt: skip
        assert words in table
        assert words in " ".join((*LACKING.values(), WIDGETS))


def test_a_page_is_given_a_picture_of_the_newest_pose_from_where_the_camera_is() -> None:
    scene = Scene(*figures.human())
    theta, targets = scene.tree.rest, np.zeros((4, 3))
    scene.show(theta, targets, change=3)
    heard = sent_by(scene.driver)
    scene.driver._hear(scene.driver, {"picture": True}, [])
    scene.look_from("side")
    scene.driver._hear(scene.driver, {"picture": True}, [])
    (said, png), (again, other) = heard
    assert said == again == {"picture": scene.driver.sent, "change": 3}
    assert Image.open(io.BytesIO(png)).size == (540, 480)
    assert png != other
    scene.close()


def test_however_many_ask_one_picture_is_drawn_and_what_fails_is_told() -> None:
    async def ask() -> list[Any]:
        scene = Scene(*figures.planar_arm(3))
        heard = sent_by(scene.driver)
        for _ in range(9):
            scene.driver._hear(scene.driver, {"picture": True}, [])
        await asyncio.sleep(0)
        scene.driver.as_png = lambda: 1 / 0  # type: ignore[assignment, return-value]
        scene.driver._hear(scene.driver, {"picture": True}, [])
        await asyncio.sleep(0)
        scene.close()
        return heard

    (first, _), (second, _) = asyncio.run(ask())
    assert "picture" in first
    assert second == {"wrong": "That did not work: division by zero"}


def sent_by(driver: Driver) -> list[Any]:
    """What the driver sends from now on, with the first buffer."""
    heard: list[Any] = []
    driver.send = lambda content, buffers=(b"",): heard.append((content, buffers[0]))  # type: ignore[method-assign]
    return heard
