"""The widget of a question: it asks, and hands over the answers."""

from collections.abc import Callable, Sequence
from typing import Any

import anywidget
import traitlets

from ikteach.markup import Markup, untouched
from ikteach.view.widgets import doors
from ikteach.view.widgets.actor import attempt
from ikteach.view.widgets.closing import Living, occupant
from ikteach.view.widgets.page import script, style


class Question(Living, anywidget.AnyWidget):
    """A widget that asks for a choice, number or order (see question.js).

    An order is one to put its options in.

    `on_answer` is called with each answer that is sent and gives the words to show under it. A
    second question of the same key closes the first: its cell was run again.
    """

    _esm, _css = script("course/question.js"), style("course/question.css")

    kind = traitlets.Enum(["choice", "number", "ranking"], "choice").tag(sync=True)
    question = traitlets.Unicode().tag(sync=True)
    note = traitlets.Unicode().tag(sync=True)
    options = traitlets.List(traitlets.Unicode()).tag(sync=True)
    numbers: Any = traitlets.List().tag(sync=True)  # low, high, unit
    button = traitlets.Unicode("Lock in").tag(sync=True)
    answer = traitlets.Any(None, allow_none=True).tag(sync=True)
    asked = traitlets.Int(0).tag(sync=True)  # how often an answer was sent
    locked = traitlets.Bool(False).tag(sync=True)
    status = traitlets.Unicode().tag(sync=True)

    def __init__(self, key: str, on_answer: Callable[[Any], str], **traits: Any) -> None:
        doors.text("the key of a question", key)
        for name in ("question", "note"):
            doors.text(f"the {name} of {key!r}", traits.get(name, ""))
        self.slot, self._on_answer = f"question {key}", on_answer
        super().__init__(**traits)
        self.observe(self._sent, "asked")

    def _sent(self, _: Any) -> None:
        if not self.locked:
            attempt(self._judge, self._say)

    def _judge(self) -> None:
        self._say(self._on_answer(self.answer))

    def _say(self, words: str) -> None:
        self.status = words

    @classmethod
    def living(cls, key: str) -> "Question | None":
        """Return the living question of this key, or None.

        It lives while it is on the page.
        """
        shown = occupant(f"question {key}")
        return shown if isinstance(shown, cls) else None

    def _repr_mimebundle_(self, **kwargs: Any) -> Any:
        """Show the widget, and beside it the question for a place without a kernel."""
        bundle = super()._repr_mimebundle_(**kwargs)
        data, metadata = bundle if isinstance(bundle, tuple) else (bundle, {})
        still = {"text/html": str(self._still()), "text/plain": self.question}
        return {**(data or {}), **still}, metadata

    def _still(self) -> str:
        lines: Sequence[str] = self.options
        if self.kind == "number":
            low, high, unit = self.numbers
            lines = [f"a number from {low} to {high} {unit}".strip()]
        items = Markup().join(map(Markup("<li>{}</li>").format, lines))
        note = Markup("<p>{}</p>").format(self.note) if self.note else ""
        return untouched(
            Markup(
                '<div style="border-left:4px solid #0072b2;padding:2px 14px">'
                "<b>{}</b>{}<ul>{}</ul></div>"
            ).format(self.question, note, items)
        )
