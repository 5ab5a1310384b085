"""A line on what goes on, which screen readers read out when it changes."""

import anywidget
import traitlets

from ikteach.view.widgets.closing import Living
from ikteach.view.widgets.page import script, style


class Status(Living, anywidget.AnyWidget):
    """A sentence on progress, and one on the last error."""

    _esm, _css = (
        script("view/widgets/status.js"),
        style("view/widgets/status.css", "view/widgets/layout.css"),
    )
    said = traitlets.Unicode("").tag(sync=True)
    wrong = traitlets.Unicode("").tag(sync=True)

    def say(self, words: str) -> None:
        """Tell of progress; an error of before is over."""
        with self.hold_sync():
            self.said, self.wrong = words, ""

    def fail(self, words: str) -> None:
        """Tell of an error."""
        with self.hold_sync():
            self.said, self.wrong = "", words
