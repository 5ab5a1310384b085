"""A layer in the page: its pythreejs objects, and which rows of a frame move them."""

from collections.abc import Iterator

import pythreejs as three

from ikteach.view.stage.forms import STATIC, Grid, Mesh
from ikteach.view.stage.layer import Layer
from ikteach.view.webgl import objects
from ikteach.view.webgl.driver import Move
from ikteach.view.webgl.mesh import fused, shifted
from ikteach.view.widgets.closing import close_all


class LayerObjects:
    """A layer and its objects.

    moves   the objects that move, and by which rows, the layer's first being 0
    things  all its objects
    """

    def __init__(self, layer: Layer, dark: bool) -> None:
        self.layer = layer
        self.moves: list[Move] = []
        self.things: list[three.Object3D] = []
        self._grids: list[tuple[three.Group, Grid]] = []
        for mesh in layer.meshes:
            for thing, how in self._objects(mesh):
                self.things.append(thing)
                if how != STATIC:
                    self.moves.append((thing, how))
        self.things += objects.labels(layer.labels)
        self.paint(dark)

    def paint(self, dark: bool) -> None:
        """Draw the grids anew, in the colours of the paper."""
        for node, grid in self._grids:
            before, node.children = node.children, [objects.floor_grid(grid, dark)]
            close_all(*before)

    @property
    def by_row(self) -> list[three.Object3D]:
        """List what moves as a whole, by its rows."""
        rows = {how: thing for thing, how in self.moves if isinstance(how, int)}
        return [rows[row] for row in sorted(rows)]

    def moves_from(self, row: int) -> list[Move]:
        """List the moves, with the layer's first row at `row`.

        That is a row of a frame.
        """
        return [
            (thing, how + row if isinstance(how, int) else shifted(how, row))
            for thing, how in self.moves
        ]

    def _objects(self, mesh: Mesh) -> Iterator[Move]:
        """Make the objects of a mesh, each with the row, or the runs of rows, that move it."""
        if mesh.single:
            for piece, mark in zip(mesh.pieces, objects.marks(mesh), strict=True):
                yield mark, piece.row
            return
        grids = [(objects.node(), row, form) for row, form, _ in mesh.pieces if type(form) is Grid]
        for node, row, grid in grids:
            self._grids.append((node, grid))
            yield node, row
        if not grids:
            thing, runs = fused(mesh)
            yield thing, STATIC if mesh.pieces[0].row == STATIC else runs
