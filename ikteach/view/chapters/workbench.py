"""The workbench of chapter 9: a human, nine panels, and everything that happened as data."""

from pathlib import Path
from typing import Any

import ipywidgets as widgets
import numpy as np

from ikteach.motion.live.log import Log
from ikteach.motion.live.session import Session
from ikteach.motion.live.settings import SESSION, check_options
from ikteach.motion.mix import Mix
from ikteach.motion.path import Motion
from ikteach.solvers import SOLVERS, Solver
from ikteach.view.chapters.gait import session_table, session_words
from ikteach.view.live.bands import OnTheNorm
from ikteach.view.live.live import Live
from ikteach.view.live.panel import Does, Panel, button
from ikteach.view.live.strips import Strips
from ikteach.view.tools.files import Keeper
from ikteach.view.tools.inspector import Glass
from ikteach.view.tools.motion_files import MotionFiles
from ikteach.view.tools.recorder import Recorder
from ikteach.view.tools.replay import Replay
from ikteach.view.tools.session_panels import GaitPanel, MethodPanel, MotionPanel, WoundPanel
from ikteach.view.tools.view_panels import GHOST, ONE, ObjectPanel, ViewPanel, scene_of
from ikteach.view.webgl.targets import Targets
from ikteach.view.widgets.closing import close_all
from ikteach.view.widgets.layout import Arranged
from ikteach.view.widgets.prose import Prose

ROOM = np.array([1.6, 1.8, 1.6])  # [m] how far from the pelvis a target may be put
OPTIONS = [name for name in SESSION if name not in ("figure", "methods")] + ["folder", "slot"]


