"""A layer of a scene: forms, and where they are at each moment."""

from collections.abc import Sequence

import numpy as np

from ikteach.arrays import Array, frozen
from ikteach.view.stage.forms import Form, Label, Mesh, Piece
from ikteach.view.stage.stage import Now, Stage

UNMOVED: Array = frozen(np.eye(3, 4)[None])


class Layer:
    """Part of a scene, for any renderer.

    A new one is a subclass, and no more.

    name    by which it is switched
    meshes  the forms; each piece names the row that moves it
    labels  words, which nothing moves
    rows    number of rows that `place` gives
    """

    name = ""

    def __init__(self, stage: Stage) -> None:
        self.stage = stage
        self.meshes: list[Mesh] = []
        self.labels: list[Label] = []
        self.rows = 0
        self.build()

    def build(self) -> None:
        """Make meshes and labels."""
        raise NotImplementedError

    def note(self, now: Now) -> None:
        """Remember this moment, if the layer shows the past; before `place`."""

    def place(self, now: Now) -> Array:
        """Place the forms: [R | p] (rows, 3, 4) of the world.

        NaN hides the forms that a row moves.
        """
        return np.zeros((0, 3, 4))

    def clear(self) -> None:
        """Forget the past."""

    def add(self, forms: Sequence[Form], colours: Sequence[str], **looks: float | bool) -> None:
        """Add a mesh of forms, each moved by the next row.

        They have these colours in turn.
        """
        pieces = [Piece(i, form, colours[i % len(colours)]) for i, form in enumerate(forms)]
        self.rows = max(self.rows, len(pieces))
        self.meshes.append(Mesh(pieces, **looks))  # type: ignore[arg-type]


def hidden(rows: Array, where: Array) -> Array:
    """Hide rows (..., 3, 4) where `where` (...) is true; they are written to."""
    if where.any():
        rows[where] = np.nan
    return rows


def upright(points: Array) -> Array:
    """Make [R | p] (points, 3, 4) that only shift.

    A row is hidden where its point (..., 3) is NaN.
    """
    rows = UNMOVED.repeat(points.size // 3, axis=0)
    rows[..., 3] = points.reshape(-1, 3)
    return rows
