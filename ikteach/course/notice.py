"""A sentence for the student, in the output of a cell."""

import html
from dataclasses import dataclass
from typing import Literal

Mood = Literal["good", "bad", "plain"]

# Sign and colour: the colour is never the only one that tells.
LOOK = {"good": ("✓", "#009e73"), "bad": ("✗", "#d55e00"), "plain": ("→", "#0072b2")}


@dataclass(frozen=True)
class Notice:
    """One sentence, and what it is about; false if that is bad."""

    sentence: str
    mood: Mood = "plain"

    def __bool__(self) -> bool:
        return self.mood != "bad"

    def __str__(self) -> str:
        return f"{LOOK[self.mood][0]} {self.sentence}"

    __repr__ = __str__

    def _repr_html_(self) -> str:
        return box(self.mood, paragraph(self.sentence))


def box(mood: Mood, content: str) -> str:
    """HTML `content` beside a sign, with a coloured edge."""
    sign, colour = LOOK[mood]
    return (
        f'<div role="status" style="border-left:4px solid {colour};padding:2px 12px;margin:4px 0">'
        f'<span aria-hidden="true" style="color:{colour};font-weight:bold">{sign}</span> '
        f"{content}</div>"
    )


def paragraph(text: str) -> str:
    """Text made safe for HTML; `code` in backquotes is set as such."""
    parts = html.escape(text).split("`")
    marked = (f"<code>{part}</code>" if i % 2 else part for i, part in enumerate(parts))
    return "".join(marked) if len(parts) % 2 else html.escape(text)
