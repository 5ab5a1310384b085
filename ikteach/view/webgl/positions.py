"""Where targets are and may be, for the handles, sliders, boxes and keys that move them."""

from collections import deque
from collections.abc import Callable, Sequence
from typing import Protocol

import numpy as np

from ikteach.arrays import TINY, Array, ArrayLike
from ikteach.checks import numbers
from ikteach.view.stage.lengths import METRE, Lengths, digits_of

AXES = "xyz"
KEEP = 200  # moves that can be undone where there is no session


def _each(name: str, values: ArrayLike, shape: tuple[int, int]) -> Array:
    """Give ends of ranges (k, 3), of one number or of what fits; ValueError names what does not."""
    ends = numbers(name, values)
    if np.isnan(ends).any():
        raise ValueError(f"{name} has no number where it should")
    try:
        return np.broadcast_to(ends, shape)
    except ValueError:
        raise ValueError(f"{name} must be one number or {shape}, not {ends.shape}") from None


class TargetKeeper(Protocol):
    """A keeper of a figure's targets that undoes their moves.

    It is a `Session`, or `Moves`.
    """

    targets: Array

    def aim(self, which: int, position: ArrayLike, *, going_on: bool = False) -> None:
        """Put one target to a position (3,) [m].

        `going_on`: as part of the move before.
        """

    def undo(self) -> object:
        """Take the last change back; LookupError if there is none."""


class Moves:
    """Targets (k, 3) [m] that nobody else keeps.

    Their moves can be undone.
    """

    def __init__(self, targets: Array) -> None:
        self.targets = targets
        self._before: deque[Array] = deque(maxlen=KEEP)

    def aim(self, which: int, position: ArrayLike, *, going_on: bool = False) -> None:
        """Put one target to a position (3,) [m].

        `going_on`: as part of the move before.
        """
        if not (going_on and self._before):
            self._before.append(self.targets)
        self.targets = self.targets.copy()
        self.targets[which] = position

    def undo(self) -> None:
        """Take the last move back; LookupError if there is none."""
        if not self._before:
            raise LookupError("there is no move to undo")
        self.targets = self._before.pop()


class Positions:
    """The positions of k targets [m], each within its range.

    Panel and handles move them.

    names      of the targets
    keeper     keeps the targets; here is nothing but their ranges
    low, high  (k, 3) the range of each coordinate [m]
    lengths    (k,) ℓ [m] of a direction, whose target turns and stays as long; 0 of a point
    unit       in which a person reads lengths
    step       the smallest difference that a person is to see [m]
    undo       undoes instead of the keeper, if whoever shows it has more to do then

    Whoever asked with `on_change` hears of each move.
    """

    def __init__(
        self,
        names: Sequence[str],
        keeper: TargetKeeper,
        low: ArrayLike,
        high: ArrayLike,
        lengths: ArrayLike = 0.0,
        *,
        unit: Lengths = METRE,
        step: float = 0.01,
        undo: Callable[[], object] | None = None,
    ) -> None:
        self.unit, self._digits = unit, digits_of(step / unit.metres)
        self.names, self.keeper, self._undo = list(names), keeper, undo or keeper.undo
        shape = (len(self.names), 3)
        if keeper.targets.shape != shape:
            raise ValueError(
                f"{shape[0]} targets need positions {shape}, not {keeper.targets.shape}"
            )
        self.low, self.high = _each("low", low, shape), _each("high", high, shape)
        self.lengths = np.broadcast_to(numbers("lengths", lengths), len(self.names))
        self._listeners: list[Callable[[int, Array], None]] = []

    @property
    def now(self) -> Array:
        """Where the targets are, within their ranges, (k, 3) [m]."""
        targets = self.keeper.targets
        size = np.linalg.norm(targets, axis=-1)
        stretch = np.where(self.lengths > 0, self.lengths / np.maximum(size, TINY), 1.0)
        return np.clip(stretch[:, None] * targets, self.low, self.high)

    def on_change(self, tell: Callable[[int, Array], None]) -> None:
        """Call tell(index, position (3,)) after each move.

        It is called from whichever thread the move came.
        """
        self._listeners.append(tell)

    def move(self, index: int, position: ArrayLike, *, going_on: bool = False) -> None:
        """Move one target within its range, or turn a direction's.

        ValueError with the range if it would leave it, or if no direction is given.

        `going_on` says that it is part of the move before: one `undo` takes back a whole drag.
        """
        new = self._turned(index, np.asarray(position, dtype=float))
        self.check(index, new)
        self.keeper.aim(index, new, going_on=going_on)
        self._moved(index)

    def drag(self, index: int, position: ArrayLike, *, going_on: bool = False) -> None:
        """Move one target as far as its range allows.

        It stops at the edge.
        """
        low, high, at = self.low[index], self.high[index], np.asarray(position, dtype=float)
        if self.lengths[index]:  # as far round as the tip, when that is drawn in to its sphere
            at = np.where(low < high, at, low)
            at = at if at.any() else self.now[index]
        else:
            at = np.clip(at, low, high)
        self.move(index, at, going_on=going_on)

    def coordinate(self, index: int, axis: int, value: float) -> Array:
        """Return where a target goes as one of its coordinates changes, (3,) [m].

        That of a direction turns: its others then have what is left of its length.
        """
        at, length = self.now[index], self.lengths[index]
        at[axis] = value
        free = self.low[index] < self.high[index]
        others = np.flatnonzero(free & (np.arange(3) != axis))
        if abs(value) <= length and len(others):
            if np.linalg.norm(at[others]) <= 1e-9 * length:
                at[others[0]] = 1.0  # at a pole any way is as good
            left = np.sqrt(length**2 - value**2)
            at[others] *= left / np.linalg.norm(at[others])
        return at

    def undo(self) -> str:
        """Take the last change back, and say so in a sentence."""
        before = self.now
        try:
            self._undo()
        except LookupError:
            return "There is nothing to take back."
        moved = np.flatnonzero((before != self.now).any(axis=-1)).tolist()
        for index in moved:
            self._moved(index)
        return f"Taken back. {self.words(moved[0]) if moved else ''}".strip()

    def words(self, index: int) -> str:
        """Say where a target is, to be read or heard."""
        x, y, z = (self._said(value) for value in self.now[index])
        points = "points to " if self.lengths[index] else ""
        return f"{self.names[index]}: {points}x {x}, y {y}, z {z} {self.unit.name}"

    def _turned(self, index: int, at: Array) -> Array:
        """Give the target of a direction its length; ValueError if it points nowhere."""
        length = self.lengths[index]
        if not length or at.shape != (3,) or not np.isfinite(at).all():
            return at
        if not at.any():
            raise ValueError(f"{self.names[index]} is a direction, and (0, 0, 0) is none")
        return length * (at / np.linalg.norm(at))

    def _said(self, length: float) -> str:
        return self.unit.number(length, self._digits)

    def _moved(self, index: int) -> None:
        for tell in self._listeners:
            tell(index, self.now[index])

    def check(self, index: int, position: Array) -> None:
        """Raise ValueError if target `index` may not be there.

        The message has the range, unless the shape is wrong.
        """
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
