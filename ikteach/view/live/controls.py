"""The controls of a live figure by name, whatever it is built of."""

from collections.abc import Mapping
from typing import Any


def controls(figure: Any) -> dict[str, Any]:
    """Return the controls of a figure, and of its parts."""
    found: dict[str, Any] = {}
    for part in parts_of(figure):
        for name, control in {**getattr(part, "controls", {}), **_buttons(part)}.items():
            found.setdefault(name, control)
    play = getattr(figure, "play_button", None)
    return found if play is None else {**found, "playing": play}


def parts_of(figure: Any) -> list[Any]:
    """List the figure and its parts with controls."""
    inner = (getattr(figure, name, None) for name in ("panel", "motion", "player", "bar"))
    own = [part for part in inner if part is not None]
    deeper = [one.panel for one in own if hasattr(one, "panel")]
    return [figure, *getattr(figure, "panels", {}).values(), *own, *deeper]


def targets(figure: Any) -> list[str]:
    """Return the names of the targets that can be moved."""
    return [*getattr(getattr(figure, "targets", None), "names", ())]


def _buttons(part: Any) -> Mapping[str, Any]:
    found = getattr(part, "buttons", {})
    return found if isinstance(found, Mapping) else {}
