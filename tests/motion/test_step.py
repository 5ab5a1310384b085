"""One tick: what stands around the solver, on any body, and what is refused at the door."""

from functools import partial
from math import inf, nan

import fuzz
import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal
from strategies import SEEDS, SHAPES, anybody, bodies, poses

from ikteach import (
    SOLVERS,
    Effectors,
    Joint,
    Tree,
    dls,
    figures,
    forward,
    jacobian,
    locate,
    pseudoinverse,
    step,
)
from ikteach.motion import BUSS_CAPS, clip, hold, ignore, per_chain, whole
from ikteach.motion.rules import clamp_error

HUMAN = figures.human()
METHODS = st.sampled_from([*SOLVERS, partial(dls, damping=0), partial(pseudoinverse, cutoff=0)])


@st.composite
def scenes(draw, limits=True):
    """A body, a pose with some joints standing at a limit, and targets near and far."""
    tree, effectors = draw(anybody(limits=limits))
    rng, shape = np.random.default_rng(draw(SEEDS)), draw(SHAPES)
    theta = poses(tree, rng, shape)
    where = rng.integers(0, 6, theta.shape)
    theta = np.where((where == 0) & np.isfinite(tree.lower), tree.lower, theta)
    theta = np.where((where == 1) & np.isfinite(tree.upper), tree.upper, theta)
    far = draw(st.sampled_from([0.0, 1e-3, 0.3, 3.0, 1e9]))
    s = locate(forward(tree, theta), effectors)
    return tree, theta, effectors, s + far * rng.normal(size=s.shape)


@given(scenes(), METHODS, st.sampled_from([hold, clip]))
def test_the_new_pose_is_finite_and_within_the_limits(scene, solver, limits):
    tree, theta, _, _ = scene
    done = step(*scene, solver, limits=limits)
    for part in done:
        assert np.isfinite(part).all()
    assert (tree.lower <= done.theta).all()
    assert (done.theta <= tree.upper).all()
    assert_allclose(done.dtheta, done.theta - theta, atol=1e-12)


@given(scenes(), METHODS)
def test_a_batch_equals_a_loop(scene, solver):
    tree, theta, effectors, targets = scene
    assume(solver != "sdls")  # not unique where singular values repeat
    options = {"max_step": 0.1, "max_error": 0.4}
    together = step(*scene, solver, **options)
    for i in np.ndindex(theta.shape[:-1]):
        alone = step(tree, theta[i], effectors, targets[i], solver, **options)
        assert_allclose(together.e[i], alone.e, atol=1e-12, rtol=1e-12)
        if solver in ("transpose", "dls"):  # the others amplify rounding at singular poses
            assert_allclose(together.theta[i], alone.theta, atol=1e-9)
            assert_array_equal(together.held[i], alone.held)


def test_pose_targets_and_mobility_may_each_be_the_batch():
    tree, effectors = HUMAN
    targets = locate(forward(tree, tree.rest), effectors) + 0.05
    many = step(tree, tree.rest, effectors, np.stack([targets, targets + 0.1, targets]), "dls")
    assert many.theta.shape == (3, 20)
    assert many.capped.shape == (3,)
    assert many.e.shape == (3, 12)
    assert_array_equal(many.theta[0], many.theta[2])
    some = np.ones((2, 1, 20))
    some[0, :, :5] = 0
    many = step(tree, tree.rest, effectors, np.stack([targets] * 3), "dls", mobility=some)
    assert many.theta.shape == (2, 3, 20)
    assert not many.dtheta[0, :, :5].any()
    many = step(tree, np.zeros((0, 20)), effectors, targets, "sdls", max_step=1)
    assert many.theta.shape == (0, 20)


@given(scenes(limits=False), METHODS)
def test_e_and_J_are_those_before_the_step(scene, solver):
    tree, theta, effectors, targets = scene
    frames = forward(tree, theta)
    done = step(*scene, solver, max_error=0.1, limits=ignore)
    s = locate(frames, effectors)
    assert_allclose(done.e, (targets - s).reshape(done.e.shape))
    assert_allclose(done.J, jacobian(tree, frames, effectors))
    done = step(*scene, solver, at_targets=True, limits=ignore)
    assert_allclose(done.J, jacobian(tree, frames, effectors, at=targets))
    assert not done.held.any()


@given(scenes(), METHODS)
def test_frames_that_are_known_already_change_nothing(scene, solver):
    tree, theta, *_ = scene
    done, again = (step(*scene, solver, frames=at) for at in (None, forward(tree, theta)))
    for one, other in zip(done, again, strict=True):
        assert_array_equal(one, other)


