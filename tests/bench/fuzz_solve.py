"""Solves of random bodies, and whether each keeps its promises: python tests/bench/fuzz_solve.py

`--solves N` says how many. Bodies, starts, targets (met by a pose, out of reach, the present ones),
methods, rules, caps, weights and restarts at random. Of every solve is asked: is the pose finite,
within the limits, and where its joints are locked unmoved; is `error` what `forward` says, and
`converged` so; is the reason one that the pose bears out; and is a batch its members, bit for bit.
"""

import argparse
from functools import partial

import numpy as np
from fuzz import body

from ikteach import SOLVERS, dls_following, forward, locate, solve
from ikteach.motion import clip, hold, ignore, per_chain, whole
from ikteach.motion.ccd import ccd
from ikteach.motion.solve import ARRIVED, AT_LIMITS, HELPS, STILL
from ikteach.solvers.bvls import bvls

METHODS = [*SOLVERS.values(), dls_following, dls_following, bvls, ccd, partial(SOLVERS["dls"])]
BATCH = 10
SLIGHT = 1e-6  # a turn, to see what a joint does [rad; in units for slides]


def options(rng, unit, k):
    """What may be told to `solve`."""
    return {
        "tolerance": float(unit * rng.choice([0.3, 1e-3, 1e-6])),
        "most": int(rng.choice([0, 1, 5, 40])),
        "limits": rng.choice([hold, hold, clip, ignore]),
        "max_step": rng.choice([None, None, 0.05]),
        "cap": rng.choice([whole, per_chain]),
        "restarts": int(rng.choice([0, 0, 2])),
        "weights": rng.choice([0.0, 1.0, 3.0], k) if rng.random() < 0.2 else None,
    }


def problem(rng, tree, effectors, unit):
    """Starts (b, n) within and beyond the limits, and targets (b, k, 3)."""
    ends = np.where(tree.slide, unit, 3.0)
    low, high = np.maximum(tree.lower, -ends), np.minimum(tree.upper, ends)
    low, high = np.minimum(low, high), np.maximum(low, high)
    theta, goals = rng.uniform(low, high, (2, BATCH, len(tree)))
    close = theta + 0.1 * ends * rng.normal(size=theta.shape)
    goals = np.where(rng.random((BATCH, 1)) < 0.5, close, goals)
    goals = np.minimum(np.maximum(goals, tree.lower), tree.upper)
    if rng.random() < 0.2:
        theta += ends * rng.normal(size=theta.shape)
    targets = locate(forward(tree, goals), effectors)
    out = rng.random((BATCH, len(effectors), 1)) < rng.choice([0, 0.3])
    return theta, targets + np.where(out, unit * 10.0 ** rng.integers(-1, 2), 0)


def share(tree, effectors, theta, targets, unit, weights=None):
    """What each joint alone can take of ‖e‖², by small turns: (n,), with the sign of the turn."""
    roots = np.ones(len(effectors)) if weights is None else weights
    slight = SLIGHT * np.where(tree.slide, unit, 1) * np.eye(len(tree))
    ways = [locate(forward(tree, theta + by), effectors) for by in (slight, -slight)]
    e = (roots[:, None] * (targets - locate(forward(tree, theta), effectors))).ravel()
    J = (roots[:, None] * (ways[0] - ways[1])).reshape(len(tree), -1)
    size = np.linalg.norm(J, axis=-1) * np.linalg.norm(e)
    cos = np.divide(J @ e, size, out=np.zeros(len(tree)), where=size > 1e-12 * unit * unit * SLIGHT)
    return cos * abs(cos)


def violations(tree, effectors, theta, targets, found, unit, tolerance, limits, **told):
    """The promises that the solves from θ (b, n) did not keep, by name, each with where."""
    if (where := ~np.isfinite(found.theta)).any():
        return {"finite": where}
    within = limits is not ignore
    start = np.minimum(np.maximum(theta, tree.lower), tree.upper) if within else theta
    off = np.linalg.norm(targets - locate(forward(tree, found.theta), effectors), axis=-1)
    rounding = 1e-12 * (unit + abs(targets).max())
    most = told["most"] * (1 + told["restarts"])
    outside = (found.theta < tree.lower) | (found.theta > tree.upper)
    broken = {
        "within": outside & within,
        "locked": (tree.mobility == 0) & (found.theta != start),
        "error": abs(found.error - off) > rounding,
        "converged": found.converged != (found.error <= tolerance).all(axis=-1),
        "converged, by forward": found.converged & (off > tolerance + rounding).any(axis=-1),
        "iterations": (found.iterations < 0) | (found.iterations > most),
        "at limits": (found.why == AT_LIMITS) & (not within),
        "stands still": np.zeros(len(theta), dtype=bool),
    }
    counts = off if told["weights"] is None else off * told["weights"]
    far = counts.max(axis=-1) > 1e-6 * unit
    for i in np.flatnonzero(np.isin(found.why, (STILL, AT_LIMITS)) & far):
        cos2 = share(tree, effectors, found.theta[i], targets[i], unit, told["weights"])
        edge = np.where(cos2 > 0, found.theta[i] >= tree.upper, found.theta[i] <= tree.lower)
        help_ = abs(cos2) * (tree.mobility > 0)
        if found.why[i] == AT_LIMITS:
            broken["at limits"][i] |= not (help_[edge] > 0.9 * HELPS).any()
        free = ~edge if found.why[i] == AT_LIMITS else slice(None)
        broken["stands still"][i] = (help_[free] > 1.1 * HELPS).any()
    return {name: where for name, where in broken.items() if where.any()}


def main(solves=200_000, seed=0, show=5):
    """Solve so many problems; print and return how many promises were broken."""
    rng = np.random.default_rng(seed)
    done = bodies = broken = 0
    whys = np.zeros(4, dtype=int)
    while done < solves:
        tree, effectors, unit = body(rng, stiff=True)
        bodies += 1
        theta, targets = problem(rng, tree, effectors, unit)
        told = options(rng, unit, len(effectors))
        solver = METHODS[rng.integers(len(METHODS))]
        found = solve(tree, effectors, targets, solver, theta=theta, seed=bodies, **told)
        wrong = violations(tree, effectors, theta, targets, found, unit, **told)
        i = rng.integers(BATCH)
        one = solve(tree, effectors, targets[i], solver, theta=theta[i], seed=bodies, **told)
        alike = [np.array_equal(a, b[i]) for a, b in zip(one, found, strict=True)]
        if not all(alike):
            wrong["batch is loop"] = np.array([i])
        for name, where in wrong.items():
            broken += int(np.count_nonzero(where))
            if broken <= show:
                print(f"body {bodies}: {name} {np.argwhere(where)[0]} {told} {solver}")
        whys += np.bincount(found.why, minlength=4)
        done += BATCH + 1
    print(f"{done} solves of {bodies} bodies, violations {broken}; {whys[ARRIVED]} arrived, {whys}")
    return broken


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--solves", type=int, default=200_000)
    parser.add_argument("--seed", type=int, default=0)
    told_ = parser.parse_args()
    raise SystemExit(main(told_.solves, told_.seed) > 0)
