"""Chapter 4's widget: a human whose hands cannot arrive, and three ways to cap its steps."""

from dataclasses import replace
from math import radians
from typing import Any

import ipywidgets as widgets

from ikteach.body.figures import human
from ikteach.motion import gait, per_chain, whole
from ikteach.solvers import Solver, pseudoinverse
from ikteach.study.experiment import capped
from ikteach.view.chapters.gait import GaitPlayer
from ikteach.view.live.bench import slider
from ikteach.view.widgets import doors
from ikteach.view.widgets.closing import Living

CAP, SIDE = (0.5, 45.0), (0.3, 2.0)  # from, to [° a step] and [m]


def rules(degrees: float) -> dict[str, Solver]:
    """The pseudoinverse without a cap, with one for the whole step, and with one a chain."""
    bound, chains = radians(degrees), human().effectors.chains
    return {
        "no cap": pseudoinverse,
        "whole step": capped(pseudoinverse, bound, chains, whole),
        "each chain": capped(pseudoinverse, bound, chains, per_chain),
    }


class CapPlayer(Living, widgets.VBox):  # type: ignore[misc]
    """The gait player with the pseudoinverse under three caps at once, and two sliders more.

    They say how large the cap is [° a step], and how far to the side the hands are to go [m].
    """

    def __init__(
        self, degrees: float = 5.0, x_hand: float = 0.9, *, slot: str | None = "caps"
    ) -> None:
        self.slot = slot
        degrees = doors.within("degrees", degrees, *CAP)
        x_hand = doors.within("x_hand", x_hand, *SIDE)
        start = replace(gait.walking, x_hand=x_hand)
        self.player = GaitPlayer(rules(degrees), slot=None, gait=start, method="whole step")
        self.player.controls["method"].description = "Cap"
        self.controls = {
            "cap": slider("cap [° a step]", degrees, *CAP, 0.5),
            "x_hand": slider("hands to the side [m]", x_hand, *SIDE, 0.05),
        }
        self.status = self.player.status
        for name, control in self.controls.items():
            obey = self.player.guarded(lambda change, name=name: self._obey(name, change["new"]))
            control.observe(obey, "value")
        super().__init__([*self.controls.values(), self.player])

    @property
    def words(self) -> str:
        """What is seen, for those who cannot see it."""
        return self.player.words

    def refresh(self) -> None:
        """Take one tick, and report."""
        self.player.session.tick()
        self.player.report()

    def _obey(self, name: str, value: float) -> None:
        if name == "cap":
            self.player.session.use(rules(value))
        else:
            self.player.session.change(x_hand=value)

    def _repr_mimebundle_(self, **kwargs: Any) -> Any:
        """The live widget, and beside it a still for places without a kernel."""
        still = self.player._repr_mimebundle_(**kwargs)
        kept = {kind: still[kind] for kind in ("text/html", "image/png", "text/plain")}
        return {**super()._repr_mimebundle_(**kwargs), **kept}
