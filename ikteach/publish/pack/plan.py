"""A chapter by minutes: its own time, shared among its parts, and what needs no class."""

from collections.abc import Iterator
from itertools import groupby
from typing import NamedTuple

from ikteach.publish.pack.parts import Chapter, Computed, Exit, Part, Posed, Stub, Told, ToTry

# How long parts take beside one another. What a chapter says of its time is shared in these
# proportions, so that the minutes of a plan always add up to it.
GOALS, QUESTION, COMPUTED, FIGURE, TASK, EXIT, OPEN = 2, 1.5, 1, 5, 6, 1.5, 2.5
WORDS = 60  # of prose, read or told, beside one another as 1


class Block(NamedTuple):
    """Some minutes of a chapter.

    begin  minutes after its begin, of those in class or of those at home
    cells  of the notebook
    """

    what: str
    who: str
    home: bool
    begin: int
    minutes: int
    cells: tuple[str, ...]


def plan(chapter: Chapter) -> list[Block]:
    """Share a chapter's minutes among its parts.

    ValueError where it has more parts than minutes.
    """
    blocks = list(_blocks(chapter))
    if len(blocks) > chapter.minutes:
        raise ValueError(f"{chapter.file} has {len(blocks)} parts in {chapter.minutes} minutes.")
    minutes = shared(chapter.minutes, [weight for *_, weight in blocks])
    clock, found = {False: 0, True: 0}, []
    for (what, who, home, cells, _), long in zip(blocks, minutes, strict=True):
        found.append(Block(what, who, home, clock[home], long, cells))
        clock[home] += long
    return found


def at_home(blocks: list[Block]) -> int:
    """Sum the minutes that need no class."""
    return sum(block.minutes for block in blocks if block.home)


def in_class(blocks: list[Block]) -> int:
    """Sum the minutes in class."""
    return sum(block.minutes for block in blocks if not block.home)


def shared(whole: int, weights: list[float]) -> list[int]:
    """Share whole minutes by weight: one to each at least."""
    left, total = whole - len(weights), sum(weights)
    exact = [left * weight / total for weight in weights]
    parts = [int(part) for part in exact]
    rest = sorted(range(len(parts)), key=lambda i: (parts[i] - exact[i], i))
    for i in rest[: left - sum(parts)]:
        parts[i] += 1
    return [part + 1 for part in parts]


Raw = tuple[str, str, bool, tuple[str, ...], float]


def _blocks(chapter: Chapter) -> Iterator[Raw]:
    yield "Goals, and what is needed", "you", False, ("title",), GOALS
    heading = chapter.title
    for kind, group in groupby(chapter.parts, key=type):
        parts: list[Part] = list(group)
        cells = tuple(dict.fromkeys(part.cell for part in parts))
        if kind is Told:
            prose = [part for part in parts if isinstance(part, Told)]
            heading = next((one.heading for one in reversed(prose) if one.heading), heading)
            words = sum(len(one.text.split()) for one in prose)
            yield f"{heading}: text and code", "you and the class", False, cells, words / WORDS
        else:
            yield _named(kind, parts, cells)


def _named(kind: type, parts: list[Part], cells: tuple[str, ...]) -> Raw:
    names = [f"`{part.key}`" for part in parts if isinstance(part, Posed | Stub | Exit)]
    told, n = ", ".join(names), len(parts)
    if kind is Posed:
        return f"Predict {told}", "each locks in an answer", False, cells, QUESTION * n
    if kind is Computed:
        return (
            "Compute, and compare with the answers",
            "you and the class",
            False,
            cells,
            COMPUTED * n,
        )
    if kind is ToTry:
        return "Figure: what the chapter says to try", "you, then each", False, cells, FIGURE * n
    if kind is Stub:
        return f"Exercise {told}", "each alone, with the check", True, cells, TASK * n
    if kind is Exit:
        return f"Exit question {told}", "each", False, cells, EXIT * n
    return "Open questions", "pairs, then all", False, cells, OPEN * n
