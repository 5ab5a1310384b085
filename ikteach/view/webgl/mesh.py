"""Many forms in one mesh, each of them where its row of the frame says.

What is slow to draw is not triangles but meshes, for each is a call of its own; and each mesh is a
handful of models that must be made, sent and freed. So a figure is one mesh, and so is a layer:
the driver moves the points of its parts.
"""

from collections.abc import Sequence

import numpy as np
import pythreejs as three

from ikteach.view.stage.colours import rgb
from ikteach.view.stage.forms import STATIC, Mesh
from ikteach.view.webgl.objects import THROUGH
from ikteach.view.webgl.surfaces import surface

Runs = list[list[int]]  # [row, points], for all points of a mesh


def fused(mesh: Mesh) -> tuple[three.Object3D, Runs]:
    """Make one object of a mesh, and its runs.

    A run [row, points] says which row moves how many of its points. It is shaded where its surfaces
    have normals, lines where they are wires.
    """
    surfaces = [surface(piece.form, mesh.cut) for piece in mesh.pieces]
    firsts = np.cumsum([0, *(len(shape.points) for shape in surfaces)])
    joined = np.concatenate(
        [shape.joined + first for shape, first in zip(surfaces, firsts[:-1], strict=True)]
    )
    colours = [rgb(piece.colour) / 255 for piece in mesh.pieces]
    arrays = {
        "position": np.concatenate([shape.points for shape in surfaces]),
        "color": np.repeat(colours, np.diff(firsts), axis=0),
    }
    normals = [shape.normals for shape in surfaces if shape.normals is not None]
    if normals:
        arrays["normal"] = np.concatenate(normals)
    geometry = three.BufferGeometry(
        attributes={
            name: three.BufferAttribute(array.astype(np.float32), normalized=False)
            for name, array in arrays.items()
        },
        index=three.BufferAttribute(joined.astype(np.uint32).ravel(), normalized=False),
    )
    wires = joined.shape[1] == 2
    rows = [piece.row for piece in mesh.pieces]
    # What moves is not seen before the first frame has put its parts in place. Nor is it to be left
    # out when it seems out of the picture: three.js would look where its points were at first.
    thing = (three.LineSegments if wires else three.Mesh)(
        geometry,
        _material(mesh, wires, bool(normals)),
        frustumCulled=False,
        visible=STATIC in rows,
        renderOrder=THROUGH if mesh.through else 0,
    )
    return thing, _runs(rows, np.diff(firsts).tolist())


def _material(mesh: Mesh, wires: bool, shaded: bool) -> three.Material:
    """Make how the mesh looks: of lines, shaded, or of one brightness."""
    looks: dict[str, object] = {"vertexColors": "VertexColors"}
    if mesh.through:
        looks |= {"transparent": True, "depthTest": False}  # drawn last
    if mesh.opacity < 1:
        looks |= {"transparent": True, "opacity": mesh.opacity, "depthWrite": mesh.hides}
    if wires:
        return three.LineBasicMaterial(**looks)
    return (three.MeshLambertMaterial if shaded else three.MeshBasicMaterial)(**looks)


def _runs(rows: Sequence[int], counts: Sequence[int]) -> Runs:
    """Put the runs of pieces together that follow each other on the same row."""
    runs: Runs = []
    for row, count in zip(rows, counts, strict=True):
        if runs and runs[-1][0] == row:
            runs[-1][1] += count
        else:
            runs.append([row, count])
    return runs


def shifted(runs: Runs, by: int) -> Runs:
    """Move the runs to later rows."""
    return [[row + by, points] for row, points in runs]
