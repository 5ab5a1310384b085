"""The panels that change a session: methods, motion, wounds, speed, and how far targets swing."""

import inspect
from collections.abc import Callable, Iterator, Mapping
from functools import cache, partial
from math import log10, pi, radians
from typing import Any

import numpy as np

from ikteach.arrays import Array
from ikteach.body.figures import human
from ikteach.checks import shown
from ikteach.formats.bvh import recorded_walk
from ikteach.markup import Markup, plain
from ikteach.motion.gait import LIMBS, MOTIONS, WOUND, Gait, displayed, walking
from ikteach.motion.live.session import Session
from ikteach.motion.live.settings import motion_of
from ikteach.motion.mix import Mix
from ikteach.motion.path import Motion, Path
from ikteach.motion.paths.walk import WALKS, Walk
from ikteach.motion.rules import BUSS_CAPS, clip, hold, ignore, per_chain, whole
from ikteach.names import unknown
from ikteach.solvers import SOLVERS, Solver
from ikteach.solvers.sdls import hard, soft
from ikteach.study.walks import for_human, three_walks
from ikteach.view.live.panel import (
    Act,
    Does,
    Panel,
    button,
    choice,
    dropdown,
    log_slider,
    slider,
    tick_box,
)
from ikteach.view.tools.drawing import DRAWN, DrawingPad
from ikteach.view.widgets.prose import Prose

Guard = Callable[[Act], Act]
OWN, EQUAL, NONE = "each author's own", "equal", "none"
CLAMPS = {"hard": hard, "soft": soft}
CAPS = {"whole": whole, "per_chain": per_chain}
LIMITS = {"hold": hold, "clip": clip, "ignore": ignore}
BY_HAND = "by hand"
WRITTEN = ("natural", "recorded")  # motions that are made when they are first chosen
LABEL: dict[str, Any] = {"label_width": "150px"}
LOOK: dict[str, Any] = {"width": "380px", **LABEL}

# Option of a solver: label, lowest, highest, step of its slider; none where it is logarithmic.
OPTIONS: Mapping[str, tuple[str, float, float, float | None]] = {
    "gain": ("gain [share of α]", 0.05, 2.0, 0.01),
    "cutoff": ("cutoff [share of σ_max]", 0.0, 0.5, 0.01),
    "damping": ("damping λ [m/rad]", 1e-3, 1.0, None),
    "max_angle": ("γ_max [rad]", pi / 60, pi, pi / 180),  # π/4 is among its steps of 1°
}
# Parameter of the gait: label, lowest, highest, step.
SLIDERS: Mapping[str, Mapping[str, tuple[str, float, float, float]]] = {
    "Speed": {
        "speed": ("speed ω [rad/s]", 0.0, 20.0, 0.1),
        "step_frequency": ("step frequency [×]", 0.1, 3.0, 0.1),
        "slowdown": ("slowdown [ticks]", 1, 10, 1),
    },
    "Steps": {
        "back_z_leg": ("left foot z swing [m]", -0.8, 0.8, 0.01),
        "front_z_leg": ("right foot z swing [m]", -0.8, 0.8, 0.01),
        "back_y_leg": ("left foot y [m]", -1.3, -0.4, 0.01),
        "front_y_leg": ("right foot y [m]", -1.3, -0.4, 0.01),
    },
    "Hands": {
        "hand_z": ("hands z swing [m]", -1.2, 1.2, 0.01),
        "back_y_hand": ("right hand y [m]", -0.6, 1.0, 0.01),
        "front_y_hand": ("left hand y [m]", -0.6, 1.0, 0.01),
    },
}


