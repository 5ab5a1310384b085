"""A chapter as a page of HTML that needs no network: run, with pictures and MathML."""

import re
from collections.abc import Mapping
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import nbformat
from latex2mathml.converter import convert
from nbclient import NotebookClient
from nbclient.util import run_sync
from nbconvert import HTMLExporter
from nbconvert.filters.highlight import Highlight2HTML
from nbconvert.filters.markdown_mistune import IPythonRenderer, MarkdownWithMath
from pygments.formatters import HtmlFormatter

from ikteach.markup import Markup

WIDGET = "application/vnd.jupyter.widget-view+json"
PAGE_STYLE = (Path(__file__).parent / "pages.css").read_text("utf-8")


class MathML(IPythonRenderer):
    """Markdown whose formulas become MathML, which browsers set by themselves."""

    def block_math(self, body: str) -> str:
        """Set a formula on a line of its own."""
        return convert(body.strip(), display="block")

    def inline_math(self, body: str) -> str:
        """Set a formula in a sentence."""
        return convert(body.strip())

    def latex_environment(self, name: str, body: str) -> str:
        """Set an environment such as align."""
        return convert(rf"\begin{{{name}}}{body}\end{{{name}}}", display="block")


def runner(notebook: Any, folder: Path, **options: Any) -> NotebookClient:
    """Make a client that runs a notebook in `folder`."""
    resources = {"metadata": {"path": str(folder)}}
    quiet = ["--log-level=ERROR"]  # not the news that a kernel listens on this machine
    return NotebookClient(notebook, resources=resources, extra_arguments=quiet, **options)


async def executed(path: Path) -> Any:
    """Run the notebook at `path`, with stills for live outputs.

    It runs in an empty folder. nbclient's CellExecutionError if a cell fails.
    """
    notebook = nbformat.read(path, as_version=4)
    with TemporaryDirectory() as folder:
        client = runner(notebook, Path(folder), timeout=300, store_widget_state=False)
        await client.async_execute()
    for cell in notebook.cells:
        for output in cell.get("outputs", []):
            _still(output)
    return notebook


def page(path: Path, titles: Mapping[str, str]) -> str:
    """Run the notebook at `path`, and make its page; as `executed`."""
    notebook = run_sync(executed)(path)  # also where a loop runs already
    exporter = HTMLExporter(
        template_name="basic", exclude_input_prompt=True, exclude_output_prompt=True
    )
    exporter.register_filter("markdown2html", _markdown)
    exporter.register_filter("highlight_code", _highlight)
    body, _ = exporter.from_notebook_node(notebook)
    nav = _nav(titles, path.name)
    whole = Markup("{0}\n<main>{1}</main>\n{0}").format(nav, Markup(body))
    return document(titles[path.name], whole)


def _nav(titles: Mapping[str, str], name: str) -> Markup:
    """Links to the chapters before and after this one."""
    names = [None, *titles, None]
    here = names.index(name)
    before = _link(titles, names[here - 1], "← ")
    after = _link(titles, names[here + 1], "→ ")
    every = Markup('<a href="index.html">All chapters</a>')
    return Markup('<nav aria-label="chapters">{} {} {}</nav>').format(before, every, after)


def _link(titles: Mapping[str, str], name: str | None, arrow: str = "") -> Markup:
    if name is None:
        return Markup("<span></span>")
    page = Path(name).with_suffix(".html")
    return Markup('<a href="{}">{}{}</a>').format(page, arrow, titles[name])


def index(titles: Mapping[str, str]) -> str:
    """Make the page that lists the chapters."""
    rows = Markup().join(Markup("<li>{}</li>").format(_link(titles, name)) for name in titles)
    text = Markup("<p>To read. Live figures need a kernel: <code>python -m ikteach</code>.</p>")
    heading = "Inverse kinematics"
    body = Markup("<main><h1>{}</h1>{}<ul>{}</ul></main>").format(heading, text, rows)
    return document(heading, body)


def document(title: str, body: Markup) -> Markup:
    """Make a whole page."""
    return Markup(
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        "<title>{}</title>\n<style>{}{}</style>\n</head>\n<body>\n{}\n</body>\n</html>\n"
    ).format(title, Markup(PAGE_STYLE), Markup(_colours()), body)


def _colours() -> str:
    return str(HtmlFormatter(style="tango", nobackground=True).get_style_defs(".highlight"))


def _markdown(context: Any, source: str = "", **_: Any) -> str:
    return str(MarkdownWithMath(renderer=MathML(escape=False)).render(source or context))


def _highlight(source: str, **_: Any) -> str:
    return str(Highlight2HTML(pygments_lexer="python")(source))


def _still(output: Any) -> None:
    """Put a picture or words in place of what needs a kernel; a picture has its words with it."""
    data = output.get("data", {})
    words = re.sub(r"\s+", " ", str(data.get("text/plain", "")))
    live = data.pop(WIDGET, None) is not None
    if "image/png" in data and (live or "text/html" not in data):
        png = data["image/png"].strip()
        data["text/html"] = Markup('<img alt="{}" src="data:image/png;base64,{}">').format(
            words, png
        )
    elif live and "text/html" not in data:
        data["text/html"] = "<p><em>A live figure stands here in the notebook.</em></p>"
