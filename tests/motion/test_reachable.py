"""What can be reached, where the answer is known."""

from dataclasses import replace
from math import inf, pi

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from metamorphic import BODY, NUMBERS, OTHER, SAME, Case, points, rows
from numpy.testing import assert_allclose, assert_array_equal
from strategies import KNOWN, SEEDS, SHAPES, anybody, bodies, poses

from ikteach import Effectors, Joint, Tree, figures, forward, locate, reachable
from ikteach.motion.reachable import annulus, nearest

# Limits of a joint, drawn by rng: half the width of a range, and where its middle is.
LIMITS = {
    "narrow": lambda rng: (rng.uniform(0.05, 0.6), rng.uniform(-3, 3)),
    "wide": lambda rng: (rng.uniform(1, 5), rng.uniform(-3, 3)),
    "a whole turn": lambda rng: (pi, rng.uniform(-3, 3)),
    "some turns away": lambda rng: (rng.uniform(0.3, 2), rng.uniform(-20, 20)),
    "one alone": lambda rng: (inf, rng.uniform(-3, 3)),
    "none": lambda rng: (inf, 0),
}


def limited(figure, kind, rng):
    """The figure with other limits, and rest anywhere within them."""
    joints = []
    for row in rows(figure.tree):
        half, middle = LIMITS[kind](rng)
        low, high = middle - half, middle + half
        if kind == "one alone":
            low, high = (middle, inf) if rng.random() < 0.5 else (-inf, middle)
        rest = rng.uniform(low, high) if np.isfinite([low, high]).all() else None
        joints.append(replace(row, lower=low, upper=high, rest=rest))
    tree = Tree.of(joints)
    return figures.Figure(tree, Effectors.of(tree, points(*figure)))


def anywhere(tree, rng, count):
    """Poses (count, n) within the limits; where one is missing, within two turns of the other."""
    lower = np.where(
        np.isfinite(tree.lower),
        tree.lower,
        np.where(np.isfinite(tree.upper), tree.upper - 4 * pi, tree.rest - 2 * pi),
    )
    upper = np.where(np.isfinite(tree.upper), tree.upper, lower + 4 * pi)
    return rng.uniform(lower, upper, (count, len(tree)))


def random_body(rng, n, slides=0.25):
    """A tree of n joints, most of them in one chain, with up to four effectors."""
    joints = []
    for j in range(n):
        parent = j - 1 if rng.random() < 0.85 else int(rng.integers(-1, j))
        joints.append(
            Joint(
                f"j{j}",
                f"j{parent}" if parent >= 0 else None,
                rng.choice([0.0, 1.0], p=[0.2, 0.8]) * rng.normal(size=3),
                rng.normal(size=3) if rng.random() < 0.6 else np.eye(3)[rng.integers(3)],
                bool(rng.random() < slides),
            )
        )
    tree = Tree.of(joints)
    ends = {f"e{i}": (f"j{rng.integers(n)}", rng.normal(size=3)) for i in range(1 + n % 4)}
    return figures.Figure(tree, Effectors.of(tree, ends))


@pytest.mark.parametrize("flat", [False, True])
@pytest.mark.parametrize("kind", LIMITS)
def test_of_own_points_a_thousandth_is_missed_at_most(kind, flat):
    """Of bodies of 1 to 12 joints: where their own random poses are can be reached."""
    found = []
    for n in range(1, 13):
        rng = np.random.default_rng([n, flat])
        figure = random_body(rng, n)
        if flat:
            figure = OTHER["in a plane"](Case(*figure, 0, 0), rng)[:2]
            figure = figures.Figure(*figure)
        tree, effectors = limited(figure, kind, rng)
        own = locate(forward(tree, anywhere(tree, rng, 60)), effectors)
        found.append(reachable(tree, effectors, own).ravel())
    found = np.concatenate(found)
    assert found.size > 1000
    assert found.mean() >= 0.999


def test_poses_that_stand_at_their_limits_are_found():
    found = []
    for n in range(1, 13):
        rng = np.random.default_rng(n)
        tree, effectors = limited(random_body(rng, n), "some turns away", rng)
        corners = np.where(rng.random((40, n)) < 0.5, tree.lower, tree.upper)
        found.append(reachable(tree, effectors, locate(forward(tree, corners), effectors)).ravel())
    assert np.concatenate(found).mean() >= 0.998


def case_of(figure, seed, shape=()):
    """Targets that the body meets, and as many that are drawn anywhere around it."""
    rng = np.random.default_rng(seed)
    tree, effectors = figure
    theta = poses(tree, rng, shape)
    own = locate(forward(tree, theta), effectors)
    away = rng.choice([0.0, 1.0], own.shape[:-1])[..., None] * rng.normal(size=own.shape)
    return Case(tree, effectors, theta, own + away), rng


