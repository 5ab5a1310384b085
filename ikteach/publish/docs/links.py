"""Links of a folder of pages: what they lead to is there, and nothing is fetched from elsewhere."""

from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

LOADED = {"src", "srcset", "poster"}  # fetched when the page is opened, not when it is asked for


class Links(HTMLParser):
    """The links, loads and anchors of one page."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.links: set[str] = set()
        self.loads: set[str] = set()
        self.anchors: set[str] = {""}
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Note where a tag leads, and what it is called."""
        for name, value in attrs:
            if name in LOADED or (name, tag) == ("href", "link"):
                self.loads.add(value or "")
            elif name == "href":
                self.links.add(value or "")
            elif name == "id" or (name, tag) == ("name", "a"):
                self.anchors.add(value or "")


def broken(folder: Path) -> list[str]:
    """List links that lead nowhere, and loads from elsewhere."""
    pages = {path: Links(path.read_text("utf-8")) for path in sorted(folder.rglob("*.html"))}
    found = []
    for path, page in pages.items():
        here = path.relative_to(folder).as_posix()
        for link in sorted(page.links | page.loads):
            parts = urlsplit(link)
            if parts.scheme or parts.netloc:
                if link in page.loads and parts.scheme != "data":
                    found.append(f"{here}: {link} is of a network")
                continue
            there = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            if not there.is_relative_to(folder.resolve()) or not there.exists():
                found.append(f"{here}: {link} is not there")
            elif there in pages and unquote(parts.fragment) not in pages[there].anchors:
                found.append(f"{here}: {link} has no such place")
    return found
