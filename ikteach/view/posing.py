"""Live figures that are posed by sliders: chapters 0 and 1."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import ipywidgets as widgets
import numpy as np

from ikteach.arrays import Array
from ikteach.body import forward, jacobian, locate
from ikteach.body.figures import TOGETHER, Figure
from ikteach.body.partials import by_differences
from ikteach.view.bench import WIDE, Bench, Shown, choice, log_slider
from ikteach.view.scene import Scene

WAYS = ("v × (s − p)", "finite differences")


class SceneBench(Bench):
    """A bench with a live scene: `show(**values)` moves the scene and gives what stands around it.

    panel  the controls as they are laid out beside the scene; all of them, one under the other,
           if not given
    """

    def __init__(
        self,
        scene: Scene,
        show: Callable[..., Shown],
        controls: Mapping[str, Any],
        *,
        slot: str | None,
        panel: Sequence[widgets.Widget] | None = None,
    ) -> None:
        self.scene = scene
        super().__init__(show, controls, slot=slot)
        column = widgets.VBox(
            list(panel if panel is not None else controls.values()),
            layout=widgets.Layout(flex="1 1 380px", min_width="340px"),
        )
        scene.widget.layout.width = f"{scene.renderer.width}px"  # so that the panel has its place
        beside = widgets.HBox([scene.widget, column], layout=widgets.Layout(flex_flow="row wrap"))
        chart = [self._picture] if self._picture.png else []
        self.children = [beside, self.status, *chart, self._below]
        scene.driver.on_sign = self._seen

    def refresh(self) -> None:
        """Draw the scene anew, and say what it shows."""
        super().refresh()
        if self.scene.driver.description != self.words:
            self.scene.driver.description = self.words

    def _seen(self, new: bool) -> None:
        if new:  # a page that has just opened knows no pose
            self._after(None)

    def _repr_mimebundle_(self, **kwargs: Any) -> Any:
        bundle = super()._repr_mimebundle_(**kwargs)
        return {**bundle, "image/png": self.scene.still().png}


class Poser(SceneBench):
    """A figure with a slider for each joint, from limit to limit; balls mark its effectors.

    Joints stand together that move the same effectors. Two rows that one angle turns
    (`figures.TOGETHER`) have one slider.
    """

    def __init__(self, figure: Figure, *, slot: str | None = "poser") -> None:
        self.figure = figure
        self._lead = {b: a for a, b in TOGETHER if {a, b} <= set(figure.tree.names)}
        sliders = {
            name: _joint_slider(figure, j)
            for j, name in enumerate(figure.tree.names)
            if name not in self._lead
        }
        groups: dict[str, list[Any]] = {}
        for name, slider in sliders.items():
            groups.setdefault(_moves(figure, name), []).append(slider)
        panel = widgets.Accordion(
            [widgets.VBox(group) for group in groups.values()],
            titles=list(groups),
            selected_index=0,
        )
        more = self._more()
        scene = Scene(*figure, width=460, height=480, slot=None)
        controls = {**more, **sliders}
        super().__init__(
            scene, self._pose, controls, slot=slot, panel=[*more.values(), panel]
        )  # fmt: skip

    def theta(self, values: Mapping[str, Any] | None = None) -> Array:
        """The pose that the sliders say, (n,) [rad]."""
        said = self.values if values is None else values
        tree = self.figure.tree
        degrees = np.array([said[self._lead.get(name, name)] for name in tree.names], dtype=float)
        return np.clip(np.radians(degrees), tree.lower, tree.upper)

    def _more(self) -> dict[str, Any]:
        """Controls over the sliders."""
        return {}

    def _pose(self, **values: Any) -> Shown:
        tree, effectors = self.figure
        theta = self.theta(values)
        s = locate(forward(tree, theta), effectors)
        self.scene.show(theta, s)
        rows = "".join(
            f"<tr><th scope='row' style='text-align:left'>{name}</th>"
            + "".join(f"<td>{x:.3f}</td>" for x in row)
            + "</tr>"
            for name, row in zip(effectors.names, s, strict=True)
        )
        table = (
            "<table class='ikteach-table'><caption>where the effectors are [m]</caption>"
            "<thead><tr><th></th><th>x (left)</th><th>y (up)</th><th>z (forward)</th></tr></thead>"
            f"<tbody>{rows}</tbody></table>"
        )
        places = ", ".join(
            f"{name} ({x:.2f}, {y:.2f}, {z:.2f})"
            for name, (x, y, z) in zip(effectors.names, s, strict=True)
        )
        return Shown(b"", f"A figure of {len(tree)} joints. Its effectors, in m: {places}.", table)


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
        moved = np.flatnonzero(abs(J).max(axis=0) > 1e-9)
        words = (
            f"{len(moved)} of {len(tree)} columns move {effector}. "
            f"Formula and differences with h = {h:.2g} rad differ by at most {gap:.2g} m/rad."
        )
        lengths = ", ".join(
            f"{tree.names[j]} {length:.2f}"
            for j, length in enumerate(np.linalg.norm(columns, axis=0))
            if length > 1e-9
        )
        return Shown(
            b"", f"{words} Lengths: {lengths}.", f"<p>{words}<br>Lengths [m/rad]: {lengths}.</p>"
        )


def _joint_slider(figure: Figure, j: int) -> Any:
    tree = figure.tree
    low, high = (
        round(float(np.degrees(limit))) if np.isfinite(limit) else free
        for limit, free in ((tree.lower[j], -180), (tree.upper[j], 180))
    )
    return widgets.FloatSlider(
        value=round(float(np.degrees(tree.rest[j]))), min=low, max=high, step=1,
        description=f"{tree.names[j]} ({low}…{high}°)", style={"description_width": "175px"},
        readout_format=".0f", layout=widgets.Layout(width="auto"),
    )  # fmt: skip


def _moves(figure: Figure, joint: str) -> str:
    """What a joint moves, in words."""
    effectors = figure.effectors
    carried = effectors.carried[:, figure.tree.index(joint)]
    names = [name for name, moves in zip(effectors.names, carried, strict=True) if moves]
    return f"moves {' and '.join(names)}" if names else "moves no effector"
