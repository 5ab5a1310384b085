"""Where the targets are: the one truth that handles, sliders, number boxes and keys change."""

from collections.abc import Callable, Sequence

import numpy as np

from ikteach.arrays import Array, ArrayLike
from ikteach.checks import numbers
from ikteach.view.stage.lengths import METRE, Lengths, digits_of

AXES = "xyz"
KEEP = 200  # moves that can be taken back


def _each(name: str, values: ArrayLike, shape: tuple[int, int]) -> Array:
    """Ends of ranges (k, 3), of one number or of what fits; ValueError names what does not."""
    ends = numbers(name, values)
    if np.isnan(ends).any():
        raise ValueError(f"{name} has no number where it should")
    try:
        return np.broadcast_to(ends, shape)
    except ValueError:
        raise ValueError(f"{name} must be one number or {shape}, not {ends.shape}") from None


class Positions:
    """The positions of k targets (k, 3) [m], each within its range, and how to take moves back.

    names      what the targets are called
    low, high  (k, 3) the range of each coordinate [m]
    unit       in which they are told to a person
    step       what is told apart [m]

    It stores, and tells whoever asked with `on_change`; it solves nothing.
    """

    def __init__(
        self, names: Sequence[str], start: ArrayLike, low: ArrayLike, high: ArrayLike,
        *, unit: Lengths = METRE, step: float = 0.01,
    ) -> None:  # fmt: skip
        self.unit, self._digits = unit, digits_of(step / unit.metres)
        self.names = list(names)
        shape = (len(self.names), 3)
        self._now = numbers("start", start).copy()
        if self._now.shape != shape:
            raise ValueError(f"{shape[0]} targets need positions {shape}, not {self._now.shape}")
        self.low, self.high = _each("low", low, shape), _each("high", high, shape)
        self._past: list[Array] = []
        self._tell: list[Callable[[int, Array], None]] = []
        for i, position in enumerate(self._now):
            self.check(i, position)

    @property
    def now(self) -> Array:
        """A copy of the positions, (k, 3) [m]."""
        return self._now.copy()

    def on_change(self, tell: Callable[[int, Array], None]) -> None:
        """Call tell(index, position (3,)) after each move, from whichever thread it came."""
        self._tell.append(tell)

    def move(self, index: int, position: ArrayLike, *, again: bool = False) -> None:
        """Move one target; ValueError with the range if it would leave it.

        `again` goes on with the move before, so that one `undo` takes back a whole drag.
        """
        new = np.asarray(position, dtype=float)
        self.check(index, new)
        if not (again and self._past):
            self._past = [*self._past[1 - KEEP :], self.now]
        self._now[index] = new
        self._told(index)

    def drag(self, index: int, position: ArrayLike, *, again: bool = False) -> None:
        """Move one target, and stop it at the edge of its range."""
        inside = np.clip(np.asarray(position, dtype=float), self.low[index], self.high[index])
        self.move(index, inside, again=again)

    def follow(self, positions: ArrayLike) -> None:
        """Take over where the targets have gone by themselves, as far as they may."""
        self._now[:] = np.clip(np.asarray(positions, dtype=float), self.low, self.high)

    def undo(self) -> int | None:
        """Take the last move back; the target that moved, or None if there is nothing left."""
        if not self._past:
            return None
        before = self._past.pop()
        moved = np.flatnonzero((before != self._now).any(axis=-1))
        self._now[:] = before
        for index in moved:
            self._told(int(index))
        return int(moved[0]) if len(moved) else None

    def words(self, index: int) -> str:
        """Where a target is, to be read or heard."""
        x, y, z = (self._said(value) for value in self._now[index])
        return f"{self.names[index]}: x {x}, y {y}, z {z} {self.unit.name}"

    def _said(self, length: float) -> str:
        return self.unit.number(length, self._digits)

    def _told(self, index: int) -> None:
        for tell in self._tell:
            tell(index, self._now[index].copy())

    def check(self, index: int, position: Array) -> None:
        """ValueError with the range if target `index` may not be there."""
        if position.shape != (3,):
            raise ValueError(f"{self.names[index]} needs three numbers, not {position.tolist()}")
        for axis, value, low, high in zip(
            AXES, position, self.low[index], self.high[index], strict=True
        ):
            hair = 1e-9 * max(high - low, abs(low), abs(high))
            if not low - hair <= value <= high + hair:
                ends = f"{self._said(low)} to {self._said(high)} {self.unit.name}"
                where = f"{axis} of {self.names[index]} goes from {ends}"
                said = f"{value / self.unit.metres:g}"
                what = f"{said} is not between them" if value == value else "this is no number"
                raise ValueError(f"{where}; {what}")
