"""The JavaScript modules of our widgets, each made of the scripts of its room."""

from pathlib import Path

VIEW = Path(__file__).parents[1]


def esm(*names: str) -> str:
    """Join `page.js`, what all widgets share, and the scripts of these names to one module."""
    return "".join(script(name) for name in ("page", *names))


def script(name: str) -> str:
    """Read the one script of that name, in whichever room it lies."""
    (path,) = VIEW.rglob(f"{name}.js")
    return path.read_text(encoding="utf-8")
