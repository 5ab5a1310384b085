"""The sentence for a name that does not exist."""

import difflib
from collections.abc import Iterable

from ikteach.checks import LONG, shown

MANY = 12  # names that a sentence lists


def unknown(kind: str, name: object, known: Iterable[str]) -> str:
    """Say that no `kind` is called `name`.

    The sentence goes on with the name that may have been meant, or with all that there are.
    """
    names = list(known)
    close = difflib.get_close_matches(name[:LONG] if isinstance(name, str) else shown(name), names)
    if close:
        return f"no {kind} {shown(name)}; did you mean {' or '.join(map(shown, close))}?"
    more = f" and {len(names) - MANY} more" if len(names) > MANY else ""
    return f"no {kind} {shown(name)}; there are {', '.join(map(shown, names[:MANY]))}{more}"
