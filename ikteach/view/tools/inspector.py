"""One iteration, magnified: the clock stops, and the next tick is shown in pages."""

from collections.abc import Callable

import ipywidgets as widgets

from ikteach.checks import function
from ikteach.markup import Markup
from ikteach.motion.anatomy import Anatomy, anatomy
from ikteach.motion.live.session import Session
from ikteach.view.tools.inspector_pages import PAGES, Names, Page
from ikteach.view.widgets import doors
from ikteach.view.widgets.cell import Cell
from ikteach.view.widgets.page import style_tag
from ikteach.view.widgets.picture import Picture
from ikteach.view.widgets.prose import Prose, table

STYLE = style_tag("view/tools/inspector.css")


class Glass(Cell):
    """The next tick of a session, taken apart.

    Its pages show e, J, U Σ Vᵀ, each method's share, Δθ and the movement.

    session  whose next tick is looked at; looking changes nothing in it
    stop     is called before looking, to stop whatever lets time pass: `player.pause`
    show     is called after "Do this tick", to draw the pose that came of it
    """

    def __init__(
        self,
        session: Session,
        stop: Callable[[], None] = lambda: None,
        show: Callable[[], None] = lambda: None,
        *,
        slot: str | None = "glass",
    ) -> None:
        session = doors.a(Session, "session", session)
        stop, show = function("stop", stop), function("show", show)
        super().__init__(slot)
        self.session, self._stop, self._show = session, stop, show
        self.names = Names(session.effectors.names, session.tree.names)
        self.tick: Anatomy | None = None
        self._pages: dict[int, Page] = {}  # of this tick, drawn when they are first opened
        self.number = 0
        look = {"button_style": "primary", "layout": {"width": "200px"}}
        self.look_button = self.button("Stop the clock and look", self.look, **look)
        self.do = self.button("Do this tick", self.advance, disabled=True)
        self.back = self.button("Back", lambda: self.turn(-1), disabled=True)
        self.next = self.button("Next", lambda: self.turn(1), disabled=True)
        self.method = widgets.Dropdown(
            options=list(session.methods), value=session.method, description="Method"
        )
        self.method.observe(self.guarded(lambda _: self._again()), "value")
        self.picture, self.table = Picture(), Prose()
        self.picture.add_class("ikteach-chart")
        self.children = [
            widgets.HBox([self.look_button, self.method, self.do]),
            widgets.HBox([self.back, self.next]),
            self.status,
            self.picture,
            self.table,
        ]
        self.status.say("Nothing is under the glass yet.")

    def look(self) -> None:
        """Stop the clock, and take the next tick apart."""
        self._stop()
        session, method = self.session, self.method.value
        *_, targets = session.ahead()
        self.tick = anatomy(
            session.tree,
            session.theta[method],
            session.effectors,
            targets,
            session.methods[method],
            methods=session.methods,
            mobility=session.gait.mobility(session.tree),
            **session.options_of(method),
        )
        self._pages.clear()
        self._turn_to(self.number)
        self.status.come(with_all=True)

    def advance(self) -> None:
        """Let the tick that was looked at happen.

        Then look at the one after it.
        """
        for _ in range(self.session.gait.slowdown):
            self.session.tick()
        self._show()
        self.look()

    def turn(self, pages: int) -> None:
        """Turn that many pages on, or back where negative."""
        self._turn_to(self.number + pages)

    @property
    def page(self) -> Page:
        """The page that is open; LookupError before the first look."""
        if self.tick is None:
            raise LookupError("nothing is under the glass yet: look first")
        if self.number not in self._pages:
            self._pages[self.number] = PAGES[self.number](self.tick, self.names)
        return self._pages[self.number]

    def _again(self) -> None:
        if self.tick is not None:
            self.look()

    def _turn_to(self, number: int) -> None:
        self.number = min(max(number, 0), len(PAGES) - 1)
        page, last = self.page, len(PAGES) - 1
        self.back.disabled, self.next.disabled = self.number == 0, self.number == last
        self.do.disabled = False
        with self.picture.hold_sync():
            self.picture.png, self.picture.alt = page.png, page.alt
        self.table.value = STYLE + Markup(
            "<details><summary>The numbers as a table</summary>"
            '<div style="overflow:auto;max-height:300px">{}</div></details>'
        ).format(table(page.table, "{:.4f}", kind="ikteach-glass"))
        self.status.say(
            f"Page {self.number + 1} of {len(PAGES)}: {page.title}. Tick "
            f"{self.session.ticks + 1} by {self.method.value}. {page.text}"
        )
