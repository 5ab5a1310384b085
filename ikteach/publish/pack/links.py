"""Addresses that open a live figure in a state."""

import json
import re
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any
from urllib.parse import quote, urlencode

from ikteach.markup import Markup

LECTURE = Path(__file__).parents[2] / "serve" / "lecture" / "pages"
SERVERS = {"lecture": "http://127.0.0.1:8866/", "lab": "http://127.0.0.1:8888/"}  # as they start


def link(figure: Any, notebook: str, setting: Mapping[str, Any], words: Markup) -> Markup:
    """Link to a figure in a state.

    In the lecture, or where no page shows it to its notebook.

    A notebook is opened as it is; its buttons do the same.
    """
    page = lecture_page(type(figure).__name__)
    server, place = (
        ("lecture", f"voila/render/{page}?{query(setting)}")
        if page
        else (
            "lab",
            f"lab/tree/{quote(notebook)}",
        )
    )
    return Markup('<a data-at="{0}" data-to="{1}" href="{2}{1}" target="{0}">{3}</a>').format(
        server, place, SERVERS[server], words
    )


def query(setting: Mapping[str, Any]) -> str:
    """Write a state as an address has it: `method=sdls&motion=running`."""
    pairs = {name: _written(value) for name, value in setting.items()}
    return urlencode(pairs, safe=",", quote_via=quote)


def _written(value: Any) -> str:
    if isinstance(value, bool):
        return "on" if value else "off"
    return ",".join(map(str, value)) if isinstance(value, list | tuple) else str(value)


@cache
def lecture_page(kind: str) -> str | None:
    """Return the page of the lecture that shows such a figure."""
    for page in sorted(LECTURE.glob("*.ipynb")):
        cells = json.loads(page.read_text("utf-8"))["cells"]
        code = "".join("".join(c["source"]) for c in cells if c["cell_type"] == "code").lower()
        if re.search(rf"\b{kind.lower()}\(\)", code):
            return page.name
    return None
