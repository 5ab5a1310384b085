"""A plot that is drawn many times a second."""

import numpy as np
from matplotlib.artist import Artist
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from ikteach.view.widgets.picture import as_png

FEW = 48  # colours of such a picture


class Canvas:
    """A figure that redraws only its `moving` artists.

    The rest stays as it was.
    """

    def __init__(self, figure: Figure, moving: list[Artist]) -> None:
        self._moving, self._canvas = moving, FigureCanvasAgg(figure)
        for artist in moving:
            artist.set_animated(True)
        self._canvas.draw()
        self._still = self._canvas.copy_from_bbox(figure.bbox)

    def png(self) -> bytes:
        """Draw the figure as it is now, as PNG."""
        self._canvas.restore_region(self._still)
        for artist in self._moving:
            artist.axes.draw_artist(artist)  # type: ignore[union-attr]
        return as_png(np.asarray(self._canvas.buffer_rgba()), FEW)
