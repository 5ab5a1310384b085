"""The workbench of chapter 9: a human, nine panels, and everything that happened as data."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from math import cos, radians, sin
from pathlib import Path
from typing import Any

import ipywidgets as widgets
import numpy as np

from ikteach.body import forward, jacobian
from ikteach.motion.gait import MOTIONS, WOUND, displayed
from ikteach.motion.live.log import Log
from ikteach.motion.live.session import Session
from ikteach.motion.mix import Mix
from ikteach.motion.reachable import annulus
from ikteach.motion.step import clip, hold, ignore, per_chain, whole
from ikteach.solvers import SOLVERS, Solver, ellipsoid
from ikteach.solvers.sdls import hard, soft
from ikteach.view.chapters.gait import table, words
from ikteach.view.live.live import Live
from ikteach.view.live.strips import Strips
from ikteach.view.tools import panels
from ikteach.view.tools.files import Keeper
from ikteach.view.tools.inspector import Glass
from ikteach.view.tools.recorder import Recorder
from ikteach.view.tools.replay import Replay
from ikteach.view.webgl.scene import Scene
from ikteach.view.webgl.targets import Targets
from ikteach.view.widgets.closing import close_all
from ikteach.view.widgets.prose import Prose

CLAMPS = {"hard": hard, "soft": soft}
CAPS = {"whole": whole, "per_chain": per_chain}
LIMITS = {"hold": hold, "clip": clip, "ignore": ignore}
GAIT = ("speed", "step_frequency", "slowdown", "back_z_leg", "front_z_leg", "back_y_leg",
        "front_y_leg", "hand_z", "back_y_hand", "front_y_hand")  # fmt: skip
ROOM = np.array([1.6, 1.8, 1.6])  # [m] how far from the pelvis a target may be put


class Workbench(Live):
    """A human that walks, runs, or follows targets by hand, with all that can be set about it.

    Display it in a notebook. `session` holds all state and may be changed from cells. To run the
    cell again closes the workbench that it made before. Files go to `folder`.

    scene, targets, recorder, glass   its parts
    panels     {title: panel}, whose `controls` are the widgets by name
    replay     the run that is looked at, or None
    """

    def __init__(
        self, *, folder: str | Path = ".", slot: str | None = "workbench", **options: Any
    ) -> None:
        mix = Mix.of(Session().effectors, dict.fromkeys(Session().effectors.names, "dls"))
        methods: dict[str, Solver] = {**SOLVERS, "mix": mix}
        session = Session(methods=methods, **options)
        self._times = np.ones(len(session.tree))
        self._plus = np.zeros(len(session.tree))
        self._chosen = 0  # the effector whose J is drawn
        self.replay: Replay | None = None
        self._figures = panels.ONE
        super().__init__(session, self._scene(session), slot, Strips(session))
        self.targets = self._targets()
        self.recorder = Recorder(session, folder=folder, slot=None)
        self.glass = Glass(session, stop=self.pause, show=self.draw, slot=None)
        made = [
            panels.MethodPanel(session), panels.motion_panel(session),
            panels.control_panel(session), panels.view_panel(session), panels.ObjectPanel(),
            panels.speed_panel(session), panels.target_panel(session, self.targets),
        ]  # fmt: skip
        self.panels: dict[str, panels.Panel] = {panel.title: panel for panel in made}
        for panel in made:
            panel.on_change(self.guarded(self._obey))
        self.bar = self._bar()
        self.bar.on_change(self.guarded(self._obey))
        self.keeper = Keeper(session, self._look_at, folder=folder, slot=None)
        self._drawer = widgets.Accordion(
            [*(panel.widget for panel in made), widgets.VBox([self.recorder, self.keeper])],
            titles=[*self.panels, "Recording"],
            selected_index=0,
            layout={"flex": "1 1 430px", "max_width": "640px", "min_width": "0"},
        )
        self._stage = widgets.VBox([self.bar.widget, self.scene.widget])
        self._fit()
        self._table, self._aside = Prose(), widgets.VBox()
        glass = widgets.Accordion(
            [self.glass], titles=["One iteration under a glass"], selected_index=None
        )
        self.children = [
            widgets.HBox([self._stage, self._drawer], layout={"flex_flow": "row wrap"}),
            self.status,
            self._aside,
            self.strips,
            self._table,
            glass,
        ]
        self._look_from(self._control("side").value)
        self._agree()
        self.report()

    # What the loop calls.

    def draw(self) -> None:
        """Have the scene show what the session says, or nothing while a replay is open."""
        if self.replay is not None:
            return
        session = self.session
        shown = [session.method] if self._figures == panels.ONE else list(SOLVERS)
        theta = displayed(
            [session.theta[name] for name in shown], times=self._times, plus=self._plus
        )
        pose = theta[0] if len(shown) == 1 else theta
        self.scene.show(
            pose, session.targets, floor=session.floor, advance=session.advance,
            change=self._changes, **self._about(theta),
        )  # fmt: skip

    def _about(self, theta: Any) -> dict[str, Any]:
        """What the layers that are on need to know of the poses (f, n)."""
        on, i, session = self.scene.layers, self._chosen, self.session
        about: dict[str, Any] = {"effector": i}
        if on["columns of J"] or on["ellipsoid"]:
            J = jacobian(session.tree, forward(session.tree, theta), session.effectors)
            rows = J[:, 3 * i : 3 * i + 3]
            about |= {"columns": rows, "ellipsoid": ellipsoid(rows)}
        if on["reach"]:
            about["reach"] = [annulus(session.tree, session.effectors, i)]
        return about

    def report(self) -> None:
        """Bring words and tables up to date."""
        session = self.session
        self.scene.driver.description = self.words
        self._table.value = table(session, session.method)
        if not session.by_hand:
            self.targets.follow(session.targets)

    # What a person can do.

    @property
    def words(self) -> str:
        """What the picture shows, for those who cannot see it."""
        return words(self.session)

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

    def say_playing(self, on: bool) -> None:
        """Have the button say whether it plays."""
        self.bar.put(playing=on)
        self.bar.controls["playing"].description = "Pause" if on else "Play"

    def quit(self) -> None:
        """Stop every loop, and say so. To run the cell again begins anew."""
        self.recorder.halt()
        self._back_to_now()
        self.pause()
        self.stop()
        for panel in (*self.panels.values(), self.bar):
            for control in panel.controls.values():
                control.disabled = True
        self.status.say("The workbench has ended: no loop runs. Run its cell again to begin anew.")

    def undo(self) -> None:
        """Take the last change back."""
        event = self.session.undo()
        self._agree()
        self.status.say(f"Taken back: {event}.")

    def scrub(self) -> None:
        """Stop the clock, and look through what was."""
        self._look_at(self.session.log())

    def keep_no_files(self) -> None:
        """Take the panel Recording away, for good: for a page that others operate."""
        close_all(self._drawer.children[-1])

    # What a control does.

    def _obey(self, name: str, value: Any) -> None:
        session = self.session
        obeys: dict[str, Callable[[Any], None]] = {
            "playing": lambda on: self.play() if on else self.pause(),
            "step": lambda _: self.step(),
            "undo": lambda _: self.undo(),
            "scrub": lambda _: self.scrub(),
            "live": lambda _: self._back_to_now(),
            "reset": lambda _: self._reset(),
            "quit": lambda _: self.quit(),
            "method": self._show,
            "motion": self._move,
            "forward": lambda on: session.change(forward=on),
            "wounded": self._wound,
            "joint": lambda _: self._agree(),
            "mobility": self._set_mobility,
            "times": lambda x: self._draw_as(self._times, x),
            "plus": lambda x: self._draw_as(self._plus, radians(x)),
            "heal": lambda _: self._heal(),
            "side": self._look_from,
            "projection": lambda how: setattr(
                self.scene.cameras, "orthographic", how == "orthographic"
            ),
            "figures": self._set_figures,
            "effector": self._choose,
            "dark": lambda on: setattr(self.scene, "dark", on),
            "straight": lambda _: self._look_from(self._control("side").value),
        }
        if name in obeys:
            obeys[name](value)
        elif name in GAIT:
            session.change(**{name: value})
        elif name.startswith("layer."):
            self._switch(name.removeprefix("layer."), value)
        elif name.startswith("mix."):
            self._mix()
        elif name in ("azimuth", "elevation", "zoom", "right", "up"):
            self._turn()
        elif name in ("caps", "cap", "whose", "limits", "clamp_error", "max_error"):
            self._bound()
        elif "." in name:
            self._set_option(*name.split("."))

    def _control(self, name: str) -> Any:
        return next(p.controls[name] for p in self.panels.values() if name in p.controls)

    def _show(self, method: str) -> None:
        self.session.show(method)
        self._agree()

    def _move(self, motion: str) -> None:
        session = self.session
        if motion == "by hand":
            session.by_hand = True
        else:
            session.by_hand = False
            session.gait = replace(
                MOTIONS[motion], forward=session.gait.forward, wound=session.gait.wound
            )
        self._agree()

    def _aim(self, index: int, position: Any) -> None:
        if not np.allclose(self.session.targets[index], position, atol=1e-12):
            self.session.aim(index, position, going_on=self.playing)
            self._agree()

    def _wound(self, on: bool) -> None:
        self.session.change(wound=dict(WOUND) if on else {})
        self._agree()

    def _set_mobility(self, value: float) -> None:
        wound = dict(self.session.gait.wound) | {self._control("joint").value: value}
        self.session.change(wound={joint: s for joint, s in wound.items() if s < 1})
        self._agree()

    def _draw_as(self, weights: Any, value: float) -> None:
        weights[self.session.tree.index(self._control("joint").value)] = value
        self.session.note("drawn", joint=self._control("joint").value, value=round(value, 4))

    def _heal(self) -> None:
        self._times[:], self._plus[:] = 1, 0
        self.session.change(wound={})
        self._agree()

    def _mix(self) -> None:
        names = self.session.effectors.names
        methods = {name: self._control(f"mix.{name}").value for name in names}
        self.session.use("mix", Mix.of(self.session.effectors, methods))

    def _set_option(self, method: str, option: str) -> None:
        solver = SOLVERS[method]
        values = {
            name.removeprefix(f"{method}."): control.value
            for name, control in self.panels["Method"].controls.items()
            if name.startswith(f"{method}.")
        }
        if "clamp" in values:
            values["clamp"] = CLAMPS[values["clamp"]]
        self.session.use(method, partial(solver, **values))

    def _bound(self) -> None:
        get = {name: one.value for name, one in self.panels["Method"].controls.items()}
        self.session.bound(panels.caps(get["caps"], radians(get["cap"])))
        self.session.adjust(
            cap=CAPS[get["whose"]],
            limits=LIMITS[get["limits"]],
            max_error=get["max_error"] if get["clamp_error"] else None,
            max_step=radians(get["cap"]) if get["caps"] == panels.EQUAL else None,
        )

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

    # What is looked at.

    def _look_from(self, side: str) -> None:
        self.scene.look_from(side)
        azimuth, elevation = self.scene.cameras.angles
        self._distance = self.scene.cameras.distance
        self.panels["Object"].put(azimuth=azimuth, elevation=elevation, zoom=1.0, right=0.0, up=0.0)

    def _turn(self) -> None:
        get = {name: one.value for name, one in self.panels["Object"].controls.items()
               if name != "straight"}  # fmt: skip
        a, e = radians(get["azimuth"]), radians(get["elevation"])
        # To move the figure right is to look at a point left of it.
        sideways, upwards = np.array([cos(a), 0, -sin(a)]), np.array([0.0, 1, 0])
        middle = self.scene.stage.extent.centre - get["right"] * sideways - get["up"] * upwards
        away = np.array([sin(a) * cos(e), sin(e), cos(a) * cos(e)]) * self._distance / get["zoom"]
        self.scene.cameras.put(middle + away, middle)

    def _choose(self, effector: str) -> None:
        self._chosen = self.session.effectors.names.index(effector)

    def _switch(self, layer: str, on: bool) -> None:
        if layer == "targets":
            for target in self.scene.targets:
                target.visible = on
        else:
            self.scene.switch(layer, on)

    def _set_figures(self, figures: str) -> None:
        self._figures = figures
        self._back_to_now()
        old, old_targets = self.scene, self.targets
        self.watch(self._scene(self.session))
        self.targets = self._targets()
        box = self.panels["Target position"].widget
        box.children = [self.targets, *box.children[1:]]
        self._stage.children = [self.bar.widget, self.scene.widget]
        self._fit()
        old_targets.close()
        old.close()
        for name, control in self.panels["View"].controls.items():
            if name.startswith("layer.") and control.value:
                self._switch(name.removeprefix("layer."), True)
        self.scene.dark = self._control("dark").value
        self.scene.cameras.orthographic = self._control("projection").value == "orthographic"
        self._look_from(self._control("side").value)

    def _scene(self, session: Session) -> Scene:
        if self._figures == panels.ONE:
            return Scene(session.tree, session.effectors, slot=None)
        apart = 0.0 if self._figures == panels.OVER else None
        return Scene(
            session.tree, session.effectors, names=list(SOLVERS), apart=apart,
            width=540 if apart == 0 else 720, slot=None,
        )  # fmt: skip

    def _fit(self) -> None:
        """Leave the picture its width, so that words under it wrap."""
        width = self.scene.renderer.width + 4
        self._stage.layout.flex, self._stage.layout.width = f"0 0 {width}px", f"{width}px"

    def _targets(self) -> Targets:
        targets = Targets(self.scene, self.session.targets, low=-ROOM, high=ROOM, slot=None)
        targets.on_change(self.guarded(self._aim))
        return targets

    def _look_at(self, run: Log) -> None:
        if run.tree.names != self.session.tree.names:
            raise ValueError("that session is of another figure")
        self.pause()
        self._back_to_now()
        self.replay = Replay(run, self.scene, slot=None)
        self._aside.children = [self.replay]
        self.status.say("A run is looked at. Play, or “Back to now”, goes on where it stopped.")

    def _back_to_now(self) -> None:
        if self.replay is not None:
            self._aside.children = []
            self.replay.close()
            self.replay = None
            self.status.say("")

    # What the panels say.

    def _agree(self) -> None:
        """Set all controls to what the session says."""
        session, gait = self.session, self.session.gait
        joint = self._control("joint").value
        j = session.tree.index(joint)
        self.panels["Method"].put(method=session.method)
        self.panels["Motion"].put(motion="by hand" if session.by_hand else gait.name)
        self.panels["Motion control"].put(
            forward=gait.forward, wounded=bool(gait.wound), times=self._times[j],
            mobility=gait.wound.get(joint, 1.0), plus=float(np.degrees(self._plus[j])),
        )  # fmt: skip
        self.panels["Speed"].put(**{name: getattr(gait, name) for name in GAIT[:3]})
        self.panels["Target position"].put(**{name: getattr(gait, name) for name in GAIT[3:]})
        self.targets.follow(session.targets)

    def _bar(self) -> panels.Panel:
        def button(words: str) -> Any:
            return widgets.Button(description=words, layout={"width": "auto"})

        row: Mapping[str, Any] = {
            "playing": widgets.ToggleButton(
                value=True, description="Pause", layout={"width": "80px"}
            ),
            "step": button("Step"), "undo": button("Undo"), "reset": button("Reset"),
            "scrub": button("Look back"), "live": button("Back to now"), "quit": button("Quit"),
        }  # fmt: skip
        return panels.Panel("Session", [row])
