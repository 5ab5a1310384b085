"""Lengths as a person reads them, in the unit that suits the body, and angles in degrees."""

from math import floor, log10, pi
from typing import NamedTuple

import numpy as np

from ikteach.arrays import Array
from ikteach.body import Effectors, Tree
from ikteach.body.extent import extent


class Lengths(NamedTuple):
    """A unit for distances of a body.

    name    as it is written, such as "cm"
    metres  its length [m]
    """

    name: str
    metres: float

    @classmethod
    def of(cls, tree: Tree, effectors: Effectors) -> "Lengths":
        """Choose the unit for distances.

        It is the largest of which the body's reach has ten.
        """
        radius = extent(tree, effectors).radius
        return next((one for one in UNITS if radius >= 10 * one.metres), UNITS[-1])

    @classmethod
    def of_places(cls, radius: float) -> "Lengths":
        """Choose the unit for coordinates.

        It suits a body of that reach [m]: metres while they do.
        """
        fit = (one for one in UNITS if one.name != "cm" and radius >= LEAST[one.name])
        return next(fit, UNITS[-1])

    def number(self, length: float, digits: int = 1) -> str:
        """Write a length [m] as a number.

        It is short where it is far too large.
        """
        value = length / self.metres
        return f"{value:.{digits}f}" if abs(value) < 1e6 else f"{value:.3g}"

    def __call__(self, length: float, digits: int = 1) -> str:
        """Write a length [m] with its unit, as "12.3 cm"."""
        return f"{self.number(length, digits)}{'' if self is DEGREE else ' '}{self.name}"


LEAST = {"km": 1e4, "m": 0.1, "mm": 1e-4, "µm": 1e-7, "nm": 0.0}  # reach [m] for places in them
UNITS = (
    Lengths("km", 1e3),
    Lengths("m", 1.0),
    Lengths("cm", 1e-2),
    Lengths("mm", 1e-3),
    Lengths("µm", 1e-6),
    Lengths("nm", 1e-9),
)

METRE = UNITS[1]
DEGREE = Lengths("°", pi / 180)  # of lengths on a circle of radius 1


def units(tree: Tree, effectors: Effectors) -> list[Lengths]:
    """Choose the unit for the distance of each effector.

    Directions are off by an angle.
    """
    length = Lengths.of(tree, effectors)
    return [length if w else DEGREE for w in effectors.w]


def misses(effectors: Effectors, error: Array) -> Array:
    """Return errors (..., k) as they are read: [m], of directions [rad].

    A direction that is off by φ has the error 2ℓ sin(φ/2).
    """
    length = np.linalg.norm(effectors.offsets, axis=-1)
    diameter = np.where(effectors.w, np.inf, 2 * length)
    return np.where(effectors.w, error, 2 * np.arcsin(np.minimum(error / diameter, 1)))


def told(tree: Tree, effectors: Effectors, error: Array) -> list[str]:
    """Say errors (k,) [m] as they are read: "pelvis 1.2 cm", "gaze 3.4° (0.6 cm)".

    A direction is off by an angle, which makes metres by its length.
    """
    length, off = Lengths.of(tree, effectors), misses(effectors, error)
    each = zip(effectors.names, effectors.w, error, off, strict=True)
    return [
        f"{name} {length(float(d))}" if w else f"{name} {DEGREE(float(phi))} ({length(float(d))})"
        for name, w, d, phi in each
    ]


def counted(effectors: Effectors) -> str:
    """Say how directions count among distances, if there are some."""
    return "" if effectors.w.all() else " A direction that is off by φ counts as 2ℓ sin(φ/2)."


def decade(tree: Tree, effectors: Effectors) -> float:
    """Return the power of ten nearest to the body's reach [m].

    It is 1 for a human.
    """
    return 10.0 ** round(log10(extent(tree, effectors).radius))


def digits_of(step: float) -> int:
    """Count the decimals that tell multiples of a step apart."""
    return max(0, -floor(log10(step) + 1e-9))


def round_step(range_: float, steps: int = 300) -> float:
    """Choose a round step for a range.

    It is 1, 2 or 5 times a power of ten, and the range has about `steps` of them.
    """
    rough = range_ / steps
    power = 10.0 ** floor(log10(rough))
    return float(min((1, 2, 5, 10), key=lambda m: abs(log10(m * power / rough))) * power)
