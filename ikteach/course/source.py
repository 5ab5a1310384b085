"""Show the code that a chapter is about, in the chapter."""

import inspect
from collections.abc import Callable
from typing import Any

from ikteach.markup import escaped


class Source:
    """Source text of a function or class, for a cell."""

    def __init__(self, thing: Any) -> None:
        self.name = f"{thing.__module__}.{thing.__qualname__}"
        self.text = inspect.getsource(thing)

    def __repr__(self) -> str:
        return self.text

    def _repr_markdown_(self) -> str:
        return f"`{escaped(self.name)}`\n\n```python\n{self.text}```"


def source(thing: Callable[..., Any]) -> Source:
    """Show the source of `thing`, as the package runs it.

    TypeError for what has none in Python.
    """
    return Source(thing)
