"""HTML in the page, and tables of numbers as HTML. Names in them never become markup."""

from collections.abc import Iterable, Sequence
from typing import Any

import ipywidgets as widgets
import pandas as pd
import traitlets

from ikteach.markup import Markup, escaped, minus, plain, untouched
from ikteach.view.widgets.closing import Living


class Prose(Living, widgets.HTML):  # type: ignore[misc]
    """A piece of HTML.

    A `value` that is not `Markup` is text, and is shown as it is.
    """

    @traitlets.validate("value")
    def _safe(self, proposal: Any) -> Markup:
        return untouched(escaped(proposal["value"])) if proposal["value"] else Markup()


def table(frame: pd.DataFrame, decimals: str, *, kind: str = "ikteach-table") -> Markup:
    """Write a table as HTML, each number in the format `decimals`."""
    shown = frame.rename(index=_plain, columns=_plain).rename_axis(index=None, columns=None)

    def number(value: float) -> str:
        return minus(decimals.format(value))

    made = shown.to_html(float_format=number, na_rep="–", border=0, classes=kind)
    return Markup(made.replace("<th></th>", "<td></td>"))  # a corner is the head of nothing


def grid(heads: Sequence[object], rows: Iterable[Sequence[object]], title: str = "") -> Markup:
    """Write rows of words as a table.

    The first column names the rows.
    """
    head, first, cell = map(Markup, ("<th>{}</th>", '<th scope="row">{}</th>', "<td>{}</td>"))
    nothing = Markup()
    body = nothing.join(
        Markup("<tr>{}{}</tr>").format(
            first.format(name), nothing.join(cell.format(value) for value in row)
        )
        for name, *row in rows
    )
    return Markup(
        '<table class="ikteach-table">{}<thead><tr>{}</tr></thead><tbody>{}</tbody></table>'
    ).format(
        Markup("<caption>{}</caption>").format(title) if title else nothing,
        nothing.join(head.format(name) if name else Markup("<td></td>") for name in heads),
        body,
    )


def _plain(name: Any) -> Any:
    return plain(name) if isinstance(name, str) else name
