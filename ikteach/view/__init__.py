"""What a person sees and touches. It holds no mathematics: it is told poses and draws them."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ikteach.view.chapters.beyond import WalksPlayer
    from ikteach.view.chapters.figure import Poser
    from ikteach.view.chapters.gait import GaitPlayer
    from ikteach.view.chapters.jacobian import ColumnPoser
    from ikteach.view.chapters.reach import Simulator
    from ikteach.view.chapters.singularity import BendBench
    from ikteach.view.chapters.svd import SvdBench
    from ikteach.view.chapters.workbench import Workbench
    from ikteach.view.live.preset import preset
    from ikteach.view.raster.still import StillScene
    from ikteach.view.tools.drawing import DrawingPad
    from ikteach.view.webgl.scene import Scene

_HOMES = {
    "BendBench": "chapters.singularity",
    "ColumnPoser": "chapters.jacobian",
    "DrawingPad": "tools.drawing",
    "GaitPlayer": "chapters.gait",
    "Poser": "chapters.figure",
    "Scene": "webgl.scene",
    "Simulator": "chapters.reach",
    "StillScene": "raster.still",
    "SvdBench": "chapters.svd",
    "WalksPlayer": "chapters.beyond",
    "Workbench": "chapters.workbench",
    "preset": "live.preset",
}

__all__ = [
    "BendBench",
    "ColumnPoser",
    "DrawingPad",
    "GaitPlayer",
    "Poser",
    "Scene",
    "Simulator",
    "StillScene",
    "SvdBench",
    "WalksPlayer",
    "Workbench",
    "preset",
]


def __getattr__(name: str) -> Any:
    """Import a figure when it is first asked for: a question needs none of them."""
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"ikteach.view.{_HOMES[name]}"), name)
