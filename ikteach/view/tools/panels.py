"""The panels of the workbench: named controls that say what was asked for, and do nothing else."""

import inspect
from collections.abc import Callable, Mapping, Sequence
from math import log10, pi
from typing import Any

import ipywidgets as widgets

from ikteach.markup import Markup, plain
from ikteach.motion.gait import MOTIONS
from ikteach.motion.live.session import Session
from ikteach.motion.rules import BUSS_CAPS
from ikteach.names import unknown
from ikteach.solvers import SOLVERS, Solver
from ikteach.view.live.controls import SLIDERS
from ikteach.view.stage.layers import LAYERS
from ikteach.view.stage.stage import CAMERAS
from ikteach.view.widgets.ball import Ball
from ikteach.view.widgets.prose import Prose

Tell = Callable[[str, Any], None]
LABEL = {"description_width": "150px"}
AUTO = {"button_width": "auto"}
ONE, BESIDE, OVER = "one figure", "all methods, side by side", "all methods, overlaid"
OWN, EQUAL, NONE = "each author's own", "equal", "none"

# Option of a solver: label, lowest, highest, whether its slider is logarithmic.
OPTIONS: Mapping[str, tuple[str, float, float, bool]] = {
    "gain": ("gain [share of α]", 0.05, 2.0, False),
    "cutoff": ("cutoff [share of σ_max]", 0.0, 0.5, False),
    "damping": ("damping λ [m/rad]", 1e-3, 1.0, True),
    "max_angle": ("γ_max [rad]", 0.05, pi, False),
}


class Panel:
    """Controls under a title. `tell(name, value)` hears of what a person changes in them.

    rows  what stands under each other: a {name: control}, whose controls stand side by side, or a
          widget that is only shown
    """

    def __init__(self, title: str, rows: Sequence[Mapping[str, Any] | Any]) -> None:
        self.title = title
        self.controls: dict[str, Any] = {}
        self._quiet = False
        boxes = []
        for row in rows:
            if isinstance(row, Mapping):
                self.controls |= row
                boxes.append(widgets.HBox(list(row.values()), layout={"flex_flow": "row wrap"}))
            else:
                boxes.append(row)
        self.widget = widgets.VBox(boxes)

    def on_change(self, tell: Tell) -> None:
        """Call tell(name, value) for every change that a person makes."""
        for name, control in self.controls.items():
            self.listen(name, control, tell)

    def listen(self, name: str, control: Any, tell: Tell) -> None:
        """Call tell(name, value) for every change of this control."""
        if isinstance(control, widgets.Button):
            control.on_click(lambda _: tell(name, None))
            return

        def changed(change: Any) -> None:
            if not self._quiet and not _rounded(change["old"], change["new"]):
                tell(name, change["new"])

        control.observe(changed, "value")

    def put(self, **values: Any) -> None:
        """Set controls, and tell nobody."""
        self._quiet = True
        try:
            for name, value in values.items():
                self.controls[name].value = value
        finally:
            self._quiet = False


def _rounded(old: Any, new: Any) -> bool:
    """Whether a slider in the page only rounded the number that it was given."""
    return isinstance(new, float) and isinstance(old, float) and abs(new - old) < 1e-9


class MethodPanel(Panel):
    """Which method is shown, the options of each, and what stands around the solver."""

    def __init__(self, session: Session) -> None:
        self.options = {
            f"{method}.{option}": control
            for method, solver in SOLVERS.items()
            for option, control in options_of(solver).items()
        }
        self.mix = {
            f"mix.{name}": widgets.Dropdown(
                options=list(SOLVERS), value="dls", description=plain(name), style=LABEL
            )
            for name in session.effectors.names
        }
        shown = widgets.ToggleButtons(
            options=list(session.methods), value=session.method, description="Method", style=AUTO
        )
        around = {
            "caps": widgets.ToggleButtons(
                options=[NONE, EQUAL, OWN], value=NONE, description="Step caps", style=AUTO
            ),
            "cap": slider("equal cap [°]", 10.0, 0.5, 90.0, 0.5),
            "whose": widgets.ToggleButtons(
                options=["whole", "per_chain"], description="Cap acts on", style=AUTO
            ),
            "limits": widgets.ToggleButtons(
                options=["hold", "clip", "ignore"], description="Limits", style=AUTO
            ),
            "clamp_error": widgets.Checkbox(value=False, description="clamp errors", indent=False),
            "max_error": slider("error clamp D [m]", 0.4, 0.01, 1.0, 0.01),
        }
        each = [{name: control} for name, control in self.options.items()]
        super().__init__("Method", [{"method": shown}])
        self.controls |= self.options | self.mix | around
        tabs = widgets.Accordion(
            [
                widgets.VBox([control for row in each for control in row.values()]),
                widgets.VBox(list(self.mix.values())),
                widgets.VBox(list(around.values())),
            ],
            titles=["Options of the methods", "Mix: a method per effector", "Around the solver"],
            selected_index=None,
        )
        self.widget.children = [*self.widget.children, tabs]


def options_of(solver: Solver) -> dict[str, Any]:
    """A control for each keyword option in the solver's signature, set to its default."""
    controls = {}
    for option in inspect.signature(solver).parameters.values():
        if option.kind is not option.KEYWORD_ONLY:
            continue
        label = f"{getattr(solver, '__name__', 'solver')}: "
        if option.name == "clamp":
            controls["clamp"] = widgets.ToggleButtons(
                options=["hard", "soft"], description=f"{label}clamp", style=AUTO
            )
        elif option.name in OPTIONS:
            words, low, high, logarithmic = OPTIONS[option.name]
            controls[option.name] = slider(
                label + words, float(option.default), low, high, 0.01, logarithmic
            )
        else:
            raise LookupError(unknown("option with a slider", option.name, OPTIONS))
    return controls


