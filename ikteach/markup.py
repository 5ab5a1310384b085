"""Text that becomes HTML: the words of names and files are escaped here, and nowhere else."""

import html
import re
from collections.abc import Iterable
from numbers import Real
from typing import Any

# Control characters, and marks that turn the direction of what stands around them.
_UNSEEN = re.compile("[\x00-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069]+")
LONGEST, SHORT = 60, 40  # letters of a label, and of one in a picture
_LOOK_ALIKE = str.maketrans("$\\", "＄＼")


class Markup(str):
    """HTML that escapes whatever is put into it.

    But for Markup itself. >>> Markup("<b>{}</b>").format("a < b") '<b>a &lt; b</b>'
    """

    def format(self, *values: Any, **named: Any) -> "Markup":
        """Put values into this template; numbers take formats, `{:.2f}`."""
        safe = {name: _escaped(value) for name, value in named.items()}
        return Markup(super().format(*map(_escaped, values), **safe))

    def join(self, parts: Iterable[Any]) -> "Markup":
        """Join the parts, with this between them."""
        return Markup(super().join(str(_escaped(part)) for part in parts))

    def __add__(self, other: str) -> "Markup":
        return Markup(super().__add__(escaped(other)))


def minus(number: str) -> str:
    """Write a number with a minus sign, not a hyphen."""
    return number.replace("-", "−")


def escaped(text: object) -> Markup:
    """Turn text into HTML that shows it; Markup stays."""
    return text if isinstance(text, Markup) else Markup(html.escape(visible(str(text))))


def visible(text: str) -> str:
    """Put text on one line, without invisible characters."""
    return _UNSEEN.sub(" ", text)


def brief(text: str, most: int = LONGEST) -> str:
    """Shorten text to one line, as a label has room."""
    seen = visible(text)
    return seen if len(seen) <= most else f"{seen[: most - 1]}…"


def plain(text: str) -> str:
    """Make a label for ipywidgets.

    They would set text that looks like TeX as a formula.
    """
    return brief(text).translate(_LOOK_ALIKE)


def as_label(name: object) -> str:
    """Make a label for matplotlib.

    It would set $…$ as a formula and leave out a leading _.
    """
    text = brief(str(name), SHORT).replace("$", r"\$")
    return f" {text}" if text.startswith("_") else text


def untouched(content: Markup) -> Markup:
    """Box HTML in which no page looks for TeX."""
    return Markup('<div class="tex2jax_ignore mathjax_ignore">{}</div>').format(content)


def _escaped(value: Any) -> Any:
    return value if isinstance(value, Real) else escaped(value)
