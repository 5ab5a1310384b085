"""Marks that moving points leave behind: trails of effectors, footprints of feet."""

from typing import Any

import numpy as np

from ikteach.arrays import Array
from ikteach.body import Effectors

MARKS, PRINTS = 24, 8  # of a trail, of a foot


class Trail:
    """Marks (f, k, length, 3) where points (f, k, 3) have been, one every `gap` [m]; NaN: none.

    They stay on the ground: when the figure has gone on by `advance`, they lie so much behind.
    """

    def __init__(self, count: tuple[int, int], length: int, gap: float) -> None:
        self.marks = np.full((*count, length, 3), np.nan)
        self._next = np.zeros(count, dtype=int)
        self._gap = gap

    def pass_through(self, points: Array, advance: float) -> Array:
        """Note where points are, and return the marks.

        The marks are where `seen` has them now.
        """
        ground = points + [0.0, 0.0, advance]
        last = np.take_along_axis(self.marks, (self._next - 1)[..., None, None], axis=2)[:, :, 0]
        far = ~(np.linalg.norm(ground - last, axis=-1) < self._gap)  # true also of the first
        self._drop(far, ground)
        return self.seen(advance)

    def seen(self, advance: float) -> Array:
        """Return where the marks are now.

        The figure has gone on by `advance` [m].
        """
        return self.marks - [0.0, 0.0, advance]

    def clear(self) -> None:
        """Forget the marks."""
        self.marks[:] = np.nan

    def _drop(self, here: Any, ground: Array) -> None:
        i, j = np.nonzero(here)
        self.marks[i, j, self._next[i, j]] = ground[i, j]
        self._next[i, j] = (self._next[i, j] + 1) % self.marks.shape[2]


class Prints(Trail):
    """Marks where points stop going forward.

    There the foot comes down.

    gap  how far a point must go for it to have moved [m]
    """

    def __init__(self, count: tuple[int, int], length: int, gap: float = 1e-4) -> None:
        super().__init__(count, length, gap)
        self._before: Array | None = None
        self._forward = np.zeros(count, dtype=bool)

    def pass_through(self, points: Array, advance: float) -> Array:
        """Note where points are, and return the marks.

        The marks are where `seen` has them now.
        """
        if self._before is not None:
            forward = points[..., 2] > self._before[..., 2] + self._gap
            back = points[..., 2] < self._before[..., 2] - self._gap
            self._drop(self._forward & back, self._before + [0.0, 0.0, advance])
            self._forward = np.where(forward | back, forward, self._forward)
        self._before = points.copy()
        return self.seen(advance)

    def clear(self) -> None:
        """Forget the marks."""
        super().clear()
        self._before = None


def feet(effectors: Effectors) -> list[int]:
    """List the effectors that leave footprints."""
    each = enumerate(zip(effectors.names, effectors.w, strict=True))
    return [i for i, (name, w) in each if w and name.startswith("foot")]
