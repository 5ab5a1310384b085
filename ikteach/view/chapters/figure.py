"""Live figures that are posed by sliders: chapters 0 and 1."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

import ipywidgets as widgets
import numpy as np

from ikteach.arrays import Array
from ikteach.body import forward, locate
from ikteach.body.extent import extent
from ikteach.body.figures import TOGETHER, Figure
from ikteach.markup import plain
from ikteach.view.live.bench import Bench, Shown
from ikteach.view.stage.lengths import Lengths, digits_of, round_step
from ikteach.view.webgl.scene import Scene
from ikteach.view.widgets import doors
from ikteach.view.widgets.picture import Still
from ikteach.view.widgets.prose import grid


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
        super().__init__(show, controls, slot=slot, note=scene.note)
        column = widgets.VBox(
            list(panel if panel is not None else controls.values()),
            layout=widgets.Layout(flex="1 1 380px", min_width="340px"),
        )
        scene.widget.layout.width = f"{scene.renderer.width}px"  # so that the panel has its place
        beside = widgets.HBox([scene.widget, column], layout=widgets.Layout(flex_flow="row wrap"))
        chart = [self._picture] if self._picture.png else []
        self.children = [beside, self.status, *chart, self._below]
        scene.driver.on_page = self._seen

    def refresh(self) -> None:
        """Draw the scene anew, and say what it shows."""
        super().refresh()
        if self.scene.driver.description != self.words:
            self.scene.driver.description = self.words

    def _seen(self, new: bool) -> None:
        if new:  # a page that has just opened knows no pose
            self._after(None)

    def _still(self) -> Still:
        return Still(self.scene.still().png, self.words)


class Poser(SceneBench):
    """A figure with a slider for each joint, from limit to limit; balls mark its effectors.

    Joints stand together that move the same effectors. Two rows that one angle turns
    (`figures.TOGETHER`) have one slider.
    """

    def __init__(self, figure: Figure, *, slot: str | None = "poser") -> None:
        self.figure = figure = doors.figure(figure)
        self._lead = {b: a for a, b in TOGETHER if {a, b} <= set(figure.tree.names)}
        scales = [Dial.of(figure, j) for j in range(len(figure.tree))]
        self._each = np.array([dial.each for dial in scales])
        sliders = {
            name: dial.slider(name)
            for name, dial in zip(figure.tree.names, scales, strict=True)
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
        values_said = [said[self._lead.get(name, name)] for name in tree.names]
        return np.clip(self._each * values_said, tree.lower, tree.upper)

    def _more(self) -> dict[str, Any]:
        """Controls over the sliders."""
        return {}

    def _pose(self, **values: Any) -> Shown:
        tree, effectors = self.figure
        theta = self.theta(values)
        s = locate(forward(tree, theta), effectors)
        unit = Lengths.of_places(self.scene.stage.extent.radius)
        self.scene.show(theta, s)
        rows = [
            [name, *(unit.number(x, 3) for x in row)]
            for name, row in zip(effectors.names, s, strict=True)
        ]
        heads = ["", "x (left)", "y (up)", "z (forward)"]
        table = grid(heads, rows, f"where the effectors are [{unit.name}]")
        places = ", ".join(
            f"{name} ({', '.join(unit.number(x, 2) for x in row)})"
            for name, row in zip(effectors.names, s, strict=True)
        )
        return Shown(
            b"", f"A figure of {len(tree)} joints. Its effectors, in {unit.name}: {places}.", table
        )


class Dial(NamedTuple):
    """How a joint is set by a person: degrees of a hinge, a length of a slide.

    each        what one unit is of θ [rad or m]
    unit        its name
    low, high   ends of the range
    value       the rest
    step        of the slider
    """

    each: float
    unit: str
    low: float
    high: float
    value: float
    step: float

    @classmethod
    def of(cls, figure: Figure, j: int) -> "Dial":
        """The dial of joint j: from limit to limit.

        A hinge that can turn for ever is set within ±180°, one with one limit through a whole turn
        from it; a slide goes on by the size of the body.
        """
        tree, slide = figure.tree, bool(figure.tree.slide[j])
        size = extent(*figure).radius
        lengths = Lengths.of_places(size)
        each, unit = (lengths.metres, f" {lengths.name}") if slide else (np.radians(1), "°")
        lower, rest, upper = (float(x[j]) / each for x in (tree.lower, tree.rest, tree.upper))
        far = size / each if slide else 180.0
        if not slide and 3600 < upper - lower < np.inf:  # limits in name only
            lower, upper = -np.inf, np.inf
        if np.isinf(lower) and np.isinf(upper):
            middle = rest if slide else 0.0
            rest = rest if slide else (rest + 180) % 360 - 180
            lower, upper = middle - far, middle + far
        elif np.isinf(lower):
            lower = min(rest, upper) - 2 * far
        elif np.isinf(upper):
            upper = max(rest, lower) + 2 * far
        step = round_step(upper - lower) if upper > lower else 1.0
        if not slide and upper - lower >= 30:
            step = 1.0
        low, value, high = (float(f"{x:.12g}") for x in (lower, rest, upper))
        return cls(float(each), unit, low, high, min(max(value, low), high), step)

    def slider(self, name: str) -> Any:
        """A slider for it, with its ends in its label."""
        return widgets.FloatSlider(
            value=self.value, min=self.low, max=self.high, step=self.step,
            description=plain(f"{name} ({self.low:.4g}…{self.high:.4g}{self.unit})"),
            style={"description_width": "175px"}, readout_format=f".{digits_of(self.step)}f",
            layout=widgets.Layout(width="auto"),
        )  # fmt: skip


def _moves(figure: Figure, joint: str) -> str:
    """What a joint moves, in words."""
    effectors = figure.effectors
    carried = effectors.carried[:, figure.tree.index(joint)]
    names = [name for name, moves in zip(effectors.names, carried, strict=True) if moves]
    return plain(f"moves {' and '.join(names)}") if names else "moves no effector"