class MethodPanel(Panel):
    """Controls of methods and of the rules around solvers.

    They choose the method that is shown, and set the options of each.
    """

    def __init__(self, session: Session, guard: Guard) -> None:
        self.session = session
        options = [
            {f"{method}.{option}": Does(control, partial(self._set_option, method, option))}
            for method, solver in SOLVERS.items()
            for option, control in options_of(solver).items()
        ]
        methods = list(SOLVERS)
        mix = [
            {f"mix.{name}": Does(dropdown(plain(name), methods, "dls", **LABEL), self._mix)}
            for name in session.effectors.names
        ]
        cap = slider("equal cap [°]", 10.0, 0.5, 90.0, 0.5, **LOOK)
        max_error = slider("error clamp D [m]", 0.4, 0.01, 1.0, 0.01, **LOOK)
        around: list[Any] = [
            {"caps": Does(choice("Step caps", [NONE, EQUAL, OWN], **LABEL), self._bound)},
            {"cap": Does(cap, self._bound)},
            {"whose": Does(choice("Cap acts on", list(CAPS), **LABEL), self._cap)},
            {"limits": Does(choice("Limits", list(LIMITS), **LABEL), self._limits)},
            {"clamp_error": Does(tick_box("clamp errors"), self._clamp)},
            {"max_error": Does(max_error, self._clamp)},
        ]
        shown = choice("Method", list(session.methods), session.method, label_width="60px")
        super().__init__(
            "Method",
            [{"method": Does(shown, session.show)}],
            folded={
                "Options of the methods": options,
                "Mix: a method per effector": mix,
                "Around the solver": around,
            },
            shows=lambda: {"method": session.method},
            guard=guard,
        )

    def _set_option(self, method: str, option: str, value: Any) -> None:
        bound = getattr(self.session.methods[method], "keywords", {})
        value = CLAMPS[value] if option == "clamp" else value
        self.session.use(method, partial(SOLVERS[method], **{**bound, option: value}))

    def _mix(self, _: str) -> None:
        effectors, values = self.session.effectors, self.values
        methods = {name: values[f"mix.{name}"] for name in effectors.names}
        self.session.use("mix", Mix.of(effectors, methods))

    def _bound(self, _: Any) -> None:
        values, methods = self.values, self.session.methods
        equal = radians(values["cap"]) if values["caps"] == EQUAL else None
        self.session.bound(
            {name: BUSS_CAPS.get(name) for name in methods}
            if values["caps"] == OWN
            else dict.fromkeys(methods, equal)
        )

    def _cap(self, name: str) -> None:
        self.session.adjust(cap=CAPS[name])

    def _limits(self, name: str) -> None:
        self.session.adjust(limits=LIMITS[name])

    def _clamp(self, _: Any) -> None:
        values = self.values
        self.session.adjust(max_error=values["max_error"] if values["clamp_error"] else None)


def options_of(solver: Solver) -> dict[str, Any]:
    """Make a control for each keyword option of a solver.

    It is set to its default.
    """
    controls = {}
    for option in inspect.signature(solver).parameters.values():
        if option.kind is not option.KEYWORD_ONLY:
            continue
        label = f"{getattr(solver, '__name__', 'solver')}: "
        if option.name == "clamp":
            controls["clamp"] = choice(f"{label}clamp", list(CLAMPS), **LABEL)
        elif option.name in OPTIONS:
            words, low, high, step = OPTIONS[option.name]
            value, label = float(option.default), label + words
            controls[option.name] = (
                log_slider(label, value, log10(low), log10(high), 0.02, **LOOK)
                if step is None
                else slider(label, value, low, high, step, **LOOK)
            )
        else:
            raise LookupError(unknown("option with a slider", option.name, OPTIONS))
    return controls


