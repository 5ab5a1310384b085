"""Chapter 8's widget: a figure for each method, one set of targets, one clock, one log."""

from math import radians
from typing import Any

import ipywidgets as widgets
import numpy as np

from ikteach.markup import Markup
from ikteach.motion import BUSS_CAPS
from ikteach.motion.gait import stature
from ikteach.motion.live.session import Session
from ikteach.motion.live.settings import SESSION, check_options
from ikteach.motion.methods import Methods
from ikteach.view.chapters.gait import table
from ikteach.view.live.bench import choice, slider
from ikteach.view.live.live import Live
from ikteach.view.live.strips import SECONDS, Strips
from ikteach.view.stage.lengths import Lengths
from ikteach.view.tools.session_panels import motions, other_motion
from ikteach.view.webgl.scene import Scene
from ikteach.view.widgets.prose import Prose

EQUAL, OWN = "equal caps", "each author's caps"


class Race(Live):
    """Figures that follow the same targets at the same moment, each by its own method.

    methods  {name: solver}, or solvers and their names in a list, or one of them alone; the four
             of the course if none are given
    degrees  the step cap of all [° a step]
    options  go to `Session`: the figure (a human if none is given), its gait or path, and so on

    Display it in a notebook. `session` holds all state; `values` is what the controls say.
    """

    def __init__(
        self, methods: Methods | None = None, *, degrees: float = 30.0, slot: str | None = "race",
        **options: Any,
    ) -> None:  # fmt: skip
        check_options(options, [*SESSION, "degrees", "slot"])
        session = Session(methods=methods, **options)
        size = stature(session.tree, session.effectors)
        count = len(session.methods)
        scene = Scene(
            session.tree,
            session.effectors,
            names=[*session.methods],
            apart=None if size is None else 1.9 * size[0],  # so that running hands do not meet
            width=540 if count == 1 else min(960, 240 * count + 120),
            height=400,
            slot=None,
        )
        self._first = session.gait
        super().__init__(session, scene, slot, Strips(session))
        self._table = Prose()
        step, reset = (widgets.Button(description=words) for words in ("Step", "Reset"))
        speed = session.gait.speed
        self.controls = {
            "caps": choice("caps", [EQUAL, OWN]),
            "motion": choice("motion", motions(session), session.gait.name),
            "degrees": slider(
                "equal cap [° a step]", degrees, min(1.0, degrees), max(45.0, degrees), 0.5
            ),
            "speed": slider("speed ω [rad/s]", speed, min(0.0, speed), max(20.0, speed), 0.1),
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
        length = Lengths.of(session.tree, session.effectors)
        far = ", ".join(f"{name} {length(run.error.mean())}" for name, run in tracks.items())
        who = self.scene.stage.crowd
        caps = self.values["caps"]
        return f"{who}, {session.gait.name}, {caps}. Mean distance: {far or 'no tick yet'}."

    def refresh(self) -> None:
        """Take one tick, and report."""
        self.session.tick()
        self.report()

    def draw(self) -> None:
        """Have the scene show what the session says."""
        session = self.session
        self.scene.show(
            np.array([*session.theta.values()]),
            session.targets,
            floor=session.floor,
            advance=session.advance,
            change=self._changes,
        )

    def report(self) -> None:
        """Bring words and tables up to date."""
        self.scene.driver.description = self.words
        whose = Markup("<p>On the left above: the effectors of {}.</p>").format(self.session.method)
        self._table.value = whose + table(self.session)

    def _obey(self, name: str) -> None:
        session, values = self.session, self.values
        if name == "motion":
            session.gait = other_motion(session, values["motion"], self._first)
            speed = self.controls["speed"]
            speed.max = max(speed.max, session.gait.speed)
            speed.value = session.gait.speed
        elif name == "speed":
            session.change(speed=values["speed"])
        else:
            equal = dict.fromkeys(session.methods, radians(values["degrees"]))
            own = {name: BUSS_CAPS.get(name) for name in session.methods}
            session.bound(own if values["caps"] == OWN else equal)
