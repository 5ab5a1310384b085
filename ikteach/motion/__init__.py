"""A figure in motion: one step, many steps, and targets as functions of time."""

from ikteach.motion import gait
from ikteach.motion.ccd import ccd
from ikteach.motion.gait import Gait
from ikteach.motion.live.session import Session
from ikteach.motion.reachable import reachable
from ikteach.motion.rules import BUSS_CAPS, clip, hold, ignore, per_chain, whole
from ikteach.motion.step import Step, step
from ikteach.motion.track import Track, growing_clamp, track

__all__ = [
    "BUSS_CAPS",
    "Gait",
    "Session",
    "Step",
    "Track",
    "ccd",
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
