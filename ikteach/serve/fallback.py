"""What a notebook shows of its figures when it is opened and no kernel holds them any more.

JupyterLab prefers the live view of an output to its picture, and says "model not found" where that
view's kernel has ended or was started anew. So a notebook is handed out without such views: what
the figure itself has left beside them, a still picture, stands there, and what to run.
"""

import re
from collections.abc import Container, Mapping
from typing import Any

from ikteach.markup import Markup

VIEW = "application/vnd.jupyter.widget-view+json"
STATE = "application/vnd.jupyter.widget-state+json"
WHY = re.compile(r'(?<=<div class="ikteach-still" style="line-height:1.4">)<p\b.*?</p>', re.DOTALL)
AGAIN = Markup(
    '<p style="border-left:4px solid #0072b2;padding:4px 10px;margin:4px 0">{} To have it again, '
    "run the cell above (Shift + Enter), or all of them: Run ▸ Run All Cells.</p>"
)
STILL = AGAIN.format("This is as it stood when its cell was run; the kernel has ended since.")
NOTHING = AGAIN.format("What stood here has ended with its kernel.")


def without_dead_views(notebook: Mapping[str, Any], living: Container[str] = ()) -> None:
    """Put stills in the place of a notebook's live views.

    living  the widgets that a kernel still has, by `model_id`: their views stay

    A notebook that has kept the state of its widgets stays as it is.
    """
    if STATE in notebook.get("metadata", {}).get("widgets", {}):
        return
    for cell in notebook.get("cells", ()):
        for output in cell.get("outputs", ()):
            data = output.get("data", {})
            if VIEW in data and data[VIEW].get("model_id") not in living:
                del data[VIEW]
                data["text/html"] = _still("".join(data.get("text/html", "")))
                data.pop("image/png", None)  # it is in the HTML, and would be shown instead of it


def _still(html: str) -> str:
    """Put what to do into what a figure has left beside its view."""
    return WHY.sub("", f"{STILL}{html}") if html else NOTHING
