"""Hip, knee and ankle over the stride, as they are turned, on the band of the norm."""

from collections.abc import Mapping
from typing import Any

import ipywidgets as widgets
import numpy as np
from matplotlib.figure import Figure

from ikteach.arrays import Array
from ikteach.markup import as_label
from ikteach.motion.live.session import Session
from ikteach.motion.paths import quality
from ikteach.study.walks import lately
from ikteach.view.charts import STYLES
from ikteach.view.live.canvas import Canvas
from ikteach.view.stage.colours import effector_colour
from ikteach.view.widgets.picture import Picture

JOINTS = {"hip": (-30, 60), "knee": (-5, 90), "ankle": (-50, 40)}  # and the axis [degrees]
SHOWN = "shown"  # the name of its one walk
OFTEN = 6  # ticks from one picture of the angles to the next
LAST = 150  # ticks that are measured
CYCLE = np.arange(51) / 50


def last_stride(session: Session, last: int) -> tuple[Array, Array]:
    """Find the shares of the last stride (T,), and its angles (T, 3) [degrees].

    Of the shown method, in the last ticks. There are none before the second tick, and none where
    nobody knows when a foot comes down: the targets are set by hand, or no foot stands.
    """
    run, path = lately(session, last), session.gait
    nothing = np.zeros(0), np.zeros((0, 3))
    if run is None or session.by_hand:
        return nothing
    try:
        share = quality.cycle(path, path.rate * run.times)[:, 0]
        angles = quality.sagittal(session.tree, run.theta)
    except (ValueError, LookupError):  # nobody says when a foot stands, or it has no knees
        return nothing
    gone = share + np.append(0, np.cumsum(np.diff(share) < 0))  # in strides
    now = gone > gone[-1] - 1
    return share[now], np.stack([angles[joint][now, 0] for joint in JOINTS], axis=-1)


class Bands(Picture):
    """Three plots over the stride, with a line per walk.

    Behind them lies the band of the norm: its mean, one standard deviation up and down.

    names  of the walks; lines differ in dashes as well as in colour, and a dot is where each is now
    """

    def __init__(self, names: list[str], *, speed: str = "Free") -> None:
        super().__init__()
        self.add_class("ikteach-chart")
        figure = Figure(figsize=(9.6, 2.7), dpi=90)
        panels = figure.subplots(1, 3)
        figure.subplots_adjust(left=0.05, right=0.99, bottom=0.17, top=0.8, wspace=0.16)
        self._means, spread = quality.norms(speed), quality.deviations(speed)
        self._lines: dict[str, list[Any]] = {name: [] for name in names}
        self._dots: dict[str, list[Any]] = {name: [] for name in names}
        for axes, (joint, span) in zip(panels, JOINTS.items(), strict=True):
            mean = self._means[joint]
            low, high = mean - spread[joint], mean + spread[joint]
            axes.fill_between(100 * CYCLE, low, high, color="0.85", label="norm ± 1 SD")
            axes.set(xlim=(0, 100), ylim=span, xlabel="% of the stride")
            axes.set_title(f"{joint}, left [°]", fontsize=10)
            axes.grid(alpha=0.3)
            for i, name in enumerate(names):
                look = {"color": effector_colour(i), "label": as_label(name)}
                self._lines[name] += axes.plot([], [], STYLES[i % len(STYLES)], lw=1.8, **look)
                self._dots[name] += axes.plot([], [], "o", ms=6, color=look["color"])
        handles = panels[0].get_legend_handles_labels()
        figure.legend(*handles, loc="upper center", ncols=1 + len(names), fontsize=9)
        moving = [*self._lines.values(), *self._dots.values()]
        self._canvas = Canvas(figure, [artist for each in moving for artist in each])
        self.draw({})

    def draw(self, walks: Mapping[str, tuple[Array, Array]]) -> None:
        """Draw walks.

        They are {name: (share of the stride (T,), angles (T, 3) [degrees])}, the last row now.
        """
        for name, (share, angles) in walks.items():
            breaks = np.flatnonzero(np.diff(share) < 0) + 1
            x, y = np.insert(100 * share, breaks, np.nan), np.insert(angles, breaks, np.nan, axis=0)
            each = zip(self._lines[name], self._dots[name], y.T, strict=True)
            for line, dot, angle in each:
                line.set_data(x, angle)
                dot.set_data(x[-1:], angle[-1:])
        off = {name: self._off(*walk) for name, walk in walks.items() if len(walk[0])}
        with self.hold_sync():
            self.png, self.alt = self._canvas.png(), _words(off)

    def _off(self, share: Array, angles: Array) -> Array:
        """Find how far angles are from the norm, (3,) [degrees], as root mean squares."""
        norm = np.array([np.interp(share, CYCLE, self._means[joint]) for joint in JOINTS])
        return np.asarray(np.sqrt(np.mean((angles.T - norm) ** 2, axis=1)))


class OnTheNorm(widgets.Accordion):  # type: ignore[misc]
    """The bands of a session, to be unfolded.

    They have the method that is shown, and are drawn while they are unfolded.
    """

    def __init__(self, session: Session) -> None:
        self._session, self._drawn = session, 0
        self.bands = Bands([SHOWN])
        title = "Hip, knee and ankle on the norm's band"
        super().__init__([self.bands], titles=[title], selected_index=None)
        self.observe(lambda _: self._draw(), "selected_index")

    def follow(self) -> None:
        """Draw what the session does, a few times a second."""
        if abs(self._session.ticks - self._drawn) >= OFTEN:
            self._draw()

    def _draw(self) -> None:
        if self.selected_index == 0:
            self._drawn = self._session.ticks
            self.bands.draw({SHOWN: last_stride(self._session, LAST)})


def _words(off: Mapping[str, Array]) -> str:
    each = (
        f"{name} "
        + ", ".join(f"{joint} {far:.0f}°" for joint, far in zip(JOINTS, fars, strict=True))
        for name, fars in off.items()
    )
    said = "; ".join(each) or "no stride yet"
    return f"Angles over the stride, left side. Off the norm, root mean square: {said}."
