"""The walking human of chapter 7: scene, controls, curves and table, alive."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import ipywidgets as widgets

from ikteach.motion.gait import MOTIONS, WOUND
from ikteach.motion.session import Session
from ikteach.solvers import SOLVERS, Solver
from ikteach.study import distances
from ikteach.view.controls import Controls
from ikteach.view.live import Live
from ikteach.view.scene import Scene
from ikteach.view.strips import SECONDS, Strips


class GaitPlayer(Live):
    """A human that follows the targets of a gait, by every method at once; one of them is shown.

    Display it in a notebook. `session` holds all state and may be changed from cells while the
    figure moves.
    """

    def __init__(
        self, methods: Mapping[str, Solver] = SOLVERS, *, slot: str | None = "gait", **options: Any
    ) -> None:
        session = Session(methods=methods, **options)
        scene = Scene(session.tree, session.effectors, slot=None)
        super().__init__(session, scene, slot, Strips(session))
        self._table = widgets.HTML()
        self.controls = Controls(list(methods), session)
        self.controls.on_change(self.guarded(self._obey))
        self.children = [
            widgets.HBox([self.scene.widget, self.controls.widget]),
            self.status,
            self.strips,
            self._table,
        ]
        self.report()

    def say_playing(self, on: bool) -> None:
        """Have the button say whether it plays."""
        self.controls.say_playing(on)

    @property
    def words(self) -> str:
        """What the picture shows, for those who cannot see it."""
        return words(self.session)

    def draw(self) -> None:
        """Have the scene show what the session says."""
        session = self.session
        self.scene.show(
            session.theta[session.method],
            session.targets,
            floor=session.floor,
            advance=session.advance,
            change=self._changes,
            frames=session.frames_of(session.method),
        )

    def report(self) -> None:
        """Bring words and tables up to date."""
        session = self.session
        self.scene.driver.description = self.words
        self._table.value = table(session, session.method)

    def _obey(self, name: str, value: Any) -> None:
        session = self.session
        if name == "method":
            session.show(value)
        elif name == "motion":
            session.gait = replace(
                MOTIONS[value], forward=session.gait.forward, wound=session.gait.wound
            )
            self.controls.agree(session.gait)
        elif name == "wounded":
            session.change(wound=WOUND if value else {})
        elif name == "view":
            self.scene.look_from(value)
        elif name == "playing":
            self.playing = value
        elif name == "reset":
            session.reset()
        elif name == "step":
            self.step()
        else:
            session.change(**{name: value})


def words(session: Session) -> str:
    """The shown figure in words: what it does, by which method, and how well."""
    far = ", ".join(
        f"{name} {100 * d:.1f} cm"
        for name, d in zip(session.effectors.names, session.error, strict=True)
    )
    motion = "by hand" if session.by_hand else session.gait.name
    wounded = "wounded, " if session.gait.wound else ""
    return f"A human, {wounded}{motion} by {session.method}. From its target: {far}."


def table(session: Session, shown: str | None = None) -> str:
    """The last seconds of each method as a table, in HTML; the one that is `shown` says so."""
    tracks = session.tracks(last=round(SECONDS / session.dt))
    if not tracks:
        return "<p>No tick yet: the table fills when the figure moves.</p>"
    frame = distances(tracks).rename(index={shown: f"{shown} (shown)"})
    return (
        "<p>Distance to target in cm, mean of the last 10 s; worst distance in cm; jitter "
        "(mean ‖Δ²θ‖) in degrees; joints held at limits, on average.</p>"
        + frame.to_html(float_format="{:.2f}".format, border=0, classes="ikteach-table")
    )
