"""How large a body is, and where: one ball that holds all its poses."""

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from ikteach.arrays import Array, frozen
from ikteach.body.tree import Effectors, Tree

ROUNDS = 1000  # of the search for the smallest ball: its radius is within a thousandth then


class Extent(NamedTuple):
    """A ball that holds every pose of a body within its limits.

    centre (3,) [m], radius [m]: 1 where the body has no length at all
    """

    centre: Array
    radius: float


@lru_cache(maxsize=32)
def extent(tree: Tree, effectors: Effectors) -> Extent:
    """Enclose all places that joints and effectors can reach.

    The travel of slides is included. A slide without a limit is taken to go as far that way as the
    body is large without it. The ball moves along with the ground, and grows with the unit of
    length.
    """
    endless = tree.slide & np.isinf([tree.lower, tree.upper])
    lower, upper = np.where(np.isinf([tree.lower, tree.upper]), tree.rest, [tree.lower, tree.upper])
    found = _smallest(*_swept(tree, effectors, lower, upper))
    if endless.any():
        far = found.radius * endless
        found = _smallest(*_swept(tree, effectors, lower - far[0], upper + far[1]))
    return found


def _swept(tree: Tree, effectors: Effectors, lower: Array, upper: Array) -> tuple[Array, Array]:
    """Make a ball in the world for each joint and effector: centres c (m, 3), radii r (m,).

    Each begins as a point and grows on its way to the ground. A hinge sweeps it along an arc: the
    smallest ball around an arc of radius ρ and half angle h < π/2 stands on its chord and has the
    radius ρ sin h. A slide sweeps it along a line. Nor can it be farther from a hinge than the
    links between them are long, whatever the angles.
    """
    n = len(tree)
    endless = np.isinf(tree.lower) | np.isinf(tree.upper)
    middle = (lower + upper) / 2
    half = np.where(endless & ~tree.slide, np.pi, (upper - lower) / 2)
    points = effectors.w == 1
    carrier = np.concatenate([np.arange(n), effectors.joints[points]])
    c, r = np.concatenate([np.zeros((n, 3)), effectors.offsets[points]]), np.zeros(len(carrier))
    far = np.linalg.norm(c, axis=-1)  # from the origin of the frame, at most
    for j in reversed(range(n)):  # children before parents
        on, axis = carrier == j, tree.axes[j]
        if tree.slide[j]:
            c[on] += middle[j] * axis
            r[on] += half[j]
            far[on] += max(abs(middle[j] - half[j]), abs(middle[j] + half[j]))
        else:
            h = min(half[j], np.pi / 2)
            along = np.outer(c[on] @ axis, axis)
            out = c[on] - along
            turned = np.cos(middle[j]) * out + np.sin(middle[j]) * np.cross(axis, out)
            c[on] = along + (np.cos(h) * turned if h < np.pi / 2 else 0)
            r[on] += np.sin(h) * np.linalg.norm(out, axis=-1)
        far[on] = np.minimum(far[on], np.linalg.norm(c[on], axis=-1) + r[on])
        loose = on & (r > far)
        c[loose], r[loose] = 0, far[loose]
        c[on] += tree.offsets[j]
        far[on] += np.linalg.norm(tree.offsets[j])
        carrier[on] = tree.parents[j]
    return c, r


def _smallest(c: Array, r: Array) -> Extent:
    """Find the smallest ball around balls, nearly: go towards the farthest of them, ever less.

    Source: Bădoiu and Clarkson, Smaller core-sets for balls, 2003.
    """
    centre = c[r >= (1 - 1e-9) * r.max()].mean(axis=0)
    for i in range(2, ROUNDS):
        away = c - centre
        distance = np.linalg.norm(away, axis=-1)
        farthest = (distance + r).argmax()
        if distance[farthest] <= 1e-9 * r[farthest]:
            break  # one ball holds the others
        way = away[farthest] / distance[farthest]
        centre = centre + (away[farthest] + r[farthest] * way) / i
    radius = float((np.linalg.norm(c - centre, axis=-1) + r).max())
    return Extent(frozen(centre), radius or 1.0)
