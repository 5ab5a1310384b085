"""Chapter 8's widget: four humans, one set of targets, one clock, one log."""

from math import radians
from typing import Any

import ipywidgets as widgets
import numpy as np

from ikteach.motion import BUSS_CAPS, gait
from ikteach.motion.session import Session
from ikteach.solvers import SOLVERS
from ikteach.view.bench import choice, slider
from ikteach.view.live import Live
from ikteach.view.player import table
from ikteach.view.scene import Scene
from ikteach.view.strips import SECONDS, Strips

EQUAL, OWN = "equal caps", "each author's caps"


class Race(Live):
    """Four humans that follow the same targets at the same moment, each by its own method.

    Display it in a notebook. `session` holds all state; `values` is what the controls say.
    """

    def __init__(self, degrees: float = 30.0, *, slot: str | None = "race") -> None:
        session = Session()
        scene = Scene(
            session.tree,
            session.effectors,
            names=list(SOLVERS),
            apart=1.9,
            width=960,
            height=400,
            slot=None,
        )
        super().__init__(session, scene, slot, Strips(session))
        self._table = widgets.HTML()
        step, reset = (widgets.Button(description=words) for words in ("Step", "Reset"))
        self.controls = {
            "caps": choice("caps", [EQUAL, OWN]),
            "motion": choice("motion", list(gait.MOTIONS)),
            "degrees": slider("equal cap [° a step]", degrees, 1.0, 45.0, 0.5),
            "speed": slider("speed ω [rad/s]", session.gait.speed, 0.0, 20.0, 0.1),
        }
        step.on_click(self.guarded(lambda _: self.step()))
        reset.on_click(self.guarded(lambda _: session.reset()))
        for name, control in self.controls.items():
            control.observe(self.guarded(lambda _, name=name: self._obey(name)), "value")
        self.children = [
            widgets.HBox([self.play_button(), step, reset]),
            # side by side where there is room, so that figures and curves are seen with them
            widgets.HBox([*self.controls.values()], layout=widgets.Layout(flex_flow="row wrap")),
            self.status,
            self.scene.widget,
            self.strips,
            self._table,
        ]
        self._obey("caps")
        self.report()

    @property
    def values(self) -> dict[str, Any]:
        """What the controls say now."""
        return {name: control.value for name, control in self.controls.items()}

    @property
    def words(self) -> str:
        """Who is how far from the targets, on average of the last seconds."""
        session = self.session
        tracks = session.tracks(last=round(SECONDS / session.dt))
        far = ", ".join(f"{name} {100 * run.error.mean():.1f} cm" for name, run in tracks.items())
        caps = self.values["caps"]
        return f"Four humans, {session.gait.name}, {caps}. Mean distance: {far or 'no tick yet'}."

    def refresh(self) -> None:
        """Take one tick, and report."""
        self.session.tick()
        self.report()

    def draw(self) -> None:
        """Have the scene show what the session says."""
        session = self.session
        self.scene.show(
            np.array([session.theta[name] for name in SOLVERS]),
            session.targets,
            floor=session.floor,
            change=self._changes,
        )

    def report(self) -> None:
        """Bring words and tables up to date."""
        self.scene.driver.description = self.words
        self._table.value = "<p>On the left above: the effectors of dls.</p>" + table(self.session)

    def _obey(self, name: str) -> None:
        session, values = self.session, self.values
        if name == "motion":
            session.gait = gait.MOTIONS[values["motion"]]
            self.controls["speed"].value = session.gait.speed
        elif name == "speed":
            session.change(speed=values["speed"])
        else:
            equal = dict.fromkeys(SOLVERS, radians(values["degrees"]))
            session.bound(BUSS_CAPS if values["caps"] == OWN else equal)
