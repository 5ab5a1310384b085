"""Sliders and number boxes for targets, which always agree with the handles in the scene."""

from collections.abc import Callable
from typing import Any

import anywidget
import numpy as np
import traitlets

from ikteach.arrays import Array, ArrayLike
from ikteach.checks import numbers
from ikteach.view.stage.colours import effector_colour
from ikteach.view.stage.forms import kinds
from ikteach.view.stage.lengths import Lengths, digits_of, round_step
from ikteach.view.stage.stage import Stage, View
from ikteach.view.webgl.handles import Handles
from ikteach.view.webgl.positions import Moves, Positions, TargetKeeper
from ikteach.view.webgl.scene import Scene
from ikteach.view.widgets import doors
from ikteach.view.widgets.actor import Actor, message_of
from ikteach.view.widgets.closing import Living
from ikteach.view.widgets.page import script, style

MARKS = {"ball": "●", "box": "■", "arrow": "➤"}
ROOM = 1.5  # [m] how far a target of a human may go from where it starts, each way


class Targets(Living, anywidget.AnyWidget):
    """A panel for the targets of a scene.

    A live scene has handles too.

    scene      shows them, once a listener of `on_change` has it do so
    start      where the targets are at first, (k, 3) [m]; not if there is a session. That of a
               direction is a vector, and turns whatever is done to it
    low, high  ranges [m] of points, one number or (k, 3); None: as far as `ROOM` from the start
    session    keeps the targets and undoes their moves, as a `Session` does; if none is given, the
               panel does so itself
    undo       undoes instead of the session, if whoever shows it has more to do then
    slot       only one of a slot lives at a time: to run a cell again closes the older one

    `positions` (k, 3) is where they are, however they were moved: dragged, by keys, by sliders, by
    number boxes, by `move`.
    """

    _esm, _css = script("view/webgl/targets.js"), style("view/webgl/targets.css")
    names = traitlets.List(traitlets.Unicode()).tag(sync=True)
    colours = traitlets.List(traitlets.Unicode()).tag(sync=True)
    marks = traitlets.List(traitlets.Unicode()).tag(sync=True)
    low: Any = traitlets.List().tag(sync=True)
    high: Any = traitlets.List().tag(sync=True)
    values: Any = traitlets.List().tag(sync=True)
    alert = traitlets.Unicode().tag(sync=True)
    unit = traitlets.Unicode("m").tag(sync=True)  # in which a person reads and writes
    metres = traitlets.Float(1.0).tag(sync=True)  # of one such unit
    step = traitlets.Float(0.01).tag(sync=True)  # of sliders and boxes, in that unit
    digits = traitlets.Int(2).tag(sync=True)

    def __init__(
        self,
        scene: View,
        start: ArrayLike | None = None,
        *,
        low: ArrayLike | None = None,
        high: ArrayLike | None = None,
        session: TargetKeeper | None = None,
        undo: Callable[[], object] | None = None,
        slot: str | None = "targets",
    ) -> None:
        self.slot = slot
        doors.has("scene", scene, "a Scene or a StillScene", "stage", "show")
        stage = scene.stage
        first: Any = start if session is None else session.targets
        at = numbers("start", first)
        if not np.isfinite(at).all():
            raise ValueError("start is not finite: each target needs three numbers")
        names = stage.effectors.names
        room = ROOM * stage.unit * stage.free
        unit = Lengths.of_places(stage.extent.radius)
        step = round_step(2 * ROOM * stage.unit / unit.metres)
        self._model = Positions(
            names,
            session or Moves(at.copy()),
            *_ranges(stage, at - room if low is None else low, at + room if high is None else high),
            unit=unit,
            step=step * unit.metres,
            undo=undo,
        )
        if session is None:
            for i, position in enumerate(at):
                self._model.check(i, position)
        self._act = Actor()
        self.handles = Handles(scene, self._model) if isinstance(scene, Scene) else None
        super().__init__(
            names=list(names),
            colours=[effector_colour(i) for i in range(len(names))],
            marks=[MARKS[kind] for kind in kinds(names, stage.effectors.w)],
            low=self._model.low.tolist(),
            high=self._model.high.tolist(),
            values=self._model.now.tolist(),
            unit=unit.name,
            metres=unit.metres,
            step=step,
            digits=digits_of(step),
        )
        self._model.on_change(lambda *_: self.agree())
        self.on_msg(self._hear)

    @property
    def positions(self) -> Array:
        """Where the targets are, (k, 3) [m]."""
        return self._model.now

    def move(self, index: int, position: ArrayLike) -> None:
        """Move one target within its range.

        ValueError with the range if it would leave it.
        """
        self._model.move(index, position)

    def follow(self, positions: ArrayLike) -> None:
        """Show where the targets have gone by themselves.

        Nobody hears of it, and it is no move to take back.
        """
        self._model.keeper.targets = np.array(positions, dtype=float)
        self.agree()

    def agree(self) -> None:
        """Show where the targets are now."""
        self.values = self._model.now.tolist()

    def undo(self) -> None:
        """Take the last change back."""
        if self.handles is not None:
            self.handles.undo()
        else:
            self._model.undo()

    def on_change(self, tell: Callable[[int, Array], None]) -> Callable[[int, Array], None]:
        """Call tell(index, position (3,)) after each move.

        It may be used as a decorator.
        """
        self._model.on_change(tell)
        return tell

    def _hear(self, _: Any, content: dict[str, Any], __: Any) -> None:
        self._act(lambda: self._obey(content))

    def _obey(self, content: dict[str, Any]) -> None:
        try:
            self.alert = ""
            if "undo" in content:
                self.undo()
            elif "target" in content:
                self._set(content)
        except Exception as error:  # of whoever follows the targets
            self.alert = message_of(error)
        finally:
            if "number" in content:
                self.send({"heard": content["number"]})

    def _set(self, content: dict[str, Any]) -> None:
        index, axis, value = int(content["target"]), int(content["axis"]), content["value"]
        new, typed = np.nan if value is None else float(value), content.get("typed")
        if not typed:
            new = float(np.clip(new, self._model.low[index, axis], self._model.high[index, axis]))
        position = self._model.coordinate(index, axis, new)
        if not typed:
            self._model.drag(index, position, going_on=not content["fresh"])
            return
        try:
            self._model.check(index, position)
        except ValueError as error:
            words = str(error)
            self.alert = f"{words[0].upper()}{words[1:]}. Nothing was changed."
            self.send({"again": True})  # the box shows once more what is
        else:
            self._model.move(index, position)


def _ranges(stage: Stage, low: ArrayLike, high: ArrayLike) -> tuple[ArrayLike, ArrayLike, Array]:
    """Give the tips of directions the ranges of a sphere: low, high, and ℓ (k,), 0 of points."""
    ends = stage.effectors
    lengths = np.where(ends.w, 0, np.linalg.norm(ends.offsets, axis=-1))
    if not ends.directed:
        return low, high, lengths
    point, sphere = ends.w[:, None] == 1, lengths[:, None] * stage.free
    return np.where(point, low, -sphere), np.where(point, high, sphere), lengths
