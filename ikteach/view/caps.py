"""Chapter 4's widget: a human whose hands cannot arrive, and three ways to cap its steps."""

from collections.abc import Callable
from dataclasses import replace
from math import radians
from typing import Any, ClassVar

import ipywidgets as widgets

from ikteach.body.figures import human
from ikteach.motion import gait, per_chain, whole
from ikteach.motion.experiment import capped
from ikteach.solvers import Solver, pseudoinverse
from ikteach.view.bench import slider
from ikteach.view.player import GaitPlayer


def rules(degrees: float) -> dict[str, Solver]:
    """The pseudoinverse without a cap, with one for the whole step, and with one a chain."""
    bound, chains = radians(degrees), human().effectors.chains
    return {
        "no cap": pseudoinverse,
        "whole step": capped(pseudoinverse, bound, chains, whole),
        "each chain": capped(pseudoinverse, bound, chains, per_chain),
    }


class CapPlayer(widgets.VBox):  # type: ignore[misc]
    """The gait player with the pseudoinverse under three caps at once, and two sliders more.

    They say how large the cap is [° a step], and how far to the side the hands are to go [m].
    """

    _living: ClassVar["CapPlayer | None"] = None

    def __init__(self, degrees: float = 5.0, x_hand: float = 1.2) -> None:
        if CapPlayer._living is not None:
            CapPlayer._living.close()
        CapPlayer._living = self
        start = replace(gait.walking, x_hand=x_hand)
        self.player = GaitPlayer(rules(degrees), slot="caps", gait=start, method="whole step")
        self.player.controls.method.description = "Cap"
        self.cap = slider("cap [° a step]", degrees, 0.5, 45.0, 0.5)
        self.x_hand = slider("hands to the side [m]", x_hand, 0.3, 2.0, 0.05)
        self.cap.observe(self._obeyed(lambda value: self._set(rules(value))), "value")
        self.x_hand.observe(
            self._obeyed(lambda value: self.player.session.change(x_hand=value)), "value"
        )
        super().__init__([self.cap, self.x_hand, self.player])

    def close(self) -> None:
        """Stop the loop and free the widgets."""
        if CapPlayer._living is self:
            CapPlayer._living = None
        self.player.close()
        for widget in (self.cap, self.x_hand):
            widget.close()
        super().close()

    def _set(self, methods: dict[str, Solver]) -> None:
        self.player.session.methods.update(methods)  # the same names: a tick under way may go on

    def _obeyed(self, act: Callable[[float], None]) -> Callable[[Any], None]:
        return lambda change: act(change["new"])

    def _repr_mimebundle_(self, **kwargs: Any) -> Any:
        """The live widget, and beside it a still for places without a kernel."""
        still = self.player._repr_mimebundle_(**kwargs)
        kept = {kind: still[kind] for kind in ("image/png", "text/plain")}
        return {**super()._repr_mimebundle_(**kwargs), **kept}
