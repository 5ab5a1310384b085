"""What a reader is given: the path of a file, or its text."""

from pathlib import Path

from ikteach.checks import shown
from ikteach.files import bounded, quoted, read_bytes

MOST_JOINTS = 2000  # of a body that is read, as of one in a session's file


def content(source: str | Path, most: int, kind: str) -> bytes:
    """Read a file of at most `most` bytes, or take its text.

    A text of several lines, or one that begins with "<", is never taken for a path. ValueError,
    OSError say what is wrong with a file in one sentence.
    """
    if isinstance(source, str) and (len(source.splitlines()) > 1 or source.lstrip()[:1] == "<"):
        return source.encode(errors="replace")
    if not isinstance(source, str | Path):
        raise TypeError(f"a {kind} file is given by its path or its text, not {shown(source)}")
    if not str(source).strip():
        raise ValueError(f"this text is empty, and no {kind} file")
    try:
        return read_bytes(source, most)
    except ValueError as error:
        name = quoted(Path(source).name)
        raise ValueError(f"{name} is not read: {bounded(str(error))}") from None
