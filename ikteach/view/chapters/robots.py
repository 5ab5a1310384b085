"""Chapter 12's figures: a robot's arm and its target frame, and a walker who stands and reaches."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ikteach.arrays import Array
from ikteach.body import Effectors, Tree, forward, locate
from ikteach.body.figures import BALL, HAND, HEEL, Figure, walker
from ikteach.formats.urdf import ARM, Robot, read_urdf
from ikteach.motion.live.session import Session
from ikteach.motion.path import Path as Motion
from ikteach.motion.paths.walk import turned
from ikteach.solvers import SOLVERS
from ikteach.view.chapters.gait import session_table
from ikteach.view.live.live import Live
from ikteach.view.live.panel import Does, Panel, button, choice, dropdown, slider
from ikteach.view.live.strips import Strips
from ikteach.view.stage.lengths import misses, units
from ikteach.view.stage.stage import sides_of
from ikteach.view.webgl.scene import Scene
from ikteach.view.widgets.layout import Arranged
from ikteach.view.widgets.prose import Prose

TOOL, ARROW = "tool", 0.25  # a direction of 1 m is drawn as long as that [m]
AHEAD, UP = (0.0, 0.0, 1.0), (0.0, 1.0, 0.0)
Values = Mapping[str, float]
Sliders = Mapping[str, tuple[str, float, float, float, float]]  # label, value, low, high, step


class AskedPlayer(Live):
    """A figure whose targets and weights are set by sliders.

    figure   a body; its targets are first where its rest pose has them
    sliders  {name: (label, value, lowest, highest, step)}
    targets  from their values to the targets (k, 3) [m]
    weights  from their values to the weights (k,)
    who      the figure, in words
    floor    height of the ground [m], where it is known
    start    the pose at the beginning (n,)

    rest     the figure, and where it starts

    A direction is drawn as a point ahead of the first point on its joint, or of the joint.

    Display it in a notebook. `session` holds all state.
    """

    def __init__(
        self,
        figure: Figure,
        sliders: Sliders,
        targets: Callable[[Values], Array],
        weights: Callable[[Values], Array],
        *,
        who: str,
        floor: float | None = None,
        start: Array | None = None,
        slot: str | None,
    ) -> None:
        self._asked, self._weights, self._who, self._floor = targets, weights, who, floor
        first = {name: value for name, (_, value, *_) in sliders.items()}
        path = Motion(lambda _: targets(first), "held")
        options: dict[str, Any] = {"iterations": 2, "weights": weights(first), "start": start}
        session = Session(figure, path, SOLVERS, method="sdls", **options)
        self.rest = figure, session.start
        self._seen_at = as_points(figure)
        scene = Scene(session.tree, self._seen_at, slot=None)
        super().__init__(session, scene, slot, Strips(session))
        self.panel, self._table = self._make_panel(sliders), Prose()
        self.controls = self.panel.controls
        self.choosing = self.controls["method"]
        self.watch(scene)
        self.children = [
            Arranged([scene.widget], [self.panel.widget, self._table]),
            self.status,
            self.strips,
        ]
        self.report()

    def _make_panel(self, sliders: Sliders) -> Panel:
        session, look = self.session, {"label_width": "60px"}
        clock = {
            "playing": self.play_button,
            "step": Does(button("Step"), self.step),
            "reset": Does(button("Reset"), session.reset),
        }
        sides = dropdown("View", sides_of(session.tree, session.effectors), **look)
        method = choice("Method", list(session.methods), session.method, **look)
        rows: list[Any] = [clock, {"method": Does(method, session.show)}]
        rows += [{"view": Does(sides, self.scene.look_from)}]
        rows += [
            {
                name: Does(
                    slider(label, value, low, high, step, width="auto", label_width="150px"),
                    lambda _: self._ask(),
                )
            }
            for name, (label, value, low, high, step) in sliders.items()
        ]
        return Panel("Asked", rows, guard=self.guarded)

    def _ask(self) -> None:
        """Put targets and weights where the sliders say."""
        session, values = self.session, self.panel.values
        weights = self._weights(values)
        if not np.array_equal(weights, session.options["weights"]):
            session.adjust(weights=weights)
        for name, at in zip(session.effectors.names, self._asked(values), strict=True):
            session.aim(name, at, going_on=True)

    @property
    def words(self) -> str:
        """The picture in words, for people who cannot see it."""
        session = self.session
        off, effectors = misses(session.effectors, session.error), session.effectors
        each = zip(effectors.names, units(session.tree, effectors), off, strict=True)
        far = ", ".join(f"{name} {unit(d)}" for name, unit, d in each)
        return f"{self._who}, by {session.method}. From its target: {far}."

    def draw(self) -> None:
        """Draw the shown pose."""
        session = self.session
        theta, effectors = session.theta[session.method], session.effectors
        targets = session.targets.copy()
        turned_to = effectors.w == 0
        places = locate(forward(session.tree, theta), self._seen_at)
        arrows = ARROW * (targets - locate(forward(session.tree, theta), effectors))
        targets[turned_to] = (places + arrows)[turned_to]
        self.scene.show(
            theta,
            targets,
            floor=session.floor if self._floor is None else self._floor,
            change=self._changes,
            frames=session.frames_of(session.method),
        )

    def report(self) -> None:
        """Bring words and table up to date."""
        self.scene.driver.description = self.words
        self._table.value = session_table(self.session, self.session.method)


def as_points(figure: Figure) -> Effectors:
    """Return the effectors as points.

    A direction is a point ahead of the first point on its joint.
    """
    tree, old = figure
    points: dict[str, tuple[str, Any]] = {}
    for name, j, o, w in zip(old.names, old.joints, old.offsets, old.w, strict=True):
        base = old.offsets[(old.joints == j) & (old.w == 1)]
        points[name] = (tree.names[j], o if w else [*base, np.zeros(3)][0] + ARROW * o)
    return Effectors.of(tree, points)


def with_y_up(robot: Robot) -> Robot:
    """Turn a robot, whose z is up, so that y is."""
    A = turned("x", np.asarray(-90.0))
    rows = [
        replace(j, offset=(A @ j.offset).tolist(), axis=(A @ j.axis).tolist())
        for j in robot.tree.joints()
    ]
    tree, old = Tree.of(rows), robot.effectors
    points = {
        name: (tree.names[j], A @ o)
        for name, j, o in zip(old.names, old.joints, old.offsets, strict=True)
    }
    return robot._replace(tree=tree, effectors=Effectors.of(tree, points))


def arm_with_frame() -> Figure:
    """Make the arm with a frame at its tool.

    A point, and two directions of 1 m: what the weight of a direction is then its length.
    """
    robot = with_y_up(read_urdf(ARM))
    tree = robot.tree
    at = robot.effectors.names.index(TOOL)
    joint, point = tree.names[robot.effectors.joints[at]], robot.effectors.offsets[at]
    directions = {"tool.ahead": (joint, AHEAD), "tool.up": (joint, UP)}
    return Figure(tree, Effectors.of(tree, {TOOL: (joint, point)}, directions=directions))


def robot_player(*, slot: str | None = "robot") -> AskedPlayer:
    """Make the arm whose target frame is moved and turned."""
    figure = arm_with_frame()
    tree, effectors = figure
    bent = np.clip(np.radians([10, 30, 0, -110, 0, 120, 0, 0, 0]), tree.lower, tree.upper)
    place, ahead, up = locate(forward(tree, bent), effectors)

    def targets(values: Values) -> Array:
        R = np.eye(3)
        for axis in "yxz":
            R = R @ turned(axis, np.asarray(values[f"turn {axis}"]))
        at = np.array([values[axis] for axis in "xyz"])
        return np.stack([at, R @ ahead, R @ up])

    def weights(values: Values) -> Array:
        return np.array([1.0, values["length"], values["length"]])

    sliders = {
        axis: (f"{axis} [m]", round(float(place[i]), 2), -1.0, 1.3, 0.01)
        for i, axis in enumerate("xyz")
    }
    sliders |= {f"turn {axis}": (f"turn about {axis} [°]", 0.0, -90.0, 90.0, 1.0) for axis in "yxz"}
    sliders |= {"length": ("length ℓ of directions [m]", 0.2, 0.0, 1.0, 0.01)}
    who = "An arm of seven hinges and its target frame"
    return AskedPlayer(figure, sliders, targets, weights, who=who, start=bent, slot=slot)


STANDING = ("heel.l", "ball.l", "heel.r", "ball.r")  # the first effectors of `standing_figure`


def standing_figure() -> Figure:
    """Make a walker with feet, a hand and a gaze."""
    tree = walker().tree
    points: dict[str, tuple[str, Sequence[float]]] = {}
    for side in "lr":
        points |= {f"heel.{side}": (f"foot.{side}", HEEL), f"ball.{side}": (f"foot.{side}", BALL)}
    points["hand.r"] = ("elbow.r", HAND)
    return Figure(tree, Effectors.of(tree, points, directions={"gaze": ("spine.twist", AHEAD)}))


def standing_player(*, slot: str | None = "standing") -> AskedPlayer:
    """Make the walker who stands, reaches and looks."""
    figure = standing_figure()
    tree, effectors = figure
    at = locate(forward(tree, tree.rest), effectors)
    floor = float(at[: len(STANDING), 1].min())
    feet = at[: len(STANDING)].copy()
    feet[:, 1] = floor

    def targets(values: Values) -> Array:
        hand = [values["x"], floor + values["y"], values["z"]]
        turn = np.radians(values["gaze"])
        return np.array([*feet, hand, [np.sin(turn), 0, np.cos(turn)]])

    def weights(values: Values) -> Array:
        return np.array([values["feet"]] * len(STANDING) + [1.0, values["length"]])

    sliders: Sliders = {
        "x": ("hand to the left [m]", -0.3, -1.2, 0.6, 0.01),
        "y": ("hand over the floor [m]", 1.0, 0.1, 2.4, 0.01),
        "z": ("hand ahead [m]", 0.4, -0.4, 1.4, 0.01),
        "feet": ("weight of the feet", 1.0, 0.0, 20.0, 0.5),
        "gaze": ("gaze to the left [°]", 0.0, -90.0, 90.0, 1.0),
        "length": ("length ℓ of the gaze [m]", 0.1, 0.0, 1.0, 0.01),
    }
    who = "A walker with both feet on the floor, who reaches with the right hand"
    return AskedPlayer(figure, sliders, targets, weights, who=who, floor=floor, slot=slot)