class WoundPanel(Panel):
    """Wounds, joint by joint, and whether the figure goes anywhere.

    times, plus  (n,) the weights with which the pose is drawn, as the thesis draws a wound
    """

    def __init__(self, session: Session, guard: Guard) -> None:
        self.session = session
        self.times, self.plus = np.ones(len(session.tree)), np.zeros(len(session.tree))
        joints = dropdown("Joint", list(session.tree.names), "knee.r", **LABEL)
        mobility = slider("mobility", 1.0, 0.0, 1.0, 0.05, **LOOK)
        times = slider("drawn × ", 1.0, 0.0, 2.0, 0.05, **LOOK)
        plus = slider("drawn + [°]", 0.0, -60.0, 60.0, 1.0, **LOOK)
        explanation = (
            "<p>A wound as the solver knows it is a <b>mobility</b>. As the thesis draws it, the"
            " pose is changed after the solve: <b>drawn ×</b> and <b>drawn +</b>.</p>"
        )
        super().__init__(
            "Motion control",
            [
                {
                    "forward": Does(tick_box("moving forward"), self._go),
                    "wounded": Does(tick_box("wounded"), self._wound),
                },
                Prose(Markup(explanation)),
                {"joint": Does(joints, lambda _: self.agree())},
                {"mobility": Does(mobility, self._set_mobility)},
                {"times": Does(times, self._set_times)},
                {"plus": Does(plus, self._set_plus)},
                {"heal": Does(button("Heal all"), self._heal)},
            ],
            shows=self._stands,
            guard=guard,
        )

    def drawn(self, theta: Array) -> Array:
        """Give poses (..., n) as they are drawn."""
        return displayed(theta, times=self.times, plus=self.plus)

    @property
    def _joint(self) -> int:
        return self.session.tree.index(self.values["joint"])

    def _stands(self) -> dict[str, Any]:
        gait, joint = self.session.gait, self.values["joint"]
        return {
            "forward": gait.forward,
            "wounded": bool(gait.wound),
            "mobility": gait.wound.get(joint, 1.0),
            "times": float(self.times[self._joint]),
            "plus": float(np.degrees(self.plus[self._joint])),
        }

    def _go(self, forward: bool) -> None:
        self.session.change(forward=forward)

    def _wound(self, on: bool) -> None:
        self.session.change(wound=dict(WOUND) if on else {})

    def _set_mobility(self, value: float) -> None:
        wound = dict(self.session.gait.wound) | {self.values["joint"]: value}
        self.session.change(wound={joint: s for joint, s in wound.items() if s < 1})

    def _set_times(self, value: float) -> None:
        self.times[self._joint] = value
        self.session.note("drawn", joint=self.values["joint"], value=round(value, 4))

    def _set_plus(self, degrees: float) -> None:
        self.plus[self._joint] = radians(degrees)
        self.session.note("drawn", joint=self.values["joint"], value=round(radians(degrees), 4))

    def heal_drawing(self) -> None:
        """Draw all joints as they are."""
        self.times[:], self.plus[:] = 1, 0

    def _heal(self) -> None:
        self.heal_drawing()
        self.session.change(wound={})


class MotionPanel(Panel):
    """The choice of how the targets move.

    given    motions to choose from, beside those that the figure knows
    by_hand  whether one of the choices is that the targets are moved by hand
    pad      whether there is a pad, on which a curve is drawn; folded, unless it is "open"

    known    {name: makes the motion}; `add` puts another among them
    pad      the pad, or None
    """

    pad: DrawingPad | None = None

    def __init__(
        self,
        session: Session,
        guard: Guard,
        given: Motion | Mapping[str, Motion] | None = None,
        *,
        by_hand: bool = True,
        pad: bool | str = True,
    ) -> None:
        self.session, self.known = session, motions(session, given)
        self._hand = [BY_HAND] if by_hand else []
        if pad:
            self.pad = DrawingPad(session, take=guard(self._go_along), slot=None)
        names = [*self.known, *self._hand]
        motion = choice("Motion", names, session.gait.name, label_width="60px")
        super().__init__(
            "Motion",
            [{"motion": Does(motion, self._move)}],
            folded={"Draw a path of your own": [self.pad]} if self.pad else None,
            opened=0 if pad == "open" else None,
            shows=self._stands,
            guard=guard,
        )
        self.controls |= self.pad.controls if self.pad else {}

    def add(self, motion: Motion) -> None:
        """Let the targets make another motion.

        From then on it is among those to choose from.
        """
        if motion.name in (*MOTIONS, *WRITTEN, DRAWN, BY_HAND):
            raise ValueError(f"{motion.name!r} is a motion already: give the file another name")
        as_set(motion, self.session).on(self.session.tree, self.session.effectors)
        self._offer(motion)
        self._move(motion.name)

    def agree(self) -> None:
        """Set the choice to what the session does, without acting."""
        gait = self.session.gait
        if not self.session.by_hand and (gait.name not in self.known or gait.name == DRAWN):
            self._offer(gait)
        if self.pad:
            self.pad.agree()
        super().agree()

    def _stands(self) -> dict[str, Any]:
        by_hand = self.session.by_hand and self._hand
        return {"motion": BY_HAND if by_hand else self.session.gait.name}

    def _offer(self, motion: Motion) -> None:
        """Put a motion among those to choose from."""
        self.known[motion.name] = partial(_itself, motion)
        offered, control = (*self.known, *self._hand), self.controls["motion"]
        if tuple(control.options) != offered:
            self._quiet = True
            try:
                control.options = offered
            finally:
                self._quiet = False

    def _move(self, name: str) -> None:
        motion = None if name == BY_HAND else as_set(self.known[name](), self.session)
        self.session.by_hand = motion is None
        if motion is not None:
            self.session.gait = motion

    def _go_along(self, curve: Motion) -> None:
        self._offer(curve)
        self._move(DRAWN)


