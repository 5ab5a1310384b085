"""The rules around the solver, the same for every method: clamp, caps and limits.

Each rule is a function that is handed to `step`.
"""

from collections.abc import Callable, Mapping
from functools import cached_property
from math import radians

import numpy as np

from ikteach.arrays import TINY, Array, ArrayLike, Index, Mask
from ikteach.body import Tree

# The step caps of Buss's code [rad]; SDLS bounds its own step. The thesis describes the one of the
# pseudoinverse (4.4.2). Caps that differ make an unfair race.
BUSS_CAPS: Mapping[str, float | None] = {
    "transpose": radians(30),
    "pseudoinverse": radians(5),
    "dls": radians(45),
    "sdls": None,
}

Cap = Callable[[Array, ArrayLike, Index], Array]
Again = Callable[[Mask, Array], Array]
LimitRule = Callable[["Bounds", Array, Array, Again], tuple[Array, Mask]]


class Bounds:
    """The range of each joint in this tick.

    It is where the joint may be at the end of it, (..., n) or (n,) [rad].

    They are the limits; for a joint that is beyond one, from there to as near to it as it may turn.
    """

    def __init__(self, tree: Tree, theta: Array, turn: Array | None = None) -> None:
        """`turn` (..., n) is how far each joint may turn in this tick, None for any way [rad]."""
        self._tree, self._theta, self._turn = tree, theta, turn

    @cached_property
    def lower(self) -> Array:
        """The least that each joint may be."""
        lower = self._tree.lower
        return lower if self._turn is None else np.minimum(lower, self._theta + self._turn)

    @cached_property
    def upper(self) -> Array:
        """The most that each joint may be."""
        upper = self._tree.upper
        return upper if self._turn is None else np.maximum(upper, self._theta - self._turn)

    def clip(self, theta: Array) -> Array:
        """Put θ (..., n) back into the bounds where it is outside."""
        near = np.minimum(np.maximum(theta, self._tree.lower), self._tree.upper)
        if self._turn is None or not np.count_nonzero(near != theta):  # the common case
            return near
        return np.minimum(np.maximum(theta, self.lower), self.upper)


def clamp_error(e: Array, max_error: ArrayLike) -> Array:
    """Shorten each error e_i (..., k, 3) to length max_error, one number or (..., k) [m]."""
    length = np.maximum(np.sqrt(np.vecdot(e, e)), TINY)
    return e * np.minimum(1, max_error / length)[..., None]


def whole(dtheta: Array, max_step: ArrayLike, chains: Index) -> Array:
    """Shorten the whole step to a largest turn max_step.

    No joint then turns further (Buss; thesis 4.4.2).

    The direction stays, but one hand that cannot reach its target slows all four limbs.
    """
    peak = np.maximum(abs(dtheta).max(axis=-1), TINY)
    return dtheta * np.minimum(1, max_step / peak)[..., None]


def per_chain(dtheta: Array, max_step: ArrayLike, chains: Index) -> Array:
    """Shorten each independent chain (`Effectors.chains`) by itself."""
    shortened = dtheta.copy()
    for chain in np.unique(chains):
        joints = chains == chain
        shortened[..., joints] = whole(dtheta[..., joints], max_step, chains)
    return shortened


def ignore(bounds: Bounds, theta: Array, dtheta: Array, again: Again) -> tuple[Array, Mask]:
    """Let the joints turn past their limits.

    So does Buss's code.
    """
    to = theta + dtheta
    return to, np.zeros(to.shape, dtype=bool)


def clip(bounds: Bounds, theta: Array, dtheta: Array, again: Again) -> tuple[Array, Mask]:
    """Put a joint that passed its limit back.

    It goes to the limit, after the solve (thesis 5.1.1). The steps that the solver meant for the
    other joints are then wrong: this alone ruins the pseudoinverse.
    """
    wished = theta + dtheta
    to = bounds.clip(wished)
    return to, to != wished


def hold(bounds: Bounds, theta: Array, dtheta: Array, again: Again) -> tuple[Array, Mask]:
    """Hold joints at their limits, and step again.

    A joint that stands at a limit and would cross it is held; the others step again.

    A joint beyond its limit, that does not come back by itself, is held to its way back.
    """
    to, stopped = clip(bounds, theta, dtheta, again)
    if not np.count_nonzero(stopped):
        return to, stopped
    held, home = np.zeros(to.shape, dtype=bool), bounds.clip(theta)
    while (crossing := stopped & (to == home) & ~held).any():
        held |= crossing
        to, stopped = clip(bounds, theta, again(held, home), again)
    return to, held | stopped
