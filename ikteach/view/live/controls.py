"""The controls of the gait player. They say what was asked for; they do nothing themselves."""

from collections.abc import Callable
from typing import Any

import ipywidgets as widgets

from ikteach.motion.gait import MOTIONS, WOUND, Gait
from ikteach.motion.live.session import Session
from ikteach.motion.path import Path
from ikteach.view.stage.stage import sides_of

# parameter of the gait: label, lowest, highest, step, unit
SLIDERS = {
    "Speed": {
        "speed": ("speed ω [rad/s]", 0.0, 20.0, 0.1),
        "step_frequency": ("step frequency [×]", 0.1, 3.0, 0.1),
        "slowdown": ("slowdown [ticks]", 1, 10, 1),
    },
    "Steps": {
        "back_z_leg": ("left foot z swing [m]", -0.8, 0.8, 0.01),
        "front_z_leg": ("right foot z swing [m]", -0.8, 0.8, 0.01),
        "back_y_leg": ("left foot y [m]", -1.3, -0.4, 0.01),
        "front_y_leg": ("right foot y [m]", -1.3, -0.4, 0.01),
    },
    "Hands": {
        "hand_z": ("hands z swing [m]", -1.2, 1.2, 0.01),
        "back_y_hand": ("right hand y [m]", -0.6, 1.0, 0.01),
        "front_y_hand": ("left hand y [m]", -0.6, 1.0, 0.01),
    },
}
LABEL = {"description_width": "140px"}


class Controls:
    """Buttons and sliders for a session. `on_change(f)` has them call f(name, value)."""

    def __init__(self, methods: list[str], session: Session) -> None:
        gait = session.gait
        walks = isinstance(gait, Gait)
        self._quiet = False
        self.playing = widgets.ToggleButton(value=True, description="Pause")
        self.method = widgets.ToggleButtons(
            options=methods, value=session.method, description="Method"
        )
        self.motion = widgets.ToggleButtons(
            options=motions(session), value=gait.name, description="Motion"
        )
        self.wounded = widgets.Checkbox(value=bool(gait.wound), description="wounded", indent=False)
        self.forward = widgets.Checkbox(
            value=gait.forward, description="moving forward", indent=False
        )
        sides = sides_of(session.tree, session.effectors)
        self.view = widgets.Dropdown(options=sides, description="View")
        self.reset = widgets.Button(description="Reset")
        self.step = widgets.Button(description="Step")
        self.sliders = {
            name: _slider(getattr(gait, name), *spec)
            for group in SLIDERS.values()
            for name, spec in group.items()
            if hasattr(gait, name)
        }
        able = set(WOUND) <= set(session.tree.names)
        for one in (self.method, self.motion):
            one.style.button_width = "auto"
            one.style.description_width = "60px"
        self.view.style.description_width = "60px"
        groups = SLIDERS if walks else {"Speed": SLIDERS["Speed"]}
        panels = widgets.Accordion(
            [widgets.VBox([self.sliders[name] for name in group]) for group in groups.values()],
            titles=list(groups),
            selected_index=0,
        )
        checks = [self.wounded] * able + [self.forward] * walks
        self.widget = widgets.VBox(
            [
                widgets.HBox([self.playing, self.step, self.reset]),
                self.method,
                self.motion,
                *([widgets.HBox(checks)] if checks else []),
                panels,
                self.view,
            ],
            layout=widgets.Layout(width="440px", flex="0 1 auto"),
        )

    def on_change(self, tell: Callable[[str, Any], None]) -> None:
        """Call tell(name, value) whenever a person moves something."""
        named = {
            "playing": self.playing, "method": self.method, "motion": self.motion,
            "wounded": self.wounded, "forward": self.forward, "view": self.view, **self.sliders,
        }  # fmt: skip

        def listen(name: str, control: Any) -> None:
            def changed(change: Any) -> None:
                if not (self._quiet or _same(change["old"], change["new"])):
                    tell(name, change["new"])

            control.observe(changed, "value")

        for name, control in named.items():
            listen(name, control)
        self.playing.observe(self._name_button, "value")
        self.reset.on_click(lambda _: tell("reset", None))
        self.step.on_click(lambda _: tell("step", None))

    def agree(self, gait: Gait | Path) -> None:
        """Set the sliders to what the gait says, and tell nobody."""
        self._quiet = True
        try:
            for name, slider in self.sliders.items():
                value = getattr(gait, name)
                slider.min, slider.max = min(slider.min, value), max(slider.max, value)
                slider.value = value
        finally:
            self._quiet = False

    def say_playing(self, on: bool) -> None:
        """Have the button say whether it plays, and tell nobody."""
        self._quiet = True
        try:
            self.playing.value = on
        finally:
            self._quiet = False

    def _name_button(self, change: Any) -> None:
        self.playing.description = "Pause" if change["new"] else "Play"


def motions(session: Session) -> list[str]:
    """The names of the motions that a session's figure can make."""
    known = list(MOTIONS) if isinstance(session.gait, Gait) else []
    return known if session.gait.name in known else [*known, session.gait.name]


def _same(old: Any, new: Any) -> bool:
    """Whether a slider in the page only rounded the number that it was given."""
    return isinstance(new, float) and abs(new - old) < 1e-9


def _slider(value: float, label: str, low: float, high: float, step: float) -> Any:
    kind = widgets.IntSlider if isinstance(step, int) else widgets.FloatSlider
    return kind(
        value=value, min=min(low, value), max=max(high, value), step=step, description=label,
        style=LABEL, layout=widgets.Layout(width="auto"), continuous_update=True,
    )  # fmt: skip
