"""Freeing widgets: what the page and the kernel hold of them, and of all that they hold."""

from typing import Any

import ipywidgets as widgets


def close_all(*roots: widgets.Widget) -> None:
    """Close these widgets and all that they hold, each once."""
    for widget in _below(*roots):
        widget.close()


def _below(*roots: widgets.Widget) -> list[widgets.Widget]:
    found: dict[str, widgets.Widget] = {}
    waiting: list[Any] = list(roots)
    while waiting:
        one = waiting.pop()
        if isinstance(one, dict | list | tuple):
            waiting += one.values() if isinstance(one, dict) else one
        elif isinstance(one, widgets.Widget) and one.comm and one.model_id not in found:
            found[one.model_id] = one
            waiting += [getattr(one, name, None) for name in one.keys]
    return list(found.values())
