"""Numbers of every room of the core, of what hangs on no last bit; as a script it prints them.

No run in here is chaotic and no pose is exactly singular, so that another processor, another LAPACK
and integers of 32 bits may move the last digits and nothing more.
"""

import json
from collections.abc import Iterator
from typing import Any

import numpy as np

from ikteach import SOLVERS, figures, forward, gait, jacobian, locate, reachable, study, track
from ikteach.motion import ccd, per_chain, step
from ikteach.solvers import bvls

POSES, FRAMES = 24, 90
CALM = {"dls": SOLVERS["dls"], "sdls": SOLVERS["sdls"], "transpose": SOLVERS["transpose"]}


def results() -> Iterator[tuple[str, Any]]:
    """Name of what is computed, such as "solvers: dls", and its numbers."""
    human, rng = figures.human(), np.random.default_rng(20)
    tree, effectors = human
    poses = rng.uniform(tree.lower, tree.upper, (POSES, len(tree)))
    frames = forward(tree, poses)
    ends = locate(frames, effectors)
    yield "body: effectors", ends
    yield "body: Jacobian", (J := jacobian(tree, frames, effectors))
    e = rng.normal(scale=0.05, size=J.shape[:-1])
    for name, solver in SOLVERS.items():
        yield f"solvers: {name}", solver(J, e)
    targets = gait.walking(gait.walking.clock(FRAMES))
    yield "motion: targets of a walk", targets
    for name, solver in {**SOLVERS, "bvls": bvls, "ccd": ccd}.items():
        moved = step(tree, poses, effectors, ends + 0.02, solver, max_step=0.1)
        yield f"motion: a step of {name}", moved.theta
    yield "motion: reachable", reachable(*human, targets[::9])
    for name in CALM:
        run = track(*human, targets, name, max_step=np.radians(5), cap=per_chain)
        yield f"motion: a walk by {name}", run.theta
    table = study.compare(*human, targets, CALM, max_step=np.radians(5), cap=per_chain)
    yield "study: summary", study.summary(table).select_dtypes("number").to_numpy()


if __name__ == "__main__":
    print(json.dumps({name: np.asarray(found, float).tolist() for name, found in results()}))
