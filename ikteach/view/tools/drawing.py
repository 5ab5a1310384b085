"""A pad on which the path of an effector is drawn by hand, over the outline of its body."""

from collections.abc import Callable, Iterator
from itertools import groupby
from math import ceil
from typing import Any

import numpy as np

from ikteach.arrays import Array
from ikteach.body import forward, locate
from ikteach.body.figures import Figure
from ikteach.checks import numbers
from ikteach.motion.live.session import Session
from ikteach.motion.path import Motion
from ikteach.motion.paths.recorded import Recorded, drawn
from ikteach.motion.paths.stroke import closed, heart, missed
from ikteach.view.live.panel import Does, Panel, button, dropdown, slider
from ikteach.view.stage.colours import BLUE, GREY, RED
from ikteach.view.stage.lengths import Lengths, round_step
from ikteach.view.stage.stage import CAMERAS, PLANE, Stage, picture_axes, plane_of
from ikteach.view.widgets import doors
from ikteach.view.widgets.cell import Cell
from ikteach.view.widgets.layout import Arranged
from ikteach.view.widgets.plane import Plane, Stroke

DRAWN = "drawn"  # what the motion is called
SIDES = ("front", "side", "top")
ACROSS = {"side": "how far to the left", "front": "how far ahead", "top": "how high"}
LABELS = {"side": ("◂ ahead", "up"), "front": ("to its left ▸", "up"), "top": ("left ▸", "▾ ahead")}
NEARLY = 0.01  # of the body's reach: what is missed by less is within reach
TAP = 0.03  # of the plane's half: a stroke that is shorter sets a point
PEN = "pen (Enter sets a point, Backspace takes one back)"


