"""Who set a control last, and when: a person, or the program in answer to a person."""

from itertools import count
from typing import Any

_turns = count(1)
_now = 0


class Turns:
    """The turns in which the controls of a panel were set.

    A turn is what a person does, counted over all figures.

    asked     {control: the turn in which a person set it}, unless the program has set it since
    followed  {control: the turn in which the program gave it another value}
    moved     controls to which the program has ever given another value
    """

    def __init__(self) -> None:
        self.asked: dict[str, int] = {}
        self.followed: dict[str, int] = {}
        self.moved: set[str] = set()

    def ask(self, name: str) -> None:
        """Note that a person sets a control."""
        global _now
        _now = self.asked[name] = next(_turns)
        self.followed.pop(name, None)

    def follow(self, name: str, old: Any, new: Any) -> None:
        """Note that the program sets a control."""
        if old != new:
            self.asked.pop(name, None)
            self.followed[name] = _now
            self.moved.add(name)
