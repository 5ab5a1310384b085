"""A strict reader of GIFT, by the rules of Moodle's importer, which forgives more than this."""

import html
import re
from typing import NamedTuple

ESCAPED = re.compile(r"\\([\\~=#{}:])")
NAMED = re.compile(r"::(?P<name>.+?)::\[html\](?P<text>[^{}]+)\{(?P<answers>[^{}]*)\}", re.DOTALL)
NUMBER = r"-?\d+(?:\.\d+)?"
NUMERIC = re.compile(
    rf"=(?P<weight>%0%)?(?P<value>{NUMBER}):(?P<margin>{NUMBER})#(?P<said>[^#~=]+)"
)
OPTION = re.compile(r"(?P<sign>[=~])(?P<option>[^#~=%]+)#(?P<said>[^#~=]*)")
PAIR = re.compile(r"=(?P<one>[^#~=]+?) -> (?P<other>[^#~=]+)")
MARKS = {mark: chr(0xE000 + i) for i, mark in enumerate("\\~=#{}:")}


class Number(NamedTuple):
    """A value that a numeric question knows; `share` of its points."""

    value: float
    margin: float
    share: float
    said: str


class Asked(NamedTuple):
    """A question: its kind, and its answers as its kind has them."""

    category: str
    name: str
    text: str
    kind: str
    answers: list[Number] | list[tuple[str, bool, str]] | list[tuple[str, str]]
    otherwise: str = ""


def read(text: str) -> list[Asked]:
    """All questions; ValueError for anything that is not wholly understood."""
    hidden = ESCAPED.sub(lambda found: MARKS[found[1]], text)
    if "\\" in hidden:
        raise ValueError("a backslash that escapes nothing")
    category, found = "", []
    for block in re.split(r"\n\s*\n", hidden.strip()):
        lines = [line for line in block.splitlines() if not line.strip().startswith("//")]
        whole = "\n".join(lines).strip()
        if whole.startswith("$CATEGORY: "):
            category = whole.removeprefix("$CATEGORY: ")
        elif whole:
            found.append(_question(category, whole))
    return found


def _question(category: str, block: str) -> Asked:
    match = NAMED.fullmatch(block)
    if match is None or re.search(r"[~=#]", match["text"]):
        raise ValueError(f"no question: {block[:80]}")
    name, text = _plain(match["name"]), html.unescape(_plain(match["text"]))
    rows = [row.strip() for row in match["answers"].strip().splitlines()]
    if rows[0] == "#":
        return _numeric(category, name, text, rows[1:])
    if all(PAIR.fullmatch(row) for row in rows):
        pairs = [PAIR.fullmatch(row) for row in rows]
        answers = [(html.unescape(_plain(p["one"])), _plain(p["other"])) for p in pairs if p]
        if len({other for _, other in answers}) < max(3, len(rows)):
            raise ValueError(f"{name} has too few pairs, or two that are alike")
        return Asked(category, name, text, "matching", answers)
    options = [OPTION.fullmatch(row) for row in rows]
    if not all(options) or sum(row.startswith("=") for row in rows) != 1:
        raise ValueError(f"{name} is no choice of one")
    told = [
        (html.unescape(_plain(o["option"])), o["sign"] == "=", html.unescape(_plain(o["said"])))
        for o in options
        if o
    ]
    return Asked(category, name, text, "choice", told)


def _numeric(category: str, name: str, text: str, rows: list[str]) -> Asked:
    *values, last = rows
    if not last.startswith("~#"):
        raise ValueError(f"{name} says nothing of other numbers")
    found = [NUMERIC.fullmatch(row) for row in values]
    if not all(found):
        raise ValueError(f"{name} has no numbers: {values}")
    numbers = [
        Number(float(n["value"]), float(n["margin"]), 0 if n["weight"] else 1, _plain(n["said"]))
        for n in found
        if n
    ]
    return Asked(category, name, text, "numeric", numbers, html.unescape(_plain(last[2:])))


def _plain(text: str) -> str:
    for mark, hidden in MARKS.items():
        text = text.replace(hidden, mark)
    return text.strip()
