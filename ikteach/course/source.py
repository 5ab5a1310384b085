"""Show the code that a chapter is about, in the chapter."""

import inspect
from collections.abc import Callable
from typing import Any

from ikteach.markup import escaped
from ikteach.names import unknown


class Source:
    """Source text of a function or class, for a cell.

    said  a sentence under it
    """

    def __init__(self, *things: Any, said: str = "") -> None:
        self.name = f"{things[0].__module__}.{things[0].__qualname__}"
        self.text = "\n\n".join(map(inspect.getsource, things))
        self.said = said

    def __repr__(self) -> str:
        return "\n".join(filter(None, [self.text, self.said]))

    def _repr_markdown_(self) -> str:
        said = f"\n\n{escaped(self.said)}" if self.said else ""
        return f"`{escaped(self.name)}`\n\n```python\n{self.text}```{said}"


def source(thing: Callable[..., Any]) -> Source:
    """Show the source of `thing`; TypeError if not in Python."""
    return Source(thing)


def plainly(thing: Callable[..., Any]) -> Source:
    """Show a function in the fewest lines, compared with its own.

    For one pose, without checks. LookupError for one that has no plain version.
    """
    from ikteach.course.plain import PLAIN, POSES, largest_difference

    if thing not in PLAIN:
        raise LookupError(
            unknown("plain version", getattr(thing, "__name__", str(thing)), _names())
        )
    versions, _ = PLAIN[thing]
    said = (
        f"Largest difference from the package's {thing.__name__}, on {POSES} poses of the human "
        f"drawn at random: {largest_difference(thing):.0e}."
    )
    return Source(*versions, said=said)


def _names() -> list[str]:
    from ikteach.course.plain import PLAIN

    return [thing.__name__ for thing in PLAIN]
