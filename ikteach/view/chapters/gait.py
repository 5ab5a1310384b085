"""The walking human of chapter 7: scene, controls, curves and table, alive."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from ikteach.markup import Markup
from ikteach.motion.gait import MOTIONS, WOUND, Gait
from ikteach.motion.live.session import Session
from ikteach.motion.live.settings import SESSION, check_options
from ikteach.motion.methods import Methods
from ikteach.motion.path import Motion
from ikteach.study import distances
from ikteach.view.live.live import Live
from ikteach.view.live.panel import Does, Panel, button, choice, dropdown, tick_box
from ikteach.view.live.strips import SECONDS, Strips
from ikteach.view.stage.lengths import Lengths, counted, misses, told
from ikteach.view.stage.stage import sides_of
from ikteach.view.tools.session_panels import (
    SLIDERS,
    MotionPanel,
    gait_rows,
    gait_values,
    settle_sliders,
)
from ikteach.view.webgl.scene import Scene
from ikteach.view.widgets import prose
from ikteach.view.widgets.layout import Arranged
from ikteach.view.widgets.prose import Prose


class GaitPlayer(Live):
    """A figure that follows a gait by every method at once.

    One of the methods is shown.

    methods  {name: solver}, or solvers and their names in a list, or one of them alone; the four
             of the course if none are given
    motions  {name: motion}, or a motion alone, to choose from beside those that the figure knows
    pad      whether there is a pad below it, on which a path is drawn by hand
    options  go to `Session`: the figure (a human if none is given), its gait or path, and so on

    Display it in a notebook. `session` holds all state and may be changed from cells while the
    figure moves.
    """

    def __init__(
        self,
        methods: Methods | None = None,
        *,
        motions: Motion | Mapping[str, Motion] | None = None,
        pad: bool = False,
        slot: str | None = "gait",
        **options: Any,
    ) -> None:
        check_options(options, [*SESSION, "slot"])
        session = Session(methods=methods, **options)
        scene = Scene(session.tree, session.effectors, slot=None)
        super().__init__(session, scene, slot, Strips(session))
        self._table = Prose()
        self.motion = MotionPanel(
            session, self._acting, motions, by_hand=False, pad="open" if pad else False
        )
        self.panel = self._make_panel()
        self.controls = self.panel.controls
        self.choosing = self.controls["method"]
        self.watch(scene)
        self.arranged = Arranged([self.scene.widget], [self.panel.widget, self._table])
        self.children = [
            self.arranged,
            self.status,
            self.strips,
        ]
        self._agree()
        self.report()

    def _make_panel(self) -> Panel:
        session, scene = self.session, self.scene
        look: dict[str, Any] = {"label_width": "60px"}
        walks, able = bool({*MOTIONS} & {*self.motion.known}), set(WOUND) <= set(session.tree.names)
        wounded = Does(tick_box("wounded", bool(session.gait.wound)), self._wound)
        forward = Does(
            tick_box("moving forward", session.gait.forward),
            lambda on: session.change(forward=on),
        )
        checks = {"wounded": wounded} if able else {}
        checks |= {"forward": forward} if walks else {}
        method = choice("Method", list(session.methods), session.method, **look)
        sides = dropdown("View", sides_of(session.tree, session.effectors), **look)
        groups = SLIDERS if walks else ["Speed"]
        panel = Panel(
            "Gait",
            [
                {
                    "playing": self.play_button,
                    "step": Does(button("Step"), self.step),
                    "reset": Does(button("Reset"), session.reset),
                },
                {"method": Does(method, session.show)},
                self.motion.widget,
                *([checks] if checks else []),
                {"view": Does(sides, scene.look_from)},
            ],
            folded={group: gait_rows(session, group, width="auto") for group in groups},
            opened=None if self.motion.pad else 0,
            shows=lambda: gait_values(session, *groups),
            guard=self.guarded,
        )
        panel.controls |= self.motion.controls
        return panel

    def _agree(self) -> None:
        self.motion.agree()
        self.panel.agree()
        settle_sliders(self.panel, self.session)

    def _wound(self, on: bool) -> None:
        self.session.change(wound=WOUND if on else {})

    @property
    def words(self) -> str:
        """The picture in words, for people who cannot see it."""
        return session_words(self.session)

    def draw(self) -> None:
        """Draw the session's state in the scene."""
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
        self._table.value = session_table(session, session.method)
        self._agree()  # with what a cell has changed


def session_words(session: Session) -> str:
    """Put the movement of the shown figure into words.

    They name its motion and its method, and say how well it follows.
    """
    far = ", ".join(told(session.tree, session.effectors, session.error))
    wounded = "wounded, " if session.gait.wound else ""
    sines, name = isinstance(session.gait, Gait), session.gait.name
    who, does = ("human", f"{name} by") if sines else ("figure", f"motion {name}, by")
    does = "moved by hand, solved by" if session.by_hand else does
    return f"A {who}, {wounded}{does} {session.method}. From its target: {far}."


def session_table(session: Session, shown: str | None = None) -> Markup:
    """Write the last seconds of each method as a table.

    The `shown` one says so.
    """
    tracks = session.tracks(last=round(SECONDS / session.dt))
    if not tracks:
        return Markup("<p>No tick yet: the table fills when the figure moves.</p>")
    frame = distances(tracks).rename(index={shown: f"{shown} (shown)"})
    effectors, length = session.effectors, Lengths.of(session.tree, session.effectors)
    off = np.array([misses(effectors, run.error).mean(axis=0) for run in tracks.values()])
    directions = frame.columns[: len(effectors)][effectors.w == 0]
    frame.loc[:, frame.columns.difference([*directions, "jitter", "held"])] *= 0.01 / length.metres
    frame.loc[:, directions] = np.degrees(off[:, effectors.w == 0])
    frame = frame.rename(columns={name: f"{name} [°]" for name in directions})
    return Markup(
        "<p>Distance to target in {}, mean of the last 10 s; worst of them; jitter "
        "(mean ‖Δ²θ‖) in degrees; joints held at limits, on average.{}</p>{}"
    ).format(length.name, counted(effectors), prose.table(frame, "{:.2f}"))
