"""The pythreejs objects that a scene is made of."""

from collections.abc import Sequence

import numpy as np
import pythreejs as three

from ikteach.arrays import ArrayLike
from ikteach.markup import brief
from ikteach.view.stage.skin import EFFECTOR_COLOURS
from ikteach.view.stage.stage import SQUARE


def node(children: Sequence[three.Object3D] = ()) -> three.Group:
    """Something that the driver moves: its matrix is given, not made from position and so on."""
    return three.Group(children=list(children), matrixAutoUpdate=False)


def lights() -> list[three.Light]:
    """Light from all around, and some from above."""
    # A light's target and shadow are given here because pythreejs would else make them in the page
    # and choke on their echo from the kernel ("Error setting state: t.on is not a function").
    shadow = three.DirectionalLightShadow(camera=three.OrthographicCamera(-1, 1, 1, -1))
    return [
        three.AmbientLight(color="#ffffff", intensity=0.55),
        three.DirectionalLight(
            color="#ffffff", intensity=0.6, position=[2, 4, 3],
            target=three.Object3D(), shadow=shadow,
        ),
    ]  # fmt: skip


def grid(unit: float, dark: bool) -> three.GridHelper:
    """The squares of the floor."""
    middle, lines = ("#5c6875", "#3a434d") if dark else ("#9aa5b1", "#cbd2d9")
    return three.GridHelper(6 * unit, round(6 / SQUARE), middle, lines)


def marks(names: Sequence[str], unit: float, sets: int) -> list[three.Mesh]:
    """Sets of targets, one for each name: a ball, or a box for what is on the right."""
    side = 1.56 * (radius := 0.045 * unit)
    box, ball = (
        three.BoxBufferGeometry(side, side, side),
        three.SphereBufferGeometry(radius, 16, 12),
    )
    looks = [
        three.MeshLambertMaterial(color=effector_colour(i), transparent=True, opacity=0.85)
        for i in range(len(names))
    ]
    return [
        three.Mesh(box if name.endswith(".r") else ball, look, matrixAutoUpdate=False)
        for _ in range(sets)
        for name, look in zip(names, looks, strict=True)
    ]


def labels(
    text: str, colour: str, height: float, places: Sequence[ArrayLike]
) -> list[three.Sprite]:
    """The same words at each of these places, which always face the camera."""
    text = brief(text)
    words = three.TextTexture(string=text, color=colour, size=64)  # on a square as wide as it
    look = three.SpriteMaterial(map=words, transparent=True, depthWrite=False)
    width = height * max(0.55 * len(text), 1)
    return [
        three.Sprite(look, position=tuple(np.asarray(at, dtype=float)), scale=(width, width, 1))
        for at in places
    ]


def effector_colour(i: int) -> str:
    """The colour of effector i and its target."""
    return EFFECTOR_COLOURS[i % len(EFFECTOR_COLOURS)]
