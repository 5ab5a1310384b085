"""Many parts in one mesh, each of them where its row of the frame says.

What is slow to draw is not triangles but meshes, for each is a call of its own; and each mesh is a
handful of models that must be made, sent and freed. So a figure is one mesh, and so is a layer:
the driver moves the points of its parts.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import pythreejs as three
from matplotlib.colors import to_rgb

from ikteach.view.stage.shapes import Shape

Runs = list[list[int]]  # [row, points], for all points of a mesh


class Piece(NamedTuple):
    """A shape in one colour, in the frame of what moves it: a row of the frame."""

    row: int
    shape: Shape
    colour: str


def fused(
    pieces: Sequence[Piece], *, opacity: float = 1.0, **looks: object
) -> tuple[three.Object3D, Runs]:
    """One object of all these pieces, and which row moves how many of its points.

    Shaded where the shapes have normals, lines where they are wires; `looks` go to the material.
    """
    shapes = [piece.shape for piece in pieces]
    firsts = np.cumsum([0, *(len(shape.points) for shape in shapes)])
    joined = np.concatenate(
        [shape.joined + first for shape, first in zip(shapes, firsts[:-1], strict=True)]
    )
    points = np.concatenate([shape.points for shape in shapes])
    colours = [to_rgb(piece.colour) for piece in pieces]
    arrays = {"position": points, "color": np.repeat(colours, np.diff(firsts), axis=0)}
    normals = [shape.normals for shape in shapes if shape.normals is not None]
    if normals:
        arrays["normal"] = np.concatenate(normals)
    shape = three.BufferGeometry(
        attributes={
            name: three.BufferAttribute(array.astype(np.float32), normalized=False)
            for name, array in arrays.items()
        },
        index=three.BufferAttribute(joined.astype(np.uint32).ravel(), normalized=False),
    )
    if opacity < 1:
        looks = {"transparent": True, "opacity": opacity, **looks}
    wires = joined.shape[1] == 2
    shaded = three.MeshLambertMaterial if normals else three.MeshBasicMaterial
    material = (three.LineBasicMaterial if wires else shaded)(vertexColors="VertexColors", **looks)
    kind = three.LineSegments if wires else three.Mesh
    # It is not seen before the first frame has put its parts in place. Nor is it to be left out
    # when it seems to be out of the picture: three.js would look where its points were at first.
    thing = kind(shape, material, frustumCulled=False, visible=False)
    return thing, _runs([piece.row for piece in pieces], np.diff(firsts).tolist())


def _runs(rows: Sequence[int], counts: Sequence[int]) -> Runs:
    """The runs of the pieces, those that follow each other on the same row put together."""
    runs: Runs = []
    for row, count in zip(rows, counts, strict=True):
        if runs and runs[-1][0] == row:
            runs[-1][1] += count
        else:
            runs.append([row, count])
    return runs


def shifted(runs: Runs, by: int) -> Runs:
    """The same, so many rows later."""
    return [[row + by, points] for row, points in runs]