@settings(max_examples=60)
@given(
    anybody(limits=True), SEEDS, SHAPES,
    st.sampled_from(list(SAME)), st.sampled_from(["as it is", *OTHER]),
)  # fmt: skip
def test_a_body_told_otherwise_reaches_the_same(figure, seed, shape, change, other):
    case, rng = case_of(figure, seed, shape)
    if other in OTHER:
        case = OTHER[other](case, rng)
    one, two, along = SAME[change](case, rng)
    before, after = (nearest(*c[:2], c.targets) for c in (one, two))
    size = 1 + np.linalg.norm(case.tree.offsets, axis=1).sum()
    assert after.shape == before[..., along.effectors].shape
    assert_allclose(after / along.length, before[..., along.effectors], atol=1e-5 * size)
    clear = abs(before - 1e-3 * size) > 1e-2 * size
    can, could = (
        reachable(*c[:2], c.targets, within=w)
        for c, w in ((one, 1e-2 * size), (two, 1e-2 * size * along.length))
    )
    assert_array_equal(
        could[clear[..., along.effectors]], can[..., along.effectors][clear[..., along.effectors]]
    )


@settings(max_examples=30)
@given(KNOWN, SEEDS, st.sampled_from(list(BODY | NUMBERS)))
def test_what_is_near_enough_goes_with_the_body(figure, seed, change):
    """The default is a thousandth of the chain's length: no unit decides."""
    rng = np.random.default_rng(seed)
    tree, effectors = figure
    outer = np.array([annulus(tree, effectors, i)[2] for i in range(len(effectors))])
    base = np.array([annulus(tree, effectors, i)[0] for i in range(len(effectors))])
    away = rng.normal(size=(len(effectors), 3))
    away /= np.linalg.norm(away, axis=1, keepdims=True)
    beyond = base + 1.01 * outer[:, None] * away
    own = locate(forward(tree, poses(tree, rng)), effectors)
    for targets, wanted in ((beyond, False), (own, True)):
        _, two, _ = (BODY | NUMBERS)[change](Case(tree, effectors, tree.rest, targets), rng)
        if change != "integers":
            assert_array_equal(reachable(*two[:2], two.targets), wanted)


@given(anybody(limits=True), SEEDS, st.sampled_from(list(BODY)), st.sampled_from(["", *OTHER]))
def test_the_annulus_moves_along_and_holds_every_pose(figure, seed, change, other):
    case, rng = case_of(figure, seed)
    if other:
        case = OTHER[other](case, rng)
    one, two, along = BODY[change](case, rng)
    assume(not (two.tree.slide & np.isinf(two.tree.lower)).any())
    theta = anywhere(two.tree, rng, 50)
    s = locate(forward(two.tree, theta), two.effectors)
    for i, was in enumerate(along.effectors):
        base, inner, outer = annulus(*one[:2], int(was))
        centre, least, most = annulus(*two[:2], i)
        assert_allclose(centre, along.length * along.turn @ base + along.shift, atol=1e-9 * most)
        assert_allclose(
            [least, most], along.length * np.array([inner, outer]), rtol=1e-9, atol=1e-9 * most
        )
        away = np.linalg.norm(s[:, i] - centre, axis=-1)
        assert (away <= most * (1 + 1e-9)).all()
        assert (away >= least - 1e-9 * most).all()


def slide(name, parent=None, axis=(1, 0, 0), **limits):
    return Joint(name, parent, (0, 0, 0), axis, slide=True, **limits)


def body(*joints, end=(0, 0, 0)):
    tree = Tree.of(joints)
    return tree, Effectors.of(tree, {"end": (tree.names[-1], end)})


def test_a_slide_makes_its_link_short_and_long():
    fixed = body(Joint("a"), slide("b", "a", lower=2, upper=2), Joint("c", "b"), end=(0.5, 0, 0))
    assert annulus(*fixed, 0)[1:] == (1.5, 2.5)
    boom = body(Joint("a"), slide("b", "a", lower=2, upper=5), Joint("c", "b"), end=(0.5, 0, 0))
    assert annulus(*boom, 0)[1:] == (1.5, 5.5)
    with pytest.raises(ValueError, match="a slide without limits has no reach: effector 'end'"):
        annulus(*body(slide("a", lower=0)), 0)


