"""The sentence for a name that does not exist."""

import difflib
from collections.abc import Iterable

from ikteach.checks import LONG, shown

MANY = 240  # letters of a list of names that a sentence shows


def unknown(kind: str, name: object, known: Iterable[str]) -> str:
    """Say that there is no `kind` called `name`, and what it may have meant or what there is."""
    names = list(known)
    close = difflib.get_close_matches(str(name)[:LONG], names, n=3)
    if close:
        return f"no {kind} {shown(name)}; did you mean {' or '.join(map(shown, close))}?"
    there = ", ".join(map(shown, names))
    if len(there) > MANY:
        there = f"{there[:MANY]} …, {len(names)} in all"
    return f"no {kind} {shown(name)}; there are {there}"