@given(scenes(), METHODS, SEEDS)
def test_a_locked_joint_never_moves(scene, solver, seed):
    tree, theta, _, _ = scene
    mobility = np.random.default_rng(seed).choice([0.0, 0.3, 1.0], len(tree))
    done = step(*scene, solver, mobility=mobility)
    assert_array_equal(done.theta[..., mobility == 0], theta[..., mobility == 0])


@given(scenes(), METHODS, st.floats(1e-3, 2))
def test_no_joint_turns_further_than_the_cap(scene, solver, max_step):
    for cap in (whole, per_chain):
        done = step(*scene, solver, max_step=max_step, cap=cap, limits=ignore)
        assert (abs(done.dtheta) <= max_step * (1 + 1e-9) + 1e-12).all()
        over = abs(done.wanted).max(axis=-1) > max_step
        assert_array_equal(done.capped, over)
    free = step(*scene, solver, limits=ignore)
    assert not free.capped.any()
    assert_array_equal(free.wanted, step(*scene, solver, limits=ignore, max_step=inf).wanted)


@given(scenes(limits=False))
def test_the_whole_step_keeps_its_direction(scene):
    done = step(*scene, "dls", max_step=0.01, limits=ignore)
    peak = abs(done.wanted).max(axis=-1, keepdims=True)
    shortened = done.wanted * np.minimum(1, 0.01 / np.maximum(peak, 1e-99))
    assert_allclose(done.dtheta, shortened, atol=1e-12)


def test_per_chain_leaves_other_chains_alone():
    """A hand that cannot reach its target slows both arms and the spine, and no foot."""
    tree, effectors = HUMAN
    theta = (tree.lower + tree.upper) / 2
    targets = locate(forward(tree, theta), effectors)
    targets[0] += 0.01
    targets[3] += 5
    free, one, all_ = (
        step(tree, theta, effectors, targets, "dls", cap=cap, max_step=m, limits=ignore)
        for cap, m in ((whole, None), (per_chain, 0.1), (whole, 0.1))
    )
    leg = effectors.chains == effectors.chains[tree.index("knee.l")]
    arm = effectors.chains == effectors.chains[tree.index("elbow.l")]
    assert_array_equal(one.dtheta[leg], free.dtheta[leg])
    assert_allclose(one.dtheta[arm], all_.dtheta[arm])
    assert abs(all_.dtheta[leg]).max() < 0.1 * abs(free.dtheta[leg]).max()


@given(scenes())
def test_what_clip_does(scene):
    tree, *_ = scene
    free, done = step(*scene, "dls", limits=ignore), step(*scene, "dls", limits=clip)
    assert_array_equal(done.theta, np.clip(free.theta, tree.lower, tree.upper))
    assert_array_equal(done.held, done.theta != free.theta)


@given(scenes())
def test_what_hold_does(scene):
    """Joints that stand at a limit and would cross it stay; without any, hold is clip."""
    _, theta, _, _ = scene
    clipped, done = step(*scene, "dls", limits=clip), step(*scene, "dls", limits=hold)
    crossing = clipped.held & (clipped.dtheta == 0)
    assert_array_equal(done.theta[crossing], theta[crossing])
    assert done.held[crossing].all()
    alone = ~crossing.any(axis=-1)
    assert_array_equal(done.theta[alone], clipped.theta[alone])


@given(scenes())
def test_hold_is_never_worse_than_clip_by_what_dls_makes_least(scene):
    """‖e − JΔθ‖² + λ²‖Δθ‖², where the joints that both stop are those that do not move at all."""
    clipped, done = step(*scene, "dls", limits=clip), step(*scene, "dls", limits=hold)
    same = ((clipped.held & (clipped.dtheta == 0)) == done.held).all(axis=-1)
    assume(same.any())

    def total(tick):
        miss = tick.e - np.matvec(tick.J, tick.dtheta)
        return np.vecdot(miss, miss) + 0.1**2 * np.vecdot(tick.dtheta, tick.dtheta)

    assert (total(done) <= total(clipped) * (1 + 1e-9) + 1e-12)[same].all()


