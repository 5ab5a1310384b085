"""The shapes that docstrings promise, with batches of 0, 1 and 2 dimensions.

Each promise is the docstring's own text: the test looks for it there, fills in the numbers of the
human (n joints, k effectors, m = 3k rows) and the batch for `...`, and runs the function.
"""

import re
from dataclasses import fields
from inspect import getdoc

import numpy as np
import pytest

from ikteach import Effectors, Frames, Step, Track, Tree, figures, motion, solvers
from ikteach import body as bodies
from ikteach.body import forward, jacobian, locate
from ikteach.body.cross import cross
from ikteach.body.plan import Plan, skew
from ikteach.motion import gait, per_chain, reachable, step, track, whole
from ikteach.motion.anatomy import Anatomy, anatomy
from ikteach.motion.live.log import Log
from ikteach.motion.live.session import Session
from ikteach.motion.mix import Mix
from ikteach.motion.reachable import nearest
from ikteach.motion.rules import clamp_error
from ikteach.solvers import adjugate, cramer, determinant, ellipsoid, independence, sdls
from ikteach.solvers.dls import filtered
from ikteach.solvers.response import Directions, directions, factors, response
from ikteach.solvers.sdls import hard, lengths, soft

TREE, EFFECTORS = figures.human()
SIZES = {"n": 20, "k": 4, "m": 12, "M": 4, "3k": 12, "3": 3, "T": 5, "r": 12}
BATCHES = [(), (3,), (2, 3), (0,)]

MIX = Mix.of(EFFECTORS, dict.fromkeys(EFFECTORS.names, "dls"))
ONE = anatomy(TREE, TREE.rest, EFFECTORS, gait.walking(0.1), "dls")
WALKED = Session()
for _ in range(5):
    WALKED.tick()


def shape_of(promise, batch):
    """The numbers of a promise such as "(..., k, 3)"."""
    parts = [part.strip() for part in promise.strip("()").split(",") if part.strip()]
    numbers = (batch if p == "..." else (SIZES.get(p) or int(p),) for p in parts)
    return tuple(number for group in numbers for number in group)


class Given:
    """Inputs with a batch."""

    def __init__(self, batch):
        rng = np.random.default_rng(0)
        self.batch = batch
        self.theta = rng.uniform(-0.1, 0.1, (*batch, 20)).clip(TREE.lower, TREE.upper)
        self.frames = forward(TREE, self.theta)
        self.s = locate(self.frames, EFFECTORS)
        self.targets = self.s + 0.05
        self.J = jacobian(TREE, self.frames, EFFECTORS)
        self.e = np.full((*batch, 12), 0.05)
        self.T = rng.uniform(0, 1, batch)
        self.walk = np.stack([self.targets] * 5)


