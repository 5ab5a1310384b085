"""Damping that follows the error against fixed dampings: python tests/bench/damping.py [poses]

The human, limits on. "far": targets of all four effectors at another pose within the limits, from
the middle pose; counted are the steps until all are within 1 mm, of those poses where that happens.
"unreachable": hands 30 cm further out than that; the jitter ‖Δ²θ‖ of the last 50 of 300 steps.
"""

import sys
from functools import partial

import numpy as np

from ikteach import dls, dls_following, figures, forward, locate, step

WITHIN = 1e-3  # [m]
STEPS = 300
METHODS = {
    "following": dls_following,
    **{f"λ = {damping}": partial(dls, damping=damping) for damping in (0.01, 0.05, 0.1, 0.3, 1.1)},
}

tree, effectors = figures.human()


def problems(poses):
    """The start (n,) and, for so many poses, targets (poses, 4, 3) near and out of reach."""
    rng = np.random.default_rng(0)
    lower, upper = np.maximum(tree.lower, -1.5), np.minimum(tree.upper, 1.5)
    start = (lower + upper) / 2
    reach = locate(forward(tree, rng.uniform(lower, upper, (poses, len(tree)))), effectors)
    beyond = reach.copy()
    hands = beyond[:, 2:]
    hands += 0.3 * hands / np.linalg.norm(hands, axis=-1, keepdims=True)
    return start, reach, beyond


def run(solver, start, targets):
    """Steps until all effectors arrive (poses,), inf for never; ‖Δ²θ‖ of the end (50, poses)."""
    theta = np.broadcast_to(start, (len(targets), len(start)))
    arrived, poses = np.full(len(targets), np.inf), []
    for count in range(1, STEPS + 1):
        theta = step(tree, theta, effectors, targets, solver).theta
        error = np.linalg.norm(targets - locate(forward(tree, theta), effectors), axis=-1)
        there = (error < WITHIN).all(axis=-1) & np.isinf(arrived)
        arrived[there] = count
        poses = [*poses[-51:], theta]
    return arrived, np.linalg.norm(np.diff(poses, n=2, axis=0), axis=-1)


def main(poses=300):
    """Print the table."""
    start, reach, beyond = problems(poses)
    print(f"{'':12}{'arrived':>9}{'median':>8}{'p99':>7}{'jitter [rad]':>14}{'p99':>9}")
    for name, solver in METHODS.items():
        arrived, _ = run(solver, start, reach)
        _, jitter = run(solver, start, beyond)
        share = np.isfinite(arrived).mean()
        there = arrived[np.isfinite(arrived)]
        steps = np.quantile(there, [0.5, 0.99]) if len(there) else (np.nan, np.nan)
        print(
            f"{name:12}{share:9.0%}{steps[0]:8.0f}{steps[1]:7.0f}"
            f"{jitter.mean():14.5f}{np.quantile(jitter, 0.99):9.4f}"
        )


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
