"""The pythreejs objects that a scene is made of."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import pythreejs as three

from ikteach.arrays import Array
from ikteach.view.skin import EFFECTOR_COLOURS, GREY
from ikteach.view.stage import SQUARE

# Where what is not to be seen is: far outside the picture, and tiny. Not of size 0, because
# three.js complains in every frame of a matrix that has no inverse.
HIDDEN: Array = np.c_[1e-6 * np.eye(3), [0, -1e4, 0]]
Children = Sequence[three.Object3D]


def node(children: Children = ()) -> three.Group:
    """Something that the driver moves: its matrix is given, not made from position and so on."""
    return three.Group(children=list(children), matrixAutoUpdate=False)


def moved(shape: three.BufferGeometry, material: three.Material) -> three.Mesh:
    """A mesh that the driver moves, without a group around it."""
    return three.Mesh(shape, material, matrixAutoUpdate=False)


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


def target(name: str, colour: str, unit: float) -> list[three.Mesh]:
    """A ball, or a box for what is on the right, so that colour is not the only sign."""
    material = three.MeshLambertMaterial(color=colour, **_see_through(0.85))
    return [three.Mesh(mark_shape(name, 0.045 * unit), material)]


def mark_shape(name: str, radius: float, round_as: tuple[int, int] = (16, 12)) -> three.Geometry:
    """A box for a name that ends with .r, else a ball."""
    side = 1.56 * radius
    if name.endswith(".r"):
        return three.BoxBufferGeometry(side, side, side)
    return three.SphereBufferGeometry(radius, *round_as)


def gap(unit: float) -> list[three.Mesh]:
    """The thin rod from an effector to its target, one metre along y."""
    material = three.MeshBasicMaterial(color=GREY)
    shape = three.CylinderBufferGeometry(0.006 * unit, 0.006 * unit, 1, 6)
    return [three.Mesh(shape, material, position=(0, 0.5, 0))]


def rod(length: float, radius: float) -> three.BufferGeometry:
    """A rod along y, half its length to either side of the origin."""
    return three.CylinderBufferGeometry(radius, radius, length, 8)


def arrow(radius: float) -> three.BufferGeometry:
    """An arrow one metre along y, to be stretched to its length."""
    outline = [(0, 0), (radius, 0), (radius, 0.78), (2.4 * radius, 0.78), (0, 1)]
    return three.LatheBufferGeometry([list(map(float, point)) for point in outline], 10)


def paints(kind: type[three.Material] = three.MeshBasicMaterial) -> list[three.Material]:
    """A material of each colour in `EFFECTOR_COLOURS`."""
    return [kind(color=colour) for colour in EFFECTOR_COLOURS]


def label(text: str, colour: str, height: float, at: Sequence[float]) -> three.Sprite:
    """Words that always face the camera."""
    words = three.TextTexture(string=text, color=colour, size=64)  # on a square as wide as it
    width = height * max(0.55 * len(text), 1)
    return three.Sprite(
        three.SpriteMaterial(map=words, transparent=True, depthWrite=False),
        position=list(at),
        scale=[width, width, 1],
    )


def _see_through(opacity: float) -> dict[str, Any]:
    return {} if opacity == 1 else {"transparent": True, "opacity": opacity}
