"""A live figure at this moment, and all that can be changed about it.

State lives here and nowhere else. Panels change the session, the scene is given a pose, and neither
is known to it. Changes are noted and can be undone; ticks are recorded.
"""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from ikteach.arrays import ArrayLike, frozen
from ikteach.checks import count, numbers
from ikteach.motion.checks import checked, solver_of
from ikteach.motion.gait import Gait
from ikteach.motion.live.log import Event
from ikteach.motion.live.play import Play
from ikteach.motion.live.settings import check_options, in_words, motion_of
from ikteach.motion.path import Motion
from ikteach.motion.step import step
from ikteach.names import unknown
from ikteach.solvers import Solver


class Session(Play):
    """A figure that walks, by every method at once.

    All methods have the same targets and the same clock.

    figure    the human if none is given
    gait      the motion of the targets: a `Gait`, a `Path`, or one of `motion.paths`, a `Walk` or
              a `Recorded`; change it with `change(...)` or put another in its place. If none is
              given, a figure that can walk walks, and any other's targets go where its own joints
              would swing them
    methods   {name: solver}, and whatever `methods_of` takes; put another to a name with `use`.
              If none are given, those of `SOLVERS`, with the λ of dls in proportion to the body
    method    the one that is shown; if none is given, dls or the first
    dt        clock time of one tick [s]
    keep      how many ticks the record holds; `dropped` counts those it has let go
    iterations  steps a tick: with one alone, a figure lags behind what goes fast
    start     the pose at the beginning (n,) [rad], the rest pose if none is given
    options   go to `step`, the same for all methods; set them with `adjust`

    caps      {method: max_step [rad] or None}: the step caps of methods that have their own; set
              them with `bound`
    by_hand   True where the targets stay where `aim` has put them, and the gait rests
    targets   (k, 3) where they are now [m]
    theta     {method: pose (n,)} [rad], and
    frames    where the joints of each are (M, ...); both are for looking at
    history   the record of ticks, and the last events and changes
    """

    @property
    def gait(self) -> Motion:
        """The motion of the targets."""
        return self._settings.gait

    @gait.setter
    def gait(self, gait: Motion) -> None:
        gait, course = motion_of(self.tree, self.effectors, gait)
        if gait is self.gait:
            return
        new, old = gait.settings(), self.gait.settings()
        what = {n: value for n, value in new.items() if n not in old or value != old[n]}
        if not what and isinstance(gait, Gait):
            return
        going_on = None
        if not what or "name" in what or "curve" in what or set(new) != set(old):
            what, going_on = {"motion": gait.name}, False  # another, or other data
        self._change("gait", what, going_on=going_on, gait=gait, course=course)

    def change(self, **parameters: Any) -> None:
        """Give the gait other parameters.

        LookupError, TypeError or ValueError says which one cannot be.
        """
        self.gait = self.gait.change(**parameters)

    @property
    def methods(self) -> dict[str, Solver]:
        """The solver of each method, by name."""
        return self._settings.methods

    def use(self, method: str | Mapping[str, Solver | str], solver: Solver | str = "") -> None:
        """Put another solver to the name of a method.

        It may be the same solver with other options bound. Several at once, which are one change,
        are a {method: solver}.
        """
        news = {method: solver} if isinstance(method, str) else method
        solvers = {self._known(name): solver_of(one) for name, one in news.items()}
        for name, one in solvers.items():
            self._try(name, one, self.options)
        words = in_words(solvers)
        if isinstance(method, str):
            words, subject = {"method": method, "solver": words[method]}, (method,)
        else:
            subject = tuple(words)
        self._change("solver", words, subject, methods=self.methods | solvers)

    @property
    def method(self) -> str:
        """The name of the method that is shown."""
        return self._settings.method

    def show(self, method: str) -> None:
        """Show the pose of `method`.

        LookupError for a name that is not among the methods.
        """
        if self._known(method) != self.method:
            self._change("method", {"shown": method}, going_on=False, method=method)

    @property
    def options(self) -> Mapping[str, Any]:
        """The options of `step`, the same for all methods."""
        return self._settings.options

    def adjust(self, **options: Any) -> None:
        """Set options of `step` for all methods.

        The errors are those of `step`.
        """
        check_options(options)
        new = {**self.options, **options}
        self._try(self.method, self.methods[self.method], new)
        self._change("options", in_words(options), tuple(options), options=new)

    @property
    def caps(self) -> Mapping[str, float | None]:
        """The step caps of methods that have their own [rad]."""
        return self._settings.caps

    def bound(self, caps: Mapping[str, float | None]) -> None:
        """Give methods step caps of their own [rad].

        None is no cap; with {} all go by `options`.
        """
        for method, cap in caps.items():
            known = self._known(method)
            self._try(known, self.methods[known], {**self.options, "max_step": cap})
        self._change("caps", dict(caps), caps=dict(caps))

    @property
    def iterations(self) -> int:
        """How many steps a tick takes."""
        return self._settings.iterations

    @iterations.setter
    def iterations(self, iterations: int) -> None:
        if (steps := count("iterations", iterations)) != self.iterations:
            self._change("iterations", {"iterations": steps}, iterations=steps)

    @property
    def by_hand(self) -> bool:
        """Whether the targets are set by hand.

        Otherwise the gait sets them.
        """
        return self._settings.by_hand is not None

    @by_hand.setter
    def by_hand(self, by_hand: bool) -> None:
        if bool(by_hand) != self.by_hand:
            at = frozen(self.targets) if by_hand else None
            self._change("by hand", {"by_hand": bool(by_hand)}, going_on=False, by_hand=at)

    def aim(self, which: int | str, position: ArrayLike, *, going_on: bool = False) -> None:
        """Put the target of an effector to a position.

        The effector goes by its name or number, the position is (3,) [m].

        From then on the targets are set by hand. `going_on` says that it is still the same move of
        the mouse, which is one event and is undone as one. LookupError, ValueError.
        """
        i = self._effector(which)
        name, at = self.effectors.names[i], numbers("position", position)
        if at.shape != (3,):
            raise ValueError(f"a target is a point (3,), not {at.shape}")
        targets = self.targets.copy()
        targets[i] = at
        checked(self.tree, self.tree.rest, self.effectors, targets)
        if not going_on:
            self.history.settle()
        if self.by_hand and np.array_equal(targets, self.targets):
            return
        what = {"effector": name, "position": at.tolist()}
        self._change("target", what, (name,), going_on=going_on, by_hand=frozen(targets))

    def undo(self) -> Event:
        """Take the last change back, and return its event.

        LookupError if there is none.
        """
        change = self.history.undo()
        self._settings = change.before
        self._retarget()
        self.note("undo", taken_back=str(change.event))
        return change.event

    def begin_again(self) -> None:
        """Put all settings back to the first ones, and reset.

        It is one change, which can be undone.
        """
        self._change("begin again", {}, going_on=False, **vars(self._first))
        self.reset()

    # Behind the changes.

    def _change(
        self,
        kind: str,
        what: Mapping[str, Any],
        subject: tuple[str, ...] | None = None,
        *,
        going_on: bool | None = None,
        **settings: Any,
    ) -> None:
        """Replace these settings, and note it: `History.change` knows which goes on with which."""
        before, event = self._settings, self._event(kind, what)
        self._settings = replace(before, **settings)
        self._retarget()
        subject = (kind, *(what if subject is None else subject))
        self.history.change(event, before, subject, going_on)

    def _effector(self, which: int | str) -> int:
        names = self.effectors.names
        if isinstance(which, str):
            if which not in names:
                raise LookupError(unknown("effector", which, names))
            return names.index(which)
        if not 0 <= which < len(names):
            raise LookupError(f"effectors are numbered 0 to {len(names) - 1}, not {which}")
        return int(which)

    def _try(self, method: str, solver: Solver, options: Mapping[str, Any]) -> None:
        """Take a step that changes nothing, so that settings that cannot be are refused at once."""
        step(self.tree, self.theta[method], self.effectors, self.targets, solver, **options)
