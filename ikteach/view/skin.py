"""What a figure looks like: solid parts, each fixed to a joint. Sizes in metres, nothing solved."""

from collections.abc import Sequence
from typing import NamedTuple

from ikteach.body import Effectors, Tree

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


def stick_skin(tree: Tree, effectors: Effectors, thick: float = 0.03) -> list[Part]:
    """Rods between joints, and from joints to effectors, for any tree."""
    parts: list[Part] = []
    for j, name in enumerate(tree.names):
        parent = tree.names[tree.parents[j]] if tree.parents[j] >= 0 else None
        parts.append(Ball(name, (0, 0, 0), (1.4 * thick,) * 3, JOINTS))
        if tree.offsets[j].any():
            parts.append(Limb(parent, (0, 0, 0), tree.offsets[j].tolist(), thick, thick, SHIRT))
    for joint, offset in zip(effectors.joints, effectors.offsets, strict=True):
        if offset.any():
            parts.append(Limb(tree.names[joint], (0, 0, 0), offset.tolist(), thick, thick, SHIRT))
    return parts


def body_skin(tree: Tree) -> list[Part]:
    """The human's or the simulator's skin, if one of them fits the tree; else none."""
    for parts in human_skin(), simulator_skin():
        if {part.joint for part in parts} - {None} <= set(tree.names):
            return parts
    return []


def has_human_skin(tree: Tree) -> bool:
    """Whether it looks like a human."""
    return bool(body_skin(tree))


def skin_of(tree: Tree, effectors: Effectors, thick: float = 0.03) -> list[Part]:
    """The skin of a human if it fits the tree, else rods so thick."""
    return body_skin(tree) or stick_skin(tree, effectors, thick)