def test_hold_lets_the_others_take_over():
    """An arm whose elbow is at its limit still reaches with the shoulder; clip stays away."""
    tree, effectors = HUMAN
    theta = tree.rest.copy()
    elbow = tree.index("elbow.l")
    targets = locate(forward(tree, theta), effectors)
    targets[3] += [0, -0.1, -0.1]  # behind the body: the elbow would have to bend back
    miss = []
    for limits in (hold, clip):
        pose = theta
        for _ in range(20):
            pose = step(tree, pose, effectors, targets, "pseudoinverse", limits=limits).theta
        miss.append(np.linalg.norm(targets - locate(forward(tree, pose), effectors), axis=-1)[3])
        assert pose[elbow] >= 0
    assert miss[0] < miss[1] + 1e-12


@given(scenes(limits=False), st.floats(0.01, 2))
def test_each_error_is_clamped_by_itself(scene, D):
    tree, theta, effectors, targets = scene
    e = targets - locate(forward(tree, theta), effectors)
    clamped = clamp_error(e, D)
    length = np.linalg.norm(clamped, axis=-1)
    assert (length <= D * (1 + 1e-12)).all()
    near = np.linalg.norm(e, axis=-1) <= D
    assert_array_equal(clamped[near], e[near])
    nearer = targets - e + clamped
    wanted = step(tree, theta, effectors, nearer, "dls", limits=ignore).dtheta
    done = step(tree, theta, effectors, targets, "dls", max_error=D, limits=ignore).dtheta
    assert_allclose(done, wanted, atol=1e-6 if abs(targets).max() > 1e3 else 1e-9)


def test_each_effector_may_have_a_clamp_of_its_own():
    e = np.array([[3.0, 0, 4], [0, 0, 0], [0, 1, 0]])
    wanted = [[0.6, 0, 0.8], [0, 0, 0], [0, 1, 0]]
    assert_allclose(clamp_error(e, np.array([1.0, 0, inf])), wanted)


def test_mobility_shares_out_the_step():
    """A joint that is less free turns less."""
    tree, effectors = figures.planar_arm([1.0, 1.0])
    theta = np.array([0.5, 1.0])
    targets = locate(forward(tree, theta), effectors) + [1e-3, 0, 0]
    even, wound = (
        step(tree, theta, effectors, targets, "pseudoinverse", mobility=s) for s in (None, [0.5, 1])
    )
    for done in (even, wound):
        assert_allclose(done.J @ done.dtheta, done.e, atol=1e-12)  # 2 joints, 2 ways: no choice
    damped = step(tree, theta, effectors, targets, "dls", mobility=[0.1, 1])
    assert abs(damped.dtheta[0]) < abs(step(tree, theta, effectors, targets, "dls").dtheta[0])


def test_the_trees_own_mobility_is_used():
    tree = Tree.of([Joint("a", mobility=0.0), Joint("b", "a", (1, 0, 0))])
    effectors = Effectors.of(tree, {"hand": ("b", (1, 0, 0))})
    done = step(tree, [0, 1], effectors, [[0, 1, 0]], "dls")
    assert done.dtheta[0] == 0 != done.dtheta[1]


@given(
    scenes(), METHODS, st.sampled_from([hold, clip, ignore]), st.sampled_from([whole, per_chain]),
    st.sampled_from([None, 0.0, 1e-3, 0.1, 2.0, inf]), st.sampled_from([0.1, 1.0, 10.0]), SEEDS,
)  # fmt: skip
def test_promises_in_order(scene, solver, limits, cap, max_step, far, seed):
    """A start beyond the limits on some joints, some joints locked, and a cap of every kind."""
    tree, theta, effectors, targets = scene
    rng = np.random.default_rng(seed)
    theta = theta + far * rng.normal(size=theta.shape) * rng.integers(0, 2, theta.shape)
    mobility = rng.choice([0.0, 0.5, 1.0], theta.shape)
    told = {"max_step": max_step, "cap": cap, "mobility": mobility, "limits": limits}
    done = step(tree, theta, effectors, targets, solver, **told)
    assert not fuzz.violations(tree, theta, done, **told)


def test_a_joint_comes_back_by_the_cap_and_the_others_make_up_for_it():
    """The hand stays where it is while the last of three joints is turned back."""
    tree = Tree.of([Joint("a"), Joint("b", "a", (1, 0, 0)), Joint("c", "b", (1, 0, 0), upper=1)])
    effectors = Effectors.of(tree, {"hand": ("c", (0.5, 0, 0))})
    theta = np.array([0.4, 0.5, 1.5])
    goal = locate(forward(tree, theta), effectors)
    far = {}
    for limits in (hold, clip):
        pose, far[limits] = theta, 0.0
        for tick in range(1, 25):
            done = step(tree, pose, effectors, goal, pseudoinverse, max_step=0.02, limits=limits)
            pose = done.theta
            assert_allclose(pose[2], 1.5 - 0.02 * tick)
            assert done.held[2]
            assert done.capped  # the way back was shortened
            gap = goal - locate(forward(tree, pose), effectors)
            far[limits] = max(far[limits], float(np.linalg.norm(gap)))
    assert far[hold] < 2e-3 < 5e-3 < far[clip]
    at_once = step(tree, theta, effectors, goal, pseudoinverse)
    assert at_once.theta[2] == 1
    assert not at_once.capped


