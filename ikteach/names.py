"""The sentence for a name that does not exist."""

import difflib
from collections.abc import Iterable

from ikteach.checks import LONG, shown

MANY = 12  # names that a sentence lists


def unknown(kind: str, name: object, known: Iterable[str]) -> str:
    """Say that there is no `kind` called `name`, and what it may have meant or what there is."""
    names = list(known)
    close = difflib.get_close_matches(name[:LONG] if isinstance(name, str) else shown(name), names)
    if close:
        return f"no {kind} {shown(name)}; did you mean {' or '.join(map(shown, close))}?"
    more = f" and {len(names) - MANY} more" if len(names) > MANY else ""
    return f"no {kind} {shown(name)}; there are {', '.join(map(shown, names[:MANY]))}{more}"
