"""How Sphinx makes the site: all that would stand in a `conf.py`, and formulas as MathML."""

from typing import Any

from docutils import nodes
from latex2mathml.converter import convert
from sphinx.application import Sphinx

from ikteach import __version__
from ikteach.publish.docs.docstrings import restructured

SETTINGS: dict[str, Any] = {
    "project": "ikteach",
    "author": "the ikteach authors",
    "copyright": "the ikteach authors. Prose and notebooks CC BY 4.0, code MIT",
    "version": __version__,
    "release": __version__,
    "extensions": [
        "myst_nb",
        "sphinx.ext.autodoc",
        "sphinx.ext.autosummary",
        "ikteach.publish.docs.settings",
    ],
    "html_theme": "furo",
    "html_title": f"ikteach {__version__}",
    "html_math_renderer": "mathml",  # set by the browser itself; MathJax would be of a network
    "html_copy_source": False,
    "html_show_sphinx": False,
    "nb_execution_mode": "off",  # `pages.executed` has run them, and put stills for what is live
    "myst_enable_extensions": ["amsmath", "dollarmath"],
    "myst_heading_anchors": 4,
    "autosummary_generate": False,
    "autodoc_member_order": "bysource",
    "autodoc_preserve_defaults": True,
    "python_use_unqualified_type_names": True,
    "add_module_names": False,
}


def setup(app: Sphinx) -> dict[str, bool]:
    """Tell Sphinx of our formulas and docstrings."""
    app.add_html_math_renderer("mathml", (_inline, None), (_block, None))
    app.connect("autodoc-process-docstring", _docstring)
    return {"parallel_read_safe": True, "parallel_write_safe": True}


def _inline(page: Any, node: nodes.math) -> None:
    page.body.append(convert(node.astext().strip()))
    raise nodes.SkipNode


def _block(page: Any, node: nodes.math_block) -> None:
    page.body.append(convert(node.astext().strip(), display="block"))
    raise nodes.SkipNode


def _docstring(app: Sphinx, what: str, name: str, it: Any, options: Any, lines: list[str]) -> None:
    lines[:] = restructured(lines)
