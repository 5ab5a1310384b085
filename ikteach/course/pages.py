"""A chapter as a page of HTML that needs no network: run, with pictures and MathML."""

import html
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import nbformat
from latex2mathml.converter import convert
from nbclient import NotebookClient
from nbconvert import HTMLExporter
from nbconvert.filters.highlight import Highlight2HTML
from nbconvert.filters.markdown_mistune import IPythonRenderer, MarkdownWithMath
from pygments.formatters import HtmlFormatter

WIDGET = "application/vnd.jupyter.widget-view+json"
STYLE = """
:root { color-scheme: light; }
body { font: 17px/1.55 system-ui, sans-serif; color: #16202a; background: #fff;
  max-width: 52rem; margin: 0 auto; padding: 1rem 1.2rem 4rem; }
h1, h2, h3 { line-height: 1.25; margin-top: 1.8em; }
h1 { margin-top: .6em; }
a { color: #00548a; }
nav { display: flex; justify-content: space-between; gap: 1rem; flex-wrap: wrap; }
img { max-width: 100%; height: auto; }
blockquote { margin: 1em 0; padding: .3em 1em; border-left: 4px solid #e69f00;
  background: #fdf6e6; }
.input { background: #f4f6f8; border-radius: 4px; padding: .1em .9em; margin-top: 1em; }
.output { margin: .2em 0 1em; overflow-x: auto; }
pre { font-size: 14px; line-height: 1.4; overflow-x: auto; margin: .6em 0; }
code { font-size: .92em; }
table { border-collapse: collapse; font-size: 14px; font-variant-numeric: tabular-nums; }
td, th { padding: 2px 9px; text-align: right; border-bottom: 1px solid #dde3e8; }
math[display=block] { margin: 1em 0; font-size: 1.15em; }
.anchor-link { display: none; }
"""


class MathML(IPythonRenderer):
    """Markdown whose formulas become MathML, which browsers set by themselves."""

    def block_math(self, body: str) -> str:
        """A formula on a line of its own."""
        return convert(body.strip(), display="block")

    def inline_math(self, body: str) -> str:
        """A formula in a sentence."""
        return convert(body.strip())

    def latex_environment(self, name: str, body: str) -> str:
        """An environment such as align."""
        return convert(rf"\begin{{{name}}}{body}\end{{{name}}}", display="block")


def page(path: Path, titles: Mapping[str, str]) -> str:
    """The page of the notebook at `path`, which is run in its own folder.
    nbclient's CellExecutionError if a cell fails.
    """
    notebook = nbformat.read(path, as_version=4)
    client = NotebookClient(
        notebook,
        timeout=300,
        resources={"metadata": {"path": path.parent}},
        extra_arguments=["--log-level=ERROR"],
        store_widget_state=False,
    )
    client.execute()
    (path.parent / "predictions.json").unlink(missing_ok=True)
    for cell in notebook.cells:
        for output in cell.get("outputs", []):
            _still(output)
    exporter = HTMLExporter(template_name="basic", exclude_input_prompt=True,
                            exclude_output_prompt=True)  # fmt: skip
    exporter.register_filter("markdown2html", _markdown)
    exporter.register_filter("highlight_code", _highlight)
    body, _ = exporter.from_notebook_node(notebook)
    nav = _nav(titles, path.name)
    return document(titles[path.name], f"{nav}\n<main>{body}</main>\n{nav}")


def _nav(titles: Mapping[str, str], name: str) -> str:
    """Links to the chapters before and after this one."""
    names = [None, *titles, None]
    here = names.index(name)
    before = _link(titles, names[here - 1], "← ")
    after = _link(titles, names[here + 1], "→ ")
    every = '<a href="index.html">All chapters</a>'
    return f'<nav aria-label="chapters">{before} {every} {after}</nav>'


def _link(titles: Mapping[str, str], name: str | None, arrow: str = "") -> str:
    if name is None:
        return "<span></span>"
    return f'<a href="{Path(name).with_suffix(".html")}">{arrow}{html.escape(titles[name])}</a>'


def index(titles: Mapping[str, str]) -> str:
    """The list of chapters."""
    rows = "".join(f"<li>{_link(titles, name)}</li>" for name in titles)
    text = "<p>To read. Live figures need a kernel: <code>python -m ikteach</code>.</p>"
    heading = "Inverse kinematics"
    return document(heading, f"<main><h1>{heading}</h1>{text}<ul>{rows}</ul></main>")


def document(title: str, body: str) -> str:
    """A whole page."""
    return (
        f'<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        f'<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f"<title>{html.escape(title)}</title>\n<style>{STYLE}{_colours()}</style>\n</head>\n"
        f"<body>\n{body}\n</body>\n</html>\n"
    )


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
    if "image/png" in data and "text/html" not in data:
        png = data["image/png"].strip()
        alt = html.escape(words, quote=True)
        data["text/html"] = f'<img alt="{alt}" src="data:image/png;base64,{png}">'
    elif live and "text/html" not in data:
        note = "A live figure stands here in the notebook."
        data["text/html"] = f"<p><em>{note}</em></p>"
