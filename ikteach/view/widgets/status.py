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
    came = traitlets.Int(0).tag(sync=True)
    with_all = traitlets.Bool(False).tag(sync=True)

    def come(self, *, with_all: bool = False) -> None:
        """Bring this line into view, once somebody has opened it.

        with_all  all that stands with it, too
        """
        with self.hold_sync():
            self.came, self.with_all = self.came + 1, with_all

    def say(self, words: str) -> None:
        """Tell of progress; an error of before is over."""
        with self.hold_sync():
            self.said, self.wrong = words, ""

    def fail(self, words: str) -> None:
        """Tell of an error."""
        with self.hold_sync():
            self.said, self.wrong = "", words
