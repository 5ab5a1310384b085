"""A picture made in the kernel, with words for those who cannot see it."""

import base64
from dataclasses import dataclass, field

import anywidget
import traitlets

from ikteach.markup import Markup
from ikteach.view.widgets.closing import Living
from ikteach.view.widgets.page import script, style


class Picture(Living, anywidget.AnyWidget):
    """A PNG and its text alternative; both can change at any time."""

    _esm, _css = script("view/widgets/picture.js"), style("view/widgets/picture.css")
    png = traitlets.Bytes(b"").tag(sync=True)
    alt = traitlets.Unicode("").tag(sync=True)


@dataclass(frozen=True)
class Still:
    """A PNG with its text alternative, for the output of a cell; it needs no kernel to be seen."""

    png: bytes = field(repr=False)
    alt: str

    def _repr_html_(self) -> str:
        data = base64.b64encode(self.png).decode()
        return Markup(
            '<img alt="{}" style="max-width:100%" src="data:image/png;base64,{}">'
        ).format(self.alt, data)
