"""Our docstrings, which are plain text, as the reStructuredText that Sphinx reads.

A docstring is made of blocks between empty lines: a sentence, an example after `>>>`, a table of
`name   meaning`, or lines that stand as they are, such as a formula or a command.
"""

import re
from collections.abc import Iterator, Sequence
from itertools import groupby

ROW = re.compile(r"(?P<name>\S(?:.*?\S)?) {2,}(?P<meaning>\S.*)")
MARK = re.compile(r"(?P<code>`[^`]+`)|[\\*_|`]")


def restructured(lines: Sequence[str]) -> list[str]:
    """Rewrite a docstring's lines as reStructuredText."""
    blocks = groupby(lines, key=lambda line: bool(line.strip()))
    return [line for full, block in blocks if full for line in [*_block(list(block)), ""]]


def _block(lines: list[str]) -> Iterator[str]:
    if lines[0].startswith(">>>"):
        yield from lines
    elif ROW.fullmatch(lines[0]):
        yield from _table(lines)
    elif any(line.startswith(" ") for line in lines):
        yield from ["::", "", *(f"    {line}" for line in lines)]
    else:
        yield from map(prose, lines)


def _table(lines: list[str]) -> Iterator[str]:
    """Each row as a definition; a line that is no row goes on with the one before."""
    for line in lines:
        if row := ROW.fullmatch(line):
            yield from [f"``{row['name']}``", f"    {prose(row['meaning'])}"]
        else:
            yield f"    {prose(line.strip())}"


def prose(line: str) -> str:
    """Mark code; escape what would be marks of reStructuredText."""
    return MARK.sub(lambda m: rf"\ `{m[0]}`\ " if m["code"] else rf"\{m[0]}", line)