@cache
def human_walk(name: str) -> Motion:
    """Return a walk for a human whose pelvis is the ground.

    name  "natural" or "recorded"
    """
    figure, path = three_walks(recorded_walk())[name]
    return for_human(path, figure, name)


class GaitPanel(Panel):
    """Sliders of a motion's parameters; those that it lacks are disabled."""

    def __init__(
        self, title: str, session: Session, groups: tuple[str, ...], guard: Guard, *above: Any
    ) -> None:
        self._session = session
        rows = [*above, *gait_rows(session, *groups)]
        super().__init__(title, rows, shows=lambda: gait_values(session, *groups), guard=guard)

    def agree(self) -> None:
        """Set the sliders to the motion's parameters, without acting."""
        super().agree()
        settle_sliders(self, self._session)


def settle_sliders(panel: Panel, session: Session) -> None:
    """Disable the sliders of parameters that the session's motion lacks."""
    for group in SLIDERS.values():
        for name in group:
            if name in panel.controls:
                panel.controls[name].disabled = not takes(session.gait, name)


def takes(motion: Motion, name: str) -> bool:
    """Say whether a motion has a parameter of `SLIDERS`.

    The speed of a walk or a recording is that of its ground, no phase per second.
    """
    return hasattr(motion, name) and (name != "speed" or isinstance(motion, Gait | Path))


def gait_rows(session: Session, *groups: str, **look: Any) -> list[dict[str, Does]]:
    """Make a slider for each parameter of these groups.

    It begins at the value of the session's motion, or of a walk if that motion has none.
    """
    return [
        {
            name: Does(
                slider(
                    label,
                    gait_values(session, group).get(name, getattr(walking, name)),
                    *span,
                    **{**LOOK, **look},
                ),
                lambda value, name=name: session.change(**{name: value}),
            )
        }
        for group in groups
        for name, (label, *span) in SLIDERS[group].items()
    ]


def gait_values(session: Session, *groups: str) -> dict[str, Any]:
    """Give the values that the sliders of `gait_rows` stand for."""
    names = [name for group in groups for name in SLIDERS[group]]
    return {name: getattr(session.gait, name) for name in names if takes(session.gait, name)}


def motions(
    session: Session, given: Motion | Mapping[str, Motion] | None = None
) -> dict[str, Callable[[], Motion]]:
    """Find the motions that a session's figure can make.

    Each is made when it is asked for: {name: makes it}.

    given  motions that are among them, {name: motion}, or one alone

    TypeError or ValueError says which of these is none, or none for this figure.
    """
    tree, effectors = session.tree, session.effectors
    known: dict[str, Callable[[], Motion]] = {}
    usual, _ = motion_of(tree, effectors)
    if isinstance(usual, Gait):
        known |= {name: partial(MOTIONS.__getitem__, name) for name in MOTIONS}
        if set(effectors.names) == set(LIMBS) and set(human().tree.names) <= set(tree.names):
            known |= {name: partial(human_walk, name) for name in WRITTEN}
    elif isinstance(usual, Walk):
        known |= {name: partial(WALKS.__getitem__, name) for name in WALKS}
    for motion in (*_given(session, given), session.gait):
        known[motion.name] = partial(_itself, motion)
    return known


def _itself(motion: Motion) -> Motion:
    return motion


def _given(session: Session, given: Any) -> Iterator[Motion]:
    """Go through the motions of a caller, each by the name that it has there."""
    if isinstance(given, Motion):
        given = {given.name: given}
    if not isinstance(given, Mapping | None):
        raise TypeError(f"motions are {{name: motion}}, or a motion alone, not {shown(given)}")
    for name, motion in (given or {}).items():
        motion, _ = motion_of(session.tree, session.effectors, motion)
        if name != motion.name and "name" not in motion.settings():
            raise ValueError(f"the motion {shown(name)} calls itself {shown(motion.name)}")
        yield motion if name == motion.name else motion.change(name=name)


def as_set(motion: Motion, session: Session) -> Motion:
    """Give a motion the wounds of the figure.

    It goes forward if the figure does.
    """
    if "forward" in motion.settings():
        return motion.change(forward=session.gait.forward, wound=session.gait.wound)
    return motion.change(wound=session.gait.wound)
