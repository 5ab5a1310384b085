"""One call to a pose: it arrives, or says why not; a batch is its members."""

from functools import partial

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from metamorphic import BODY, Case
from numpy.testing import assert_array_equal
from strategies import SEEDS, anybody, poses

from ikteach import (
    SOLVERS,
    Effectors,
    Joint,
    Tree,
    dls,
    dls_following,
    figures,
    forward,
    locate,
    solve,
)
from ikteach.motion import clip, ignore
from ikteach.motion.ccd import ccd
from ikteach.motion.solve import POOL, _elsewhere
from ikteach.solvers.bvls import bvls

HUMAN = figures.human()
EVERY = [*SOLVERS.values(), dls_following, bvls, ccd]


def problems(figure, count, near, seed=0):
    """Starts (count, n), and targets that a pose `near` [rad] them meets."""
    tree, effectors = figure
    rng = np.random.default_rng(seed)
    middle, half = (tree.lower + tree.upper) / 2, (tree.upper - tree.lower) / 2
    starts = middle + rng.uniform(-0.7, 0.7, (count, len(tree))) * half
    goals = np.clip(starts + rng.uniform(-near, near, starts.shape), tree.lower, tree.upper)
    return starts, locate(forward(tree, goals), effectors)


def test_near_targets_are_all_met_and_far_ones_with_restarts():
    starts, targets = problems(HUMAN, 300, 0.1)
    near = solve(*HUMAN, targets, theta=starts, tolerance=1.8e-3)
    assert near.converged.all()
    starts, targets = problems(HUMAN, 300, 0.5)
    far = solve(*HUMAN, targets, theta=starts, tolerance=1.8e-3, restarts=5)
    assert far.converged.mean() >= 0.98


@pytest.mark.parametrize("solver", EVERY, ids=lambda solver: solver.__name__)
@given(figure=anybody(limits=True), seed=SEEDS)
def test_what_it_says_is_so(solver, figure, seed):
    tree, effectors = figure
    rng = np.random.default_rng(seed)
    targets = locate(forward(tree, poses(tree, rng, (4,))), effectors)
    targets[0] += rng.normal(size=3) * 10  # out of reach, most likely
    found = solve(tree, effectors, targets, solver, theta=poses(tree, rng, (4,)), most=20)
    off = np.linalg.norm(targets - locate(forward(tree, found.theta), effectors), axis=-1)
    assert np.isfinite(found.theta).all()
    assert ((found.theta >= tree.lower) & (found.theta <= tree.upper)).all()
    assert found.error == pytest.approx(off, abs=1e-9)
    assert_array_equal(found.converged, (found.error <= 1e-4).all(axis=-1))
    assert (found.iterations <= 20).all()


@pytest.mark.parametrize("solver", ["dls", "sdls", dls_following, ccd, bvls])
def test_a_batch_is_its_members_to_the_last_bit(solver):
    starts, targets = problems(HUMAN, POOL + 30, 0.5)
    targets[1::2] += 0.4  # out of reach: these end at different times, and late ones join
    options = {"tolerance": 1.8e-3, "most": 40, "restarts": 1}
    every = solve(*HUMAN, targets, solver, theta=starts, **options)
    for i in [0, 1, 7, POOL - 1, POOL, POOL + 1, POOL + 29]:
        one = solve(*HUMAN, targets[i], solver, theta=starts[i], **options)
        for alone, among in zip(one, every, strict=True):
            assert_array_equal(alone, among[i])


def test_a_solver_of_one_pose_is_asked_about_one_pose():
    """As a student writes it, and as `step` asks it."""

    def plain(J, e):
        return J.T @ np.linalg.solve(J @ J.T + 0.01 * np.eye(len(e)), e)

    starts, targets = problems(HUMAN, 1, 0.1)
    assert solve(*HUMAN, targets[0], plain, theta=starts[0]).converged
    like = solve(*HUMAN, targets[0], "dls", theta=starts[0])
    assert solve(*HUMAN, targets[0], plain, theta=starts[0]).theta == pytest.approx(like.theta)


def test_what_has_arrived_is_what_is_given():
    """Though another pose was nearer in the sum of squares."""
    tree = Tree.of([Joint(name, axis=(1, 0, 0), slide=True) for name in "ab"])
    ends = Effectors.of(tree, {"a": ("a", (0, 0, 0)), "b": ("b", (0, 0, 0))})
    found = solve(tree, ends, [[1.1, 0, 0], [0, 0, 0]], lambda J, e: [0.2, 0.9], tolerance=1.0)
    assert found.converged
    assert found.theta == pytest.approx([0.2, 0.9])
    assert found.error.max() <= 1


