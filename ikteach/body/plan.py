"""The table of joints in the order in which `forward` climbs it, worked out once per tree.

All that θ does not change stands in here: which joint follows which, and the entries of Rodrigues'
formula, all of which are sums of 1, sin θ and cos θ (and θ, for slides).
"""

from collections.abc import Iterator
from dataclasses import dataclass
from types import EllipsisType

import numpy as np

from ikteach.arrays import Array, Index, Mask, frozen

DEEP = 8  # joints in a chain, from which on fewer rounds are worth more products
TURN_AND_PLACE = (..., slice(4))  # the columns R and p of [R p v; 0 1 0]

Rows = tuple[EllipsisType, slice, slice, slice]


@dataclass(frozen=True, eq=False)
class Plan:
    """The joints of a tree in order of depth.

    order         (n,)         the joints, those that hang from the ground first
    inverse       (n,)         the row of joint j
    rounds                     in each: an index of rows, and of the row above each of them
    coefficients  (n, 3, 20)   factors of 1, sin θ and cos θ in [R p v; 0 1 0], each joint in
                               its parent's frame and this order; (n, 4, 20) with θ for slides
    slides                     whether there are any
    """

    order: Index
    inverse: Index
    rounds: tuple[tuple[Rows, Index], ...]
    coefficients: Array
    slides: bool

    @classmethod
    def of(cls, parents: Index, offsets: Array, axes: Array, slide: Mask) -> "Plan":
        """Plan for joints with parents (n,), offsets and axes (n, 3), slide (n,)."""
        chains: list[list[int]] = []  # from each joint up to the ground
        for joint, parent in enumerate(parents):
            chains.append([joint, *(chains[parent] if parent >= 0 else [])])
        depth = np.array([len(chain) for chain in chains])
        order = np.argsort(depth, kind="stable")
        inverse, slides = np.argsort(order), bool(slide.any())
        return cls(
            order=frozen(order, np.intp),
            inverse=frozen(inverse, np.intp),
            rounds=tuple(_rounds(chains, depth, order, inverse)),
            coefficients=frozen(_coefficients(offsets, axes, slide)[order, : 3 + slides]),
            slides=slides,
        )

    def local(self, theta: Array) -> Array:
        """Make [R p v; 0 1 0] (..., n, 4, 5) of each joint in its parent's frame, in order."""
        theta = theta.take(self.order, axis=-1)
        x = np.empty((*theta.shape, 3 + self.slides))
        x[..., 0] = 1
        np.sin(theta, out=x[..., 1])
        np.cos(theta, out=x[..., 2])
        if self.slides:
            x[..., 3] = theta
        return np.vecmat(x, self.coefficients).reshape(*theta.shape, 4, 5)

    def climb(self, T: Array) -> Iterator[tuple[Array, Array]]:
        """Yield joints of T and their parents' [R p; 0 1], by rounds.

        The first are views, to be written to before the next round.
        """
        for rows, above in self.rounds:
            yield T[rows], T.take(above, axis=-3)[TURN_AND_PLACE]


def _rounds(
    chains: list[list[int]], depth: Index, order: Index, inverse: Index
) -> Iterator[tuple[Rows, Index]]:
    """Join level by level, each row once; of long chains by pointer doubling.

    Then every row first holds the last 1, 2, 4 … transforms of its chain, so that 64 joints take
    six rounds and not 63.
    """
    deepest = int(depth.max())
    if deepest <= DEEP:
        rounds = [(over, over + 1, 1) for over in range(1, deepest)]
    else:
        rounds = [(2**r, deepest, 2**r) for r in range((deepest - 1).bit_length())]
    for over, down, height in rounds:  # rows deeper than `over`, by those `height` above them
        rows = slice(int((depth <= over).sum()), int((depth <= down).sum()))
        above = [inverse[chains[joint][height]] for joint in order[rows]]
        yield (..., rows, slice(None), slice(None)), frozen(above, np.intp)


def _coefficients(offsets: Array, axes: Array, slide: Mask) -> Array:
    """(n, 4, 20): the factors of 1, sin θ, cos θ and θ in [R p v; 0 1 0].

    R = vvᵀ + sin θ [v]× + cos θ (I − vvᵀ) for a hinge, R = I and p = offset + θ v for a slide.
    """
    v, slides = axes, slide[:, None, None]
    vvT = v[:, :, None] * v[:, None, :]
    coefficients = np.zeros((4, len(v), 4, 5))
    one, sin, cos, travel = coefficients
    one[:, :3, :3] = np.where(slides, np.eye(3), vvT)
    one[:, :3, 3], one[:, 3, 3], one[:, :3, 4] = offsets, 1, v
    sin[:, :3, :3] = np.where(slides, 0, skew(v))
    cos[:, :3, :3] = np.where(slides, 0, np.eye(3) - vvT)
    travel[:, :3, 3] = np.where(slide[:, None], v, 0)
    return coefficients.swapaxes(0, 1).reshape(len(v), 4, 20)


def skew(v: Array) -> Array:
    """Make [v]×, the matrix with [v]× w = v × w: (..., 3) to (..., 3, 3)."""
    x, y, z = np.moveaxis(v, -1, 0)
    o = np.zeros_like(x)
    return np.stack([o, -z, y, z, o, -x, -y, x, o], axis=-1).reshape(*v.shape, 3)
