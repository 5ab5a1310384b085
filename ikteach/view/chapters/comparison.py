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
from ikteach.view.chapters.gait import session_table
from ikteach.view.live.live import Live
from ikteach.view.live.panel import Does, Panel, button, choice, slider
from ikteach.view.live.strips import SECONDS, Strips
from ikteach.view.stage.lengths import Lengths
from ikteach.view.tools.session_panels import motions, other_motion
from ikteach.view.webgl.scene import Scene
from ikteach.view.widgets import doors
from ikteach.view.widgets.layout import Arranged
from ikteach.view.widgets.prose import Prose

EQUAL, OWN = "equal caps", "each author's caps"
CAP = (0.5, 180.0)  # from, to [degrees per step]


class Race(Live):
    """Figures that follow the same targets, one per method.

    All follow them at the same moment, each by its own method.

    methods  {name: solver}, or solvers and their names in a list, or one of them alone; the four
             of the course if none are given
    degrees  the step cap of all [degrees per step]
    options  go to `Session`: the figure (a human if none is given), its gait or path, and so on

    Display it in a notebook. `session` holds all state; `values` are those of the controls.
    """

    def __init__(
        self,
        methods: Methods | None = None,
        *,
        degrees: float = 30.0,
        slot: str | None = "race",
        **options: Any,
    ) -> None:
        degrees = doors.within("degrees", degrees, *CAP)
        check_options(options, [*SESSION, "degrees", "slot"])
        session = Session(methods=methods, **options)
        super().__init__(session, _scene(session), slot, Strips(session))
        self._table = Prose()
        self._first = session.gait
        self.panel = self._panel(degrees)
        self.controls = self.panel.controls
        step, reset = button("Step"), button("Reset")
        step.on_click(self.guarded(lambda _: self.step()))
        reset.on_click(self.guarded(lambda _: session.reset()))
        clock = widgets.HBox([self.play_button, step, reset])
        self.children = [
            Arranged([self.scene.widget, self._table], [clock, self.panel.widget], wide=True),
            self.status,
            self.strips,
        ]
        self._bound()
        self.report()

    def _panel(self, degrees: float) -> Panel:
        session = self.session
        speed = slider("speed ω [rad/s]", session.gait.speed, 0.0, 20.0, 0.1)
        row = {  # side by side where there is room, so that figures and curves are seen with them
            "caps": Does(choice("caps", [EQUAL, OWN]), self._bound),
            "motion": Does(choice("motion", motions(session), session.gait.name), self._move),
            "degrees": Does(slider("equal cap [° per step]", degrees, 1.0, 45.0, 0.5), self._bound),
            "speed": Does(speed, lambda speed: session.change(speed=speed)),
        }
        return Panel("Race", [row], guard=self.guarded)

    @property
    def values(self) -> dict[str, Any]:
        """The values of the controls, by name."""
        return self.panel.values

    @property
    def words(self) -> str:
        """The figures, and how far each is from the targets.

        Distances are means over the last seconds.
        """
        session = self.session
        tracks = session.tracks(last=round(SECONDS / session.dt))
        length = Lengths.of(session.tree, session.effectors)
        far = ", ".join(f"{name} {length(run.error.mean())}" for name, run in tracks.items())
        who = self.scene.stage.crowd
        caps = self.values["caps"]
        return f"{who}, {session.gait.name}, {caps}. Mean distance: {far or 'no tick yet'}."

    def draw(self) -> None:
        """Draw the session's state in the scene."""
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
        whose = Markup("<p>The curves of each effector are those of {}.</p>").format(
            self.session.method
        )
        self._table.value = session_table(self.session) + whose

    def _move(self, motion: str) -> None:
        self.session.gait = other_motion(self.session, motion, self._first)
        self.panel.put(speed=self.session.gait.speed)

    def _bound(self, _: Any = None) -> None:
        session, values = self.session, self.values
        equal = dict.fromkeys(session.methods, radians(values["degrees"]))
        own = {name: BUSS_CAPS.get(name) for name in session.methods}
        session.bound(own if values["caps"] == OWN else equal)


def _scene(session: Session) -> Scene:
    """Make a scene with a figure per method, side by side."""
    size, count = stature(session.tree, session.effectors), len(session.methods)
    return Scene(
        session.tree,
        session.effectors,
        names=[*session.methods],
        apart=None if size is None else 1.9 * size[0],  # so that running hands do not meet
        width=540 if count == 1 else min(960, 240 * count + 120),
        height=400,
        slot=None,
    )