def test_shapes_of_batches_go_together():
    starts, targets = problems(HUMAN, 6, 0.1)
    one_start = solve(*HUMAN, targets.reshape(2, 3, 4, 3), theta=starts[0])
    assert one_start.theta.shape == (2, 3, 20)
    assert one_start.error.shape == (2, 3, 4)
    assert one_start.converged.shape == one_start.iterations.shape == (2, 3)
    one_goal = solve(*HUMAN, targets[0], theta=starts)
    assert one_goal.theta.shape == (6, 20)
    single = solve(*HUMAN, targets[0])
    assert single.theta.shape == (20,)
    assert isinstance(single.reason, str)
    none = solve(*HUMAN, np.zeros((0, 4, 3)))
    assert none.theta.shape == (0, 20)


ARM = figures.planar_arm(2)
HINGE = Tree.of([Joint("a", lower=0, upper=1)])
LOCKED = Tree.of([Joint("a", mobility=0), Joint("b", "a", (1, 0, 0), mobility=0)])


def _hand(tree):
    return Effectors.of(tree, {"hand": (tree.names[-1], (1, 0, 0))})


@pytest.mark.parametrize(
    ("tree", "effectors", "theta", "target", "options", "reason"),
    [
        (*ARM, [0.3, 0.4], [1, 1, 0], {}, "arrived"),
        (*ARM, [0, 0], [5, 0, 0], {}, "stands still"),
        (*ARM, [0.1, 0], [5, 0, 0], {"most": 40}, "stands still"),
        (*ARM, [0, 0], [1, 0, 0], {}, "stands still"),  # singular: stretched, the target inward
        (*ARM, [0, 0], [5, 0, 0], {"most": 3}, "stands still"),
        (*ARM, [0, 0], [1, 0, 0], {"weights": [0]}, "stands still"),
        (LOCKED, _hand(LOCKED), [0, 0], [0, 2, 0], {"restarts": 2}, "stands still"),
        (HINGE, _hand(HINGE), [0], [0, 1, 0], {}, "at limits"),
        (HINGE, _hand(HINGE), [1], [0, 1, 0], {"most": 0}, "at limits"),
        (HINGE, _hand(HINGE), [1], [0, 1, 0], {"limits": clip}, "at limits"),
        (HINGE, _hand(HINGE), [0], [0, 1, 0], {"limits": ignore}, "arrived"),
        (*ARM, [0.3, 0.4], [1, 1, 0], {"solver": partial(dls, damping=9), "most": 3}, "out of"),
        (*ARM, [0.3, 0.4], [1, 1, 0], {"solver": lambda J, e: 0 * J[0]}, "out of patience"),
        (*ARM, [0.3, 0.4], [1, 1, 0], {"most": 0}, "out of patience"),
    ],
)
def test_reasons_in_words(tree, effectors, theta, target, options, reason):
    found = solve(tree, effectors, [target], theta=theta, **options)
    assert found.reason.startswith(reason)
    assert found.converged == (reason == "arrived")


def test_what_is_there_already_takes_no_step():
    there = locate(forward(HUMAN.tree, HUMAN.tree.rest), HUMAN.effectors)
    found = solve(*HUMAN, there)
    assert found.iterations == 0
    assert found.converged
    assert_array_equal(found.theta, HUMAN.tree.rest)


def test_a_start_outside_its_limits_is_brought_within():
    theta = HUMAN.tree.rest + 9
    found = solve(*HUMAN, np.ones((4, 3)), theta=theta, most=5)
    assert ((found.theta >= HUMAN.tree.lower) & (found.theta <= HUMAN.tree.upper)).all()
    stays = solve(*HUMAN, np.ones((4, 3)), theta=theta, limits=ignore, most=0)
    assert_array_equal(stays.theta, theta)


