"""Life and death of what a cell shows: made whole or not at all, and closed with all it made.

The kernel keeps every widget until it is closed, and sends a page that is loaded anew the state of
each. The state of one that holds a closed widget cannot be sent, and then no widget of the notebook
comes back. So nothing here closes a widget but `close_all`, which leaves nobody behind who holds a
closed one.
"""

from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from functools import wraps
from inspect import signature
from threading import local
from typing import Any

import ipywidgets as widgets
from ipywidgets.widgets.widget import _instances as living  # {id: widget}, of all that live

from ikteach.names import unknown

_slots: dict[str, "Living"] = {}
_now = local()  # .parts: the list of what is made now, in this thread


class Living:
    """A widget, or a holder of widgets, that ends in one way.

    If making it fails, all that it had made is closed. `close` closes all that it made and all
    that is in it. Of all that have the same `slot` the newest lives: a cell that is run again
    closes the one of before, once the new one is there. A part of something else has no slot.
    """

    slot: str | None = None
    foreign: frozenset[str] = frozenset()  # traits that hold widgets of somebody else
    _belongings: tuple[widgets.Widget, ...] = ()

    def __init_subclass__(cls, **options: Any) -> None:
        super().__init_subclass__(**options)
        if "__init__" in vars(cls):
            cls.__init__ = _whole(cls.__init__)  # type: ignore[method-assign]

    def begun(self) -> None:
        """Note the state in which it was made."""

    def end(self) -> None:
        """Stop everything that goes on by itself.

        Called before its widgets are closed.
        """

    def close(self) -> None:
        """Stop it, and free all its widgets.

        Neither the page nor the kernel holds anything of it afterwards.
        """
        if occupant(self.slot) is self:
            _slots.pop(str(self.slot), None)
        itself = [self] if isinstance(self, widgets.Widget) else []
        close_all(*itself, *self._belongings)
        self._belongings = ()


def occupant(slot: str | None) -> Living | None:
    """Return the one that lives under this slot, if any."""
    return None if slot is None else _slots.get(slot)


def close_all(*roots: widgets.Widget) -> None:
    """Close these widgets and all that they hold.

    Each is closed once, and taken out of all others.
    """
    gone = _below(roots)
    while bereft := _bereft_of(gone):
        gone |= {one.model_id: one for one in bereft}
    for widget in gone.values():
        if isinstance(widget, Living):
            widget.end()
    for widget in gone.values():
        # Ours would come back to here.
        widgets.Widget.close(widget) if isinstance(widget, Living) else widget.close()


def _whole(make: Callable[..., None]) -> Callable[..., None]:
    """Wrap an `__init__`: it leaves nothing when it fails, and remembers its parts."""

    taken = signature(make).parameters
    open_ended = any(one.kind is one.VAR_KEYWORD for one in taken.values())

    @wraps(make)
    def made(self: Living, *arguments: Any, **options: Any) -> None:
        for name in options:
            if name not in taken and not open_ended:
                known = list(taken)[1:]  # but for self
                raise TypeError(unknown(f"option of {type(self).__name__}", name, known))
        if "_belongings" in vars(self):  # of a class above: the outermost one does it for all
            return make(self, *arguments, **options)
        self._belongings = ()
        with making() as parts:
            make(self, *arguments, **options)
            if not isinstance(self.slot, str | None):
                raise TypeError(f"a slot is a name, or None for none, not {self.slot!r}")
        self._belongings = tuple(parts)
        self.begun()
        before = occupant(self.slot)
        if before is not None:
            before.close()
        if self.slot is not None:
            _slots[self.slot] = self

    return made


@contextmanager
def making() -> Iterator[list[widgets.Widget]]:
    """List the widgets that are made meanwhile.

    Should an error come, they are closed. May be used as a decorator, `@making()`, of a function
    that makes a figure of several parts.
    """
    outer, parts = getattr(_now, "parts", None), list[widgets.Widget]()
    _now.parts = parts
    try:
        yield parts
    except BaseException:
        close_all(*parts)
        raise
    finally:
        _now.parts = outer
    if outer is not None:
        outer += parts


def _note(widget: widgets.Widget) -> None:
    parts = getattr(_now, "parts", None)
    if parts is not None:
        parts.append(widget)


widgets.Widget.on_widget_constructed(_note)


def _below(roots: Iterable[Any]) -> dict[str, widgets.Widget]:
    """Find the living among these widgets and all that they hold, by their ids."""
    found: dict[str, widgets.Widget] = {}
    waiting = list(roots)[::-1]
    while waiting:
        one = waiting.pop()
        if one.comm and one.model_id not in found:
            found[one.model_id] = one
            others = one.foreign if isinstance(one, Living) else ()
            for name in one.keys:
                if name not in others:
                    waiting += _within(getattr(one, name, None))
    return found


def _within(value: Any) -> Iterator[widgets.Widget]:
    """Find the widgets in the value of a trait."""
    if isinstance(value, widgets.Widget):
        yield value
    elif isinstance(value, dict | list | tuple):
        for one in value.values() if isinstance(value, dict) else value:
            yield from _within(one)


def _bereft_of(gone: dict[str, widgets.Widget]) -> list[widgets.Widget]:
    """Take what goes out of the boxes of those who stay; give those who cannot be without it."""

    def goes(value: Any) -> bool:
        return any(not one.comm or one.model_id in gone for one in _within(value))

    bereft = []
    for one in list(living.values()) if gone else []:
        if one.model_id in gone:
            continue
        held = [name for name in one.keys if goes(getattr(one, name, None))]
        if held == ["children"]:
            one.children = [child for child in one.children if not goes(child)]
        elif held:  # a link, say
            bereft.append(one)
    return bereft
