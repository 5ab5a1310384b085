"""The pythreejs objects that a scene is made of."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import pythreejs as three

from ikteach.arrays import Array, ArrayLike
from ikteach.body.rotation import quaternion_from_y
from ikteach.view.skin import GREY, Ball, Limb, Part
from ikteach.view.stage import SQUARE

# Where what is not to be seen is: far outside the picture, and tiny. Not of size 0, because
# three.js complains in every frame of a matrix that has no inverse.
HIDDEN: Array = np.c_[1e-6 * np.eye(3), [0, -1e4, 0]]
Children = Sequence[three.Object3D]


def node(children: Children = ()) -> three.Group:
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


def solid(part: Part, opacity: float = 1.0) -> list[three.Mesh]:
    """The meshes of one part of a body."""
    material = three.MeshLambertMaterial(color=part.colour, **_see_through(opacity))
    if isinstance(part, Ball):
        ball = three.SphereBufferGeometry(1, 20, 14)
        return [three.Mesh(ball, material, position=list(part.centre), scale=list(part.radii))]
    return _limb(part, material)


def _limb(part: Limb, material: three.Material) -> list[three.Mesh]:
    start, end = np.asarray(part.start, dtype=float), np.asarray(part.end, dtype=float)
    rod = three.CylinderBufferGeometry(
        part.thin, part.thick, float(np.linalg.norm(end - start)), 16, 1, True
    )
    middle = three.Mesh(
        rod, material,
        position=((start + end) / 2).tolist(), quaternion=quaternion_from_y(end - start),
    )  # fmt: skip
    tips = [
        three.Mesh(three.SphereBufferGeometry(radius, 16, 12), material, position=at.tolist())
        for at, radius in ((start, part.thick), (end, part.thin))
    ]
    return [middle, *tips]


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


def rod(direction: ArrayLike, length: float, radius: float, colour: str) -> three.Mesh:
    """A rod through the origin, half its length to either side."""
    return three.Mesh(
        three.CylinderBufferGeometry(radius, radius, length, 8),
        three.MeshBasicMaterial(color=colour),
        quaternion=quaternion_from_y(direction),
    )


def arrow(radius: float, colour: str) -> list[three.Mesh]:
    """An arrow one metre along y, to be stretched to its length."""
    material = three.MeshLambertMaterial(color=colour)
    shaft = three.CylinderBufferGeometry(radius, radius, 0.78, 8)
    head = three.CylinderBufferGeometry(0, 2.4 * radius, 0.22, 12)
    return [
        three.Mesh(shaft, material, position=(0, 0.39, 0)),
        three.Mesh(head, material, position=(0, 0.89, 0)),
    ]


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
