"""Layers that are always drawn: floor, targets, figures, directions, and ways that are left."""

import numpy as np

from ikteach.arrays import Array
from ikteach.body.rotation import sticks, transforms
from ikteach.view.stage.colours import GREY, SHIRT, effector_colour
from ikteach.view.stage.forms import Arrow, Ball, Box, Form, Grid, Label, Mesh, Piece, Rod, kinds
from ikteach.view.stage.layer import Layer, hidden, upright
from ikteach.view.stage.stage import SQUARE, Now, Stage

FLOOR = 6.0  # side of the floor under a human [m]
FINE, PLAIN = (10, 3), (8, 2)  # how the balls of one figure are cut, and those of several
LETTERS = 16  # of a name over a head


class Floor(Layer):
    """Squares under the figures, or behind planar ones."""

    name = "floor"

    def build(self) -> None:
        """Lay out one grid."""
        self.add([Grid(FLOOR * self.stage.unit, round(FLOOR / SQUARE))], [GREY])

    def place(self, now: Now) -> Array:
        """Let the floor glide back under the figures."""
        return self.stage.ground(now.floor, now.advance)[None]


class TargetMarks(Layer):
    """Marks where effectors are to come.

    They are balls, boxes on the right; of directions they are arrows from their joints. Overlaid
    figures share those of points.
    """

    name = "targets"

    def build(self) -> None:
        """Make a mark for each target of each figure."""
        stage, radius = self.stage, 0.045 * self.stage.unit
        ends = stage.effectors
        self.sets = 1 if stage.overlaid and not ends.directed else len(stage)
        arrows = [Arrow(thickness) for thickness in 0.012 * _sizes(stage)]
        forms: dict[str, Form] = {"box": Box(0.78 * radius), "ball": Ball((0, 0, 0), (radius,) * 3)}
        each = zip(kinds(ends.names, ends.w), arrows, strict=True)
        marks = [forms.get(kind, arrow) for kind, arrow in each]
        self.rows = self.sets * len(marks)
        pieces = [
            Piece(row, form, effector_colour(row % len(marks)))
            for row, form in enumerate(marks * self.sets)
        ]
        for arrows_only in (False, True):
            these = [piece for piece in pieces if isinstance(piece.form, Arrow) is arrows_only]
            if these:
                self.meshes.append(Mesh(these, 0.85, single=True, through=arrows_only))

    def place(self, now: Now) -> Array:
        """Put the marks where the targets are."""
        targets = (now.targets + self.stage.places[:, None])[: self.sets]
        rows = upright(targets)
        if self.stage.effectors.directed:
            rows = rows.reshape(*targets.shape[:2], 3, 4)
            point = self.stage.effectors.w == 1
            begin = (now.origins + self.stage.places[:, None])[:, ~point]
            rows[:, ~point] = sticks(begin, targets[:, ~point])
            if self.stage.overlaid:
                rows[1:, point] = np.nan
        return rows.reshape(-1, 3, 4)


class Figures(Layer):
    """Figures with their skin and their names.

    A row per figure comes first, then one per joint of each.
    """

    name = "figures"

    def build(self) -> None:
        """Make a mesh per figure.

        All overlaid figures but the first can be looked through.
        """
        stage = self.stage
        f, n = len(stage), len(stage.tree)
        self.rows = f + f * n
        self._grounds = upright(stage.places)
        cut = FINE if f == 1 else PLAIN
        for i, name in enumerate(stage.names):
            row: dict[str | None, int] = {None: i}
            row |= {joint: f + i * n + j for j, joint in enumerate(stage.tree.names)}
            pieces = [Piece(row[joint], form, colour) for joint, form, colour in stage.skin]
            pieces = [self._dressed(piece, i) for piece in sorted(pieces, key=lambda one: one.row)]
            self.meshes.append(Mesh(pieces, 0.5 if stage.overlaid and i else 1.0, cut=cut))
            if name:
                at, text = stage.places[i] + stage.name_at(i), _brief(name)
                self.labels.append(Label(at.tolist(), text, self._shirt(i), 0.13 * stage.unit))

    def place(self, now: Now) -> Array:
        """Put each part where its joint is."""
        joints = transforms(now.orientations, now.positions + self.stage.places[:, None])
        return np.concatenate([self._grounds, joints.reshape(-1, 3, 4)])

    def _dressed(self, piece: Piece, i: int) -> Piece:
        return piece._replace(colour=self._shirt(i)) if piece.colour == SHIRT else piece

    def _shirt(self, i: int) -> str:
        """Choose the colour that figure i wears."""
        return SHIRT if len(self.stage) == 1 else effector_colour(i)


class Gaps(Layer):
    """A rod from each effector to its target.

    It is the way that is left.
    """

    name = "gaps"

    def build(self) -> None:
        """Make a rod for each effector of each figure."""
        rod = Rod((0, 0, 0), (0, 1, 0), 0.006 * self.stage.unit)
        self.add([rod] * len(self.stage) * len(self.stage.effectors), [GREY])

    def place(self, now: Now) -> Array:
        """Stretch the rods from effectors to targets.

        A rod that is too short to be seen is hidden.
        """
        places = self.stage.places[:, None]
        rods = sticks(now.effectors + places, now.targets + places)
        left = rods[..., 1]  # of the way
        short = np.vecdot(left, left) < (1e-3 * self.stage.unit) ** 2
        return hidden(rods, short).reshape(-1, 3, 4)


class Pointers(Layer):
    """A rod from its joint for each effector that is a direction.

    They and their targets are seen through the body, in which they often are.
    """

    name = "directions"

    def build(self) -> None:
        """Make a rod for each of them, of each figure.

        It is thicker than its target's arrow, and thinner than the arrow's head.
        """
        stage = self.stage
        self._which = np.flatnonzero(stage.effectors.w == 0)
        thick = 0.018 * _sizes(stage)
        rods = [Rod((0, 0, 0), (0, 1, 0), thick[i]) for i in self._which]
        if rods:
            colours = [effector_colour(int(i)) for i in self._which]
            self.add(rods * len(stage), colours, through=True)

    def place(self, now: Now) -> Array:
        """Stretch the rods from the joints to the tips."""
        places = self.stage.places[:, None]
        begin, end = (at[:, self._which] + places for at in (now.origins, now.effectors))
        return sticks(begin, end).reshape(-1, 3, 4)


BASICS = (Floor, TargetMarks, Figures, Gaps, Pointers)


def _sizes(stage: Stage) -> Array:
    """Measure how thick arrows may be, (k,) [m]: less on short ones."""
    return np.minimum(stage.unit, 5 * np.linalg.norm(stage.effectors.offsets, axis=-1))


def _brief(name: str) -> str:
    """Shorten a name to fit over a head."""
    return name if len(name) <= LETTERS else f"{name[: LETTERS - 1]}…"
