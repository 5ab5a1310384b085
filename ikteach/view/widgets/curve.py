"""A plot in which one place is chosen, by pointing or with the keyboard."""

from typing import Any

import anywidget
import traitlets

from ikteach.view.widgets.closing import Living
from ikteach.view.widgets.page import script, style


class Curve(Living, anywidget.AnyWidget):
    """A picture of curves with a line at the chosen place.

    A click or the arrow keys move the line.

    png, alt  the picture, and the same in words
    span      where its axis begins and ends across the picture, 0..1
    places    where each thing lies on the axis, 0..1
    labels    the name of each
    chosen    the number of the chosen one
    """

    _esm, _css = script("view/widgets/curve.js"), style("view/widgets/curve.css")
    png = traitlets.Bytes(b"").tag(sync=True)
    alt = traitlets.Unicode("").tag(sync=True)
    span = traitlets.List([0.0, 1.0]).tag(sync=True)
    places: Any = traitlets.List().tag(sync=True)
    labels: Any = traitlets.List().tag(sync=True)
    chosen = traitlets.Int(0).tag(sync=True)
