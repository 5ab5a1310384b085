"""A figure in motion: one step, many steps, and targets as functions of time."""

from ikteach.motion import gait
from ikteach.motion.ccd import ccd
from ikteach.motion.gait import Gait
from ikteach.motion.live.session import Session
from ikteach.motion.path import Motion, Path
from ikteach.motion.paths import quality
from ikteach.motion.paths.perform import imitate, perform
from ikteach.motion.paths.recorded import Recorded, drawn
from ikteach.motion.paths.retarget import retarget
from ikteach.motion.paths.walk import Walk
from ikteach.motion.reachable import reachable
from ikteach.motion.rules import BUSS_CAPS, clip, hold, ignore, per_chain, whole
from ikteach.motion.step import Step, step
from ikteach.motion.track import Track, growing_clamp, track

__all__ = [
    "BUSS_CAPS",
    "Gait",
    "Motion",
    "Path",
    "Recorded",
    "Session",
    "Step",
    "Track",
    "Walk",
    "ccd",
    "clip",
    "drawn",
    "gait",
    "growing_clamp",
    "hold",
    "ignore",
    "imitate",
    "per_chain",
    "perform",
    "quality",
    "reachable",
    "retarget",
    "step",
    "track",
    "whole",
]
