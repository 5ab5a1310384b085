"""Which views of a stage are shown at once, and how they share a picture."""

from ikteach.names import unknown
from ikteach.view.stage.stage import Stage

FREE = "free"  # the view that looks from wherever it is put
VIEWS = {1: (FREE,), 2: (FREE, "side"), 4: (FREE, "front", "side", "top")}


def views_of(stage: Stage) -> dict[int, tuple[str, ...]]:
    """Name the views by how many are shown at once.

    A planar figure has one.
    """
    return {1: VIEWS[1]} if stage.planar else VIEWS


def checked_views(stage: Stage, count: int) -> int:
    """Return how many views there are to be.

    ValueError if there are none so many.
    """
    known = views_of(stage)
    if isinstance(count, bool) or count not in known:
        raise ValueError(unknown("number of views", str(count), [str(one) for one in known]))
    return int(count)


def needed(stage: Stage, aspect: float) -> float:
    """Return width over height of what every view must show.

    It is that of the picture, where figures stand side by side; the ball of all poses of one figure
    is as wide as high.
    """
    beside = len(stage) > 1 and not stage.overlaid
    return aspect if beside else min(aspect, 1.0)


def tiles(count: int, aspect: float, least: float) -> tuple[int, int]:
    """Choose columns and rows for the views of a picture.

    It is done as in panes.js. Two stand beside or below each other, so that what must be seen is
    the larger; it is `least` times as wide as high.
    """

    def size(columns: int) -> float:
        rows = count // columns
        return min(1 / rows, aspect / columns / least)

    columns = max((2, 1), key=size) if count == 2 else round(count**0.5)
    return columns, count // columns