PROMISES = [  # function, its promise, how to run it
    (locate, "(..., k, 3)", lambda g: locate(g.frames, EFFECTORS)),
    (jacobian, "(..., 3k, n)", lambda g: jacobian(TREE, g.frames, EFFECTORS)),
    (jacobian, "(..., 3k, n)", lambda g: jacobian(TREE, g.frames, EFFECTORS, at=g.targets)),
    *(
        (solver, "(..., n)", lambda g, solver=solver: solver(g.J, g.e))
        for solver in solvers.SOLVERS.values()
    ),
    (solvers.ask, "(..., n)", lambda g: solvers.ask(solvers.dls, g.J, g.e)),
    (cramer, "(..., 3)", lambda g: cramer(g.J[..., :3, 2:5], g.e[..., :3])),
    (adjugate, "(..., 3, 3)", lambda g: adjugate(g.J[..., :3, 2:5])),
    (determinant, "(...)", lambda g: determinant(g.J[..., :3, 2:5])),
    (independence, "(...)", lambda g: independence(g.J[..., :3, 2:5])),
    (hard, "(..., n)", lambda g: hard(g.theta, g.T)),
    (factors, "(..., r)", lambda g: factors(g.J, g.e, g.theta)),
    (filtered, "(..., r)", lambda g: filtered(g.e)),
    (lengths, "(..., k, r)", lambda g: lengths(np.ones((*g.batch, 12, 12)))),
    (clamp_error, "(..., k, 3)", lambda g: clamp_error(g.targets, 0.1)),
    (reachable, "(..., k)", lambda g: reachable(TREE, EFFECTORS, g.targets)),
    (nearest, "(..., k)", lambda g: nearest(TREE, EFFECTORS, g.targets, within=0.1)),
    (skew, "(..., 3, 3)", lambda g: skew(g.targets[..., 0, :])),
    (gait.Gait.__call__, "(..., 4, 3)", lambda g: gait.walking(g.T)),
    (gait.Gait.at, "(..., 4, 3)", lambda g: gait.walking.at(g.T)),
    (gait.Gait.advance, "(..., 3)", lambda g: gait.walking.advance(g.T)),
    (gait.Gait.mobility, "(n,)", lambda g: gait.walking.mobility(TREE)),
    (Mix.__call__, "(..., n)", lambda g: MIX(g.J, g.e)),
    (response, "(r,)", lambda g: response(sdls, ONE.J, ONE.e)),
    (motion.growing_clamp, "(..., k)", lambda g: motion.growing_clamp(g.e, np.ones((*g.batch, 4)))),
    (EFFECTORS.__class__.mask.func, "(k, 1, n)", lambda g: EFFECTORS.mask),
]
# Functions that say nothing of their answer's shape, because it is that of what they are given.
SAME = [
    (soft, "(..., n)", lambda g: soft(g.theta, g.T)),
    (whole, "(..., n)", lambda g: whole(g.theta, 0.1, EFFECTORS.chains)),
    (per_chain, "(..., n)", lambda g: per_chain(g.theta, 0.1, EFFECTORS.chains)),
    (cross, "(..., 3, n)", lambda g: cross(*np.ones((2, *g.batch, 4, 20)))),
    (solvers.manipulability, "(...)", lambda g: solvers.manipulability(g.J)),
    (solvers.conditioning, "(...)", lambda g: solvers.conditioning(g.J)),
    (solvers.dls_following, "(..., n)", lambda g: solvers.dls_following(g.J, g.e)),
    (
        solvers.bvls,
        "(..., n)",
        lambda g: solvers.bvls(g.J, g.e, low=-abs(g.theta), high=1 + g.theta**2),
    ),
]
RECORDS = [  # a record, its promises by field, how to make one
    (Frames, lambda g: g.frames),
    (solvers.Ellipsoid, lambda g: ellipsoid(g.J)),
    (Step, lambda g: step(TREE, g.theta, EFFECTORS, g.targets, "dls", max_step=0.1)),
    (Track, lambda g: track(TREE, EFFECTORS, g.walk, sdls, theta=g.theta)),
    (Log, lambda g: WALKED.log()),
    (Anatomy, lambda g: ONE),
    (Directions, lambda g: directions(g.J, g.e)),
    (Tree, lambda g: TREE),
    (Effectors, lambda g: EFFECTORS),
    (Plan, lambda g: TREE.plan),
]


@pytest.mark.parametrize("batch", BATCHES, ids=str)
@pytest.mark.parametrize(("function", "promise", "run"), PROMISES)
def test_what_a_function_promises(function, promise, run, batch):
    assert promise in function.__doc__
    assert np.shape(run(Given(batch))) == shape_of(promise, batch)


@pytest.mark.parametrize("batch", BATCHES, ids=str)
@pytest.mark.parametrize(("function", "shape", "run"), SAME)
def test_what_goes_through_a_function(function, shape, run, batch):
    assert np.shape(run(Given(batch))) == shape_of(shape, batch)


@pytest.mark.parametrize("batch", BATCHES, ids=str)
@pytest.mark.parametrize(("record", "make"), RECORDS)
def test_what_a_record_promises(record, make, batch):
    """Its docstring has lines such as `positions  (..., n, 3)  p_j [m]`."""
    made = make(Given(batch))
    names = [f.name for f in fields(record)] if hasattr(made, "__dict__") else made._fields
    kept = 0
    for line in getdoc(record).splitlines():
        said = re.match(r"(\w[\w, ]*?)\s+(\([\w., ]*\))", line)
        if said:
            for name in said[1].split(", "):
                assert name in names, line
                assert np.shape(getattr(made, name)) == shape_of(said[2], batch), line
                kept += 1
    arrays = [name for name in names if isinstance(getattr(made, name), np.ndarray)]
    assert kept == len(arrays), f"{record.__name__} says the shape of {kept} of {arrays}"


def test_every_public_function_of_the_ground_is_in_the_tables():
    tested = {entry[0] for entry in PROMISES + SAME} | {record for record, _ in RECORDS}
    tested |= {forward, ellipsoid}  # their answers are records
    for module in (bodies, solvers):
        for name in module.__all__:
            thing = getattr(module, name)
            if callable(thing) and name not in ("Joint", "Solver", "Solvers", "name_of"):
                assert thing in tested, name
