"""A picture made in the kernel, with words for those who cannot see it."""

import base64
import io
from dataclasses import dataclass, field
from typing import Any

import anywidget
import traitlets
from matplotlib.figure import Figure
from numpy.typing import NDArray

from ikteach.markup import Markup
from ikteach.view.widgets.closing import Living
from ikteach.view.widgets.page import script, style


class Picture(Living, anywidget.AnyWidget):
    """A PNG and its text alternative.

    Both can change at any time.
    """

    _esm, _css = script("view/widgets/picture.js"), style("view/widgets/picture.css")
    png = traitlets.Bytes(b"").tag(sync=True)
    alt = traitlets.Unicode("").tag(sync=True)


@dataclass(frozen=True)
class Still:
    """A PNG with its text alternative, for a cell's output.

    It needs no kernel to be seen.

    chart  it is on white paper, and is turned dark in a dark page
    """

    png: bytes = field(repr=False)
    alt: str
    chart: bool = field(default=False, repr=False)

    def _repr_html_(self) -> str:
        data = base64.b64encode(self.png).decode()
        return Markup(
            '<img alt="{}" class="{}" style="max-width:100%" src="data:image/png;base64,{}">'
        ).format(self.alt, "ikteach-chart" if self.chart else "", data)


def png_of(figure: Figure) -> bytes:
    """Draw a figure of matplotlib as PNG."""
    out = io.BytesIO()
    figure.savefig(out, format="png")
    return out.getvalue()


def as_png(pixels: NDArray[Any], colours: int | None = None) -> bytes:
    """Write RGB or RGBA pixels (h, w, 3 or 4) as PNG.

    colours  of a palette: with 48 of them the file takes a third of the bytes and half of the time
    """
    from PIL import Image  # comes with matplotlib

    image, out = Image.fromarray(pixels[..., :3]), io.BytesIO()
    if colours is not None:
        image = image.quantize(colours, method=Image.Quantize.FASTOCTREE, dither=Image.Dither.NONE)
    image.save(out, "PNG", compress_level=1)
    return out.getvalue()
