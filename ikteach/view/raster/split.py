"""A picture of a stage from one side, or from several at once."""

from collections.abc import Sequence

from PIL import Image, ImageDraw

from ikteach.view.raster.drawing import Drawing, font
from ikteach.view.stage.colours import paper
from ikteach.view.stage.layer import Layer
from ikteach.view.stage.stage import Now, Stage
from ikteach.view.stage.views import FREE, checked_views, needed, tiles, views_of


class Split:
    """A picture of a stage, in one view or several.

    The first looks from any side.

    size   (width, height) of the picture [pixels]
    count  how many views there are; may be set
    names  of the views
    """

    def __init__(self, stage: Stage, size: tuple[int, int]) -> None:
        self.stage, self.size = stage, size
        self._count, self._side = 1, stage.side
        self._drawings: dict[tuple[int, int], dict[str, Drawing]] = {}

    @property
    def count(self) -> int:
        """Tell how many views there are; may be set, ValueError."""
        return self._count

    @count.setter
    def count(self, count: int) -> None:
        self._count = checked_views(self.stage, count)

    @property
    def names(self) -> tuple[str, ...]:
        """Name the views, the free one first."""
        return views_of(self.stage)[self._count]

    def look_from(self, side: str) -> None:
        """Put the first view to a named side.

        LookupError for an unknown one.
        """
        self.stage.eye(side, 1.0)
        self._side = side
        for drawings in self._drawings.values():
            if FREE in drawings:
                drawings[FREE].look_from(side)

    def picture(self, layers: Sequence[Layer], now: Now, dark: bool = False) -> Image.Image:
        """Draw one moment of these layers."""
        (width, height), looks = self.size, paper(dark)
        columns, rows = tiles(self._count, width / height, needed(self.stage, width / height))
        pane = width // columns, height // rows
        if self._count == 1:
            return self._drawing(FREE, pane).picture(layers, now, dark)
        image = Image.new("RGB", self.size, looks.middle)
        for i, name in enumerate(self.names):
            left, top = pane[0] * (i % columns), pane[1] * (i // columns)
            one = self._drawing(name, pane).picture(layers, now, dark)
            image.paste(one.crop((0, 0, pane[0] - 1, pane[1] - 1)), (left, top))
            pen = ImageDraw.Draw(image)
            pen.text((left + 6, top + 4), name, fill=looks.ink, font=font(13))
        return image

    def _drawing(self, name: str, pane: tuple[int, int]) -> Drawing:
        """Give the drawing of a view, which keeps what it knows of the layers."""
        known = self._drawings.setdefault(pane, {})
        if name not in known:
            known[name] = Drawing(self.stage, pane, self._side if name == FREE else name)
        return known[name]
