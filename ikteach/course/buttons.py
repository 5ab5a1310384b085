"""The widget of what to try: each sentence has a button that does it."""

from collections.abc import Callable, Mapping
from typing import Any

import ipywidgets as widgets

from ikteach.markup import Markup, untouched
from ikteach.view.widgets.cell import Cell
from ikteach.view.widgets.prose import Prose


class Tries(Cell):
    """Sentences, each with the button that does it.

    figure  whose sentences they are; only the last ones of a figure's slot live
    acts    {sentence: what its button does}
    """

    def __init__(self, figure: Any, acts: Mapping[str, Callable[[], object]]) -> None:
        super().__init__(f"tries {getattr(figure, 'slot', None)}")
        self.sentences = list(acts)
        rows = []
        for i, (sentence, act) in enumerate(acts.items(), start=1):
            done = f"The figure is set as in {i}."
            button = self.button(f"Show me {i}", self._doing(act, done), tooltip=sentence)
            rows.append(widgets.HBox([button, Prose(sentence)]))
        self.children = [*rows, self.status]

    def _doing(self, act: Callable[[], object], done: str) -> Callable[[], None]:
        def do() -> None:
            act()
            self.status.say(done)

        return do

    def _repr_mimebundle_(self, **kwargs: Any) -> Any:
        """Show the widget, and beside it the sentences for a place without a kernel."""
        bundle = super()._repr_mimebundle_(**kwargs)
        data, metadata = bundle if isinstance(bundle, tuple) else (bundle, {})
        items = Markup().join(map(Markup("<li>{}</li>").format, self.sentences))
        still = {
            "text/html": str(untouched(Markup("<ol>{}</ol>").format(items))),
            "text/plain": "\n".join(self.sentences),
        }
        return {**(data or {}), **still}, metadata
