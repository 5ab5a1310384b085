"""The one layout of live figures: a picture, and its controls and numbers where there is room."""

from collections.abc import Sequence

import ipywidgets as widgets

Parts = Sequence[widgets.Widget]


class Arranged(widgets.Box):  # type: ignore[misc]
    """A picture first, with controls and numbers beside or below it.

    They stand beside it where there is room, and below it where there is none; layout.css does it,
    by the width that the page gives.

    seen    the picture, and what belongs under it
    beside  controls and numbers, one under the other
    wide    the picture is much wider than high, and needs more room for that
    chart   the picture is a chart, which cannot shrink: all else stands below it
    """

    def __init__(
        self, seen: Parts, beside: Parts, *, wide: bool = False, chart: bool = False
    ) -> None:
        self.seen, self.beside = widgets.VBox([*seen]), widgets.VBox([*beside])
        self.seen.add_class("ikteach-seen")
        self.beside.add_class("ikteach-beside")
        super().__init__([self.seen, self.beside])
        self.add_class("ikteach-arranged")
        for name, on in (("ikteach-wide", wide), ("ikteach-chart-above", chart)):
            if on:
                self.add_class(name)
