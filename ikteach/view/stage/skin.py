"""What a figure looks like: solid parts, each fixed to a joint. Sizes in metres, nothing solved."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from ikteach.arrays import Array, Mask
from ikteach.body import Effectors, Tree
from ikteach.body.extent import Extent
from ikteach.body.figures import BALL, Figure, floating, human, simulator, walker
from ikteach.body.tree import GROUND
from ikteach.view.stage.colours import HAIR, JOINTS, SHIRT, SHOES, SKIN, TROUSERS
from ikteach.view.stage.forms import ORIGIN, Ball, Limb, Vector


class Part(NamedTuple):
    """A form in the frame of `joint` (None: the ground)."""

    joint: str | None
    form: Ball | Limb
    colour: str


def human_skin() -> list[Part]:
    """Build pelvis, trunk, head and limbs for `figures.human()`."""
    parts: list[Part] = [
        Part(None, Ball((0, 0.045, 0), (0.15, 0.11, 0.105)), TROUSERS),
        Part("spine.bend", Limb((0, -0.08, 0), (0, 0.1, 0), 0.105, 0.11), SHIRT),
        Part("spine.twist", Ball((0, 0.2, 0), (0.17, 0.2, 0.115)), SHIRT),
        Part("spine.twist", Limb((-0.19, 0.355, 0), (0.19, 0.355, 0), 0.052, 0.052), SHIRT),
        Part("spine.twist", Limb((0, 0.36, 0), (0, 0.47, 0.01), 0.05, 0.045), SKIN),
        Part("spine.twist", Ball((0, 0.565, 0.015), (0.078, 0.115, 0.095)), SKIN),
        Part("spine.twist", Ball((0, 0.6, -0.012), (0.083, 0.09, 0.092)), HAIR),
        Part("spine.twist", Ball((0, 0.555, 0.112), (0.014, 0.02, 0.02)), SKIN),
    ]
    for side in "lr":
        parts += _limbs(side, "shoulder.turn", "hip.turn")
    return parts


def floating_skin(root: str = "root") -> list[Part]:
    """Build the human's skin on the rows of a free pelvis."""
    return [part._replace(joint=part.joint or f"{root}.z") for part in human_skin()]


def walker_skin() -> list[Part]:
    """Build the skin of `figures.walker()`, with feet in two parts."""
    parts = [part for part in floating_skin("pelvis") if part.colour != SHOES]
    for side in "lr":
        sole, tip = Limb((0, -0.045, -0.05), (0, -0.05, BALL[2]), 0.035, 0.028), 0.026
        parts.append(Part(f"foot.{side}", sole, SHOES))
        parts.append(Part(f"toes.{side}", Ball((0, 0.02, 0.025), (0.042, tip, 0.05)), SHOES))
    return parts


def simulator_skin() -> list[Part]:
    """Build the figure of CS 490.

    It has two segments of the back, and a round head.
    """
    parts: list[Part] = [
        Part(None, Ball((0, 0.045, 0), (0.15, 0.11, 0.105)), TROUSERS),
        Part("back.lower", Limb((0, 0, 0), (0, 0.2, 0), 0.115, 0.115), SHIRT),
        Part("back.upper", Ball((0, 0.08, 0), (0.17, 0.15, 0.115)), SHIRT),
        Part("back.upper", Limb((-0.19, 0.2026, 0), (0.19, 0.2026, 0), 0.052, 0.052), SHIRT),
        Part("back.upper", Limb((0, 0.2, 0), (0, 0.28, 0), 0.05, 0.045), SKIN),
        Part("neck", Ball((0, 0.14, 0.01), (0.105, 0.105, 0.105)), SKIN),
        Part("neck", Ball((0, 0.158, -0.014), (0.107, 0.1, 0.1)), HAIR),
        Part("neck", Ball((0, 0.13, 0.118), (0.018, 0.022, 0.024)), SKIN),
        Part("neck", Ball((0.04, 0.15, 0.101), (0.012, 0.012, 0.012)), HAIR),
        Part("neck", Ball((-0.04, 0.15, 0.101), (0.012, 0.012, 0.012)), HAIR),
    ]
    for side in "lr":
        parts += _limbs(side, "shoulder.x", "hip.z")
    return parts


def _limbs(side: str, shoulder: str, hip: str) -> list[Part]:
    """Build the arm and the leg of a side, below the hinges with these names."""
    return [
        Part(f"{shoulder}.{side}", Limb((0, 0, 0), (0, -0.3348, 0), 0.052, 0.042), SHIRT),
        Part(f"elbow.{side}", Limb((0, 0, 0), (0, -0.27, 0), 0.04, 0.03), SKIN),
        Part(f"elbow.{side}", Ball((0, -0.335, 0), (0.022, 0.075, 0.042)), SKIN),
        Part(f"{hip}.{side}", Limb((0, 0, 0), (0, -0.441, 0), 0.083, 0.058), TROUSERS),
        Part(f"knee.{side}", Limb((0, 0, 0), (0, -0.4428, 0), 0.056, 0.04), TROUSERS),
        Part(f"ankle.{side}", Limb((0, -0.045, -0.05), (0, -0.05, 0.13), 0.035, 0.028), SHOES),
        Part(f"ankle.{side}", Ball((0, -0.05, 0.15), (0.042, 0.026, 0.05)), SHOES),
    ]


