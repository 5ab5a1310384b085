"""How much the body costs beside the linear algebra: python tests/bench/speed.py [rounds]

Every line is a ratio of two things called in turns, A B A B …, in one process on one BLAS thread:
the median of the paired ratios, and the ratio of the two fastest. The human, 4 effectors. Turns of
one call each put both in the same state of the machine's caches. Alone in a loop the bare line runs
from the innermost cache, which no program that also draws a figure does; "looped" shows that.
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before numpy starts its threads

import sys
from statistics import median
from timeit import timeit

import numpy as np
import textbook

from ikteach import dls, figures, forward, jacobian, locate, sdls, step

DAMPING = 0.1
BATCH = 1000
FEW = 100  # poses, as of a crowd, or of a grid of starts

tree, effectors = figures.human()
# Well inside the limits, so that a step is one solve; that of a held joint is one more.
middle = (np.maximum(tree.lower, -1) + np.minimum(tree.upper, 1)) / 2
rng = np.random.default_rng(0)


def problem(*batch):
    """Poses (..., n) inside the limits, targets (..., 4, 3) 3 cm from the effectors, and J, e."""
    theta = middle + rng.uniform(-0.1, 0.1, (*batch, len(tree)))
    frames = forward(tree, theta)
    targets = locate(frames, effectors) + rng.normal(0, 0.03, (*batch, 4, 3))
    return theta, targets, jacobian(tree, frames, effectors), rng.normal(0, 0.03, (*batch, 12))


def bare_dls(J, e):
    """The textbook line in numpy, and nothing around it."""
    A = J @ J.mT + DAMPING**2 * np.eye(12)
    return np.vecmat(np.linalg.solve(A, e[..., None])[..., 0], J)


def public_step(solver, theta, targets, **options):
    """A step as a student writes it, in the package's public calls."""
    frames = forward(tree, theta)
    s = locate(frames, effectors)
    J = jacobian(tree, frames, effectors, at=s)
    e = (targets - s).reshape(*theta.shape[:-1], 12)
    return theta + solver(J, e, **options)


def damped(J, e):
    """DLS with the bench's damping."""
    return dls(J, e, damping=DAMPING)


def comparisons():
    """{what: (A, B, turns in a round, the most that A may cost in units of B)}."""
    theta, targets, J, e = problem()
    many, few = problem(BATCH), problem(FEW)[:2]
    identity = DAMPING**2 * np.eye(12)

    def bare():
        return J.T @ np.linalg.solve(J @ J.T + identity, e)

    def bare_many():
        return bare_dls(many[2], many[3])

    def door(solver, theta=theta, targets=targets):
        return lambda: step(tree, theta, effectors, targets, solver)

    def public(solver, theta=theta, targets=targets):
        return lambda: public_step(solver, theta, targets)

    def svd():
        return np.linalg.svd(J)

    def foil():
        return textbook.dls_step(tree, effectors, theta, targets, DAMPING)

    def foil_few():
        return [textbook.dls_step(tree, effectors, *one, DAMPING) for one in zip(*few, strict=True)]

    return {
        "DLS step, public calls / bare solve": (public(damped), bare, 400, 5),
        "DLS step(...)           / bare solve": (door(damped), bare, 400, 5),
        "SDLS step, public calls / bare SVD": (public(sdls), svd, 100, 3.5),
        "SDLS step(...)          / bare SVD": (door(sdls), svd, 100, 3.5),
        "1000 poses, public calls / bare solves": (public(damped, *many[:2]), bare_many, 2, 4.5),
        "1000 poses, step(...)    / bare solves": (door(damped, *many[:2]), bare_many, 2, 4.5),
        "textbook loops / DLS step, public calls": (foil, public(damped), 20, None),
        "textbook loops / DLS step(...)": (foil, door(damped), 20, None),
        "100 poses, textbook loops / public calls": (foil_few, public(damped, *few), 1, None),
    }


def measure(a, b, turns, rounds, loop=1):
    """(median of paired ratios, ratio of minima, fastest a [s], fastest b [s])."""
    a(), b()
    pairs = [(timeit(a, number=loop), timeit(b, number=loop)) for _ in range(turns * rounds)]
    fastest = [min(times) / loop for times in zip(*pairs, strict=True)]
    return median(x / y for x, y in pairs), fastest[0] / fastest[1], *fastest


def main(rounds=60):
    """Print the table."""
    print(f"{'':42}{'median':>8}{'of min':>8}{'bar':>6}{'A [µs]':>10}{'B [µs]':>10}{'looped':>8}")
    for what, (a, b, turns, bar) in comparisons().items():
        ratio, least, x, y = measure(a, b, turns, rounds)
        looped, *_ = measure(a, b, 1, rounds, loop=turns)
        bar = f"≤ {bar}" if bar else "≥ 15"
        print(
            f"{what:42}{ratio:8.2f}{least:8.2f}{bar:>6}{x * 1e6:10.1f}{y * 1e6:10.1f}{looped:8.2f}"
        )


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
