"""A scene is as dark as its page, until somebody chooses."""

from ikteach.body.figures import planar_arm
from ikteach.view import Scene
from ikteach.view.stage.colours import DARK, LIGHT


def test_a_scene_follows_its_page_until_somebody_chooses() -> None:
    scene = Scene(*planar_arm(2), slot=None)
    assert scene.scene.background == LIGHT.back
    scene.driver.dark = True
    assert scene.scene.background == DARK.back
    scene.driver.dark = False
    assert scene.scene.background == LIGHT.back
    scene.dark = True
    scene.driver.dark = True
    scene.driver.dark = False
    assert scene.dark


def test_a_scene_made_dark_stays_dark() -> None:
    scene = Scene(*planar_arm(2), dark=True, slot=None)
    scene.driver.dark = True
    scene.driver.dark = False
    assert scene.scene.background == DARK.back
