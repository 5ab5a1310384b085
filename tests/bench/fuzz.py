"""Steps of random bodies, and whether each keeps its promises: python tests/bench/fuzz.py

`--ticks N` says how many. Bodies, starts (beyond the limits too), targets, methods, caps,
mobilities and rules at random. Of every tick of every pose is asked, in the order of `step`'s
docstring: is it finite; do locked joints stay; does no joint turn further than the cap; is within
the limits what was within, and is nothing further out; does what is beyond come back, as far as it
may; does `capped` tell the truth.
"""

import argparse
from functools import partial

import numpy as np

from ikteach import Effectors, Joint, Tree, dls, dls_following, pseudoinverse, sdls, transpose
from ikteach.motion import clip, hold, ignore, per_chain, step, whole
from ikteach.solvers.sdls import soft

METHODS = [
    transpose, pseudoinverse, dls, sdls, dls_following, partial(dls, damping=0),
    partial(pseudoinverse, cutoff=0), partial(sdls, clamp=soft), partial(transpose, gain=0.5),
]  # fmt: skip
BATCH, TICKS = 20, 10  # poses of a body, and steps that each takes


def body(rng, stiff=False):
    """A tree of 1 to 12 joints, in any unit, some with limits, and 1 to 4 effectors.

    With `stiff`, some joints are locked or take a part of their step.
    """
    n, unit, joints = rng.integers(1, 13), 10.0 ** rng.integers(-6, 7), []
    for j in range(n):
        slide = bool(rng.random() < 0.2)
        lower, upper = np.sort(rng.uniform(-4, 4, 2) * (unit if slide else 1))
        if rng.random() < 0.3:
            lower, upper = rng.choice([(-np.inf, upper), (lower, np.inf), (-np.inf, np.inf)])
        if rng.random() < 0.05:
            upper = lower = 0.0
        parent = f"j{rng.integers(0, j)}" if j and rng.random() < 0.9 else None
        offset = unit * rng.choice([0, 1, 1]) * rng.normal(size=3)
        axis = rng.choice([rng.normal(size=3), np.eye(3)[rng.integers(3)]])
        share = float(rng.choice([0, 0.5, 1, 1, 1, 1])) if stiff else 1.0
        ends = float(lower), float(upper)
        joints.append(Joint(f"j{j}", parent, offset, axis, slide, *ends, mobility=share))
    tree = Tree.of(joints)
    ends = {
        f"e{i}": (f"j{rng.integers(n)}", unit * rng.normal(size=3))
        for i in range(rng.integers(1, 5))
    }
    return tree, Effectors.of(tree, ends), unit


def options(tree, rng, unit):
    """What may be told to `step`."""
    n = len(tree)
    caps = [None, 0.0, 1e-3, 0.1, 1.0, np.inf, 10.0 ** rng.uniform(-3, 1, BATCH)]
    mobilities = [None, rng.choice([0, 0.3, 1], n), rng.choice([0.0, 1], (BATCH, n))]
    return {
        "max_step": caps[rng.integers(len(caps))],
        "cap": rng.choice([whole, per_chain]),
        "mobility": mobilities[rng.integers(len(mobilities))],
        "limits": rng.choice([hold, hold, clip, ignore]),
        "max_error": rng.choice([None, unit]),
        "at_targets": bool(rng.random() < 0.1),
    }


def violations(tree, theta, done, max_step=None, mobility=None, limits=hold, **_):
    """The promises that a step from θ (b, n) did not keep, by name, each with where."""
    lower, upper, to = tree.lower, tree.upper, done.theta
    locked = np.broadcast_to(0 if mobility is None else np.asarray(mobility) == 0, to.shape)
    cap = np.broadcast_to(np.inf if max_step is None else max_step, to.shape[:-1])[..., None]
    ends = [np.where(np.isfinite(end), abs(end), 0) for end in (lower, upper, cap)]
    rounding = 4e-15 * (1 + abs(theta) + sum(ends))
    turned = abs(to - theta)
    out, still_out = np.maximum(lower - theta, theta - upper), np.maximum(lower - to, to - upper)
    largest = abs(done.wanted).max(axis=-1)
    broken = {
        "finite": ~np.isfinite(to),
        "locked": locked & (to != theta),
        "cap": turned > cap + rounding,
        "dtheta": done.dtheta != to - theta,
        "capped without a cap": done.capped & np.isinf(cap[..., 0]),
        "capped, and nothing was too far": done.capped
        & ~done.held.any(axis=-1)
        & (largest < cap[..., 0] * (1 - 1e-9)),
        "the cap is not told": ~done.capped & ~done.held.any(axis=-1)
        & (largest > cap[..., 0] * (1 + 1e-9)),
    }  # fmt: skip
    if limits is not ignore:
        back = np.where(locked, 0, np.minimum(np.maximum(out, 0), cap))
        broken |= {
            "within": (out <= 0) & (still_out > 0),
            "further out": (out > 0) & (still_out > out),
            "back": (out > 0) & (out - np.maximum(still_out, 0) < back - rounding),
            "the way back is not told": ~done.capped
            & ((still_out > rounding) & done.held & ~locked).any(axis=-1),
        }
    return {name: where for name, where in broken.items() if where.any()}


def main(ticks=1_000_000, seed=0, show=5):
    """Step until so many ticks are done; print and return how many promises were broken."""
    rng = np.random.default_rng(seed)
    done = bodies = broken = 0
    while done < ticks:
        tree, effectors, unit = body(rng)
        bodies += 1
        told = options(tree, rng, unit)
        solver = METHODS[rng.integers(len(METHODS))]
        low, high = np.maximum(tree.lower, -7), np.minimum(tree.upper, 7)
        theta = rng.uniform(np.minimum(low, high), np.maximum(low, high), (BATCH, len(tree)))
        beyond = rng.random(theta.shape) < rng.choice([0, 0, 0.3])
        theta += np.where(beyond, rng.normal(size=theta.shape) * rng.choice([0.1, 10]), 0)
        edge = rng.random(theta.shape) < 0.1
        theta = np.where(edge & np.isfinite(tree.lower), tree.lower, theta)
        far = unit * 10.0 ** rng.integers(-3, 4)
        targets = far * rng.normal(size=(BATCH, len(effectors), 3))
        for _ in range(TICKS):
            one = step(tree, theta, effectors, targets, solver, **told)
            wrong = violations(tree, theta, one, **told)
            for name, where in wrong.items():
                broken += int(where.sum())
                if broken <= show:
                    print(f"body {bodies}: {name} {np.argwhere(where)[0]} {told} {solver}")
            theta = one.theta
            done += BATCH
    print(f"{done} ticks of {bodies} bodies, violations {broken}")
    return broken


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--ticks", type=int, default=1_000_000)
    parser.add_argument("--seed", type=int, default=0)
    told_ = parser.parse_args()
    raise SystemExit(main(told_.ticks, told_.seed) > 0)
