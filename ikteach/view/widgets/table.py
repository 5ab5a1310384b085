"""A table of which one row is chosen, by pointing or with the keyboard."""

from typing import Any

import anywidget
import traitlets

from ikteach.view.widgets.closing import Living
from ikteach.view.widgets.page import script, style


class Rows(Living, anywidget.AnyWidget):
    """A table of rows, chosen by click or arrow keys.

    header, rows  words; chosen: the number of the chosen row; label: what the rows are
    """

    _esm, _css = script("view/widgets/table.js"), style("view/widgets/table.css")
    label = traitlets.Unicode("ticks of the run").tag(sync=True)
    header: Any = traitlets.List().tag(sync=True)
    rows: Any = traitlets.List().tag(sync=True)
    chosen = traitlets.Int(0).tag(sync=True)
