"""A sentence for the student, in the output of a cell."""

from dataclasses import dataclass
from typing import Literal

from ikteach.markup import Markup, escaped, untouched

Mood = Literal["good", "bad", "plain"]

# Sign and colour: the colour is never the only one that tells.
LOOK = {"good": ("✓", "#009e73"), "bad": ("✗", "#d55e00"), "plain": ("→", "#0072b2")}


@dataclass(frozen=True)
class Notice:
    """One sentence and its mood, false if that is bad."""

    sentence: str
    mood: Mood = "plain"

    def __bool__(self) -> bool:
        return self.mood != "bad"

    def __str__(self) -> str:
        return f"{LOOK[self.mood][0]} {self.sentence}"

    __repr__ = __str__

    def _repr_html_(self) -> str:
        return box(self.mood, paragraph(self.sentence))


def box(mood: Mood, content: Markup) -> Markup:
    """Put the content beside a sign, with a coloured edge."""
    sign, colour = LOOK[mood]
    return untouched(
        Markup(
            '<div role="status" style="border-left:4px solid {1};padding:2px 12px;margin:4px 0">'
            '<span aria-hidden="true" style="color:{1};font-weight:bold">{0}</span> {2}</div>'
        ).format(sign, colour, content)
    )


def paragraph(text: str) -> Markup:
    """Write the text as HTML.

    `code` in backquotes is set as such.
    """
    parts, code = text.split("`"), Markup("<code>{}</code>")
    if len(parts) % 2 == 0:
        return escaped(text)
    return Markup().join(code.format(part) if i % 2 else part for i, part in enumerate(parts))
