"""Text of the course as HTML, with formulas as MathML and pictures inside."""

import base64
import re
from collections.abc import Iterable, Sequence
from pathlib import Path

from nbconvert.filters.markdown_mistune import MarkdownWithMath

from ikteach.markup import Markup
from ikteach.publish.pages import MathML

ANCHOR = re.compile(r'<a class="anchor-link".*?</a>')  # of a heading, for pages with links
PICTURE = re.compile(r'src="(pictures/[\w.-]+)"')
KINDS = {".svg": "svg+xml", ".png": "png"}


def rendered(text: str, pictures: Path | None = None) -> Markup:
    """Render Markdown; `pictures` is the folder whose pictures it shows."""
    html = ANCHOR.sub("", MarkdownWithMath(renderer=MathML(escape=False)).render(text))

    def inside(found: re.Match[str]) -> str:
        assert pictures is not None
        path = pictures / found[1]
        return f'src="{inlined(path.read_bytes(), KINDS[path.suffix])}"'

    return Markup(PICTURE.sub(inside, html) if pictures else html)


def in_line(text: str) -> Markup:
    """Render Markdown of one paragraph, without the paragraph."""
    return Markup(str(rendered(text)).strip().removeprefix("<p>").removesuffix("</p>"))


def inlined(data: bytes, kind: str = "png") -> Markup:
    """Return a picture as an address that holds it."""
    return Markup(f"data:image/{kind};base64,{base64.b64encode(data).decode()}")


def as_list(items: Iterable[Markup], kind: str = "ul") -> Markup:
    """Make a list."""
    rows = Markup().join(Markup("<li>{}</li>").format(item) for item in items)
    return Markup("<{0}>{1}</{0}>").format(Markup(kind), rows)


def as_table(heads: Sequence[str], rows: Iterable[Sequence[object]], caption: str = "") -> Markup:
    """Make a table; what is no Markup is shown as text."""
    head = Markup().join(Markup('<th scope="col">{}</th>').format(name) for name in heads)
    body = Markup().join(
        Markup("<tr>{}</tr>").format(Markup().join(map(Markup("<td>{}</td>").format, row)))
        for row in rows
    )
    told = Markup("<caption>{}</caption>").format(caption) if caption else Markup()
    return Markup("<table>{}<thead><tr>{}</tr></thead><tbody>{}</tbody></table>").format(
        told, head, body
    )
