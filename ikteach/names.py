"""The sentence for a name that does not exist."""

import difflib
from collections.abc import Iterable


def unknown(kind: str, name: object, known: Iterable[str]) -> str:
    """Say that there is no `kind` called `name`, and what it may have meant or what there is."""
    names = list(known)
    close = difflib.get_close_matches(str(name), names, n=3)
    if close:
        return f"no {kind} {name!r}; did you mean {' or '.join(map(repr, close))}?"
    return f"no {kind} {name!r}; there are {', '.join(map(repr, names))}"
