"""Chapter 11's figure: a recorded walk, the thesis's and a natural one, on a treadmill each."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from ikteach.arrays import Array
from ikteach.body import forward, locate
from ikteach.formats.bvh import recorded_walk
from ikteach.markup import Markup
from ikteach.motion.live.abreast import Abreast
from ikteach.motion.live.session import Session
from ikteach.motion.paths.walk import Walk, at_speed
from ikteach.solvers import SOLVERS
from ikteach.study import gait_report
from ikteach.study.walks import lately, limbs, three_walks
from ikteach.view.live.bands import LAST, OFTEN, Bands, last_stride
from ikteach.view.live.live import Live, recorded_bones
from ikteach.view.live.panel import Does, Panel, button, choice, dropdown, slider, tick_box
from ikteach.view.stage.layers import RECORDED_BONES
from ikteach.view.stage.stage import sides_of
from ikteach.view.webgl.scene import Scene
from ikteach.view.widgets import prose
from ikteach.view.widgets.layout import Arranged
from ikteach.view.widgets.prose import Prose

SEEN = ("ball.l", "ball.r", "hand.l", "hand.r", "knee.l", "knee.r")  # whose targets are drawn
PARTS = ("pelvis", "feet", "knees", "elbows", "hands")  # effectors that are switched together
PART = {"heel": "feet", "ball": "feet", "knee": "knees", "elbow": "elbows", "hand": "hands"}
NOBODY, SIDE = "nobody", "three-quarter"
SHOWN, FIRST = "shown", "sdls"  # the one method of each walk, and which it is at first
TOO_SHORT = 0.01  # by which legs may be too short before it is said [m]
TABLE = ("score", "slip", "drag", "clearance", "double support")
PARAMETERS: Mapping[str, tuple[str, float, float, float]] = {
    "speed": ("speed [m/s]", 0.6, 1.6, 0.05),
    "cadence": ("steps per minute", 80.0, 140.0, 1.0),
    "duty": ("duty [share of the cycle]", 0.52, 0.75, 0.01),
    "lift": ("lift of the ankle [m]", 0.0, 0.2, 0.005),
    "push_off": ("push-off [°]", -90.0, -20.0, 1.0),
    "strike": ("heel strike [°]", 0.0, 30.0, 1.0),
    "height": ("height of the pelvis [m]", 0.84, 0.95, 0.005),
    "tilt": ("tilt of the pelvis [°]", 0.0, 25.0, 1.0),
}


def stretched(walk: Walk) -> str:
    """Say so if a walk's stride is too long."""
    if walk.spare > -TOO_SHORT:
        return ""
    return (
        f"The legs are {-100 * walk.spare:.0f} cm too short for a stride of {walk.stride:.2f} m:"
        " the feet cannot be where the plan wants them."
    )


