"""Gaits as a table: how natural each run is, beside how near it came to its targets."""

from collections.abc import Mapping

import numpy as np
import pandas as pd

from ikteach.checks import shown
from ikteach.motion.path import Motion
from ikteach.motion.paths import quality
from ikteach.motion.track import Track


def gait_report(
    tracks: Mapping[str, Track], path: Motion | Mapping[str, Motion], *, speed: str = "Free"
) -> pd.DataFrame:
    """Tabulate the quality of gaits: a row per run.

    tracks  {name: Track} on a treadmill, the phase of a frame being `path.rate` times its time, as
            `motion.paths.perform` makes them
    path    the motion that they follow, or {name: motion}
    speed   of the norms: "Slow", "Free" or "Fast"

    error           mean distance to the targets [m]
    score           distance to the norm's hip, knee, ankle and pelvic tilt (`gait_score`)
    hip, knee, ankle, pelvis   each alone [degrees]
    slip, drag      of the standing foot, and along the ground in a stride, the worse foot [m]
    clearance       of the swinging foot, the worse one [m]
    double support  share of time
    arm             r of a hand with the foot of its side, the worse side
    below           how far a sole is under the ground, at most [m]

    ValueError or LookupError for runs that cannot be measured.
    """
    if not isinstance(tracks, Mapping) or not tracks:
        raise ValueError(f"runs are {{name: Track}}, at least one, not {shown(tracks)}")
    rows = {}
    for name, run in tracks.items():
        motion = path[name] if isinstance(path, Mapping) else path
        curves, means = quality.curves(run, motion), quality.norms(speed)
        rows[name] = {
            "error": run.error.mean(),
            "score": quality.score_of(curves, speed),
            **{c: np.sqrt(np.mean((curves[c] - means[c]) ** 2)) for c in quality.CURVES},
            "slip": quality.slip(run, motion).max(),
            "drag": quality.drag(run, motion).max(),
            "clearance": quality.clearance(run, motion).min(),
            "double support": quality.double_support(run, motion),
            "arm": quality.arm_swing(run, motion).max(),
            "below": max(0.0, -quality.soles(run, motion).heights.min()),
        }
    return pd.DataFrame.from_dict(rows, orient="index")
