"""A plane with lines and arrows in it, and one point that is dragged, or moved by keys."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import anywidget
import traitlets
from matplotlib.axes import Axes

from ikteach.arrays import Array
from ikteach.view.widgets.closing import Living
from ikteach.view.widgets.page import script, style


@dataclass(frozen=True, eq=False)
class Stroke:
    """A line through points (g, 2), or an arrow.

    name    stands at its end, or in the legend, where ends may come together
    dashes  of an SVG's stroke, such as "6 4"; none of a solid line
    """

    points: Array
    colour: str
    name: str = ""
    arrow: bool = False
    dashes: str = ""
    width: float = 2.0
    legend: bool = False

    @property
    def state(self) -> dict[str, Any]:
        """Give what the page draws."""
        return {**vars(self), "points": self.points.tolist()}

    def draw(self, axes: Axes) -> None:
        """Draw it in a still picture."""
        style = (0, [float(x) / self.width for x in self.dashes.split()]) if self.dashes else "-"
        end, before = self.points[-1], self.points[-2]
        label = self.name if self.legend else None
        axes.plot(*self.points.T, color=self.colour, ls=style, lw=self.width, label=label)
        if self.arrow:
            look = {"color": self.colour, "lw": self.width, "arrowstyle": "->"}
            axes.annotate("", end, before, arrowprops=look)


class Plane(Living, anywidget.AnyWidget):
    """A plane from −half to half both ways, with lines.

    Its point, if the handle has a name, is dragged, or moved by the arrow keys. With a pen the
    pointer draws anywhere else, Enter sets the point, and Backspace takes one back; `on_msg` is
    told {"stroke": [[x, y], …]}, {"point": [x, y]} or {"back": True}.

    handle  the name of the point; "" for none
    at      where the point is, [x, y]
    said    where it is in words
    step    of an arrow key; with Shift a tenth
    alt     the picture in words
    """

    _esm, _css = script("view/widgets/plane.js"), style("view/widgets/plane.css")
    title = traitlets.Unicode("").tag(sync=True)
    xlabel = traitlets.Unicode("").tag(sync=True)
    ylabel = traitlets.Unicode("").tag(sync=True)
    half = traitlets.Float(1.0).tag(sync=True)
    lines: Any = traitlets.List().tag(sync=True)
    handle = traitlets.Unicode("").tag(sync=True)
    at: Any = traitlets.List([0.0, 0.0]).tag(sync=True)
    said = traitlets.Unicode("").tag(sync=True)
    step = traitlets.Float(0.05).tag(sync=True)
    pen = traitlets.Bool(False).tag(sync=True)
    alt = traitlets.Unicode("").tag(sync=True)

    def show(self, lines: Sequence[Stroke], alt: str) -> None:
        """Draw these lines, which `alt` puts into words."""
        self.drawn = list(lines)
        with self.hold_sync():
            self.lines, self.alt = [line.state for line in lines], alt

    def draw(self, axes: Axes) -> None:
        """Draw it in a still picture."""
        axes.set(xlim=(-self.half, self.half), ylim=(-self.half, self.half), aspect="equal")
        axes.set(title=self.title, xlabel=self.xlabel, ylabel=self.ylabel)
        axes.grid(alpha=0.3)
        for line in self.drawn:
            line.draw(axes)
        named = [line for line in self.drawn if line.name and not line.legend]
        for line, place in zip(
            named, self._apart([line.points[-1] for line in named]), strict=True
        ):
            axes.annotate(line.name, place, textcoords="offset points", xytext=(5, 5))
        if self.handle:
            axes.plot(*self.at, "o", ms=8, color="0.2")
        if any(line.legend for line in self.drawn):
            axes.legend(loc="upper left", fontsize=8)

    def _apart(self, places: Sequence[Array]) -> list[tuple[float, float]]:
        """Move names up or down where one would lie on another, as plane.js does."""
        wide, row = 0.22 * self.half, 0.1 * self.half
        free: list[tuple[float, float]] = []
        for x, y in places:
            step = -row if y > 0 else row  # towards the middle
            while any(abs(x - one[0]) < wide and abs(y - one[1]) < row for one in free):
                y += step
            free.append((float(x), float(y)))
        return free