def slider(
    label: str, value: float, low: float, high: float, step: float, logarithmic: bool = False
) -> Any:
    """A slider over its label's range."""
    layout = widgets.Layout(width="380px")
    if logarithmic:
        return widgets.FloatLogSlider(
            value=value, min=log10(low), max=log10(high), step=0.02, description=label,
            style=LABEL, layout=layout, readout_format=".3g",
        )  # fmt: skip
    kind = widgets.IntSlider if isinstance(step, int) else widgets.FloatSlider
    return kind(
        value=value, min=low, max=high, step=step, description=label, style=LABEL, layout=layout
    )


def gait_sliders(session: Session, group: str) -> dict[str, Any]:
    """The sliders of one group of gait parameters."""
    return {
        name: slider(label, getattr(session.gait, name), low, high, step)
        for name, (label, low, high, step) in SLIDERS[group].items()
    }


def motion_panel(session: Session) -> Panel:
    """What the targets do."""
    motion = widgets.ToggleButtons(
        options=[*MOTIONS, "by hand"], value=session.gait.name, description="Motion", style=AUTO
    )
    return Panel("Motion", [{"motion": motion}])


def control_panel(session: Session) -> Panel:
    """Wounds, joint by joint, and whether the figure goes anywhere."""
    joint = widgets.Dropdown(
        options=list(session.tree.names), value="knee.r", description="Joint", style=LABEL
    )
    return Panel(
        "Motion control",
        [
            {
                "forward": widgets.Checkbox(description="moving forward", indent=False),
                "wounded": widgets.Checkbox(description="wounded", indent=False),
            },
            Prose(
                Markup(
                    "<p>A wound as the solver knows it is a <b>mobility</b>. As the thesis draws "
                    "it, the pose is changed after the solve: <b>drawn ×</b> and <b>drawn +</b>."
                    "</p>"
                )
            ),
            {"joint": joint},
            {"mobility": slider("mobility", 1.0, 0.0, 1.0, 0.05)},
            {"times": slider("drawn × ", 1.0, 0.0, 2.0, 0.05)},
            {"plus": slider("drawn + [°]", 0.0, -60.0, 60.0, 1.0)},
            {"heal": widgets.Button(description="Heal all")},
        ],
    )


def view_panel(session: Session) -> Panel:
    """What is looked at, and from where."""
    layers = {
        f"layer.{name}": widgets.Checkbox(description=name, indent=False, layout={"width": "130px"})
        for name in (*LAYERS, "targets")
    }
    layers["layer.targets"].value = True
    return Panel(
        "View",
        [
            {"side": widgets.Dropdown(options=list(CAMERAS), description="View", style=LABEL)},
            {
                "projection": widgets.ToggleButtons(
                    options=["perspective", "orthographic"], description="Projection", style=AUTO
                )
            },
            {"figures": widgets.Dropdown(options=[ONE, BESIDE, OVER], description="Figures",
                                         style=LABEL)},
            layers,
            {"effector": widgets.Dropdown(options=list(session.effectors.names),
                                          description="J and ellipsoid of", style=LABEL)},
            {"dark": widgets.Checkbox(description="dark", indent=False)},
        ],
    )  # fmt: skip


class ObjectPanel(Panel):
    """Turn, move and zoom the figure: what the thesis calls the transformation of the object."""

    def __init__(self) -> None:
        self.ball = Ball(azimuth=36.0, elevation=6.0)
        super().__init__(
            "Object",
            [
                self.ball,
                {"azimuth": slider("turn [°]", 36.0, -180.0, 180.0, 1.0)},
                {"elevation": slider("tilt [°]", 6.0, -85.0, 85.0, 1.0)},
                {"zoom": slider("zoom [×]", 1.0, 0.3, 3.0, 0.05)},
                {"right": slider("move right [m]", 0.0, -1.5, 1.5, 0.05)},
                {"up": slider("move up [m]", 0.0, -1.5, 1.5, 0.05)},
                {"straight": widgets.Button(description="As it was")},
            ],
        )

    def on_change(self, tell: Tell) -> None:
        """Call tell(name, value) for every change; ball and sliders agree."""
        super().on_change(tell)

        def turned(change: Any) -> None:
            if not self._quiet:
                self.put(azimuth=self.ball.azimuth, elevation=self.ball.elevation)
                tell(change["name"], change["new"])

        self.ball.observe(turned, ["azimuth", "elevation"])

    def put(self, **values: Any) -> None:
        """Set controls, and the ball with them."""
        super().put(**values)
        self._quiet = True
        try:
            self.ball.set_trait("azimuth", self.controls["azimuth"].value)
            self.ball.set_trait("elevation", self.controls["elevation"].value)
        finally:
            self._quiet = False


def speed_panel(session: Session) -> Panel:
    """How fast time goes, and in what leaps."""
    sliders = gait_sliders(session, "Speed")
    return Panel("Speed", [{name: control} for name, control in sliders.items()])


def target_panel(session: Session, targets: Any) -> Panel:
    """Where the targets are, and how far they swing."""
    rows: list[Any] = [targets]
    for group in ("Steps", "Hands"):
        rows += [{name: one} for name, one in gait_sliders(session, group).items()]
    return Panel("Target position", rows)


def caps(which: str, equal: float) -> Mapping[str, float | None]:
    """The step cap of each method [rad], where `equal` is the one of all; None is no cap."""
    return BUSS_CAPS if which == OWN else dict.fromkeys(SOLVERS, equal if which == EQUAL else None)
