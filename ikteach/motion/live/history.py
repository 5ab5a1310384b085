"""The record of a session, as far back as there is room, and the one way to undo a change."""

from collections import deque
from itertools import islice
from time import monotonic
from typing import NamedTuple

import numpy as np

from ikteach.arrays import Array
from ikteach.motion.live.log import Event, Moment
from ikteach.motion.live.settings import Settings

ONE_MOVE = 0.7  # [s] a slider that is moved again so soon is still making the same change
UNDOS = 100  # changes that can be undone


class Change(NamedTuple):
    """A change that can be undone.

    event    as it was noted
    before   how things stood
    subject  the thing that was changed, to tell whether another change goes on with this one
    """

    event: Event
    before: Settings
    subject: tuple[object, ...]


class History:
    """The ticks, events and changes of a session, each with a bound.

    ticks    the last ticks in which poses followed
    events   the last changes, notes and errors
    dropped  how many ticks and events came before these, by name
    """

    def __init__(self, keep: int, keep_events: int) -> None:
        self.ticks: deque[Moment] = deque(maxlen=keep)
        self.events: deque[Event] = deque(maxlen=keep_events)
        self.dropped = {"ticks": 0, "events": 0}
        self._changes: deque[Change] = deque(maxlen=UNDOS)
        self._open, self._changed = False, -np.inf  # when, by the clock on the wall [s]

    def add(self, moment: Moment) -> None:
        """Record a tick."""
        self.dropped["ticks"] += len(self.ticks) == self.ticks.maxlen
        self.ticks.append(moment)

    def clear(self) -> None:
        """Forget all ticks.

        The next change is then a change of its own.
        """
        self.ticks.clear()
        self.dropped["ticks"] = 0
        self.settle()

    def note(self, event: Event) -> None:
        """Record an event."""
        self.dropped["events"] += len(self.events) == self.events.maxlen
        self.events.append(event)

    def change(
        self, event: Event, before: Settings, subject: tuple[object, ...], going_on: bool | None
    ) -> None:
        """Record a change, new or continued.

        It is a new event, or takes the place of the one that it goes on with. It goes on with the
        last one of the same subject if `going_on`; if that is not known (None), if nothing else
        happened since, and that only just.
        """
        last = self._changes[-1] if self._open and self._changes else None
        if going_on is None and last is not None:
            recent = monotonic() - self._changed < ONE_MOVE
            going_on = recent and bool(self.events) and self.events[-1] is last.event
        if going_on and last is not None and last.subject == subject:
            self._changes.pop()
            self._forget(last.event)
            before = last.before
        self.note(event)
        self._changes.append(Change(event, before, subject))
        self._open, self._changed = True, monotonic()

    def undo(self) -> Change:
        """Take the last change off; LookupError if there is none."""
        if not self._changes:
            raise LookupError("there is nothing to undo")
        self.settle()
        return self._changes.pop()

    def settle(self) -> None:
        """End the change that may be going on.

        The next change is then a change of its own.
        """
        self._open = False

    def last(self, count: int | None = None) -> list[Moment]:
        """Return the last ticks in order, or all."""
        return list(islice(reversed(self.ticks), count))[::-1]

    def jitter(self, last: int) -> Array:
        """Give ‖Δ²θ‖ in the last ticks by each of M methods, (≤ last, M) [rad per tick²].

        Before the first tick of the record the figure is taken to have stood still.
        """
        poses = [row.theta for row in self.last(last + 2)]
        if not poses:
            return np.zeros((0, 0))
        if len(poses) < last + 2:  # they begin with the first of all
            poses = [*2 * poses[:1], *poses][-(last + 2) :]
        return np.asarray(np.linalg.norm(np.diff(poses, n=2, axis=0), axis=-1))

    def _forget(self, event: Event) -> None:
        """Take an event out, wherever it stands; it may have been dropped."""
        for i in reversed(range(len(self.events))):
            if self.events[i] is event:
                del self.events[i]
                return
