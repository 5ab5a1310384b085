"""Chapter 4's live figure: a human whose hands cannot arrive, and three ways to cap its steps."""

from dataclasses import replace
from math import radians

from ikteach.body.figures import human
from ikteach.motion import gait, per_chain, whole
from ikteach.solvers import Solver, pseudoinverse
from ikteach.study.experiment import capped
from ikteach.view.chapters.gait import GaitPlayer
from ikteach.view.live.link import StateLink
from ikteach.view.live.panel import Does, Panel, slider
from ikteach.view.live.preset import link_of
from ikteach.view.widgets import doors
from ikteach.view.widgets.cell import Cell
from ikteach.view.widgets.picture import Still

CAP, SIDE = (0.5, 45.0), (0.3, 2.0)  # from, to [degrees per step] and [m]


def rules(degrees: float) -> dict[str, Solver]:
    """Cap the pseudoinverse in three ways.

    Not at all, the whole step, or each chain by itself.
    """
    bound, chains = radians(degrees), human().effectors.chains
    return {
        "no cap": pseudoinverse,
        "whole step": capped(pseudoinverse, bound, chains, whole),
        "each chain": capped(pseudoinverse, bound, chains, per_chain),
    }


class CapPlayer(Cell):
    """The gait player with the pseudoinverse under three caps.

    All caps are tried at once; two more sliders set them.

    degrees  the cap [degrees per step]
    x_hand   how far to the side the hands are to go [m]
    """

    def __init__(
        self, degrees: float = 5.0, x_hand: float = 0.9, *, slot: str | None = "caps"
    ) -> None:
        degrees = doors.within("degrees", degrees, *CAP)
        x_hand = doors.within("x_hand", x_hand, *SIDE)
        start = replace(gait.walking, x_hand=x_hand)
        player = GaitPlayer(rules(degrees), slot=None, gait=start, method="whole step")
        super().__init__(slot, player.note)
        self.player = player
        player.controls["method"].description = "Cap"
        player.whole = self
        panel = self.panel = Panel(
            "Caps",
            [
                {"cap": Does(slider("cap [° per step]", degrees, *CAP, 0.5), self._cap)},
                {"x_hand": Does(slider("hands to the side [m]", x_hand, *SIDE, 0.05), self._put)},
            ],
            guard=self.guarded,
        )
        self.controls = panel.controls
        beside = player.arranged.beside
        beside.children = [panel.widget, *beside.children]
        self.children = [self.status, player]

    @property
    def words(self) -> str:
        """The picture in words, for people who cannot see it."""
        return self.player.words

    def still(self) -> Still:
        """Draw it for a place without a kernel."""
        return self.player.still()

    def make_link(self) -> StateLink:
        """Make the widget that links to its state."""
        return StateLink(lambda: link_of(self), self.guarded)

    def acted(self) -> None:
        """Draw the change that a slider has made."""
        self.player.acted()

    def _cap(self, degrees: float) -> None:
        self.player.session.use(rules(degrees))

    def _put(self, x_hand: float) -> None:
        self.player.session.change(x_hand=x_hand)
