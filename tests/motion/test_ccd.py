"""Cyclic coordinate descent: each joint alone does the best that it can."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from strategies import anybody, poses

from ikteach import (
    Effectors,
    Joint,
    Tree,
    bvls,
    ccd,
    figures,
    forward,
    gait,
    jacobian,
    locate,
    step,
    track,
)
from ikteach.motion import Session


def sweep(tree, effectors, theta, targets, low=None, high=None):
    frames = forward(tree, theta)
    e = (targets - locate(frames, effectors)).reshape(*theta.shape[:-1], -1)
    low = tree.lower - theta if low is None else low
    high = tree.upper - theta if high is None else high
    return ccd(
        jacobian(tree, frames, effectors), e, tree=tree, effectors=effectors, frames=frames,
        low=low, high=high,
    )  # fmt: skip


def test_one_hinge_points_at_its_target():
    tree, effectors = figures.planar_arm(1)
    turn = sweep(tree, effectors, np.zeros(1), np.array([[0.0, 3.0, 0.0]]))
    assert turn == pytest.approx([np.pi / 2])


def test_one_slide_stops_beside_its_target():
    tree = Tree.of([Joint("s", axis=(1, 0, 0), slide=True, lower=-1, upper=1)])
    effectors = Effectors.of(tree, {"tool": ("s", (0, 0, 0))})
    assert sweep(tree, effectors, np.zeros(1), np.array([[0.4, 2, 0]])) == pytest.approx([0.4])
    assert sweep(tree, effectors, np.zeros(1), np.array([[9.0, 2, 0]])) == pytest.approx([1.0])


def test_no_turn_of_one_joint_alone_is_better():
    tree, effectors = figures.human()
    targets = locate(forward(tree, tree.rest), effectors) + 0.2
    last = int(effectors.joints[2])  # of the right hand: it alone has turned when its turn comes
    turn = sweep(tree, effectors, tree.rest, targets)[last]
    ways = (
        tree.rest
        + np.linspace(tree.lower[last], tree.upper[last], 2001)[:, None] * np.eye(len(tree))[last]
    )
    off = np.linalg.norm(targets[2] - locate(forward(tree, ways), effectors)[:, 2], axis=-1)
    best = np.linspace(tree.lower[last], tree.upper[last], 2001)[off.argmin()]
    assert turn == pytest.approx(best, abs=2e-3)


@given(anybody(limits=True), st.integers(0, 1000))
def test_sweeps_never_make_it_worse_and_stay_within_limits(figure, seed):
    tree, effectors = figure
    rng = np.random.default_rng(seed)
    theta = poses(tree, rng, (3,))
    targets = locate(forward(tree, poses(tree, rng, (3,))), effectors)
    before = np.inf
    for _ in range(5):
        error = np.square(targets - locate(forward(tree, theta), effectors)).sum(axis=(-1, -2))
        assert (error <= before + 1e-12).all()
        before = error
        theta = theta + sweep(tree, effectors, theta, targets)
        assert (theta >= tree.lower - 1e-12).all()
        assert (theta <= tree.upper + 1e-12).all()


@pytest.mark.parametrize("method", [ccd, bvls], ids=lambda method: method.__name__)
def test_a_foil_goes_wherever_a_method_goes(method):
    tree, effectors = figures.human()
    targets = gait.walking(gait.walking.clock(20))
    followed = track(tree, effectors, targets, method)
    assert ((followed.theta >= tree.lower) & (followed.theta <= tree.upper)).all()
    session = Session(methods={"foil": method, "dls": "dls"})
    for _ in range(20):
        session.tick()
    session.show("foil")
    still = np.linalg.norm(session.targets - locate(forward(tree, tree.rest), effectors), axis=-1)
    assert session.error.mean() < still.mean()


def test_a_locked_joint_is_known_to_a_foil():
    """The others do what it would have done."""
    tree = Tree.of([Joint("a"), Joint("b", "a", (1, 0, 0), mobility=0)])
    effectors = Effectors.of(tree, {"hand": ("b", (1, 0, 0))})
    done = step(tree, [0.0, 0.5], effectors, [[0.0, 3.0, 0.0]], ccd)
    hand = locate(forward(tree, done.theta), effectors)[0]
    assert done.theta[1] == 0.5
    assert hand[0] == pytest.approx(0, abs=1e-12)
