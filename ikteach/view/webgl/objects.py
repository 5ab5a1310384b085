"""The pythreejs objects that a scene is made of."""

from collections.abc import Sequence
from functools import cache

import numpy as np
import pythreejs as three

from ikteach.markup import brief
from ikteach.view.stage.colours import paper
from ikteach.view.stage.forms import Arrow, Ball, Box, Form, Grid, Label, Mesh
from ikteach.view.webgl.surfaces import surface

THROUGH = 5  # in the order of drawing, of what is seen through all else


def node(children: Sequence[three.Object3D] = ()) -> three.Group:
    """Make an object that the driver moves.

    Its matrix is given, not made from position.
    """
    return three.Group(children=list(children), matrixAutoUpdate=False)


def lights() -> list[three.Light]:
    """Make light from all around, and some from above."""
    # A light's target and shadow are given here because pythreejs would else make them in the page
    # and choke on their echo from the kernel ("Error setting state: t.on is not a function").
    shadow = three.DirectionalLightShadow(camera=three.OrthographicCamera(-1, 1, 1, -1))
    return [
        three.AmbientLight(color="#ffffff", intensity=0.55),
        three.DirectionalLight(
            color="#ffffff",
            intensity=0.6,
            position=[2, 4, 3],
            target=three.Object3D(),
            shadow=shadow,
        ),
    ]


def floor_grid(form: Grid, dark: bool) -> three.GridHelper:
    """Make the squares of the floor."""
    looks = paper(dark)
    return three.GridHelper(form.side, form.squares, looks.middle, looks.line)


def marks(mesh: Mesh) -> list[three.Mesh]:
    """Make an object per ball, box or arrow of a mesh.

    Marks of one shape share it, and marks of one colour share how they look.
    """
    shape = cache(_geometry)

    @cache
    def look(colour: str, shaded: bool) -> three.Material:
        kind = three.MeshLambertMaterial if shaded else three.MeshBasicMaterial
        return kind(
            color=colour, transparent=True, opacity=mesh.opacity, depthTest=not mesh.through
        )

    return [
        three.Mesh(
            shape(piece.form),
            look(piece.colour, not isinstance(piece.form, Arrow)),
            matrixAutoUpdate=False,
            renderOrder=THROUGH if mesh.through else 0,
        )
        for piece in mesh.pieces
    ]


def _geometry(form: Form) -> three.BufferGeometry:
    if isinstance(form, Box):
        return three.BoxBufferGeometry(*[2 * form.half] * 3)
    if isinstance(form, Ball):
        return three.SphereBufferGeometry(form.radii[0], 16, 12)
    if isinstance(form, Arrow):
        points, joined, _ = surface(form, (0, 0))
        return three.BufferGeometry(
            attributes={
                "position": three.BufferAttribute(points.astype(np.float32), normalized=False)
            },
            index=three.BufferAttribute(joined.astype(np.uint32).ravel(), normalized=False),
        )
    raise TypeError(f"nobody can take hold of {form}")


def labels(labels: Sequence[Label]) -> list[three.Sprite]:
    """Make words that always face the camera.

    The same words share how they look.
    """

    @cache
    def look(text: str, colour: str) -> three.SpriteMaterial:
        words = three.TextTexture(string=text, color=colour, size=64)  # as wide as it is high
        # Words are seen through a body that stands before them.
        return three.SpriteMaterial(map=words, transparent=True, depthTest=False, depthWrite=False)

    sprites = []
    for at, text, colour, height in labels:
        short = brief(text)
        width = height * max(0.55 * len(short), 1)
        place = tuple(np.asarray(at, dtype=float))
        sprites.append(three.Sprite(look(short, colour), position=place, scale=(width, width, 1)))
    return sprites
