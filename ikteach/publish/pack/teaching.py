"""What TEACHING.md tells of each chapter: the demonstration, and wrong beliefs with their cells."""

import re
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

TEXTS = Path(__file__).parent / "texts"
BELIEF = re.compile(r"^\| (.+) \| `(\S+)` \| `(\S+)` \|$", re.MULTILINE)
DEMO = re.compile(r"^\| (\d+) \| (.+) \| (.+) \| (.+) \| (.+) \|$", re.MULTILINE)


class Belief(NamedTuple):
    """A wrong belief, what students say, and what to answer."""

    belief: str
    key: str
    cell: str
    says: str
    answer: str


class Demo(NamedTuple):
    """A chapter's demonstration."""

    ask: str
    do: str
    seen: str
    finds: str


class Teaching(NamedTuple):
    """All that is told to who teaches.

    beliefs  {key of the prediction: belief}
    demos    {number of the chapter: demonstration}
    """

    beliefs: Mapping[str, Belief]
    demos: Mapping[str, Demo]


def teaching(clone: Path) -> Teaching:
    """Read it; LookupError for a belief without an answer."""
    text = (clone / "TEACHING.md").read_text("utf-8")
    said = data("misconceptions")
    beliefs = {}
    for belief, key, cell in BELIEF.findall(section(text, "Wrong beliefs")):
        if key not in said:
            raise LookupError(f"misconceptions.toml has no answer to {key}: {belief}.")
        beliefs[key] = Belief(belief, key, cell, said[key]["says"], said[key]["answer"])
    rows = DEMO.findall(section(text, "Chapter by chapter"))
    return Teaching(beliefs, {f"{int(number):02}": Demo(*row) for number, *row in rows})


def section(text: str, heading: str) -> str:
    """Return what stands under a heading that begins so."""
    return text.partition(f"\n## {heading}")[2].partition("\n## ")[0]


def data(name: str) -> dict[str, Any]:
    """Read a table of `texts`."""
    return tomllib.loads((TEXTS / f"{name}.toml").read_text("utf-8"))
