"""What a person sees and touches. It holds no mathematics: it is told poses and draws them."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ikteach.view.bend import BendBench
    from ikteach.view.player import GaitPlayer
    from ikteach.view.posing import ColumnPoser, Poser
    from ikteach.view.scene import Scene
    from ikteach.view.simulator import Simulator
    from ikteach.view.still import StillScene
    from ikteach.view.workbench import Workbench

_HOMES = {
    "BendBench": "bend",
    "ColumnPoser": "posing",
    "GaitPlayer": "player",
    "Poser": "posing",
    "Scene": "scene",
    "Simulator": "simulator",
    "StillScene": "still",
    "Workbench": "workbench",
}

__all__ = [
    "BendBench",
    "ColumnPoser",
    "GaitPlayer",
    "Poser",
    "Scene",
    "Simulator",
    "StillScene",
    "Workbench",
]


def __getattr__(name: str) -> Any:
    """Import a figure when it is first asked for: a question needs none of them."""
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"ikteach.view.{_HOMES[name]}"), name)