class DrawingPad(Cell):
    """A plane on which a closed curve is drawn.

    It lies over the outline of a body. By mouse, pen or finger: a stroke is closed, smoothed, and
    at once the path of an effector. By keys: arrows move the pen, Enter sets a point, Backspace
    takes it back, and the button sends the effector along them. A click sets a point, too.

    session   whose targets go along the curve; one of a human, if none is given
    effector  that goes along it at first; the last, a hand of the human, if none is named
    take      is given the motion, in place of the session

    points    (T, 3) that were set, or the curve of a stroke [m]
    motion    the last one that was made, for `GaitPlayer(gait=pad.motion)` and others; None before
    """

    def __init__(
        self,
        session: Session | None = None,
        *,
        effector: str | None = None,
        take: Callable[[Motion], object] | None = None,
        slot: str | None = "drawing pad",
    ) -> None:
        super().__init__(slot)
        self.session = Session() if session is None else doors.a(Session, "session", session)
        self._take = self._go if take is None else take
        tree, effectors = self.figure = Figure(self.session.tree, self.session.effectors)
        self.points = np.zeros((0, 3))
        self.motion: Recorded | None = None
        self._by_stroke, self._far = False, np.zeros(0)
        self._ball = Stage(tree, effectors).extent
        self._unit = Lengths.of_places(self._ball.radius)
        self._normal = plane_of(tree, effectors)
        self.plane = Plane(title="The body", half=1.08 * self._ball.radius, handle=PEN, pen=True)
        self.plane.step = round_step(2 * self.plane.half, 100)
        self.panel = self._make_panel(effector)
        self.controls = self.panel.controls
        self.plane.on_msg(lambda _, content, __: self.guarded(self._hear)(content))
        self.plane.observe(lambda _: self._say_pen(), "at")
        self.children = [Arranged([self.plane], [self.panel.widget]), self.status]
        self._turn()

    def _make_panel(self, effector: str | None) -> Panel:
        effectors, look = self.figure.effectors, {"label_width": "110px"}
        names = [name for name, w in zip(effectors.names, effectors.w, strict=True) if w]
        if not names:
            raise ValueError("this figure has directions alone, and none goes along a curve")
        if effector is not None:
            heart(self.figure, effector)  # whose errors name it
        sides = SIDES if self._normal is None else (PLANE,)
        step = round_step(2 * self._ball.radius, 200)
        far = step * ceil(self._ball.radius / step)
        depth = slider("depth [m]", 0.0, -far, far, step, **look)
        depth.disabled = self._normal is not None
        seconds = slider("once round [s]", 2.0, 0.5, 10.0, 0.1, **look)
        which = dropdown("Curve of", names, effector or names[-1], **look)
        return Panel(
            "Drawing",
            [
                {"drawn": Does(which, lambda _: self._turn())},
                {"plane": Does(dropdown("Seen from", list(sides), **look), lambda _: self._turn())},
                {"depth": Does(depth, lambda _: self.draw())},
                {"seconds": Does(seconds, lambda _: self._again())},
                {
                    "point": Does(button("Add the place of its target"), self._add_target),
                    "back": Does(button("Take the last back"), self._back),
                    "forget": Does(button("Forget all"), self._forget),
                    "along": Does(button("Go along them"), self._go_along),
                },
            ],
            guard=self.guarded,
        )

    # The plane.

    @property
    def axes(self) -> Array:
        """Right, up and towards the eye, in columns (3, 3)."""
        side = self.panel.values["plane"]
        back = self._normal if self._normal is not None else np.round(CAMERAS[side])
        return picture_axes(np.asarray(back, dtype=float))

    def seen(self, places: Array) -> Array:
        """Tell where places (..., 3) [m] are on the plane, (..., 2)."""
        return np.asarray((places - self._ball.centre) @ self.axes[:, :2])

    def place(self, at: Array) -> Array:
        """Tell where points (..., 2) of the plane are in the world, (..., 3) [m]."""
        axes = self.axes
        depth = self.panel.values["depth"] - self._ball.centre @ axes[:, 2]
        if self._normal is not None:
            depth = 0.0
        return np.asarray(self._ball.centre + at @ axes[:, :2].T + depth * axes[:, 2])

    def _turn(self) -> None:
        """Look from another side, or at another effector."""
        side, which = self.panel.values["plane"], self.panel.values["drawn"]
        tree, effectors = self.figure
        middle = heart(self.figure, which)
        step = self.controls["depth"].step
        self.panel.put(depth=step * round(float(middle @ self.axes[:, 2]) / step))
        self.controls["depth"].description = f"{ACROSS.get(side, 'depth')} [m]"
        rest = locate(forward(tree, self.session.start), effectors)
        self.plane.xlabel, self.plane.ylabel = LABELS.get(side, ("", ""))
        self.plane.at = self.seen(rest[effectors.names.index(which)]).tolist()
        self._forget()

    # What a person does.

    def _hear(self, content: dict[str, Any]) -> None:
        """Take a stroke or a point of the page, or take one back."""
        if "back" in content:
            return self._back()
        at = numbers("what was drawn", content.get("stroke", [content.get("point")]))
        if at.ndim != 2 or at.shape[1] != 2 or not np.isfinite(at).all():
            raise ValueError("what was drawn are points (T, 2)")
        at = np.clip(at, -self.plane.half, self.plane.half)
        if np.ptp(at, axis=0).max() < TAP * self.plane.half:
            return self._add(self.place(at[-1]))
        self.points, self._by_stroke = closed(self.place(at)), True
        self._go_along()

    def _add(self, place: Array) -> None:
        """Set a point behind the others; a stroke of before is over."""
        before = np.zeros((0, 3)) if self._by_stroke else self.points
        self.points, self._by_stroke = np.concatenate([before, [place]]), False
        self._look()
        self.status.say(f"{self._counted()} at {self._said(place)}. {self._reach()}")

    def _add_target(self) -> None:
        which = self.figure.effectors.names.index(self.panel.values["drawn"])
        self._add(self.session.targets[which])

    def _back(self) -> None:
        """Take the last point back, or a stroke as a whole."""
        self.points = self.points[: 0 if self._by_stroke else -1]
        self._by_stroke = False
        self._look()
        self.status.say(f"{self._counted()}.")

    def _forget(self) -> None:
        self.points, self._by_stroke = np.zeros((0, 3)), False
        self._look()
        self.status.say("Draw a closed curve, or set points: by a click, or by arrows and Enter.")

    def _go_along(self) -> None:
        """Make the curve the path of the effector."""
        if len(self.points) < 2:
            raise ValueError("a curve needs two points or more: draw it, or set points first")
        values = self.panel.values
        which, period = values["drawn"], values["seconds"]
        self.motion = drawn(self.points, period, figure=self.figure, effector=which, name=DRAWN)
        self._look()
        self._take(self.motion)
        self.status.say(f"{which} goes along the curve in {period:g} s. {self._reach()}")

    def _again(self) -> None:
        """Go along the same curve in another time."""
        if self.motion is not None and self.session.gait.name == DRAWN:
            self._go_along()

    def _go(self, motion: Motion) -> None:
        self.session.by_hand, self.session.gait = False, motion

    def agree(self) -> None:
        """Show the session's curve, if it is another one."""
        gait, mine = self.session.gait, self.motion
        if not isinstance(gait, Recorded) or gait.name != DRAWN:
            return
        if mine is None or not np.array_equal(gait.targets, mine.targets):
            moves = int(np.ptp(gait.targets, axis=0).max(axis=-1).argmax())
            self.panel.put(drawn=gait.names[moves], seconds=gait.period)
            self.motion, self.points, self._by_stroke = gait, gait.targets[:, moves], True
            self._look()

    # What is seen.

    def _look(self) -> None:
        """Ask what can be reached, and draw."""
        radius = self._ball.radius
        self._far = (
            missed(self.figure, self.panel.values["drawn"], self.points, within=NEARLY * radius)
            if len(self.points)
            else np.zeros(0)
        )
        self.draw()

    def draw(self) -> None:
        """Draw outline and curve, and what is out of reach."""
        lines = [Stroke(self.seen(bone), GREY, width=3.0) for bone in self._bones()]
        at, size = self.seen(self.points), 0.02 * self.plane.half
        for bad, run in groupby(range(len(at)), lambda i: bool(self._far[i])):
            part = [*run]
            part.append((part[-1] + 1) % len(at))
            look: dict[str, Any] = {"colour": RED, "dashes": "2 4", "width": 4.0} if bad else {}
            lines.append(Stroke(at[part], **{"colour": BLUE, **look}))
        if not self._by_stroke:
            lines += [Stroke(part, BLUE) for point in at for part in _cross(point, size)]
        self.plane.show(lines, f"{self.words} {self._reach()}")
        self._say_pen()

    def _bones(self) -> Iterator[Array]:
        """Go through the chains from the ground to each effector and each last joint, (m, 3)."""
        tree, effectors = self.figure
        frames = forward(tree, self.session.start)
        s = locate(frames, effectors)
        ends = {int(j): [s[i]] for i, j in enumerate(effectors.joints) if effectors.w[i]}
        for j in set(range(len(tree))) - set(tree.parents.tolist()) | set(ends):
            yield np.array([*frames.positions[tree.above(j)[::-1]], *ends.get(j, [])])

    @property
    def words(self) -> str:
        """The plane in words."""
        which, side = self.panel.values["drawn"], self.panel.values["plane"]
        return f"The body, seen from {side}; curve of {which}: {self._counted().lower()}."

    def _say_pen(self) -> None:
        self.plane.said = self._said(self.place(np.array(self.plane.at)))

    def _said(self, place: Array) -> str:
        x, y, z = (self._unit.number(one, 2) for one in place)
        return f"x {x}, y {y}, z {z} {self._unit.name}"

    def _counted(self) -> str:
        count = len(self.points)
        return (
            "A drawn curve" if self._by_stroke else "1 point" if count == 1 else f"{count} points"
        )

    def _reach(self) -> str:
        """Say how much of the curve cannot be reached, and by how much."""
        out = int((self._far > 0).sum())
        if not len(self._far):
            return ""
        if not out:
            return "All of it is within reach."
        share, most = 100 * out / len(self._far), Lengths.of(*self.figure)(float(self._far.max()))
        return f"{share:.0f} % of it is out of reach, by up to {most}; it is dotted and red."


def _cross(at: Array, size: float) -> Iterator[Array]:
    """Draw a small × at a point of the plane."""
    for way in ([1, 1], [1, -1]):
        yield at + size * np.outer([-1, 1], way)