def test_the_reach_of_a_floating_body_is_asked_from_where_it_is_carried():
    human, hand = figures.human(), figures.human().effectors.names.index("hand.l")
    tree, effectors = figures.floating(human)
    base, inner, outer = annulus(*human, hand)
    rng = np.random.default_rng(0)
    theta = rng.uniform(np.maximum(tree.lower, -3), np.minimum(tree.upper, 3), (500, len(tree)))
    frames = forward(tree, theta)
    centre, *reach = annulus(tree, effectors, hand, frames)
    assert reach == [inner, outer]
    root = tree.index("root.z")
    turned = np.matvec(frames.orientations[:, root], base)
    assert_allclose(centre, frames.positions[:, root] + turned, atol=1e-12)
    far = np.linalg.norm(locate(frames, effectors)[:, hand] - centre, axis=-1)
    assert (inner <= far).all()
    assert (far <= outer).all()
    # What is on the pelvis itself is as far from its middle as it is fixed there.
    walker = figures.walker()
    names = walker.effectors.names
    assert annulus(*walker, names.index("pelvis"))[1:] == (0, 0)
    assert annulus(*walker, names.index("heel.l"))[2] < 1.2
    # A carriage carries an arm; an arm on a mast that ends is not carried.
    rail = body(slide("x"), Joint("a", "x", (0, 0.2, 0), lower=-1, upper=1), end=(0.5, 0, 0))
    assert annulus(*rail, 0)[1:] == (0.5, 0.5)


@pytest.mark.parametrize("far", [1.0, 1e3, 1e6])
def test_slides_without_limits_go_as_far_as_the_target_is(far):
    gantry = body(slide("x"), slide("y", "x", (0, 1, 0)), slide("z", "y", (0, 0, 1)))
    lift = body(slide("up", axis=(0, 1, 0), lower=0), Joint("a", "up"), end=(0.5, 0, 0))
    polar = body(Joint("a"), Joint("b", "a", axis=(0, 1, 0)), slide("r", "b"), end=(0.1, 0, 0))
    assert reachable(*gantry, far * np.array([[1, -2, 3]]))
    assert nearest(*gantry, far * np.array([[1, -2, 3]])) <= 1e-9 * far
    assert reachable(*lift, [[0.3, far, 0]])
    assert not reachable(*lift, [[0.3, -far, 0]])
    assert not reachable(*lift, [[0.6, far, 0]])
    assert reachable(*polar, far * np.array([[1, -2, 3]]))


def test_only_joints_that_move_move_it():
    locked = body(Joint("a", lower=0.5, upper=0.5), end=(1, 0, 0))
    there = [[np.cos(0.5), np.sin(0.5), 0]]
    assert reachable(*locked, there)
    assert_allclose(nearest(*locked, [[1, 0, 0]]), 2 * np.sin(0.25))
    root = body(Joint("a", offset=(5, 6, 7)))  # an effector that no joint moves
    assert reachable(*root, [[5, 6, 7]])
    assert not reachable(*root, [[5, 6, 7 + 1e-6]])
    assert_allclose(nearest(*root, [[5, 6, 8]]), 1)
    assert annulus(*root, 0)[1:] == (0, 0)


@pytest.mark.parametrize("lengths", [[1], [3], [1, 1], [1, 2], [2, 1, 1], [0.5, 3, 1, 0.2]])
def test_arms_in_the_plane_come_as_near_as_their_ring(lengths):
    """An arm that turns freely reaches a ring, from max(0, 2 max ℓ − Σℓ) to Σℓ."""
    grid = np.arange(-4.0, 5.0)
    goals = np.array([[x, y, z] for x in grid for y in grid for z in (0, 1)])
    away, outer = np.hypot(goals[:, 0], goals[:, 1]), sum(lengths)
    gap = np.maximum(0, np.maximum(away - outer, 2 * max(lengths) - outer - away))
    near = nearest(*figures.planar_arm(lengths), goals[:, None])[:, 0]
    assert_allclose(near, np.hypot(gap, goals[:, 2]), atol=1e-9)


@pytest.mark.parametrize("links", [1, 2, 3, 7, 30])
@pytest.mark.parametrize("unit", [1e-6, 1, 1e6])
def test_where_reach_ends(links, unit):
    tree, hand = figures.planar_arm([unit] * links)
    ends = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0.6, -0.8, 0]])[:, None] * links * unit
    assert_allclose(nearest(tree, hand, ends), 0, atol=1e-6 * links * unit)
    assert reachable(tree, hand, ends).all()
    assert not reachable(tree, hand, 1.01 * ends).any()
    assert_allclose(nearest(tree, hand, 1.01 * ends), 0.01 * links * unit, rtol=1e-6)
    assert_allclose(nearest(tree, hand, [[1e9 * unit, 0, 0]]), (1e9 - links) * unit, rtol=1e-12)
    assert (nearest(tree, hand, [[0, 0, 0]]) < 1e-6 * unit) == (links > 1)


