"""Methods that look beyond J and e: at the body itself, or at how far its joints may turn.

Such a method names in `wants` what else it takes, by keyword: fields of `Here`. `step` gives it.
"""

from functools import partial
from typing import Any, NamedTuple

import numpy as np

from ikteach.arrays import Array
from ikteach.body import Effectors, Frames, Tree
from ikteach.motion.rules import Bounds, LimitRule, ignore
from ikteach.solvers import Solver


class Here(NamedTuple):
    """Where a step is asked for.

    tree, effectors  the body
    frames           where its joints are
    low, high        (..., n) how far each joint may turn down and up in this step [rad]
    weights          (..., k) of the targets, by which e and the rows of J are multiplied
    """

    tree: Tree
    effectors: Effectors
    frames: Frames
    low: Array
    high: Array
    weights: Array

    @classmethod
    def of(
        cls,
        tree: Tree,
        effectors: Effectors,
        frames: Frames,
        theta: Array,
        limits: LimitRule,
        bounds: Bounds,
        mobility: Array,
        weights: Array | None = None,
    ) -> "Here":
        """Look around from θ.

        Locked joints turn no way; without limits the others turn any way.
        """
        low, high = (-np.inf, np.inf) if limits is ignore else (bounds.lower, bounds.upper)
        locked = mobility == 0
        low, high = (np.where(locked, 0, end - theta) for end in (low, high))
        weights = effectors.alike if weights is None else weights
        return cls(tree, effectors, frames, low, high, weights)

    def at(self, i: int) -> "Here":
        """Pose i of a batch (p, n)."""
        frames = Frames(*(part[i] for part in self.frames))
        own = (end[i] if end.ndim > 1 else end for end in (self.low, self.high, self.weights))
        return Here(self.tree, self.effectors, frames, *own)


def wants(solver: Any) -> tuple[str, ...]:
    """Say which fields of `Here` a solver takes."""
    while isinstance(solver, partial):
        solver = solver.func
    return getattr(solver, "wants", ())


def situated(solver: Any, here: Here) -> Solver:
    """Bind what a solver wants: a function of J and e."""
    if hasattr(solver, "situated"):  # it is made of others
        return solver.situated(here)
    return partial(solver, **{name: getattr(here, name) for name in wants(solver)})