class Workbench(Live):
    """A human that moves, with all that can be set.

    It walks, runs, or follows targets by hand. Display it in a notebook. `session` holds all state
    and may be changed from cells. To run the cell again closes the workbench that it made before.
    Files go to `folder`.

    scene, targets, recorder, glass, norm   its parts
    panels     {title: panel}, whose `controls` are the widgets by name
    replay     the run that is looked at, or None
    """

    def __init__(
        self, *, folder: str | Path = ".", slot: str | None = "workbench", **options: Any
    ) -> None:
        check_options(options, OPTIONS)
        session = _session(options)
        super().__init__(session, scene_of(session, ONE), slot, Strips(session))
        self.replay: Replay | None = None
        self.figures, self.targets = ONE, self._targets()
        self.recorder = Recorder(session, folder=folder, slot=None)
        self.glass = Glass(session, stop=self.pause, show=self.draw, slot=None)
        self.norm = OnTheNorm(session)
        self.keeper = Keeper(session, self._look_at, folder=folder, slot=None)
        self.motion = MotionPanel(session, self._acting)
        self.files = MotionFiles(session, self._take, folder=folder, slot=None)
        self.wounds = WoundPanel(session, self._acting)
        self.view = ViewPanel(self, self.guarded, self._turned, self._set_figures)
        self.object = ObjectPanel(self, self.guarded, self.view.straighten)
        self.panels = {panel.title: panel for panel in self._make_panels()}
        self.choosing = self.panels["Method"].controls["method"]
        self.watch(self.scene)
        self.bar = _bar(self)
        self._drawer = widgets.Accordion(
            [
                *(panel.widget for panel in self.panels.values()),
                widgets.VBox([self.recorder, self.files, self.keeper]),
                self.glass,
            ],
            titles=[*self.panels, "Recording", "One iteration, magnified"],
            selected_index=0,
        )
        self._table, self._aside = Prose(), widgets.VBox()  # aside: a run that is looked at
        self._arranged = Arranged(self._stage(), [self._aside, self._drawer, self._table])
        self.children = [self._arranged, self.status, self.strips, self.norm]
        self.view.straighten()
        self._agree()
        self.report()

    def _make_panels(self) -> list[Panel]:
        session, act = self.session, self._acting
        swings = ("Steps", "Hands")
        return [
            MethodPanel(session, act),
            self.motion,
            self.wounds,
            self.view,
            self.object,
            GaitPanel("Speed", session, ("Speed",), act),
            GaitPanel("Target position", session, swings, act, self.targets),
        ]

    # What the loop calls.

    def draw(self) -> None:
        """Draw the session, or nothing while a replay is open."""
        if self.replay is not None:
            return
        session = self.session
        shown = [session.method, self.view.values["ghost"]] if self.figures == GHOST else SOLVERS
        shown = [session.method] if self.figures == ONE else list(shown)
        theta = self.wounds.drawn(np.array([session.theta[name] for name in shown]))
        self.scene.show(
            theta[0] if len(shown) == 1 else theta,
            session.targets,
            floor=session.floor,
            advance=session.advance,
            change=self._changes,
            **self.view.about(theta),
        )

        self.norm.follow()

    def report(self) -> None:
        """Bring words and tables up to date."""
        self.scene.driver.description = self.words
        self._table.value = session_table(self.session, self.session.method)
        self.targets.agree()
        self.view.agree()  # with a page that became dark

    # What a person can do.

    @property
    def words(self) -> str:
        """The picture in words, for people who cannot see it."""
        return session_words(self.session)

    def play(self) -> None:
        """Let time pass."""
        self._back_to_now()
        self.session.note("play")
        super().play()

    def pause(self) -> None:
        """Stop the clock; controls still act."""
        if self.playing:
            self.session.note("pause")
        super().pause()

    def quit(self) -> None:
        """Stop every loop, and say so.

        To run the cell again begins anew.
        """
        self.recorder.halt()
        self._back_to_now()
        self.pause()
        self.stop()
        for panel in (*self.panels.values(), self.bar):
            panel.disable()
        self.status.say("The workbench has ended: no loop runs. Run its cell again to begin anew.")

    def undo(self) -> None:
        """Take the last change back."""
        event = self.session.undo()
        self._agree()
        self.status.say(f"Taken back: {event}.")

    def scrub(self) -> None:
        """Stop the clock, and look through the log."""
        self._look_at(self.session.log())

    def stay(self) -> None:
        """Begin again in place of Quit, on a page without a cell."""
        self.bar.controls["quit"].layout.display = "none"
        self.bar.controls["begin"].layout.display = None

    def keep_no_files(self) -> None:
        """Take the panel Recording away, for good.

        For a page that others operate.
        """
        close_all(self._drawer.children[-2])
        self._drawer.titles = [title for title in self._drawer.titles if title != "Recording"]

    def begin_again(self) -> None:
        """Put all back to the beginning, and play."""
        self._back_to_now()
        self.session.begin_again()
        self.scene.clear()
        for panel in self.panels.values():
            panel.restore()
        self.wounds.heal_drawing()
        self.view.renew() if self.figures == ONE else self._set_figures(ONE)
        self.set_pace(0)
        self._agree()
        self.play()

    def step(self) -> None:
        """Stop the clock, and let time leap once."""
        self._back_to_now()
        self.pause()
        for _ in range(self.session.gait.slowdown):
            self.session.tick()

    def _reset(self) -> None:
        self._back_to_now()
        self.session.reset()
        self.scene.clear()

    def _agree(self) -> None:
        for panel in self.panels.values():
            panel.agree()
        self.targets.agree()

    # What is looked at.

    def _turned(self) -> None:
        self.object.begin()

    def _set_figures(self, figures: str) -> None:
        self.figures = figures
        self._back_to_now()
        old, old_targets = self.scene, self.targets
        self.watch(scene_of(self.session, figures))
        self.scene.driver.measures = figures in (ONE, GHOST)
        self.targets = self._targets()
        box = self.panels["Target position"].widget
        box.children = [self.targets, *box.children[1:]]
        self._arranged.seen.children = self._stage()
        old_targets.close()
        old.close()
        self.view.renew()

    def _stage(self) -> list[widgets.Widget]:
        """List the picture and the clock."""
        return [self.scene.widget, self.bar.widget]

    def _targets(self) -> Targets:
        targets = Targets(
            self.scene, session=self.session, low=-ROOM, high=ROOM, undo=self.undo, slot=None
        )
        targets.on_change(self.guarded(lambda *_: self._agree()))
        return targets

    def _take(self, motion: Motion) -> None:
        """Let the targets make a motion from a file."""
        self.motion.add(motion)
        self._agree()
        self.acted()

    def _look_at(self, run: Log) -> None:
        if run.tree.names != self.session.tree.names:
            raise ValueError("that session is of another figure")
        self.pause()
        self._back_to_now()
        self.replay = Replay(run, self.scene, slot=None)
        self._aside.children = [self.replay]
        self.replay.status.come(with_all=True)
        self.status.say("A run is looked at. Play, or “Back to now”, goes on where it stopped.")

    def _back_to_now(self) -> None:
        if self.replay is not None:
            self._aside.children = []
            self.replay.close()
            self.replay = None
            self.status.say("")


def _bar(bench: Workbench) -> Panel:
    """Make the buttons of the clock."""
    row = {
        "playing": bench.play_button,
        "step": Does(button("Step"), bench.step),
        "undo": Does(button("Undo"), bench.undo),
        "reset": Does(button("Reset"), bench._reset),
        "scrub": Does(button("Look back"), bench.scrub),
        "live": Does(button("Back to now"), bench._back_to_now),
        "begin": Does(button("Begin again"), bench.begin_again),
        "quit": Does(button("Quit"), bench.quit),
    }
    row["begin"].control.layout.display = "none"  # until nobody can run the cell: `stay`
    return Panel("Session", [row], guard=bench.guarded)


def _session(options: dict[str, Any]) -> Session:
    """Make a session of a human with a mix among its methods."""
    effectors = Session().effectors
    mix = Mix.of(effectors, dict.fromkeys(effectors.names, "dls"))
    methods: dict[str, Solver] = {**SOLVERS, "mix": mix}
    return Session(methods=methods, **options)
