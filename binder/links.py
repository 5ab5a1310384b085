"""Links that open the course: on Binder, and on a class's own JupyterHub. Needs Python alone.

    python binder/links.py https://github.com/OWNER/REPOSITORY [--hub https://HUB] [--write]

prints them as Markdown; with --write it puts them into README.md, and the repository's address into
pyproject.toml and CITATION.cff, each between two marks. No address is written anywhere else.
"""

import argparse
import re
import sys
from collections.abc import Callable
from pathlib import Path
from urllib.parse import quote, urlencode, urlsplit

ROOT = Path(__file__).resolve().parents[1]
README, PROJECT, CITATION = (
    ROOT / name for name in ("README.md", "pyproject.toml", "CITATION.cff")
)
FIRST, LAST = "<!-- links by binder/links.py -->\n", "<!-- end of links -->\n"
PLAIN = "# links by binder/links.py\n", "# end of links\n"  # the marks where no HTML is read
BADGE = "https://mybinder.org/badge_logo.svg"
PROVIDERS = {"github.com": "gh", "gitlab.com": "gl"}  # Binder's short names


def chapters(root: Path = ROOT) -> dict[str, str]:
    """Chapter, such as "7 gait", -> what the server is asked for: its notebook in JupyterLab.

    What is no chapter, such as "prerequisites", comes before them.
    """
    names = [path.stem for path in (root / "notebooks").glob("*.ipynb")]
    return {
        re.sub(r"^0?(\d+)_", r"\1 ", name): f"lab/tree/notebooks/{name}.ipynb"
        for name in sorted(names, key=lambda name: (name[0].isdigit(), name))
    }


def lecture(root: Path = ROOT) -> dict[str, str]:
    """Page for a lecture, such as "race", -> what the server is asked for: the page by Voilà."""
    pages = root / "ikteach" / "serve" / "lecture" / "pages"
    return {
        path.stem: f"voila/render/{path.relative_to(root).as_posix()}"
        for path in sorted(pages.glob("*.ipynb"))
    }


def on_binder(address: str, page: str) -> str:
    """Make the link that has mybinder.org open a page of the repository."""
    host, path = repository(address)
    if host not in PROVIDERS:
        source = f"git/{quote(address, safe='')}"
    elif host == "gitlab.com":
        source = f"gl/{quote(path, safe='')}"
    else:
        source = f"gh/{path}"
    return f"https://mybinder.org/v2/{source}/HEAD?{urlencode({'urlpath': page})}"


def on_hub(hub: str, address: str, page: str) -> str:
    """Make the link that fetches the repository and opens a page.

    nbgitpuller does it, which the hub must have; what a student has changed it keeps.
    """
    if urlsplit(hub).scheme != "https" or not urlsplit(hub).netloc:
        raise ValueError(f"{hub!r} is not a hub's address, such as https://hub.example.edu")
    repository(address)
    return f"{hub.rstrip('/')}/hub/user-redirect/{pull(address, page)}"


def pull(address: str, page: str) -> str:
    """Make nbgitpuller's query; it names the folder by the address."""
    folder = address.rstrip("/").rpartition("/")[2].removesuffix(".git")
    application, way, path = page.split("/", 2)
    query = urlencode({"repo": address, "urlpath": f"{application}/{way}/{folder}/{path}"})
    return f"git-pull?{query}"


def repository(address: str) -> tuple[str, str]:
    """Split a repository's address into host and path, without `.git`."""
    parts = urlsplit(address)
    path = parts.path.strip("/").removesuffix(".git")
    if parts.scheme not in ("http", "https") or not parts.netloc or "/" not in path:
        wanted = "https://github.com/OWNER/REPOSITORY"
        raise ValueError(f"{address!r} is not a repository's address, such as {wanted}")
    return parts.netloc, path


def markdown(link: Callable[[str], str], start: str, root: Path = ROOT) -> str:
    """List the links to start, chapters and lecture, in three paragraphs."""
    pages = chapters(root)
    first = next(page for name, page in pages.items() if name[0].isdigit())
    rows = {"Chapters": pages, "For a lecture": lecture(root)}
    lines = [f"[{start}]({link(first)})"] + [
        f"{title}: " + " · ".join(f"[{name}]({link(page)})" for name, page in row.items())
        for title, row in rows.items()
    ]
    return "\n\n".join(lines) + "\n"


def urls(address: str) -> str:
    """List the addresses that a package index shows, as TOML."""
    repository(address)
    home = address.rstrip("/").removesuffix(".git")
    pages = {
        "Homepage": home,
        "Issues": f"{home}/issues",
        "Changelog": f"{home}/blob/HEAD/CHANGELOG.md",
    }
    return "".join(f'{name} = "{page}"\n' for name, page in pages.items())


def write(text: str, path: Path) -> None:
    """Put lines into a file between its marks; nothing else in it changes."""
    first, last = (FIRST, LAST) if path.suffix == ".md" else PLAIN
    before, first, rest = path.read_text(encoding="utf-8").partition(first)
    _, last, after = rest.partition(last)
    if not last:
        raise ValueError(f"{path} lacks the two marks between which the links go")
    path.write_text(f"{before}{first}{text}{last}{after}", encoding="utf-8")


def main(argv: list[str] | None = None) -> int:
    """Print the links, or write them into the README."""
    parser = argparse.ArgumentParser(description="Links that open the course without installing.")
    parser.add_argument("address", help="of the repository: https://github.com/OWNER/REPOSITORY")
    parser.add_argument("--hub", help="of your JupyterHub, which has this package and nbgitpuller")
    parser.add_argument("--write", action="store_true", help="write them into the files")
    options = parser.parse_args(argv)
    try:
        badge = f"![Open the course on Binder]({BADGE})"
        text = markdown(lambda page: on_binder(options.address, page), badge)
        if options.hub:
            start = f"**Open the course on {urlsplit(options.hub).netloc}**"
            text += "\n" + markdown(lambda page: on_hub(options.hub, options.address, page), start)
        if options.write:
            write(text, README)
            write(urls(options.address), PROJECT)
            write(f'repository-code: "{options.address}"\n', CITATION)
        else:
            print(text, end="")
    except ValueError as error:
        print(error, file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