class WalksPlayer(Live):
    """Three walkers side by side, on a treadmill each.

    One follows a recorded walk, one the thesis's targets, one a natural walk, whose parameters have
    sliders. Below them hip, knee and ankle run on the norm's band.

    session   has `sessions` by name, which may be changed from cells
    """

    REPORT_EVERY = 90  # ticks: to measure three gaits takes longer than a tick

    def __init__(self, *, slot: str | None = "walks") -> None:
        self.walks = three_walks(recorded_walk())
        sessions = {
            name: Session(figure, path, {SHOWN: FIRST}, iterations=2)
            for name, (figure, path) in self.walks.items()
        }
        self.tree = sessions["natural"].tree
        self._seen_at = limbs(self.tree, SEEN)
        names = [*sessions]
        scene = Scene(
            self.tree, self._seen_at, names=names, apart=1.2, width=760, height=400, slot=None
        )
        super().__init__(Abreast(sessions), scene, slot)
        self._drawn = -1
        self.bands, self._table = Bands(names), Prose()
        self.panel = self._make_panel()
        self.controls = self.panel.controls
        self.choosing = self.controls["method"]
        self.watch(scene)
        below = [self.panel.widget, self._table]
        self.children = [Arranged([scene.widget, self.bands], below, wide=True), self.status]
        self.report()

    def _make_panel(self) -> Panel:
        walk = self.session.sessions["natural"].gait
        look: dict[str, Any] = {"label_width": "60px"}
        sliders = [
            {
                name: Does(
                    slider(label, getattr(walk, name), *span, width="auto", label_width="150px"),
                    lambda value, name=name: self._change(**{name: value}),
                )
            }
            for name, (label, *span) in PARAMETERS.items()
        ]
        follow = tick_box("the rest follows the speed, as in people", width="auto")
        follows = {"follows": Does(follow, self._follow)}
        asked = {part: Does(tick_box(part, True, width="auto"), self._weigh) for part in PARTS}
        ground = dropdown("Ground goes with", [*self.walks, NOBODY], "natural", label_width="110px")
        sides = dropdown("View", sides_of(self.tree, self._seen_at), SIDE, **look)
        clock = {
            "playing": self.play_button,
            "step": Does(button("Step"), self.step),
            "reset": Does(button("Reset"), self._reset),
        }
        method = Does(choice("Method", list(SOLVERS), FIRST, **look), self._show)
        self.scene.look_from(SIDE)
        return Panel(
            "Walks",
            [
                clock,
                {"method": method},
                {"view": Does(sides, self.scene.look_from), "ground": ground},
                {"skeleton": Does(tick_box(RECORDED_BONES, False, width="auto"), self._haunt)},
            ],
            folded={"The natural walk": [*sliders, follows], "Effectors of all": [asked]},
            opened=0,
            guard=self.guarded,
        )

    def _haunt(self, on: bool) -> None:
        """Show the bones of whom the walk was recorded from, or hide them."""
        self.scene.switch(RECORDED_BONES, on)

    def _show(self, method: str) -> None:
        for session in self.session.sessions.values():
            session.use(SHOWN, method)

    def _change(self, **parameters: float) -> None:
        session = self.session.sessions["natural"]
        if "speed" in parameters and self.panel.values["follows"]:
            session.gait = at_speed(parameters["speed"])
            self.panel.put(**{name: getattr(session.gait, name) for name in PARAMETERS})
        else:
            session.change(**parameters)
        assert isinstance(session.gait, Walk)
        self.status.say(stretched(session.gait))

    def _follow(self, on: bool) -> None:
        if on:
            self._change(speed=self.panel.values["speed"])

    def _weigh(self, _: bool) -> None:
        """Ask for the parts that are ticked, and for nothing else."""
        on = self.panel.values
        for session in self.session.sessions.values():
            parts = [PART.get(name.partition(".")[0], "pelvis") for name in session.effectors.names]
            session.adjust(weights=np.array([float(on[part]) for part in parts]))

    def _reset(self) -> None:
        self.session.reset()
        self._drawn = -1
        self.scene.clear()

    @property
    def words(self) -> str:
        """The three walks, in words."""
        each = "; ".join(
            f"{name} {100 * session.error.mean():.1f} cm from its targets, left knee"
            f" {np.degrees(session.theta[session.method][self.tree.index('knee.l')]):.0f}°"
            for name, session in self.session.sessions.items()
        )
        return f"Three walkers side by side, by {self.controls['method'].value}: {each}."

    def draw(self) -> None:
        """Draw each walk over one floor, and its angles."""
        sessions = self.session.sessions
        floor = sessions["natural"].floor
        up = self.tree.index("pelvis.y.slide")
        theta, targets, bones = [], [], list[Array | None]()
        for session in sessions.values():
            pose = session.theta[session.method].copy()
            pose[up] += (rise := floor - session.floor)
            theta.append(pose)
            targets.append(self._targets(session, pose, rise))
            recorded = recorded_bones(session)
            bones.append(None if recorded is None else recorded + (0, rise, 0))
        ground = sessions.get(self.panel.values["ground"])
        gone = 0.0 if ground is None else ground.gait.pace * ground.time
        self.scene.show(
            *(np.array(theta), np.array(targets)),
            floor=floor,
            advance=gone,
            change=self._changes,
            skeletons=bones,
        )
        if self.session.ticks // OFTEN != self._drawn:
            self._drawn = self.session.ticks // OFTEN
            self.bands.draw({name: last_stride(one, LAST) for name, one in sessions.items()})

    def _targets(self, session: Session, pose: Array, rise: float) -> Array:
        """Place the targets that are drawn (k, 3); where none is, the mark lies on the body."""
        places = locate(forward(self.tree, pose), self._seen_at)
        for i, name in enumerate(self._seen_at.names):
            if name in session.effectors.names:
                places[i] = session.targets[session.effectors.names.index(name)] + (0, rise, 0)
        return places

    def report(self) -> None:
        """Bring words and table up to date."""
        self.scene.driver.description = self.words
        rows = {name: self._measured(one) for name, one in self.session.sessions.items()}
        frame = pd.DataFrame.from_dict(rows, orient="index")
        self._table.value = Markup(
            "<p>The last strides: mean distance to the targets [cm]; score against the norm [°];"
            " slip, drag and clearance of the worse foot [cm]; share of time on both feet."
            " “–”: no whole stride yet.</p>{}"
        ).format(prose.table(frame, "{:.2f}"))

    def _measured(self, session: Session) -> dict[str, float]:
        """Measure the last strides of a walk."""
        run, found = lately(session, LAST), dict.fromkeys(TABLE, np.nan)
        if run is not None:
            try:
                report = gait_report({"": run}, session.gait).iloc[0]
            except ValueError:  # no whole stride as yet
                report = pd.Series(found)
            found = {name: float(report[name]) for name in TABLE}
        found |= {name: 100 * found[name] for name in ("slip", "drag", "clearance")}
        return {"distance": 100 * float(session.error.mean()), **found}
