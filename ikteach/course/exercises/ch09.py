"""Chapter 9: a mix of methods, a method per effector."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from ikteach.body import figures
from ikteach.course.checking import NotYetError, WrongError, exercise, expect
from ikteach.motion import gait, track
from ikteach.motion.mix import Mix
from ikteach.solvers import SOLVERS

FEET, SHAKE = 0.002, 2.0  # [m] and [degrees a tick²]: what no single method keeps to at once
FRAMES, SETTLING = 120, 30


def walk(solver: Any) -> tuple[float, float]:
    """Mean distance of the feet [m] and jitter [degrees] of 4 s of walking, the first left out."""
    tree, effectors = figures.human()
    run = track(tree, effectors, gait.walking(gait.walking.clock(FRAMES)), solver)
    feet = [name.startswith("foot") for name in effectors.names]
    return run.error[SETTLING:, feet].mean(), float(np.degrees(run.jitter[SETTLING:].mean()))


@exercise(
    "09.mix",
    returns=None,
    value=True,
    hints=[
        "The feet can be reached, the hands cannot. Who is good at each of these?",
        "One of the undamped or selectively damped methods for the feet; the calmest for the arms.",
    ],
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
    expect(shake < SHAKE, f"The figure shakes by {shake:.1f}° a tick, not below {SHAKE:g}°.")
