"""The one channel from the kernel to the scene: one binary message a frame, none queued."""

from collections.abc import Callable, Sequence
from time import monotonic
from typing import Any

import anywidget
import traitlets
from ipywidgets import Widget, widget_serialization

from ikteach.arrays import Array
from ikteach.view.widgets.actor import Actor
from ikteach.view.widgets.closing import Living
from ikteach.view.widgets.lacking import LACKING
from ikteach.view.widgets.page import script, style

Move = tuple[Widget, int | list[list[int]]]
"""What is moved, and by which row of a frame; or, of a mesh, [row, points] of each of its parts."""

AHEAD = 30  # frames that may be sent and not yet known to be drawn: a second's
PATIENCE = 10.0  # [s] without a sign of life before a page counts as gone


class Driver(Living, anywidget.AnyWidget):
    """A writer of matrices into pythreejs objects (see driver.js).

    It hears which frames the page has drawn.

    renderer      draws the scene
    nodes, plan   the objects that it moves, and how (`Move`); set them with `move`
    rows          number of rows of a frame
    description   the picture in words, for people who cannot see it
    dark          whether the page is dark, as it says itself
    on_page       is called with True when a page begins to look and with False when it has
                  drawn, from whichever thread hears of it
    as_png        draws the last moment, for a page that lacks pythreejs or WebGL
    acts          {key: what it does}, of keys that the page hands on to
    on_act        which is called with the key
    on_calm       is called once, if the first page is to have nothing that moves by itself
    pace          how fast time passes, in words; none where it does not pass
    measures      whether there are distances to show, and
    measuring     whether the page shows those that `show` gives, of
    effectors     [name, colour] of each
    panes         {"name", "way"} of each view that is shown, `Views.panes`
    view          the one that keys act on, as the page says itself
    needed        width over height of what each must show
    splits        whether there may be several
    """

    _esm, _css = (
        script("view/webgl/driver.js"),
        style(
            *(f"view/webgl/{name}.css" for name in ("driver", "looking", "labels")),
            "view/widgets/layout.css",
        ),
    )
    renderer = traitlets.Instance(Widget).tag(sync=True, **widget_serialization)
    nodes = traitlets.List(traitlets.Instance(Widget)).tag(sync=True, **widget_serialization)
    plan: Any = traitlets.List().tag(sync=True)
    rows = traitlets.Int().tag(sync=True)
    description = traitlets.Unicode().tag(sync=True)
    acts: Any = traitlets.Dict().tag(sync=True)
    pace = traitlets.Unicode().tag(sync=True)
    measures = traitlets.Bool(False).tag(sync=True)
    measuring = traitlets.Bool(False).tag(sync=True)
    effectors: Any = traitlets.List().tag(sync=True)
    dark = traitlets.Bool(False).tag(sync=True)
    panes: Any = traitlets.List().tag(sync=True)
    view = traitlets.Int(0).tag(sync=True)
    needed = traitlets.Float(1.0).tag(sync=True)
    splits = traitlets.Bool(False).tag(sync=True)
    lacking = traitlets.Dict(LACKING, read_only=True).tag(sync=True)

    def __init__(self, renderer: Widget, **kwargs: Any) -> None:
        super().__init__(renderer=renderer, **kwargs)
        self.sent = self.drawn = -1
        self._change = 0
        self.seen = False
        self.heard = monotonic()
        self.on_page: Callable[[bool], None] = lambda new: None
        self.on_act: Callable[[str], object] = lambda key: None
        self.on_calm: Callable[[], object] = lambda: None
        self.as_png: Callable[[], bytes] = bytes
        self._asked = False
        self._act = Actor()
        self.on_msg(self._hear)

    def move(self, moves: Sequence[Move], rows: int) -> None:
        """Have the page move these from now on.

        `rows` is the number of rows of a frame.
        """
        with self.hold_sync():
            self.nodes, self.plan = [node for node, _ in moves], [how for _, how in moves]
            self.rows = rows

    def show(self, matrices: Array, change: int = 0, far: Sequence[str] | None = None) -> None:
        """Send [R | p] (rows, 3, 4) to the page.

        `change` comes back with the drawn frame; `far` are the distances in words, to be shown.
        """
        self.sent += 1
        self._change = change
        numbers = matrices.swapaxes(-1, -2).astype("<f4")
        content: dict[str, Any] = {"frame": self.sent, "change": change}
        if far is not None:
            content["far"] = far
        self.send(content, buffers=[numbers.tobytes()])

    @property
    def ready(self) -> bool:
        """Tell whether a page looks and can take a frame.

        It can while few are under way to it.
        """
        return self.seen and self.sent - self.drawn < AHEAD

    @property
    def unwatched(self) -> bool:
        """Tell whether nobody looks.

        There is no page yet, or no sign has come back of many frames.
        """
        waiting = self.sent - self.drawn >= AHEAD
        return not self.seen or (waiting and monotonic() - self.heard > PATIENCE)

    def _hear(self, _: Any, content: dict[str, Any], __: Any) -> None:
        self.heard = monotonic()
        if "picture" in content:
            if not self._asked:  # however many pages ask
                self._asked = True
                self._act(self._depict, lambda words: self.send({"wrong": words}))
            return
        if "act" in content:
            self._act(
                lambda: self.on_act(str(content["act"])), lambda words: self.send({"wrong": words})
            )
            return
        new = "hello" in content
        if new:
            if not self.seen and content.get("calm"):
                self.on_calm()
            self.seen = True
            self.drawn = self.sent  # what was under way to a page that has gone is lost
        else:
            self.drawn = max(self.drawn, int(content["drawn"]))
        self.on_page(new)

    def _depict(self) -> None:
        """Send the page a picture of the newest frame."""
        self._asked = False
        self.send({"picture": self.sent, "change": self._change}, buffers=[self.as_png()])
