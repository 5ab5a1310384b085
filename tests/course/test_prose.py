"""What the prose of chapters 3 to 6, 8 and 10 says without computing it there."""

from functools import partial
from math import degrees, pi, radians

import numpy as np
import pytest

from ikteach import cramer, dls, figures, forward, gait, jacobian, pseudoinverse, track, transpose
from ikteach.motion import BUSS_CAPS, clip, hold, per_chain, whole
from ikteach.motion.reach import packages
from ikteach.solvers import SOLVERS
from ikteach.study.experiment import arrivals, nearby, starts

ARM, HUMAN = figures.planar_arm(3), figures.human()
CYCLE = gait.walking.at(np.linspace(0, 2 * np.pi, 34, endpoint=False))
WALK = np.tile(CYCLE, (3, 1, 1))

pytestmark = pytest.mark.usefixtures("rounding")


@pytest.mark.parametrize("body", [ARM, HUMAN], ids=["arm", "human"])
def test_03_a_shorter_step_is_the_better_habit(body):
    half, best = (arrivals(*body, partial(transpose, gain=gain), poses=20) for gain in (0.5, 1))
    assert np.median(half) < np.median(best)


def test_03_steps_with_the_best_alpha_come_to_stand_at_right_angles():
    goal = np.tile([[0.5, 2.2, 0.0]], (12, 1, 1))
    turn = np.diff(track(*ARM, goal, transpose, theta=[0.9, -0.7, -0.6]).theta, axis=0)
    turn /= np.linalg.norm(turn, axis=1, keepdims=True)
    assert abs(np.vecdot(turn[1:], turn[:-1]))[-4:].max() < 0.1


def test_04_caps():
    caps = [{}, *({"max_step": radians(5), "cap": cap} for cap in (per_chain, whole))]
    same = {"targets": WALK[:, None], "solver": pseudoinverse, "theta": nearby(HUMAN.tree.rest, 20)}
    free, apart, as_one = (track(*HUMAN, **same, **cap) for cap in caps)
    feet = [run.error[34:, :, :2].mean(axis=(0, 2)) for run in (free, apart, as_one)]
    assert feet[2].min() > 20 * max(feet[0].max(), feet[1].max())
    hands, jitter = (
        [np.median(values.mean(axis=0)) for values in (one(free), one(as_one))]
        for one in (lambda run: run.error[..., 2:].mean(axis=-1), lambda run: run.jitter)
    )
    assert hands[0] > 1.1 * hands[1]
    assert jitter[0] > 3 * jitter[1]


def test_04_it_shakes_or_it_freezes():
    walk = gait.walking(gait.walking.clock(300))[:, None]
    free = track(*HUMAN, walk, pseudoinverse, theta=nearby(HUMAN.tree.rest, 40))
    jitter = np.degrees(free.jitter).reshape(10, 30, 40).mean(axis=1)
    assert (jitter[:2] > 100).mean() > 0.95  # at first they shake
    frozen, shaking = (jitter[-1] < 10).mean(), (jitter[-1] > 50).mean()
    assert 0.05 < frozen < 0.75
    assert frozen + shaking > 0.8  # there is little between


def test_04_the_step_grows_like_one_over_the_bend_and_then_is_none():
    tree, hand = ARM
    bends = np.array([[0.01], [0.02]])
    J = jacobian(tree, forward(tree, bends * [0.5, -1, 0.5]), hand)
    inward = np.array([-0.1, 0, 0])
    sizes = np.linalg.norm(pseudoinverse(J, inward, cutoff=0), axis=1)
    assert sizes[0] / sizes[1] == pytest.approx(2, rel=0.01)
    assert np.linalg.norm(pseudoinverse(J[:1] * 1.0, inward), axis=1) < 1e-3 * sizes[0]


def test_04_holding_joints_is_quicker_than_clipping_them():
    counts = [
        np.median(arrivals(*HUMAN, pseudoinverse, poses=40, most=200, spread=0.6, limits=rule))
        for rule in (clip, hold)
    ]
    assert counts[1] < counts[0]


def test_05_no_damping_moves_a_straight_arm_inward():
    tree, hand = ARM
    J = jacobian(tree, forward(tree, tree.rest), hand)
    for damping in (0.001, 0.1, 10.0):
        assert not dls(J, np.array([-1.0, 0, 0]), damping=damping).any()


def smallest(theta):
    """σ₁₂ of the human at poses (..., 20)."""
    tree, effectors = HUMAN
    return np.linalg.svdvals(jacobian(tree, forward(tree, theta), effectors))[..., -1]


def test_06_the_spine_moves_a_straight_arm_too():
    tree = HUMAN.tree
    theta = starts(tree, 1000, spread=0.4)[1:]
    theta[:, [tree.index("elbow.l"), tree.index("elbow.r")]] = 0
    assert smallest(theta).min() > 1e-6
    assert np.median(smallest(theta)) == pytest.approx(0.04, abs=0.01)
    J = jacobian(tree, forward(tree, tree.rest), HUMAN.effectors)
    assert (np.linalg.svdvals(J) < 1e-9).sum() == 2


def test_06_a_cap_of_its_own_makes_the_pseudoinverse_as_calm_as_dls():
    same = {"targets": WALK[:68, None], "theta": nearby(HUMAN.tree.rest, 20)}
    jitter = [
        np.median(track(*HUMAN, **same, solver=solver, max_step=radians(cap)).jitter.mean(axis=0))
        for solver, cap in ((dls, 45), (pseudoinverse, 5), (pseudoinverse, 45))
    ]
    assert jitter[1] / jitter[0] == pytest.approx(1, abs=0.3)
    assert jitter[2] / jitter[0] > 5


def test_07_feet_of_the_pseudoinverse_are_nearer_than_those_of_dls():
    walk = gait.walking(gait.walking.clock(300))
    cap = {"max_step": radians(5), "cap": per_chain}
    near = [
        track(*HUMAN, walk, name, **cap).error[30:, :2].mean() for name in ("pseudoinverse", "dls")
    ]
    assert near[0] < 0.7 * near[1]


def test_06_and_08_constants():
    assert round(degrees(4 / pi)) == 73
    caps = {name: cap and round(degrees(cap)) for name, cap in BUSS_CAPS.items()}
    assert caps == {"transpose": 30, "pseudoinverse": 5, "dls": 45, "sdls": None}
    assert list(SOLVERS) == list(caps)


def test_10_a_step_along_an_arm_grows_as_it_gets_straight_and_one_across_does_not():
    body = packages.ReachingFigure()
    poses = np.tile(body.tree.rest, (2, 1))
    poses[:, body.tree.index("elbow.r")] = np.radians([0.1, 1.0])
    J = packages.by_hand(body, poses, packages.PACKAGES[0])
    ahead, up = (abs(cramer(J, np.array(e))).max(axis=-1) for e in ([0, 0, 0.05], [0, 0.05, 0]))
    assert up[0] / up[1] == pytest.approx(10, rel=0.01)
    assert ahead[0] / ahead[1] == pytest.approx(1, rel=0.01)
