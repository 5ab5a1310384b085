"""Pictures of live figures, as a chapter sets them: drawn by the figures themselves."""

from collections.abc import Mapping
from typing import Any

from ikteach.course.tries import put
from ikteach.view.widgets.picture import Still

TICKS = 45  # that pass before the picture, where time passes in a figure


def still(figure: Any, setting: Mapping[str, Any]) -> Still:
    """Set a live figure, let some time pass, and draw it."""
    put(figure, setting)
    session = getattr(figure, "session", None) or getattr(
        getattr(figure, "player", None), "session", None
    )
    if session is not None:
        for _ in range(TICKS):
            session.tick()
    drawn: Still = figure.still()
    return drawn