class Skin(NamedTuple):
    """A human's skin for a tree shaped like a human's.

    The tree may be of any size and in any place.

    parts  its solid parts
    unit   how many times as large as a human it is
    base   (3,) where its pelvis is [m]
    """

    parts: list[Part]
    unit: float
    base: Array

    @property
    def extent(self) -> Extent:
        """The ball that holds all its poses.

        It is narrower than the one that `body.extent` gives for any tree.
        """
        return Extent(self.base + [0, 0.11 * self.unit, 0], 1.175 * self.unit)


def skin_of(tree: Tree) -> Skin | None:
    """Choose the skin that fits the shape of a tree.

    Names do not matter. None if no skin fits.
    """
    for figure, skin in SKINS:
        like = figure().tree
        if len(tree) == len(like) and _roots(tree).sum() == _roots(like).sum():
            unit = _links(tree) / _links(like)
            base = tree.offsets[_roots(tree)].mean(axis=0)
            base = base - unit * like.offsets[_roots(like)].mean(axis=0)
            named = _matched(tree, like, unit, base)
            if named:
                return Skin([_placed(part, named, unit, base) for part in skin()], unit, base)
    return None


SKINS: tuple[tuple[Callable[[], Figure], Callable[[], list[Part]]], ...] = (
    (human, human_skin),
    (simulator, simulator_skin),
    (lambda: floating(human()), floating_skin),
    (walker, walker_skin),
)


def _roots(tree: Tree) -> Mask:
    """Find the joints that hang from the ground, (n,)."""
    return tree.parents == GROUND


def _links(tree: Tree) -> float:
    """Add up the lengths of all links [m]."""
    return float(np.linalg.norm(tree.offsets[~_roots(tree)], axis=-1).sum())


def _matched(tree: Tree, like: Tree, unit: float, base: Array) -> dict[str, str]:
    """Name the joint of `tree` at each joint of `like`; {} if one has none.

    A joint's parents are matched before it, so that branches are not mistaken for each other.
    """
    row = {GROUND: GROUND}
    for j, parent in enumerate(like.parents.tolist()):
        offset = unit * like.offsets[j] + (base if parent == GROUND else 0)
        near = np.linalg.norm(tree.offsets - offset, axis=-1) <= 1e-3 * unit
        along = np.linalg.norm(tree.axes - like.axes[j], axis=-1) <= 1e-3
        alike = tree.slide == like.slide[j]
        fit = np.flatnonzero((tree.parents == row[parent]) & near & along & alike)
        if len(fit) != 1:
            return {}
        row[j] = int(fit[0])
    return {like.names[j]: tree.names[i] for j, i in row.items() if j != GROUND}


def _placed(part: Part, named: dict[str, str], unit: float, base: Array) -> Part:
    """Put a part in that size on the joint of that name, or on the ground at the base."""

    def at(point: Vector) -> Vector:
        return (unit * np.asarray(point) + (base if part.joint is None else 0)).tolist()

    joint = None if part.joint is None else named[part.joint]
    if isinstance(part.form, Ball):
        radii = [unit * radius for radius in part.form.radii]
        return Part(joint, Ball(at(part.form.centre), radii), part.colour)
    start, end, thick, thin = part.form
    return Part(joint, Limb(at(start), at(end), unit * thick, unit * thin), part.colour)


def stick_skin(tree: Tree, effectors: Effectors, thick: float) -> list[Part]:
    """Join joints to each other and to effectors by rods.

    The tree may be any. `thick` is the radius of the rods [m].
    """
    parts: list[Part] = []
    base = tree.offsets[_roots(tree)].mean(axis=0)
    for j, name in enumerate(tree.names):
        fixed = tree.parents[j] == GROUND
        parent, start = (None, base) if fixed else (tree.names[tree.parents[j]], np.zeros(3))
        parts.append(Part(name, Ball(ORIGIN, (1.4 * thick,) * 3), JOINTS))
        if np.linalg.norm(tree.offsets[j] - start) > 1e-3 * thick:
            end = tree.offsets[j].tolist()
            parts.append(Part(parent, Limb(start.tolist(), end, thick, thick), SHIRT))
    for joint, offset, w in zip(effectors.joints, effectors.offsets, effectors.w, strict=True):
        if w and np.linalg.norm(offset) > 1e-3 * thick:
            limb = Limb(ORIGIN, offset.tolist(), thick, thick)
            parts.append(Part(tree.names[joint], limb, SHIRT))
    return parts
