"""The simulator of CS 490: packages, ways, and how runs end."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal
from strategies import SEEDS

from ikteach import Joint, Tree, figures, forward, jacobian, locate, reachable, study
from ikteach.motion.reach.packages import (
    MIDDLE,
    NONE,
    PACKAGES,
    ReachingFigure,
    arm_reaches,
    back_reaches,
    both_reach,
    by_columns,
    by_differences,
    by_hand,
    choose,
    coupling,
    degrees,
    look,
)
from ikteach.motion.reach.planar import PlanarReach, square
from ikteach.motion.reach.reaching import ROOM, Reach, period, reachable_cursors, trial
from ikteach.motion.reach.ways import (
    ARRIVED,
    EASE,
    MAX_STEP,
    WAYS,
    Way,
    advance,
    after_solve,
    at_rest,
    here,
    homewards,
    null_space,
)
from ikteach.solvers import SOLVERS, cramer

BODY = ReachingFigure()
TREE = BODY.tree
packages = pytest.mark.parametrize("package", PACKAGES, ids=lambda p: p.name)
every_way = pytest.mark.parametrize("name", WAYS)


def some_poses(count, seed=0):
    """Poses (count, n) within the limits; rows that turn together have one angle."""
    q = np.random.default_rng(seed).uniform(
        TREE.lower[BODY.rows], TREE.upper[BODY.rows], (count, len(BODY.degrees))
    )
    return q @ BODY.C.T


def hand_of(package, theta):
    return locate(forward(TREE, theta), BODY.hands[package.side])[..., 0, :]


# The degrees of motion, and J three times.


def test_16_degrees_of_motion_turn_17_rows():
    assert len(degrees(TREE)) == 16
    C = coupling(TREE)
    assert_array_equal(C.sum(axis=1), 1)
    assert_array_equal(C.sum(axis=0), [2, *[1] * 15])
    assert BODY.degrees[0] == "back"
    assert_array_equal(coupling(figures.human().tree), np.eye(20))


@packages
def test_three_ways_to_the_same_jacobian(package):
    theta = some_poses(200)
    J = by_columns(BODY, theta, package)
    assert_allclose(by_hand(BODY, theta, package), J, atol=1e-12)
    assert_allclose(by_differences(BODY, theta, package), J, atol=1e-8)


def test_the_determinant_of_an_arm_is_a_formula():
    """det J = ± r L₁ L₂ sin b: none where the arm is straight or the hand over the shoulder."""
    theta = some_poses(50)
    _, a, b = theta[:, BODY.arm("l")].T
    r = BODY.L1 * np.sin(a) + BODY.L2 * np.sin(a + b)
    det = np.linalg.det(by_hand(BODY, theta, PACKAGES[1]))
    assert_allclose(abs(det), abs(r * BODY.L1 * BODY.L2 * np.sin(b)), atol=1e-12)


# Which package answers.


@packages
def test_what_a_hand_has_reached_is_within_reach(package):
    theta = some_poses(300, seed=2)
    if "back" in package.degrees:
        elbow = BODY.arm(package.side)[2]
        theta[:, elbow] = TREE.rest[elbow]
        answers = back_reaches(BODY, package.side, hand_of(package, theta))
        assert answers.mean() > 0.97  # but at the very ends of the back, which is searched by steps
    else:
        assert arm_reaches(BODY, package.side, hand_of(package, theta), theta[:, BODY.back]).all()


def test_within_reach_is_what_least_squares_says():
    """The closed form against the bounded search of `reachable`, away from the very border."""
    points = np.random.default_rng(3).uniform([-0.3, -0.6, -0.9], [1.1, 1.1, 0.9], (150, 3))
    ours = both_reach(BODY, "l", points)
    # `reachable` knows no shared angle: the back is locked for it.
    hand = BODY.hands["l"]
    stiff = Tree.of(
        Joint(n, None if p < 0 else TREE.names[p], o, v, lower=low, upper=high, rest=rest)
        for n, p, o, v, low, high, rest in zip(
            TREE.names, TREE.parents, TREE.offsets, TREE.axes,
            np.where(np.arange(17) < 2, 0, TREE.lower), np.where(np.arange(17) < 2, 0, TREE.upper),
            TREE.rest, strict=True,
        )
    )  # fmt: skip
    arm_alone = arm_reaches(BODY, "l", points, 0.0)
    theirs = reachable(stiff, hand, points[:, None, :])[:, 0]
    assert (arm_alone == theirs).mean() > 0.97
    assert theirs[arm_alone].all()
    assert (ours | ~arm_alone).all()
    assert 0.1 < ours.mean() < 0.9


def test_the_cursor_chooses_the_package():
    rest = TREE.rest[BODY.back]
    for cursor, number in [
        ([-0.35, 0.25, 0.35], 0), ([0.35, 0.25, 0.35], 1),
        ([-0.4, -0.2, 0.4], 2), ([0.4, -0.2, 0.4], 3),
        ([0.0, 0.25, 0.35], NONE), ([MIDDLE / 2, 0.25, 0.35], NONE), ([-1, 1, 1], NONE),
    ]:  # fmt: skip
        assert choose(BODY, np.array(cursor), rest) == number, cursor


def test_left_and_right_are_alike():
    cursors = reachable_cursors(BODY, 300)
    mirrored = cursors * [-1, 1, 1]
    ours, theirs = choose(BODY, cursors, 0.0), choose(BODY, mirrored, 0.0)
    other = np.array([1, 0, 3, 2, NONE])  # NONE is −1: the last
    assert_array_equal(other[ours], theirs)
    for way in ("cramer", "dls"):
        a, b = (trial(BODY, c[:20], WAYS[way], ticks=40) for c in (cursors, mirrored))
        assert_allclose(a.distance, b.distance, atol=1e-9)


# The neck.


@given(SEEDS)
def test_the_face_looks_at_the_cursor_or_stands_at_a_limit(seed):
    rng = np.random.default_rng(seed)
    cursor, back = rng.uniform(*ROOM), rng.uniform(-0.2, 0.6)
    nod = look(BODY, cursor, back)
    assert TREE.lower[BODY.neck] <= nod <= TREE.upper[BODY.neck]
    assert_allclose(np.degrees([TREE.lower[BODY.neck], TREE.upper[BODY.neck]]), [-30, 60])
    theta = TREE.rest.copy()
    theta[[BODY.back, BODY.back + 1, BODY.neck]] = back, back, nod
    frames = forward(TREE, theta)
    up, ahead = frames.orientations[BODY.neck][:, 1], frames.orientations[BODY.neck][:, 2]
    eyes = frames.positions[BODY.neck] + 0.15 * up
    gaze = cursor - eyes
    if TREE.lower[BODY.neck] < nod < TREE.upper[BODY.neck] and gaze @ gaze > 0.05:
        assert abs(gaze @ up) < 1e-9  # neither over the cursor nor under it
        assert gaze @ ahead > -1e-9


# Return to rest.


@given(SEEDS)
def test_nobody_goes_to_rest_faster_than_a_degree_a_tick(seed):
    theta = some_poses(5, seed)
    wish = homewards(BODY, theta, besides=("back",))
    assert (abs(wish) <= EASE).all()
    assert not wish[:, [BODY.degrees.index("back"), BODY.degrees.index("neck")]].any()
    elbow = BODY.degrees.index("elbow.l")
    left = TREE.rest[TREE.index("elbow.l")] - theta[:, TREE.index("elbow.l")]
    assert_array_equal(np.sign(wish[:, elbow]), np.sign(left))


@given(SEEDS)
def test_null_space_rest_leaves_the_hand_to_first_order(seed):
    """Half the rest, a quarter of the way that the hand goes: there is no first order in it."""
    theta = some_poses(1, seed)[0]
    J = jacobian(TREE, forward(TREE, theta), BODY.hands["r"]) @ BODY.C
    wish = np.random.default_rng(seed).uniform(-1, 1, len(BODY.degrees))
    still = null_space(J, wish)
    assert_allclose(J @ still, 0, atol=2e-3 * np.linalg.norm(J))
    assert wish @ still >= -1e-12  # towards rest, or not at all
    assert_allclose(null_space(J, still), still, atol=1e-9)
    if np.linalg.svdvals(J)[-1] > 1e-2:

        def moved(h):
            return np.linalg.norm(
                hand_of(PACKAGES[0], theta + h * still @ BODY.C.T) - hand_of(PACKAGES[0], theta)
            )

        assert moved(5e-4) <= 0.26 * moved(1e-3) + 1e-12
    assert_array_equal(after_solve(J, wish), wish)


def test_return_to_rest_spoils_what_the_solve_had_reached_and_the_null_space_does_not():
    """Wrong by a centimetre or so as long as joints are on their way, against a millimetre."""
    spoilt = Way(SOLVERS["dls"], rest=after_solve)
    kept = Way(SOLVERS["dls"])
    cursor = np.array([0.4, 0.1, 0.45])
    ends = [trial(BODY, cursor, way).distance for way in (spoilt, kept)]
    assert ends[0] > 0.02
    assert ends[1] < 0.0025


# One tick.


@every_way
@given(seed=SEEDS, parts=st.sampled_from([1, 6, 30]), cap=st.sampled_from([None, MAX_STEP]))
def test_a_tick_keeps_limits_cap_and_shared_angle(name, seed, parts, cap):
    theta = some_poses(4, seed)
    cursor = np.random.default_rng(seed).uniform(ROOM[0] - 1, ROOM[1] + 1, (4, 3))
    tick = advance(BODY, theta, cursor, WAYS[name], parts=parts, max_step=cap)
    assert np.isfinite(tick.theta).all()
    assert ((tick.theta >= TREE.lower) & (tick.theta <= TREE.upper)).all()
    assert_array_equal(tick.theta[:, BODY.back], tick.theta[:, BODY.back + 1])
    turned = abs(tick.theta - theta)
    turned[:, BODY.neck] = 0
    if cap is not None:
        assert turned.max() <= cap + 1e-12
    silent = tick.package == NONE
    assert (turned[silent] <= EASE + 1e-12).all()


@every_way
def test_a_batch_is_a_loop(name):
    theta, cursors = some_poses(12, 4), reachable_cursors(BODY, 12)
    many = advance(BODY, theta.reshape(3, 4, -1), cursors.reshape(3, 4, 3), WAYS[name])
    assert many.distance.shape == many.package.shape == (3, 4)
    for i in range(12):
        one = advance(BODY, theta[i], cursors[i], WAYS[name])
        assert_allclose(many.theta.reshape(12, -1)[i], one.theta, atol=1e-9)
        assert_allclose(many.det.ravel()[i], one.det, atol=1e-9)


def test_a_straight_arm_is_refused_and_said_so():
    reach = Reach({"cramer": WAYS["cramer"]})
    theta = TREE.rest.copy()
    theta[TREE.index("elbow.r")] = 0
    tick = advance(BODY, theta, reach.cursor, WAYS["cramer"])
    assert tick.independence < 1e-9
    assert abs(tick.det) < 1e-9
    right = BODY.arm("r")
    assert_array_equal(tick.theta[right], theta[right])
    reach.standing["cramer"].take(tick)
    assert "det is near 0" in reach.standing["cramer"].words


def test_each_tick_goes_one_part_of_the_way():
    start = advance(BODY, TREE.rest, [-0.35, 0.2, 0.3], WAYS["cramer"], parts=200).distance
    for parts in (40, 80):
        near = TREE.rest
        for _ in range(5):
            near = (tick := advance(BODY, near, [-0.35, 0.2, 0.3], WAYS["cramer"], parts=parts))[0]
        assert_allclose(tick.distance / start, (1 - 1 / parts) ** 5, rtol=0.05)


@pytest.mark.parametrize(
    ("theta", "cursor", "options", "words"),
    [
        (np.zeros(3), [0, 0, 0], {}, "17 joints need theta"),
        (TREE.rest, [0, 0], {}, "a cursor is x, y and z"),
        (TREE.rest, [0, np.nan, 0], {}, "finite"),
        (TREE.rest, "left", {}, "the cursor must be made of numbers"),
        (TREE.rest, [0, 0, 0], {"parts": 0}, "1 part or more"),
    ],
)
def test_unfit_ticks_are_refused(theta, cursor, options, words):
    with pytest.raises(ValueError, match=words):
        advance(BODY, theta, cursor, WAYS["dls"], **options)


ODD = {
    "the origin": [0, 0, 0],
    "far away": [1e9, -1e9, 1e9],
    "so near that it is nothing": [1e-9, -1e-9, 1e-9],
    "in a shoulder": BODY.shoulder("r") + [0, BODY.waist + BODY.segment, 0],
    "in a hand": locate(forward(TREE, TREE.rest), BODY.hands["l"])[0],
    "under a straight arm": BODY.shoulder("l") + [0, BODY.waist - 0.496, 0],
}


@given(
    st.sampled_from(list(WAYS)), st.sampled_from(list(ODD)), SEEDS, st.sampled_from([None, 0.003])
)
def test_wherever_the_cursor_is_poses_stay_within_limits(name, place, seed, max_step):
    """Of any pose, also one whose two segments of the back are not turned alike."""
    rng = np.random.default_rng(seed)
    corner = np.where(rng.random(len(TREE)) < 0.5, TREE.lower, TREE.upper)
    theta = np.stack([rng.uniform(TREE.lower, TREE.upper), corner, TREE.rest])
    for _ in range(10):
        tick = advance(BODY, theta, ODD[place], WAYS[name], max_step=max_step)
        assert np.isfinite(tick.distance).all()
        assert (tick.theta >= TREE.lower).all()
        assert (tick.theta <= TREE.upper).all()
        if max_step:  # also of those that go to rest; the neck just looks
            turned = np.delete(abs(tick.theta - theta), BODY.neck, axis=-1)
            assert turned.max() <= max_step + 1e-12
        theta = tick.theta


@pytest.mark.parametrize("links", [1, 2, 3])
def test_an_arm_in_the_plane_stays_within_limits_wherever_the_cursor_is(links):
    arm = PlanarReach(links)
    hand = locate(forward(arm.tree, arm.tree.rest), arm.effectors)[0]
    for cursor in [[0, 0, 0], [1e9, 1, 0], [1e-9, 0, 0], [0.5, 0, 0], [1.2, 0, 0], [0, 0, 5], hand]:
        arm.put(cursor)
        for _ in range(40):
            arm.tick()
        for one in arm.standing.values():
            assert np.isfinite(one.tick.distance)
            assert (one.tick.theta >= arm.tree.lower).all()
            assert (one.tick.theta <= arm.tree.upper).all()


def test_points_may_be_lists():
    point, array = [0.35, 0.2, 0.3], np.array([0.35, 0.2, 0.3])
    assert choose(BODY, point, 0) == choose(BODY, array, 0)
    assert look(BODY, point, 0) == look(BODY, array, 0)
    assert arm_reaches(BODY, "l", point, 0) == arm_reaches(BODY, "l", array, 0)
    assert back_reaches(BODY, "l", point) == back_reaches(BODY, "l", array)
    J = by_hand(BODY, TREE.rest.tolist(), PACKAGES[0])
    assert_array_equal(J, by_hand(BODY, TREE.rest, PACKAGES[0]))
    for wrong in ([0, 0], [0, 0, np.inf]):
        with pytest.raises(ValueError, match="are x, y and z, all finite"):
            choose(BODY, wrong, 0)


# How runs end.


def test_a_period_is_found_and_nothing_else():
    t = np.arange(150)
    wave = np.stack([np.sin(2 * np.pi * t / 12), np.cos(2 * np.pi * t / 12)], axis=-1)
    assert period(wave) == 12
    assert period(1e-4 * wave) == 0  # too small to be seen
    assert period(wave * 0.97 ** t[:, None]) == 0  # it dies out
    assert period(np.stack([t, t], axis=-1) / 50) == 0  # it goes on and on
    assert period(wave[:23]) == 0  # not seen twice yet
    assert_array_equal(period(np.stack([wave, 0 * wave], axis=1)), [12, 0])


SAMPLE = reachable_cursors(BODY, 120, seed=5)


def test_the_sample_is_within_reach():
    side = np.where(SAMPLE[:, 0] < 0, "r", "l")
    reach = [both_reach(BODY, s, c) for s, c in zip(side, SAMPLE, strict=True)]
    assert np.mean(reach) > 0.98  # the back is searched by half degrees


def test_no_run_oscillates_unnoticed():
    """Each run ends at rest, or repeats itself and is told, or is said not to have come to rest."""
    table = study.reaches(SAMPLE)
    C, mended, general = table.loc["cramer"], table.loc["cramer, mended"], table.loc[list(SOLVERS)]
    assert C["oscillates"] > 0.02  # while the back turns, as CS 490 admits
    assert mended["oscillates"] == 0
    assert mended["arrived"] > C["arrived"] > 0.4
    assert C["silent"] > 0.05  # between the ranges, as CS 490 admits
    assert (general["silent"] == 0).all()
    assert (general["arrived"] > 0.85).all()
    assert (table["largest [°]"] <= np.degrees(MAX_STEP) + 1e-9).all()
    assert (table["unsettled"] < 0.15).all()


def test_an_oscillation_is_told_while_it_runs():
    reach = Reach({"cramer": WAYS["cramer"], "mended": WAYS["cramer, mended"]})
    reach.put([0.4, -0.2, 0.3])
    for _ in range(150):
        reach.tick()
    assert "oscillates" in reach.standing["cramer"].words
    assert "arrived" in reach.standing["mended"].words
    assert not reach.settled
    table = study.standings(reach)
    assert "oscillates" in table.loc["cramer", "how it stands"]
    # What mends it is that the package is chosen as seen from rest, and nothing else.
    for origin, oscillates in ((here, True), (at_rest, False)):
        way = Way(cramer, packaged=True, origin=origin, rest=after_solve)
        assert (trial(BODY, [0.4, -0.2, 0.3], way).period > 0) == oscillates


def test_a_trial_is_a_session():
    for name, cursor in (("cramer", [-0.3, 0.3, 0.4]), ("dls", [0.3, 0.9, 0.1])):
        reach = Reach({name: WAYS[name]}, method=name, cursor=cursor)
        end = trial(BODY, cursor, WAYS[name])
        while not reach.settled and reach.ticks < 300:
            reach.tick()
        standing = reach.standing[name]
        assert standing.arrived == end.ticks
        assert_allclose(standing.tick.distance, end.distance, atol=1e-12)
        assert_allclose(standing.largest, end.largest, atol=1e-12)
        assert end.arrived
        assert end.distance <= ARRIVED


# The session.


def test_the_session_says_what_is_white():
    reach = Reach()
    assert reach.within
    assert reach.words == "within reach of the right arm"
    reach.put([0, 0.3, 0.3])
    assert not reach.within
    assert "in the middle" in reach.words
    reach.show("dls")
    assert reach.within
    assert "together" in reach.words
    reach.put([1, 1.3, 1.2])
    assert not reach.within
    assert "out of reach" in reach.words
    reach.move([9, 9, 9])
    assert_array_equal(reach.cursor, ROOM[1])
    reach.reset()
    assert_array_equal(reach.theta, TREE.rest)
    assert reach.ticks == 0


def test_out_of_reach_all_goes_back_to_rest():
    reach = Reach({"cramer": WAYS["cramer"]})
    for _ in range(40):
        reach.tick()
    assert reach.standing["cramer"].arrived is not None
    reach.put([-1, 1.3, 1.2])
    away = reach.theta - TREE.rest
    away[BODY.neck] = 0
    for _ in range(int(np.degrees(abs(away).max())) + 2):
        reach.tick()
    away = reach.theta - TREE.rest
    away[BODY.neck] = 0
    assert_allclose(away, 0, atol=1e-12)
    assert reach.standing["cramer"].words == "does not answer: at rest"


def test_a_failing_method_changes_nothing():
    def broken(J, e):
        return J[..., 0, :] * np.nan

    ways = {"dls": WAYS["dls"], "broken": replace(WAYS["dls"], solver=broken)}
    reach = Reach(ways, method="dls")
    with pytest.raises(FloatingPointError):
        reach.tick()
    assert reach.ticks == 0
    assert_array_equal(reach.theta, TREE.rest)


@pytest.mark.parametrize("session", [Reach, PlanarReach])
def test_unfit_names_and_cursors(session):
    reach = session()
    before = reach.cursor
    with pytest.raises(LookupError, match="did you mean 'dls'"):
        reach.show("dlss")
    for cursor in ([0, 0], [0, 0, np.inf], "here", None):
        with pytest.raises(ValueError, match="cursor"):
            reach.put(cursor)
    assert_array_equal(reach.cursor, before)


# The planar model.


def test_the_planar_jacobian_and_its_determinant():
    figure = figures.planar_model()
    rng = np.random.default_rng(0)
    for _ in range(20):
        theta = rng.uniform(-1, 1, 3)
        J = jacobian(figure.tree, forward(figure.tree, theta), figure.effectors)
        square_J, _ = square(figure, theta, J, np.zeros(3))
        assert_allclose(np.linalg.det(square_J), 0.5 * 0.4 * np.sin(theta[1]), atol=1e-12)


@pytest.mark.parametrize("links", [1, 2, 3])
def test_the_planar_model_reaches(links):
    reach = PlanarReach(links)
    figure = figures.planar_model(links)
    rng = np.random.default_rng(links)
    for _ in range(5):
        theta = rng.uniform(-1, 1, links)
        reach.put(locate(forward(figure.tree, theta), figure.effectors)[0])
        for _ in range(120):
            reach.tick()
        assert reach.within
        assert reach.standing["dls"].tick.distance < ARRIVED
    assert ("cramer" in reach.ways) == (links == 3)
    reach.put([1.3, 1.3, 0])
    assert not reach.within


def test_planar_cramer_points_outward():
    reach = PlanarReach(method="cramer", parts=3, cursor=(0.6, 0.6, 0))
    for _ in range(80):
        reach.tick()
    assert reach.standing["cramer"].arrived is not None
    assert_allclose(reach.theta.sum(), np.pi / 4, atol=0.01)
    reach.put([0.0, 0.15, 0])
    assert not reach.within
    assert "last link" in reach.words
    still = reach.theta
    reach.tick()
    assert_array_equal(reach.theta, still)


def test_sigma_is_that_of_the_pose_also_where_a_limit_holds_a_joint():
    reach = PlanarReach(method="dls", cursor=(-0.9, -0.4, 0))
    held = 0
    for _ in range(40):
        theta = reach.standing["dls"].tick.theta
        reach.tick()
        J = jacobian(reach.tree, forward(reach.tree, theta), reach.effectors)[:2]
        assert reach.standing["dls"].tick.sigma == np.linalg.svdvals(J)[-1]
        after = reach.standing["dls"].tick.theta
        held += bool(((after == reach.tree.lower) | (after == reach.tree.upper)).any())
    assert held
