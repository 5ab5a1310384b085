"""A figure that follows targets through time."""

from dataclasses import FrozenInstanceError

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal
from strategies import SEEDS, bodies, poses

from ikteach import SOLVERS, figures, forward, gait, jacobian, locate, sdls, step, track
from ikteach.motion import clip, growing_clamp, hold

TREE, EFFECTORS = figures.human()
WALK = gait.walking(gait.walking.clock(12))


def test_every_frame_is_a_step_from_the_last():
    run = track(TREE, EFFECTORS, WALK, "dls", max_step=0.05, iterations=2)
    pose = TREE.rest
    for frame, targets in enumerate(WALK):
        capped = 0
        for _ in range(2):
            done = step(TREE, pose, EFFECTORS, targets, "dls", max_step=0.05)
            pose, capped = done.theta, capped + done.capped / 2
        assert_array_equal(run.theta[frame], pose)
        assert_array_equal(run.held[frame], done.held)
        assert run.capped[frame] == capped
        s = locate(forward(TREE, pose), EFFECTORS)
        assert_allclose(run.error[frame], np.linalg.norm(targets - s, axis=-1))
        assert_allclose(run.positions[frame], s)
        J = jacobian(TREE, forward(TREE, pose), EFFECTORS)
        assert_allclose(run.smallest_sigma[frame], np.linalg.svdvals(J)[-1])
    assert len(run) == 12
    assert run.method == "dls"
    assert run.seconds > 0
    assert_array_equal(run.start, TREE.rest)


def test_jitter_is_the_second_difference_from_standing_still():
    run = track(TREE, EFFECTORS, WALK, "dls")
    poses = np.vstack([TREE.rest, TREE.rest, run.theta])
    wanted = [poses[i + 2] - 2 * poses[i + 1] + poses[i] for i in range(12)]
    assert_allclose(run.jitter, np.linalg.norm(wanted, axis=-1))


def test_the_clock():
    assert_allclose(track(TREE, EFFECTORS, WALK[:3], "dls", dt=0.5).times, [0.5, 1, 1.5])
    times = [3.0, 4.0, 7.0]
    assert_array_equal(track(TREE, EFFECTORS, WALK[:3], "dls", times=times).times, times)


@pytest.mark.parametrize("method", SOLVERS)
def test_equal_inputs_give_equal_runs(method):
    first, second = (track(TREE, EFFECTORS, WALK, method) for _ in range(2))
    for name in ("theta", "error", "capped", "held", "jitter"):
        assert_array_equal(getattr(first, name), getattr(second, name))


@pytest.mark.parametrize("method", SOLVERS)
def test_a_batch_of_runs_is_many_runs(method):
    targets = np.stack([WALK, WALK + 0.01], axis=1)
    theta = np.stack([TREE.rest + 0.1, TREE.rest + 0.2]).clip(TREE.lower, TREE.upper)
    both = track(TREE, EFFECTORS, targets, method, theta=theta)
    assert both.theta.shape == (12, 2, 20)
    assert both.error.shape == (12, 2, 4)
    assert both.capped.shape == (12, 2)
    assert both.jitter.shape == both.smallest_sigma.shape == (12, 2)
    for i in range(2):
        alone = track(TREE, EFFECTORS, targets[:, i], method, theta=theta[i])
        assert_allclose(both.theta[:, i], alone.theta, atol=1e-6)


def test_one_start_for_many_targets():
    run = track(TREE, EFFECTORS, np.stack([WALK, WALK], axis=1), "dls")
    assert run.start.shape == (2, 20)
    assert run.jitter.shape == (12, 2)


@settings(max_examples=25)
@given(bodies(limits=True), SEEDS, st.sampled_from(list(SOLVERS)), st.sampled_from([hold, clip]))
def test_limits_hold_and_nothing_is_nan_however_far_the_targets(figure, seed, method, limits):
    tree, effectors = figure
    rng = np.random.default_rng(seed)
    far = 10.0 ** rng.integers(-3, 10)
    targets = far * rng.normal(size=(15, len(effectors), 3))
    run = track(tree, effectors, targets, method, theta=poses(tree, rng), limits=limits)
    assert np.isfinite(run.theta).all()
    assert np.isfinite(run.error).all()
    assert (tree.lower <= run.theta).all()
    assert (run.theta <= tree.upper).all()


