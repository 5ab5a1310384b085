"""Chapter 9: a mix of methods, a method per effector."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from ikteach.body import figures
from ikteach.course.checking import NotYetError, WrongError, exercise, expect
from ikteach.motion import gait, track
from ikteach.motion.mix import Mix
from ikteach.solvers import SOLVERS
from ikteach.study.experiment import nearby

FEET, SHAKE = 0.002, 3.0  # [m] and [degrees per tick²]: what no single method keeps to at once
FRAMES, SETTLING = 120, 30
POSES = 64  # to start from: some mixes are chaotic, and freeze from a few of them only


def walk(solver: Any) -> tuple[float, float]:
    """Mean distance of the feet [m] and jitter [degrees] of 4 s of walking, the first left out.

    The worst of many starts that differ by rounding alone.
    """
    tree, effectors = figures.human()
    targets = gait.walking(gait.walking.clock(FRAMES))
    run = track(tree, effectors, targets[:, None], solver, theta=nearby(tree.rest, POSES))
    feet = [name.startswith("foot") for name in effectors.names]
    distance = run.error[SETTLING:, :, feet].mean(axis=(0, 2))
    jitter = np.degrees(run.jitter[SETTLING:].mean(axis=0))
    return float(distance.max()), float(jitter.max())


@exercise(
    "09.mix",
    returns=None,
    value=True,
    hints=[
        "The feet can be reached, the hands cannot. Who is good at each of these?",
        "One of the undamped or selectively damped methods for the feet; the calmest for the arms.",
    ],
    seconds=30,
)
def mix(value: Any) -> None:
    """my_mix: {effector: method} that keeps the feet near and the figure calm."""
    _, effectors = figures.human()
    if not isinstance(value, Mapping):
        raise WrongError(f"A mix is a dictionary {{effector: method}}, not {type(value).__name__}.")
    if ... in value.values():
        raise NotYetError("name a method for every effector.")
    for name in effectors.names:
        expect(name in value, f"{name!r} has no method in your mix.")
    for name, method in value.items():
        expect(name in effectors.names, f"There is no effector {name!r}.")
        expect(method in SOLVERS, f"{method!r} is none of {', '.join(SOLVERS)}.")
    feet, shake = walk(Mix.of(effectors, dict(value)))
    expect(feet < FEET, f"The feet are {1000 * feet:.1f} mm from their targets, not below 2 mm.")
    expect(shake < SHAKE, f"The figure shakes by {shake:.1f}° per tick, not below {SHAKE:g}°.")
