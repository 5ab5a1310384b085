"""A figure in motion: one step, many steps, and targets as functions of time."""

from ikteach.motion import gait
from ikteach.motion.gait import Gait
from ikteach.motion.reachable import reachable
from ikteach.motion.step import BUSS_CAPS, Step, clip, hold, ignore, per_chain, step, whole
from ikteach.motion.track import Track, growing_clamp, track

__all__ = [
    "BUSS_CAPS",
    "Gait",
    "Step",
    "Track",
    "clip",
    "gait",
    "growing_clamp",
    "hold",
    "ignore",
    "per_chain",
    "reachable",
    "step",
    "track",
    "whole",
]
