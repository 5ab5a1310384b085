"""The walking human of chapter 7: scene, controls, curves and table, alive."""

from dataclasses import replace
from typing import Any

import ipywidgets as widgets

from ikteach.markup import Markup
from ikteach.motion.gait import MOTIONS, WOUND, Gait
from ikteach.motion.live.session import Session
from ikteach.motion.methods import Methods
from ikteach.motion.path import Path
from ikteach.study import distances
from ikteach.view.live.controls import Controls
from ikteach.view.live.live import Live
from ikteach.view.live.strips import SECONDS, Strips
from ikteach.view.stage.lengths import Lengths
from ikteach.view.webgl.scene import Scene
from ikteach.view.widgets import prose
from ikteach.view.widgets.prose import Prose


class GaitPlayer(Live):
    """A figure that follows the targets of a gait, by every method at once; one of them is shown.

    methods  {name: solver}, or solvers and their names in a list, or one of them alone; the four
             of the course if none are given
    options  go to `Session`: the figure (a human if none is given), its gait or path, and so on

    Display it in a notebook. `session` holds all state and may be changed from cells while the
    figure moves.
    """

    def __init__(
        self, methods: Methods | None = None, *, slot: str | None = "gait", **options: Any
    ) -> None:
        session = Session(methods=methods, **options)
        scene = Scene(session.tree, session.effectors, slot=None)
        super().__init__(session, scene, slot, Strips(session))
        self._table = Prose()
        self._first = session.gait
        self.controls = Controls(list(session.methods), session)
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
            session.gait = other_motion(session, value, self._first)
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


def other_motion(session: Session, name: str, start: Gait | Path) -> Gait | Path:
    """The motion of that name, or the one that it began with, with what is set about the figure."""
    gait: Gait | Path = MOTIONS[name] if name in MOTIONS and name != start.name else start
    if isinstance(gait, Gait):
        return replace(gait, forward=session.gait.forward, wound=session.gait.wound)
    return replace(gait, wound=session.gait.wound)


def words(session: Session) -> str:
    """The shown figure in words: what it does, by which method, and how well."""
    length = Lengths.of(session.tree, session.effectors)
    far = ", ".join(
        f"{name} {length(d)}"
        for name, d in zip(session.effectors.names, session.error, strict=True)
    )
    motion = "by hand" if session.by_hand else session.gait.name
    wounded = "wounded, " if session.gait.wound else ""
    who = "human" if isinstance(session.gait, Gait) else "figure"
    return f"A {who}, {wounded}{motion} by {session.method}. From its target: {far}."


def table(session: Session, shown: str | None = None) -> Markup:
    """The last seconds of each method as a table; the one that is `shown` says so."""
    tracks = session.tracks(last=round(SECONDS / session.dt))
    if not tracks:
        return Markup("<p>No tick yet: the table fills when the figure moves.</p>")
    frame = distances(tracks).rename(index={shown: f"{shown} (shown)"})
    length = Lengths.of(session.tree, session.effectors)
    frame.loc[:, [*session.effectors.names, "worst"]] *= 0.01 / length.metres
    return Markup(
        "<p>Distance to target in {}, mean of the last 10 s; worst of them; jitter "
        "(mean ‖Δ²θ‖) in degrees; joints held at limits, on average.</p>{}"
    ).format(length.name, prose.table(frame, "{:.2f}"))
