"""Buss's tracking runs through `track`: four experiments, twenty settings.

Runs with the same solver go side by side in one batch, over the first half of their 4,400 frames,
whose mean the reference also gives; those with 20 steps a frame go to the checkpoint at 401, and
their mean is not compared. IKTEACH_FULL=1 in the environment runs everything to its end. Each start
is run twice, the second time moved by 1e-10: where the two means part by more than 1e-7 the run is
chaotic, rounding decides it, and only its first steps can be compared.
"""

import os
from collections import defaultdict
from functools import cache, partial
from math import pi, radians

import numpy as np
import pytest
from numpy.testing import assert_allclose
from reference import EXPERIMENTS, model

from ikteach import dls, forward, locate, pseudoinverse, sdls, track, transpose
from ikteach.motion import BUSS_CAPS, growing_clamp, ignore
from ikteach.solvers.sdls import hard, soft

NUDGE, PARTED = 1e-10, 1e-7
SOLVERS = {
    "transpose": transpose,
    "transposethesis": partial(transpose, gain=0.5),
    "pinv": pseudoinverse,
    "dls": dls,
    "dlssvd": dls,
    "dlsclamp": dls,
    "sdls": partial(sdls, clamp=soft),
    "sdlspaper": partial(sdls, clamp=hard),
    "sdlsthesis": partial(sdls, clamp=hard, max_angle=4 / pi),
}
CAPS = {
    "transpose": BUSS_CAPS["transpose"],
    "pinv": BUSS_CAPS["pseudoinverse"],
    "dls": BUSS_CAPS["dls"],
    "dlssvd": radians(45),
    "dlsclamp": BUSS_CAPS["dls"],
}
CLAMPED = {"dlsclamp", "sdls", "sdlspaper", "sdlsthesis"}
RUNS = [(x, r) for x, experiment in EXPERIMENTS.items() for r in experiment["runs"]]


def company(run):
    """What a run must share with others to go side by side with them."""
    return SOLVERS[run["method"]], CAPS.get(run["method"]), run["active"], run["inner"]


def goals(experiment):
    """The targets over time (T, k, 3), as the protocol of the reference makes them."""
    settings = experiment["settings"]
    tree, effectors = model(experiment["model"])
    T = settings["T0"]
    times = []
    for _ in range(settings["WARM"] + settings["STEPS"]):
        T += settings["DT"]
        times.append(T)
    T = np.array(times)
    if settings["MODE"] == "sin":
        c, a, f = np.moveaxis(np.reshape(settings["SIN"], (len(effectors), 3, 3)), -1, 0)
        return c + settings["AMP"] * a * np.sin(f * T[:, None, None])
    center, amplitude, frequency, phase = np.reshape(settings["FK"], (len(tree), 4)).T
    theta = center + amplitude * np.sin(frequency * T[:, None] + phase)
    pivot = np.array(settings.get("PIVOT", np.zeros(3)))
    return pivot + settings["AMP"] * (locate(forward(tree, theta), effectors) - pivot)


def clamp_as_coded(e, error, *, base=0.4):
    """Buss's clamp with the entries of e that his code reads: i, i + 1, i + 2 for effector i."""
    k = error.shape[-1]
    read = np.stack([e[..., i : i + 3] for i in range(k)], axis=-2)
    return base + np.maximum(0, error - np.linalg.norm(read, axis=-1))


def clamp_rule(clamps):
    """The clamp of each run of a batch (r, 2): as coded, fixed or none."""
    as_coded = np.array([c == "buss" for c in clamps])[:, None, None]
    none = np.array([c == "none" for c in clamps])[:, None, None]

    def rule(e, error):
        bound = np.where(as_coded, clamp_as_coded(e, error), growing_clamp(e, error))
        return np.where(none, np.inf, bound)

    return rule


def span(run):
    """The frames of a run that are compared: those left out, all, and the name of their mean."""
    if os.environ.get("IKTEACH_FULL"):
        return run["warm"], run["warm"] + run["steps"], "mean_dist"
    if run["inner"] == 1:
        return run["warm"], run["warm"] + 2000, "mean_dist_first2000"
    return 0, 401, None


@cache
def batches():
    together = defaultdict(list)
    for x, r in RUNS:
        together[company(EXPERIMENTS[x]["runs"][r])].append((x, r))
    return dict(together)


@cache
def batch(key):
    """{(experiment, run): poses (T, 2, n), distances (T, 2, k)} of one batch."""
    solver, cap, active, inner = key
    members = batches()[key]
    runs = [EXPERIMENTS[x]["runs"][r] for x, r in members]
    tree, effectors = model("yshape")
    start = np.array([EXPERIMENTS[x]["theta0"] for x, _ in members])[:, None, :]
    start = start + np.array([[0.0], [NUDGE]])
    targets = np.stack([goals(EXPERIMENTS[x]) for x, _ in members], axis=1)[:, :, None]
    targets = targets[: span(runs[0])[1]]
    if solver is dls:
        solver = partial(dls, damping=np.array([[run["lambda"]] for run in runs]))
    clamps = [run["sclamp"] if run["method"] in CLAMPED else "none" for run in runs]
    done = track(
        tree, effectors, targets, solver, theta=start, iterations=inner, max_step=cap,
        clamp_rule=clamp_rule(clamps) if set(clamps) != {"none"} else None,
        limits=ignore, at_targets=active == "target",
    )  # fmt: skip
    return {m: (done.theta[:, i], done.error[:, i]) for i, m in enumerate(members)}


def test_the_runs_that_go_side_by_side_have_the_same_figure_and_no_limits():
    for x, r in RUNS:
        assert EXPERIMENTS[x]["model"] == "yshape"
        assert not EXPERIMENTS[x]["runs"][r]["limits"]
    assert len(RUNS) == 80


@pytest.mark.parametrize(("x", "r"), sorted(RUNS, key=lambda run: run[1]))
def test_run(x, r):
    run = EXPERIMENTS[x]["runs"][r]
    theta, error = batch(company(run))[x, r]
    warm, frames, mean = span(run)
    means = error[warm:].mean(axis=(0, 2))
    chaotic = abs(means[0] - means[1]) > PARTED
    assert np.isfinite(theta).all()
    if mean is not None:
        assert_allclose(means[0], run[mean], rtol=0, atol=5e-3 if chaotic else 1e-6)
    tree, effectors = model("yshape")
    for checkpoint in run["checkpoints"]:
        frame = checkpoint["step"] - 1
        if frame >= (10 if chaotic else frames):
            break
        parted = abs(theta[frame, 0] - theta[frame, 1]).max()
        tolerance = max(1e-8, 100 * parted)
        assert_allclose(theta[frame, 0], checkpoint["theta"], rtol=0, atol=tolerance)
        s = locate(forward(tree, theta[frame, 0]), effectors)
        assert_allclose(s, checkpoint["effectors"], rtol=0, atol=10 * tolerance)
