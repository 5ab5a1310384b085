"""The JavaScript modules of our widgets, each made of the scripts in this folder."""

from pathlib import Path

HERE = Path(__file__).parent


def esm(*names: str) -> str:
    """Join `page.js`, what all widgets share, and the scripts of these names to one module."""
    return "".join((HERE / f"{name}.js").read_text(encoding="utf-8") for name in ("page", *names))