def test_a_still_target_is_reached():
    theta = (TREE.lower + TREE.upper) / 2
    targets = np.repeat(locate(forward(TREE, theta), EFFECTORS)[None], 300, axis=0)
    for method in SOLVERS:
        run = track(TREE, EFFECTORS, targets, method, theta=theta + 0.05, max_step=0.3)
        assert run.error[-1].max() < 1e-3, method


def test_the_growing_clamp():
    e = np.array([3.0, 4, 0, 1, 0, 0])
    assert_allclose(growing_clamp(e, np.array([5.5, 0.2])), [0.9, 0.4])
    assert_allclose(growing_clamp(e, np.array([5.5, 0.2]), base=1), [1.5, 1])
    seen = []

    def rule(e, error):
        seen.append((e, error))
        return growing_clamp(e, error)

    run = track(TREE, EFFECTORS, WALK[:2], sdls, clamp_rule=rule)
    first = step(TREE, TREE.rest, EFFECTORS, WALK[0], sdls)
    assert_array_equal(run.theta[0], first.theta)  # no clamp before the first step
    second = step(TREE, first.theta, EFFECTORS, WALK[1], sdls, max_error=growing_clamp(*seen[0]))
    assert_array_equal(run.theta[1], second.theta)


@pytest.mark.parametrize(
    ("wrong", "error", "match"),
    [
        ({"targets": WALK[0]}, ValueError, r"targets over time .* not \(4, 3\)"),
        ({"targets": WALK[:, :2]}, ValueError, r"4 effectors need targets of shape"),
        ({"targets": WALK[:0]}, ValueError, "no frames"),
        ({"targets": "there"}, ValueError, "targets must be made of numbers"),
        ({"targets": WALK * np.nan}, ValueError, "target of 'foot.l' is not finite"),
        ({"theta": np.full(20, np.nan)}, ValueError, "angle of 'spine.bend' is not finite"),
        ({"theta": np.zeros(3)}, ValueError, "20 joints need theta"),
        ({"iterations": 0}, ValueError, "iterations must be 1 or more, and whole, not 0"),
        ({"iterations": 1.5}, ValueError, "iterations must be 1 or more, and whole, not 1.5"),
        ({"iterations": np.nan}, ValueError, "iterations must be 1 or more, and whole, not nan"),
        ({"iterations": np.inf}, ValueError, "iterations must be 1 or more, and whole, not inf"),
        ({"iterations": "two"}, ValueError, "iterations must be 1 or more, and whole, not 'two'"),
        ({"iterations": None}, ValueError, "iterations must be 1 or more, and whole, not None"),
        ({"iterations": True}, ValueError, "iterations must be 1 or more, and whole, not True"),
        ({"dt": 0.1, "times": range(12)}, ValueError, "dt or times, not both"),
        ({"dt": np.nan}, ValueError, "dt must be 0 or more, and finite, not nan"),
        ({"dt": "slow"}, ValueError, "dt must be 0 or more, and finite, not 'slow'"),
        ({"dt": 0}, ValueError, "dt must be more than 0"),
        ({"times": "now"}, ValueError, "times must be made of numbers, not 'now'"),
        ({"times": [1] * 12}, ValueError, "times must be finite and ascend"),
        ({"times": [*range(11), np.nan]}, ValueError, "times must be finite and ascend"),
        ({"times": [1, 2]}, ValueError, r"12 frames need 12 times, not \(2,\)"),
        ({"solver": "sdsl"}, LookupError, "no method 'sdsl'"),
        ({"max_step": -1}, ValueError, "max_step must be 0 or more"),
        ({"speed": 3}, TypeError, "no option 'speed'; there are"),
        ({"max_stp": 3}, TypeError, "no option 'max_stp'; did you mean 'max_step'"),
        ({"iteration": 3}, TypeError, "no option 'iteration'; did you mean 'iterations'"),
        ({"frames": None}, TypeError, "no option 'frames'"),
        ({"clamp_rule": 0.4}, TypeError, "clamp_rule must be a function, not 0.4"),
        (
            {"theta": np.zeros((2, 20)), "targets": np.stack([WALK] * 3, 1)},
            ValueError,
            r"batches of theta and targets do not fit together: \(2,\) and \(3,\)",
        ),
    ],
)
def test_what_is_wrong_is_named(wrong, error, match):
    with pytest.raises(error, match=match):
        track(TREE, EFFECTORS, **({"targets": WALK, "solver": "dls"} | wrong))


def test_a_track_is_frozen():
    run = track(TREE, EFFECTORS, WALK[:2], "dls")
    with pytest.raises(FrozenInstanceError):
        run.theta = 0
