"""Curves that run along with a session: distances and jitter of the last seconds.

They are drawn in the page. The kernel sends numbers, a few hundred bytes ten times a second, so
that the figure does not wait for a picture of a plot to be made.
"""

from itertools import takewhile
from typing import Any

import anywidget
import numpy as np
import traitlets

from ikteach.motion.live.log import Log
from ikteach.motion.live.session import Session
from ikteach.view.stage.colours import effector_colour
from ikteach.view.stage.lengths import Lengths, decade
from ikteach.view.widgets.closing import Living
from ikteach.view.widgets.page import script, style

EVERY = 3  # ticks from one message to the next: 10 a second at 30 ticks a second
SECONDS = 10.0
DASHES: tuple[list[int], ...] = ([], [7, 3], [2, 3], [9, 3, 2, 3], [5, 5], [1, 2])
DISTANCE, JITTER = [1e-4, 3.0], [1e-3, 100.0]  # [m] and [degrees], the ranges of the axes


class Strips(Living, anywidget.AnyWidget):
    """Three plots over the last seconds, on logarithmic axes.

    The distance of each effector of the shown method to its target, the mean distance of each
    method, and each method's jitter, ‖Δ²θ‖ per tick. Lines differ in dashes as well as in colour.
    """

    _esm, _css = script("view/live/strips.js"), style("view/live/strips.css")
    panels: Any = traitlets.List().tag(sync=True)
    seconds = traitlets.Float(SECONDS).tag(sync=True)
    alt = traitlets.Unicode("No tick yet.").tag(sync=True)

    def __init__(self, session: Session) -> None:
        self._session, self._run, self._sent = session, session.runs, 0
        self._methods = list(session.methods)
        size = decade(session.tree, session.effectors)
        distance = {"range": [size * end for end in DISTANCE], "unit": "m"}
        self._length = Lengths.of(session.tree, session.effectors)
        super().__init__(
            panels=[
                {
                    "title": "each effector, shown method"
                    if session.effectors.w.all()
                    else "each effector; directions 2ℓ sin(φ/2)",
                    "lines": _lines(session.effectors.names),
                    **distance,
                },
                {"title": "mean distance, each method", "lines": _lines(self._methods), **distance},
                {
                    "title": "jitter, each method",
                    "lines": _lines(self._methods),
                    "range": JITTER,
                    "unit": "°",
                },
            ]
        )

    def send_new(self) -> None:
        """Send the ticks that the page has not had."""
        session = self._session
        fresh = session.runs != self._run
        had = 0 if fresh else self._sent
        new = takewhile(lambda row: row.tick > had, reversed(session.record))
        rows = list(new)[::-1]
        self._run, self._sent = session.runs, session.ticks
        if not (rows or fresh):
            return
        log = Log.of(session.tree, session.effectors, session.dt, self._methods, rows)
        shown = log.error[np.arange(len(log)), log.shown]
        mean, jitter = log.error.mean(axis=-1), session.jitter(len(rows))
        degrees = np.degrees([*jitter.values()]).T
        samples = np.column_stack([log.clock, shown, mean, degrees]).astype("<f4")
        self.send({"fresh": fresh, "rows": len(rows)}, buffers=[samples.tobytes()])
        if rows and session.ticks % (10 * EVERY) < EVERY:
            self.alt = "Mean distance to target and jitter: " + "; ".join(
                f"{name} {self._length(far)}, {much:.2g}°"
                for name, far, much in zip(self._methods, mean[-1], degrees[-1], strict=True)
            )


def _lines(names: Any) -> list[dict[str, Any]]:
    return [
        {
            "name": name,
            "colour": effector_colour(i),
            "dashes": DASHES[i % len(DASHES)],
        }
        for i, name in enumerate(names)
    ]
