"""A matplotlib picture that is given points in space, seen in parallel view."""

import io
from math import radians, tan

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.patches import Ellipse

from ikteach.arrays import Array
from ikteach.markup import as_label
from ikteach.view.stage.skin import DARK, LIGHT, Ball, Limb, Part
from ikteach.view.stage.stage import FIELD, Stage, picture_axes

DPI = 100
BEHIND, BEFORE = -100.0, 100.0  # drawn before, or after, all that is sorted by depth


class Sheet:
    """A matplotlib picture that is given points in space."""

    def __init__(self, side: str, size: tuple[float, float], stage: Stage, dark: bool) -> None:
        self._middle = stage.extent.centre
        back = stage.eye(side, size[0] / size[1]) - self._middle
        half = float(np.linalg.norm(back)) * tan(radians(FIELD / 2))  # of the height [m]
        wide = half * size[0] / size[1]
        self._axes_of_picture = picture_axes(back)
        self._points = size[1] * 72 / (2 * half)  # points a metre
        self.faint, ink = ("#3a434d", "#e8ebee") if dark else ("#cbd2d9", "#20262d")
        self._ink = ink
        self._figure = Figure(figsize=size, dpi=DPI, facecolor=DARK if dark else LIGHT)
        self._axes: Axes = self._figure.add_axes((0, 0, 1, 1))
        self._axes.set(xlim=(-wide, wide), ylim=(-half, half))
        self._axes.set_axis_off()

    def png(self) -> bytes:
        """The picture."""
        out = io.BytesIO()
        self._axes.legend(
            loc="upper right", fontsize=7, title="targets", title_fontsize=7, labelcolor=self._ink,
            facecolor=self._figure.get_facecolor(),
        ).get_title().set_color(self._ink)  # fmt: skip
        self._figure.savefig(out, format="png", facecolor=self._figure.get_facecolor())
        return out.getvalue()

    def part(self, part: Part, R: Array, p: Array, opacity: float) -> None:
        """A limb or a ball of a body whose joint stands at p, turned by R."""
        if isinstance(part, Ball):
            half = R * np.asarray(part.radii, dtype=float)
            centre = p + R @ np.asarray(part.centre, dtype=float)
            depth = float(self._see(centre)[2]) + 1e-6  # a joint is seen on its limbs
            self.ellipsoid(centre, half, part.colour, opacity, depth)
        else:
            self._limb(part, R, p, opacity)

    def _limb(self, part: Limb, R: Array, p: Array, opacity: float) -> None:
        ends = p + np.array([part.start, part.end], dtype=float) @ R.T
        t = np.linspace(0, 1, 9)[:, None]  # short pieces make it thinner towards the end
        points = self._see(ends[0] * (1 - t) + ends[1] * t)
        widths = 2 * self._points * (part.thick * (1 - t) + part.thin * t)[:-1, 0]
        pieces = LineCollection(
            list(np.stack([points[:-1, :2], points[1:, :2]], axis=1)), linewidths=widths,
            colors=part.colour, alpha=opacity, capstyle="round",
            zorder=float(points[:, 2].mean()),
        )  # fmt: skip
        self._axes.add_collection(pieces, autolim=False)

    def ellipsoid(
        self, centre: Array, half: Array, colour: str, opacity: float, depth: float
    ) -> None:
        """An ellipsoid with these half axes (3, 3), in columns."""
        x, y, _ = self._see(centre)
        flat = (self._axes_of_picture.T @ half)[:2]
        squares, ways = np.linalg.eigh(flat @ flat.T)
        short, long = 2 * np.sqrt(np.maximum(squares, 0))
        angle = float(np.degrees(np.arctan2(ways[1, 1], ways[0, 1])))
        shape = Ellipse((x, y), long, short, angle=angle, color=colour, alpha=opacity, lw=0)
        shape.set_zorder(depth)
        self._axes.add_patch(shape)

    def line(
        self, ends: Array, colour: str, width: float, depth: float, opacity: float = 1.0
    ) -> None:
        """A line so many points wide."""
        x, y, _ = self._see(ends).T
        self._axes.plot(
            x, y, "-", color=colour, lw=width, zorder=depth, alpha=opacity,
            solid_capstyle="round",
        )  # fmt: skip

    def mark(self, at: Array, name: str, colour: str, radius: float, legend: str | None) -> None:
        """A target."""
        x, y, _ = self._see(at)
        shape = "s" if name.endswith(".r") else "o"
        self._axes.plot(
            [x], [y], shape, color=colour, ms=2 * radius * self._points, zorder=BEFORE,
            label=None if legend is None else as_label(legend), alpha=0.85, mec="white", mew=0.8,
        )  # fmt: skip

    def dots(self, points: Array, colour: str, size: float) -> None:
        """Dots; none where a point is NaN."""
        x, y, _ = self._see(points).T
        self._axes.plot(x, y, ".", color=colour, ms=size, zorder=BEFORE)

    def arrow(self, start: Array, end: Array, colour: str) -> None:
        """An arrow."""
        a, b = self._see(np.array([start, end]))[:, :2]
        if np.linalg.norm(b - a) * self._points > 0.1:  # an arrow that can be seen
            look = {"arrowstyle": "-|>", "color": colour, "lw": 2, "shrinkA": 0, "shrinkB": 0}
            self._axes.annotate("", b, a, arrowprops=look, zorder=BEFORE)

    def circle(self, centre: Array, radius: float, colour: str, style: str) -> None:
        """The outline of a ball."""
        x, y, _ = self._see(centre)
        self._axes.add_patch(
            Ellipse((x, y), 2 * radius, 2 * radius, fill=False, ec=colour, ls=style, zorder=BEFORE)
        )

    def words(self, at: Array, text: str, colour: str) -> None:
        """Words at a point."""
        x, y, _ = self._see(at)
        self._axes.text(
            x, y, as_label(text), color=colour, ha="center", va="center", zorder=BEFORE, size=10
        )

    def _see(self, points: Array) -> Array:
        """x, y in the picture and nearness to the eye, (..., 3)."""
        return (points - self._middle) @ self._axes_of_picture
