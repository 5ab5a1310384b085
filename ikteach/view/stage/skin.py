"""What a figure looks like: solid parts, each fixed to a joint. Sizes in metres, nothing solved."""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from ikteach.arrays import Array, Mask
from ikteach.body import Effectors, Tree
from ikteach.body.extent import Extent
from ikteach.body.figures import Figure, human, simulator
from ikteach.body.tree import GROUND

Vector = Sequence[float]

# Okabe & Ito's colours, which people with any colour vision can tell apart.
BLUE, ORANGE, RED, GREEN = "#0072b2", "#e69f00", "#d55e00", "#009e73"
PURPLE, SKY, GREY = "#cc79a7", "#56b4e9", "#808890"
EFFECTOR_COLOURS = (BLUE, ORANGE, RED, GREEN, PURPLE, SKY)

LIGHT, DARK = "#f4f6f8", "#0f1318"  # backgrounds
SKIN, SHIRT, TROUSERS, SHOES, HAIR = "#d9a57e", "#5f8fb4", "#4a5568", "#2d3340", "#4b3a2f"
JOINTS = "#aab4be"  # of rods


class Limb(NamedTuple):
    """A rod with round ends from `start` to `end` in the frame of `joint` (None: the ground)."""

    joint: str | None
    start: Vector
    end: Vector
    thick: float
    thin: float
    colour: str


class Ball(NamedTuple):
    """An ellipsoid with these half axes, in the frame of `joint`."""

    joint: str | None
    centre: Vector
    radii: Vector
    colour: str


Part = Limb | Ball


def human_skin() -> list[Part]:
    """Pelvis, trunk, head and limbs for `figures.human()`."""
    parts: list[Part] = [
        Ball(None, (0, 0.045, 0), (0.15, 0.11, 0.105), TROUSERS),
        Limb("spine.bend", (0, -0.08, 0), (0, 0.1, 0), 0.105, 0.11, SHIRT),
        Ball("spine.twist", (0, 0.2, 0), (0.17, 0.2, 0.115), SHIRT),
        Limb("spine.twist", (-0.19, 0.355, 0), (0.19, 0.355, 0), 0.052, 0.052, SHIRT),
        Limb("spine.twist", (0, 0.36, 0), (0, 0.47, 0.01), 0.05, 0.045, SKIN),
        Ball("spine.twist", (0, 0.565, 0.015), (0.078, 0.115, 0.095), SKIN),
        Ball("spine.twist", (0, 0.6, -0.012), (0.083, 0.09, 0.092), HAIR),
        Ball("spine.twist", (0, 0.555, 0.112), (0.014, 0.02, 0.02), SKIN),
    ]
    for side in "lr":
        parts += _limbs(side, "shoulder.turn", "hip.turn")
    return parts


def simulator_skin() -> list[Part]:
    """The figure of CS 490, `figures.simulator()`: two segments of the back, a round head."""
    parts: list[Part] = [
        Ball(None, (0, 0.045, 0), (0.15, 0.11, 0.105), TROUSERS),
        Limb("back.lower", (0, 0, 0), (0, 0.2, 0), 0.115, 0.115, SHIRT),
        Ball("back.upper", (0, 0.08, 0), (0.17, 0.15, 0.115), SHIRT),
        Limb("back.upper", (-0.19, 0.2026, 0), (0.19, 0.2026, 0), 0.052, 0.052, SHIRT),
        Limb("back.upper", (0, 0.2, 0), (0, 0.28, 0), 0.05, 0.045, SKIN),
        Ball("neck", (0, 0.14, 0.01), (0.105, 0.105, 0.105), SKIN),
        Ball("neck", (0, 0.158, -0.014), (0.107, 0.1, 0.1), HAIR),
        Ball("neck", (0, 0.13, 0.118), (0.018, 0.022, 0.024), SKIN),
        Ball("neck", (0.04, 0.15, 0.101), (0.012, 0.012, 0.012), HAIR),
        Ball("neck", (-0.04, 0.15, 0.101), (0.012, 0.012, 0.012), HAIR),
    ]
    for side in "lr":
        parts += _limbs(side, "shoulder.x", "hip.z")
    return parts