def test_locked_joints_stay_and_steps_are_capped():
    tree = Tree.of([Joint("a", mobility=0), Joint("b", "a", (1, 0, 0))])
    end = Effectors.of(tree, {"end": ("b", (1, 0, 0))})
    found = solve(tree, end, [[1.0, 1.0, 0.0]], theta=[0.0, 0.3])
    assert found.theta[0] == 0
    assert found.converged
    out = solve(tree, end, [[0.0, 5.0, 0.0]], theta=[0.3, 0.3], restarts=4)
    assert out.theta[0] == 0.3
    slow = solve(tree, end, [[1.0, 1.0, 0.0]], theta=[0.0, 0.3], max_step=0.1, most=4)
    assert slow.theta[1] == pytest.approx(0.7)


def test_other_rules_at_limits():
    starts, targets = problems(HUMAN, 50, 0.5)
    for rule in (clip, ignore):
        found = solve(*HUMAN, targets, theta=starts, limits=rule, tolerance=1.8e-3)
        assert found.converged.mean() > 0.9


def test_weights_say_which_target_matters_more():
    targets = locate(forward(HUMAN.tree, HUMAN.tree.rest), HUMAN.effectors)
    targets[2] += [-0.5, 0.5, 0.5]  # farther than the arm is long
    even = solve(*HUMAN, targets)
    feet = solve(*HUMAN, targets, weights=[10, 10, 1, 1])
    assert feet.error[:2].max() <= even.error[:2].max() + 1e-12


@given(anybody(limits=True, slides=False), SEEDS, st.sampled_from([*BODY]))
def test_it_moves_along_with_the_body(figure, seed, change):
    rng = np.random.default_rng(seed)
    targets = locate(forward(figure.tree, poses(figure.tree, rng)), figure.effectors)
    one, two, along = BODY[change](Case(*figure, poses(figure.tree, rng), targets), rng)
    size = 1e-3 * along.length
    first = solve(one.tree, one.effectors, one.targets, theta=one.theta, tolerance=1e-3, most=8)
    second = solve(two.tree, two.effectors, two.targets, theta=two.theta, tolerance=size, most=8)
    assert first.iterations == second.iterations
    assert along.pose(first.theta) == pytest.approx(second.theta, abs=1e-6)


@pytest.mark.parametrize(
    ("options", "error", "words"),
    [
        ({"targets": np.zeros((3, 3))}, ValueError, "4 effectors need targets"),
        ({"targets": np.full((4, 3), np.nan)}, ValueError, "is not finite"),
        ({"theta": np.zeros(3)}, ValueError, "20 joints need theta"),
        ({"tree": HUMAN.effectors}, TypeError, "a Tree is needed here"),
        ({"effectors": HUMAN.tree}, TypeError, "Effectors are needed here"),
        ({"effectors": figures.planar_arm(4).effectors}, ValueError, "of a body of 4 joints"),
        ({"theta": np.zeros((2, 20)), "targets": np.ones((3, 4, 3))}, ValueError, "do not fit"),
        ({"solver": "dsl"}, LookupError, "did you mean 'dls'"),
        ({"tolerance": -1}, ValueError, "tolerance must be"),
        ({"tolerance": "x"}, ValueError, "tolerance must be"),
        ({"most": 2.5}, ValueError, "most must be"),
        ({"restarts": -1}, ValueError, "restarts must be"),
        ({"max_step": np.nan}, ValueError, "max_step must be"),
        ({"limits": "hold"}, TypeError, "limits must be a function"),
        ({"weights": [1, 2]}, ValueError, "weights"),
        ({"weights": [1, 1, 1, -1]}, ValueError, "weights"),
        ({"seed": "x"}, ValueError, "seed must be"),
        ({"solver": lambda J, e: None}, ValueError, "gave back nothing"),
    ],
)
def test_bad_input_is_named(options, error, words):
    arguments = {**HUMAN._asdict(), "targets": np.ones((4, 3))} | options
    with pytest.raises(error, match=words):
        solve(**arguments)


@pytest.mark.parametrize("unit", [1e-3, 1.0, 1e3])
def test_restarts_draw_slides_as_far_as_the_body_is_large(unit):
    slide = Tree.of([Joint("s", axis=(1, 0, 0), slide=True), Joint("a", "s", (unit, 0, 0))])
    end = Effectors.of(slide, {"end": ("a", (unit, 0, 0))})
    starts, goals = np.zeros((40, 2)), np.zeros((40, 1, 3))
    drawn = _elsewhere(slide, end, starts, goals, np.random.default_rng(0))
    assert 0.1 * unit < abs(drawn[:, 0]).max() <= 8 * unit
