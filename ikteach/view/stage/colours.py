"""Colours: of effectors and joints, of skins, of paper and ink."""

from typing import NamedTuple

import numpy as np

from ikteach.arrays import Array

# Okabe & Ito's colours, which people with any colour vision can tell apart.
BLUE, ORANGE, RED, GREEN = "#0072b2", "#e69f00", "#d55e00", "#009e73"
PURPLE, SKY, GREY = "#cc79a7", "#56b4e9", "#808890"
EFFECTOR_COLOURS = (BLUE, ORANGE, RED, GREEN, PURPLE, SKY)

SKIN, SHIRT, TROUSERS, SHOES, HAIR = "#d9a57e", "#5f8fb4", "#4a5568", "#2d3340", "#4b3a2f"
JOINTS = "#aab4be"  # of rods


class Paper(NamedTuple):
    """The colours of background, words, and lines of the floor.

    They are the paper that a scene is drawn on.
    """

    back: str
    ink: str
    line: str
    middle: str
    shadow: str


LIGHT = Paper("#f4f6f8", "#2d3340", "#cbd2d9", "#9aa5b1", "#dde2e6")
DARK = Paper("#0f1318", "#e8ebee", "#3a434d", "#5c6875", "#080a0d")


def paper(dark: bool) -> Paper:
    """Choose the dark paper or the light one."""
    return DARK if dark else LIGHT


def effector_colour(i: int) -> str:
    """Give effector i, its target, joint i or figure i its colour."""
    return EFFECTOR_COLOURS[i % len(EFFECTOR_COLOURS)]


def rgb(colour: str) -> Array:
    """Read the three numbers of "#rrggbb", 0 to 255."""
    return np.array([int(colour[i : i + 2], 16) for i in (1, 3, 5)], dtype="f4")