def _limbs(side: str, shoulder: str, hip: str) -> list[Part]:
    """The arm and the leg of a side, below the hinges with these names."""
    return [
        Limb(f"{shoulder}.{side}", (0, 0, 0), (0, -0.3348, 0), 0.052, 0.042, SHIRT),
        Limb(f"elbow.{side}", (0, 0, 0), (0, -0.27, 0), 0.04, 0.03, SKIN),
        Ball(f"elbow.{side}", (0, -0.335, 0), (0.022, 0.075, 0.042), SKIN),
        Limb(f"{hip}.{side}", (0, 0, 0), (0, -0.441, 0), 0.083, 0.058, TROUSERS),
        Limb(f"knee.{side}", (0, 0, 0), (0, -0.4428, 0), 0.056, 0.04, TROUSERS),
        Limb(f"ankle.{side}", (0, -0.045, -0.05), (0, -0.05, 0.13), 0.035, 0.028, SHOES),
        Ball(f"ankle.{side}", (0, -0.05, 0.15), (0.042, 0.026, 0.05), SHOES),
    ]


class Flesh(NamedTuple):
    """A human's skin for a tree that is shaped like a human's, of any size and in any place.

    parts  what it is made of
    unit   how many times as large as a human it is
    base   (3,) where its pelvis is [m]
    """

    parts: list[Part]
    unit: float
    base: Array

    @property
    def extent(self) -> Extent:
        """The ball that holds all its poses; narrower than what is known of any body."""
        return Extent(self.base + [0, 0.11 * self.unit, 0], 1.175 * self.unit)


def flesh_of(tree: Tree) -> Flesh | None:
    """The human's or the simulator's skin, if one of them fits the tree, whatever its names."""
    for figure, skin in SKINS:
        like = figure().tree
        if len(tree) == len(like) and _roots(tree).sum() == _roots(like).sum():
            unit = _links(tree) / _links(like)
            base = tree.offsets[_roots(tree)].mean(axis=0)
            base = base - unit * like.offsets[_roots(like)].mean(axis=0)
            named = _matched(tree, like, unit, base)
            if named:
                return Flesh([_placed(part, named, unit, base) for part in skin()], unit, base)
    return None


SKINS: tuple[tuple[Callable[[], Figure], Callable[[], list[Part]]], ...] = (
    (human, human_skin),
    (simulator, simulator_skin),
)


def _roots(tree: Tree) -> Mask:
    """Which joints hang from the ground, (n,)."""
    return tree.parents == GROUND


def _links(tree: Tree) -> float:
    """The length of all links together [m]."""
    return float(np.linalg.norm(tree.offsets[~_roots(tree)], axis=-1).sum())


def _matched(tree: Tree, like: Tree, unit: float, base: Array) -> dict[str, str]:
    """For each joint of `like` the name of the one that sits there in `tree`; {} if one does not.

    A joint's parents are matched before it, so that branches are not mistaken for each other.
    """
    row = {GROUND: GROUND}
    for j, parent in enumerate(like.parents.tolist()):
        offset = unit * like.offsets[j] + (base if parent == GROUND else 0)
        near = np.linalg.norm(tree.offsets - offset, axis=-1) <= 1e-3 * unit
        along = np.linalg.norm(tree.axes - like.axes[j], axis=-1) <= 1e-3
        fit = np.flatnonzero((tree.parents == row[parent]) & near & along & ~tree.slide)
        if len(fit) != 1:
            return {}
        row[j] = int(fit[0])
    return {like.names[j]: tree.names[i] for j, i in row.items() if j != GROUND}


def _placed(part: Part, named: dict[str, str], unit: float, base: Array) -> Part:
    """The part in that size, on the joint of that name; what is on the ground, at the base."""

    def at(point: Vector) -> Vector:
        return (unit * np.asarray(point) + (base if part.joint is None else 0)).tolist()

    joint = None if part.joint is None else named[part.joint]
    if isinstance(part, Ball):
        radii = [unit * radius for radius in part.radii]
        return Ball(joint, at(part.centre), radii, part.colour)
    return Limb(
        joint, at(part.start), at(part.end), unit * part.thick, unit * part.thin, part.colour
    )


def stick_skin(tree: Tree, effectors: Effectors, thick: float) -> list[Part]:
    """Rods between joints, and from joints to effectors, so thick [m], for any tree."""
    parts: list[Part] = []
    base = tree.offsets[_roots(tree)].mean(axis=0)
    for j, name in enumerate(tree.names):
        fixed = tree.parents[j] == GROUND
        parent, start = (None, base) if fixed else (tree.names[tree.parents[j]], np.zeros(3))
        parts.append(Ball(name, (0, 0, 0), (1.4 * thick,) * 3, JOINTS))
        if np.linalg.norm(tree.offsets[j] - start) > 1e-3 * thick:
            end = tree.offsets[j].tolist()
            parts.append(Limb(parent, start.tolist(), end, thick, thick, SHIRT))
    for joint, offset in zip(effectors.joints, effectors.offsets, strict=True):
        if np.linalg.norm(offset) > 1e-3 * thick:
            parts.append(Limb(tree.names[joint], (0, 0, 0), offset.tolist(), thick, thick, SHIRT))
    return parts