def test_mirrored_sides_come_as_near():
    """Local minima that only one side falls into would show."""
    human = figures.human()
    side = np.array([[1], [-1], [-1], [1]]) * [1, 0, 0]  # of the feet, then of the hands
    near = nearest(*human, [0.5, 1, 1] * side * [[0.7]] * 2 + [0, -0.3, 0.2])
    assert_allclose(near[[0, 2]], near[[1, 3]], atol=1e-6)


@pytest.mark.parametrize("within", [-1, np.nan, "near", [1, 2], None])
def test_a_bound_is_one_length(within):
    with pytest.raises(ValueError, match=r"within must be (one number, )?0 or more, and finite"):
        nearest(*figures.planar_arm(2), [[1, 1, 0]], within=within)


@settings(max_examples=20)
@given(bodies(limits=True), SHAPES, SEEDS)
def test_where_some_pose_is_can_be_reached(figure, shape, seed):
    tree, effectors = figure
    theta = poses(tree, np.random.default_rng(seed), shape)
    can = reachable(tree, effectors, locate(forward(tree, theta), effectors))
    assert can.shape == (*shape, len(effectors))
    assert can.all()


@settings(max_examples=20)
@given(bodies(limits=True, slides=False), SEEDS)
def test_further_than_the_chain_is_long_cannot(figure, seed):
    tree, effectors = figure
    rng = np.random.default_rng(seed)
    length = np.linalg.norm(tree.offsets, axis=1).sum()
    length += np.linalg.norm(effectors.offsets, axis=1)
    away = rng.normal(size=(len(effectors), 3))
    away *= (length + 0.01)[:, None] / np.linalg.norm(away, axis=1, keepdims=True)
    assert not reachable(tree, effectors, away).any()
    assert (nearest(tree, effectors, away) >= 0.01 - 1e-12).all()


def test_how_near_a_planar_arm_can_come():
    tree, effectors = figures.planar_arm([1.0, 0.5])
    targets = np.array([[2.0, 0, 0], [0.2, 0, 0], [0, 1, 0], [1, 0, 1]])[:, None]
    wanted = [0.5, 0.3, 0, 1]
    assert_allclose(nearest(tree, effectors, targets)[:, 0], wanted, atol=1e-4)
    assert_array_equal(reachable(tree, effectors, targets, within=0.31)[:, 0], [0, 1, 1, 0])


def test_limits_count():
    def arm(upper):
        tree = Tree.of([Joint("a", lower=0, upper=upper)])
        return tree, Effectors.of(tree, {"hand": ("a", (1, 0, 0))})

    assert reachable(*arm(2.0), [[0, 1, 0]])
    assert not reachable(*arm(1.5), [[0, 1, 0]])
    assert_allclose(nearest(*arm(np.pi / 4), [[0, 1, 0]]), 2 * np.sin(np.pi / 8), atol=1e-9)


def test_slides_count():
    tree = Tree.of([Joint("lift", axis=(0, 1, 0), slide=True, lower=0, upper=0.5)])
    effectors = Effectors.of(tree, {"top": ("lift", (0, 0, 0))})
    assert_allclose(nearest(tree, effectors, [[0, 0.8, 0]]), 0.3, atol=1e-9)
    assert reachable(tree, effectors, [[0, 0.4, 0]])


def test_each_effector_is_asked_by_itself_and_mobility_does_not_count():
    tree = Tree.of([Joint("a", mobility=0.0)])
    ends = {"one": ("a", (1, 0, 0)), "other": ("a", (1, 0, 0))}
    effectors = Effectors.of(tree, ends)
    assert reachable(tree, effectors, [[0, 1, 0], [0, -1, 0]]).all()


def test_bad_targets_are_named():
    tree, effectors = figures.human()
    with pytest.raises(ValueError, match="4 effectors need targets of shape"):
        reachable(tree, effectors, np.zeros((3, 3)))
    with pytest.raises(ValueError, match=r"target of 'foot.l' is not finite"):
        reachable(tree, effectors, np.full((4, 3), np.nan))


@settings(max_examples=20)
@given(bodies(limits=True, directions=True), SEEDS)
def test_where_a_pose_takes_points_and_directions_is_reachable(figure, seed):
    tree, effectors = figure
    theta = poses(tree, np.random.default_rng(seed))
    targets = locate(forward(tree, theta), effectors)
    directions = effectors.w == 0
    assert reachable(tree, effectors, targets, within=0.05)[directions].all()
    longer = np.where(directions[:, None], 2 * targets, targets)
    long = np.linalg.norm(targets, axis=-1)
    assert not (reachable(tree, effectors, longer) & directions & (long > 1e-6)).any()
