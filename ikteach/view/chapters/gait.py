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
from ikteach.view.live.controls import SLIDERS, motions
from ikteach.view.live.live import Live
from ikteach.view.live.panel import Does, Panel, button, choice, dropdown, slider, tick_box
from ikteach.view.live.strips import SECONDS, Strips
from ikteach.view.stage.lengths import Lengths
from ikteach.view.stage.stage import sides_of
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
        self.panel = self._panel()
        self.controls = self.panel.controls
        self.children = [
            widgets.HBox([self.scene.widget, self.panel.widget]),
            self.status,
            self.strips,
            self._table,
        ]
        self.report()

    @property
    def words(self) -> str:
        """Say what the picture shows, for those who cannot see it."""
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

    def _panel(self) -> Panel:
        session, gait = self.session, self.session.gait
        walks, able = isinstance(gait, Gait), set(WOUND) <= set(session.tree.names)
        methods = choice("Method", list(session.methods), session.method, label_width="60px")
        motion = choice("Motion", motions(session), gait.name, label_width="60px")
        sides = dropdown("View", sides_of(session.tree, session.effectors), label_width="60px")
        boxes = {}
        if able:
            boxes["wounded"] = Does(tick_box("wounded", bool(gait.wound)), self._wound)
        if walks:
            ahead = tick_box("moving forward", gait.forward)
            boxes["forward"] = Does(ahead, lambda on: session.change(forward=on))
        clock = {
            "playing": self.play_button,
            "step": Does(button("Step"), self.step),
            "reset": Does(button("Reset"), session.reset),
        }
        return Panel(
            "Gait",
            [
                clock,
                {"method": Does(methods, session.show)},
                {"motion": Does(motion, self._move)},
                *([boxes] if boxes else []),
                {"view": Does(sides, self.scene.look_from)},
            ],
            folded={
                group: [{name: self._slider(name, *spec)} for name, spec in sliders.items()]
                for group, sliders in SLIDERS.items()
                if walks or group == "Speed"
            },
            opened=0,
            guard=self.guarded,
            width="440px",
            flex="0 1 auto",
        )

    def _slider(self, name: str, label: str, low: float, high: float, step: float) -> Does:
        """Make the slider of a parameter of the gait."""
        value = getattr(self.session.gait, name)
        made = slider(label, value, low, high, step, width="auto", label_width="140px")
        return Does(made, lambda value: self.session.change(**{name: value}))

    def _wound(self, on: bool) -> None:
        self.session.change(wound=WOUND if on else {})

    def _move(self, motion: str) -> None:
        session = self.session
        session.gait = other_motion(session, motion, self._first)
        parameters = vars(session.gait).keys() & self.controls.keys() - {"forward"}
        self.panel.put(**{name: getattr(session.gait, name) for name in parameters})


def other_motion(session: Session, name: str, start: Gait | Path) -> Gait | Path:
    """Give the motion of that name, or `start`, with the present wound and way."""
    gait: Gait | Path = MOTIONS[name] if name in MOTIONS and name != start.name else start
    if isinstance(gait, Gait):
        return replace(gait, forward=session.gait.forward, wound=session.gait.wound)
    return replace(gait, wound=session.gait.wound)


def words(session: Session) -> str:
    """Say what the shown figure does, by which method, and how well."""
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
    """Write the last seconds of each method as a table; the `shown` one says so."""
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