def test_a_locked_joint_stays_beyond_its_limits():
    tree, effectors = HUMAN
    knee, theta = tree.index("knee.l"), tree.rest.copy()
    theta[knee] = -0.5
    for limits in (hold, clip, ignore):
        for max_step in (None, 0.01):
            done = step(
                tree, theta, effectors, GOALS + 0.1, "dls", max_step=max_step, limits=limits,
                mobility=np.arange(20) != knee,
            )  # fmt: skip
            assert done.dtheta[knee] == 0
            assert abs(done.dtheta).max() > 1e-3


def test_a_pose_outside_the_limits_comes_back():
    tree, effectors = HUMAN
    targets = locate(forward(tree, tree.rest), effectors)
    done = step(tree, tree.upper + 1, effectors, targets, "dls")
    assert (done.theta <= tree.upper).all()


def good():
    tree, effectors = HUMAN
    targets = locate(forward(tree, tree.rest), effectors)
    return {"theta": tree.rest.copy(), "targets": targets, "solver": "dls"}


def spoilt(array, index, value):
    array = array.copy()
    array[index] = value
    return array


REST, GOALS = good()["theta"], good()["targets"]


@pytest.mark.parametrize(
    ("wrong", "error", "match"),
    [
        ({"targets": GOALS[:3]}, ValueError,
         r"4 effectors need targets of shape \(\.\.\., 4, 3\), not \(3, 3\)"),
        ({"targets": GOALS.ravel()}, ValueError, r"targets of shape .* not \(12,\)"),
        ({"targets": GOALS[:, :2]}, ValueError, r"targets of shape .* not \(4, 2\)"),
        ({"targets": None}, ValueError, "targets must be made of numbers, not None"),
        ({"targets": 1.0}, ValueError, r"targets of shape .* not \(\)"),
        ({"targets": np.eye(4)}, ValueError,
         r"4 effectors need .*, not \(4, 4\); a target is a point, and no pose"),
        ({"targets": "there"}, ValueError, "targets must be made of numbers, not 'there'"),
        ({"targets": [[1, 2, 3], [1, 2]]}, ValueError, "targets must be made of numbers"),
        ({"targets": spoilt(GOALS, (2, 1), nan)}, ValueError, "target of 'hand.r' is not finite"),
        ({"targets": spoilt(GOALS, (0, 0), inf)}, ValueError, "target of 'foot.l' is not finite"),
        ({"targets": spoilt(np.stack([GOALS] * 3), (2, 3, 2), -inf)}, ValueError,
         "target of 'hand.l' is not finite"),
        ({"theta": REST[:5]}, ValueError,
         r"20 joints need theta of shape \(\.\.\., 20\), not \(5,"),
        ({"theta": 0.0}, ValueError, r"20 joints need theta of shape"),
        ({"theta": "up"}, ValueError, "theta must be made of numbers, not 'up'"),
        ({"theta": spoilt(REST, 13, nan)}, ValueError, "angle of 'knee.l' is not finite"),
        ({"theta": spoilt(np.stack([REST] * 2), (1, 0), inf)}, ValueError,
         "angle of 'spine.bend' is not finite"),
        ({"solver": "dsl"}, LookupError, "no method 'dsl'; did you mean 'dls'"),
        ({"solver": None}, TypeError, r"a solver is a function of \(J, e\) or a name, not None"),
        ({"solver": partial(dls, damping=-1)}, ValueError, "damping must be 0 or more"),
        ({"solver": partial(dls, damping=nan)}, ValueError, "damping must be 0 or more"),
        ({"solver": lambda J, e: J[0] * nan}, FloatingPointError, "<lambda> gave a step that is"),
        ({"mobility": 0.5}, ValueError, r"mobility needs one number per joint, \(20,\), not \(\)"),
        ({"mobility": np.ones(19)}, ValueError, r"mobility needs one number per joint"),
        ({"mobility": spoilt(np.ones(20), 3, 1.1)}, ValueError, "mobility of 'shoulder.out.l'"),
        ({"mobility": spoilt(np.ones(20), 18, -0.1)}, ValueError, "mobility of 'knee.r'"),
        ({"mobility": spoilt(np.ones(20), 0, nan)}, ValueError, "mobility of 'spine.bend'"),
        ({"mobility": "none"}, ValueError, "mobility must be made of numbers"),
        ({"max_step": -0.1}, ValueError, "max_step must be 0 or more, not -0.1"),
        ({"max_step": [0.1, nan]}, ValueError, r"max_step must be 0 or more, not \[0.1, nan\]"),
        ({"theta": np.stack([REST] * 2), "max_step": [0.1] * 3}, ValueError,
         r"batches of theta, targets, .* do not fit together: \(2,\) and .*\(3,\)"),
        ({"theta": np.stack([REST] * 2), "mobility": np.ones((3, 20))}, ValueError, "fit together"),
        ({"theta": np.stack([REST] * 2), "targets": np.stack([GOALS] * 3)}, ValueError,
         "do not fit together"),
        ({"theta": np.stack([REST] * 2), "max_error": np.ones((3, 4))}, ValueError, "together"),
        ({"max_error": "far"}, ValueError, "max_error must be made of numbers, not 'far'"),
        ({"mobility": ["1"] * 20}, ValueError, "mobility must be made of numbers"),
        ({"theta": REST.astype(str)}, ValueError, "theta must be made of numbers"),
        ({"theta": REST * 1j}, ValueError, "theta must be made of numbers"),
        ({"frames": 3}, TypeError, r"frames of forward\(tree, theta\) are needed here, not 3"),
        ({"tree": HUMAN}, TypeError, "a Tree is needed here, not Figure"),
        ({"effectors": HUMAN}, TypeError, "Effectors are needed here, not Figure"),
        ({"effectors": figures.simulator().effectors}, ValueError,
         "these effectors are of a body of 17 joints, not of 20"),
        ({"max_step": nan}, ValueError, "max_step must be 0 or more, not nan"),
        ({"max_step": "5°"}, ValueError, "max_step must be made of numbers, not '5°'"),
        ({"max_error": -1}, ValueError, "max_error must be 0 or more, not -1"),
        ({"max_error": [1, 1, nan, 1]}, ValueError, "max_error must be 0 or more"),
        ({"max_error": [1, 1]}, ValueError,
         r"max_error needs one number, or \(\.\.\., 4\), not \(2,\)"),
        ({"limits": "hold"}, TypeError, "limits must be a function, not 'hold'"),
        ({"cap": "whole", "max_step": 1}, TypeError, "cap must be a function, not 'whole'"),
        ({"frames": forward(HUMAN[0], np.stack([REST] * 2))}, ValueError,
         r"frames are of poses \(2, 20\), not \(20,\)"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_named(wrong, error, match):
    given_ = dict(zip(("tree", "effectors"), HUMAN, strict=True)) | good() | wrong
    with pytest.raises(error, match=match) as told:
        step(**given_)
    assert len(str(told.value)) < 300


def test_a_solver_that_fails_at_a_limit_is_named_too():
    tree, effectors = HUMAN

    def fails_later(J, e):
        return np.where((J == 0).all(axis=0).any(), nan, np.full(20, -0.1))

    with pytest.raises(FloatingPointError, match="fails_later"):
        step(tree, tree.lower, effectors, GOALS, fails_later)


def test_nothing_that_is_given_is_changed():
    tree, effectors = HUMAN
    theta, targets, mobility = REST.copy(), GOALS + 1, np.ones(20)
    for array in (theta, targets, mobility):
        array.setflags(write=False)
    step(tree, theta, effectors, targets, "sdls", mobility=mobility, max_step=0.1, max_error=0.1)


def test_busss_caps():
    assert dict(BUSS_CAPS) == {
        "transpose": np.radians(30), "pseudoinverse": np.radians(5), "dls": np.radians(45),
        "sdls": None,
    }  # fmt: skip


@given(bodies(), SEEDS)
def test_a_step_towards_a_near_target_comes_nearer(figure, seed):
    tree, effectors = figure
    rng = np.random.default_rng(seed)
    theta = poses(tree, rng)
    s = locate(forward(tree, theta), effectors)
    targets = locate(forward(tree, theta + 1e-4 * rng.normal(size=len(tree))), effectors)
    before = np.linalg.norm(targets - s)
    for solver in SOLVERS:
        to = step(tree, theta, effectors, targets, solver).theta
        after = np.linalg.norm(targets - locate(forward(tree, to), effectors))
        assert after <= before + 1e-7
