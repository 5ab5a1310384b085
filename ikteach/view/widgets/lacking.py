"""Sentences on what a front end lacks, and how to mend it, where the figure would be.

Three may say it, by how far the page comes: the driver (driver.js), if the page has anywidget;
a `Note` under the figure, if it has ipywidgets; else the output of the cell as HTML.
"""

from importlib.metadata import version
from typing import Any

from ikteach.markup import Markup
from ikteach.view.widgets.page import style_tag
from ikteach.view.widgets.picture import Still
from ikteach.view.widgets.prose import Prose

PYTHREEJS = f"pythreejs=={version('pythreejs')}"  # the page needs what the kernel has
WHERE = (
    "in the environment from which Jupyter itself was started (this notebook may run in another), "
    "then reload this page and run the cell again"
)
PICTURES = "Until then pictures follow it."
LACKING = {
    "pythreejs": f"The figure cannot be shown in 3-D: the server of this page lacks pythreejs. Run "
    f"pip install {PYTHREEJS} {WHERE}. {PICTURES}",
    "webgl": "The figure cannot be shown in 3-D: this browser has no WebGL. Switch on hardware "
    "acceleration in its settings, or take another browser, then reload this page. "
    f"{PICTURES}",
}
WIDGETS = Markup(
    "This is a still picture: the server of this page lacks what shows the live figure. If it is "
    "that of JupyterLab, Jupyter Notebook or Voilà, run "
    "<code>pip install ipywidgets anywidget {}</code> {}. Elsewhere (marimo, GitHub, a printed "
    "page) there are pictures only: <code>python -m ikteach</code> opens JupyterLab."
).format(PYTHREEJS, WHERE)

# It stays unseen for so long as our scripts may still come, and for good when they have.
STYLE = style_tag("view/widgets/lacking.css")


class Note:
    """A picture, for a page that cannot run our scripts.

    It says why it does not move. `widget` is to be put among the widgets that it stands in for.
    """

    def __init__(self) -> None:
        self.widget = Prose()
        self.widget.add_class("ikteach-note")

    def beside(self, bundle: dict[str, Any], still: Still) -> dict[str, Any]:
        """Add the still picture to the output of a cell.

        This note is among the widgets of the cell.
        """
        words = in_place_of(still)
        self.widget.value = STYLE + words
        picture = {"image/png": still.png} if still.png else {}
        return {**bundle, **picture, "text/html": str(words), "text/plain": still.alt}


def in_place_of(still: Still) -> Markup:
    """Show the picture, and say why it does not move."""
    box = (
        '<div class="ikteach-still" style="line-height:1.4"><p style="border-left:4px solid '
        '#d55e00;padding:4px 10px;margin:4px 0">{}</p>{}</div>'
    )
    return Markup(box).format(WIDGETS, Markup(still._repr_html_() if still.png else ""))
