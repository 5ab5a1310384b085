"""Chapter 1's live figure: the columns of J as arrows, by formula or by differences."""

from typing import Any

import ipywidgets as widgets
import numpy as np

from ikteach.body import forward, jacobian, locate
from ikteach.body.figures import Figure
from ikteach.body.partials import by_differences
from ikteach.markup import Markup
from ikteach.view.chapters.figure import Poser
from ikteach.view.live.bench import WIDE, Shown, choice, log_slider

WAYS = ("v × (s − p)", "finite differences")


class ColumnPoser(Poser):
    """A `Poser` that draws the columns of J at one effector, as formulas or differences have them.

    Half a metre on the screen is 1 m/rad.
    """

    def __init__(self, figure: Figure, *, slot: str | None = "columns") -> None:
        super().__init__(figure, slot=slot)
        self.scene.switch("columns of J")

    def _more(self) -> dict[str, Any]:
        names = list(self.figure.effectors.names)
        pick = widgets.Dropdown(options=names, description="effector", style=WIDE, value=names[-1])
        h = log_slider("h of the differences [rad]", 1e-3, -6.0, 0.5)
        h.readout_format = ".0e"
        return {"effector": pick, "way": choice("columns by", list(WAYS)), "h": h}

    def _pose(self, **values: Any) -> Shown:
        tree, effectors = self.figure
        effector, way, h = (values[name] for name in ("effector", "way", "h"))
        theta, i = self.theta(values), effectors.names.index(effector)
        frames = forward(tree, theta)
        rows = slice(3 * i, 3 * i + 3)
        J = jacobian(tree, frames, effectors)[rows]
        differences = by_differences(tree, theta, effectors, h=h)[rows]
        columns = J if way == WAYS[0] else differences
        self.scene.show(theta, locate(frames, effectors), effector=i, columns=columns)
        gap = abs(J - differences).max()
        least = 1e-9 * self.scene.stage.unit  # of what is no rounding [m/rad]
        moved = np.flatnonzero(abs(J).max(axis=0) > least)
        words = (
            f"{len(moved)} of {len(tree)} columns move {effector}. "
            f"Formula and differences with h = {h:.2g} rad differ by at most {gap:.2g} m/rad."
        )
        lengths = ", ".join(
            f"{tree.names[j]} {length:.3g}"
            for j, length in enumerate(np.linalg.norm(columns, axis=0))
            if length > least
        )
        return Shown(
            b"",
            f"{words} Lengths: {lengths}.",
            Markup("<p>{}<br>Lengths [m/rad]: {}.</p>").format(words, lengths),
        )
