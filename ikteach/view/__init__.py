"""What a person sees and touches. It holds no mathematics: it is told poses and draws them."""

from ikteach.view.bend import BendBench
from ikteach.view.player import GaitPlayer
from ikteach.view.posing import ColumnPoser, Poser
from ikteach.view.scene import Scene
from ikteach.view.simulator import Simulator
from ikteach.view.still import StillScene
from ikteach.view.workbench import Workbench

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
