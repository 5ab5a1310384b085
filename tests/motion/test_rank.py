"""The most rank that a body can have, and what is called singular by it."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from metamorphic import BODY, Case, ground_moved, in_a_plane
from numpy.testing import assert_allclose, assert_array_equal
from strategies import SEEDS, anybody, poses

from ikteach import Effectors, Joint, Tree, figures, forward, jacobian
from ikteach.motion.rank import full_rank, smallest_sigma

X, Y, Z = np.eye(3)


def body(*joints, **ends):
    tree = Tree.of(joints)
    return tree, Effectors.of(tree, ends or {"end": (tree.names[-1], (1, 0, 0))})


STICK = (Joint("a", axis=X), Joint("b", "a", axis=Y), Joint("c", "b", axis=Z))
BODIES = {
    "one link": (figures.planar_arm(1), 1),
    "two links": (figures.planar_arm(2), 2),
    "three links": (figures.planar_arm(3), 2),
    "thirty links": (figures.planar_arm(30), 2),
    "links of all sizes": (figures.planar_arm([1e-3, 1e3, 1]), 2),
    "the planar model": (figures.planar_model(3), 2),
    "the human": (figures.human(), 12),
    "the simulator": (figures.simulator(), 12),
    "the Y": (figures.y_shape(), 6),
    "the double Y": (figures.double_y(), 12),
    "a slide": (body(Joint("a", slide=True)), 1),
    "two slides one way": (body(Joint("a", slide=True), Joint("b", "a", slide=True)), 1),
    "two slides": (body(Joint("a", slide=True), Joint("b", "a", axis=X, slide=True)), 2),
    "a slide and a hinge": (body(Joint("a", slide=True), Joint("b", "a")), 2),
    "a joint that no effector needs": (body(*STICK[:2], end=("a", (0, 1, 0))), 1),
    "an end on its own axis": (body(Joint("a"), end=("a", (0, 0, 1))), 0),
    "a ball": (body(*STICK), 2),
    "two ends of a bone": (body(*STICK, e=("c", (1, 0, 0)), f=("c", (0, 1, 0))), 3),
    "one end twice": (body(*STICK, e=("c", (1, 0, 0)), f=("c", (1, 0, 0))), 2),
    # The middle joint cannot turn, so that the other two are in line for ever.
    "fixed in line": (body(Joint("a", axis=Z), Joint("b", "a", axis=X, lower=0, upper=0),
                           Joint("c", "b", axis=Z), end=("c", (1, 0, 0))), 2),
}  # fmt: skip


@pytest.mark.parametrize("name", BODIES)
def test_the_most_rank(name):
    (tree, effectors), rank = BODIES[name]
    assert full_rank(tree, effectors) == rank


@given(anybody(limits=True), SEEDS, st.sampled_from(list(BODY)), st.booleans())
def test_it_is_the_bodys_however_that_is_told(figure, seed, change, flat):
    rng = np.random.default_rng(seed)
    case = Case(*figure, figure.tree.rest, np.zeros((len(figure.effectors), 3)))
    if flat:
        case = in_a_plane(case, rng)
    one, other, _ = BODY[change](case, rng)
    assert full_rank(*one[:2]) == full_rank(*other[:2])


@given(anybody(), SEEDS)
def test_no_pose_has_more(figure, seed):
    J = jacobian(
        figure.tree, forward(figure.tree, poses(figure.tree, np.random.default_rng(seed))),
        figure.effectors,
    )  # fmt: skip
    assert np.linalg.matrix_rank(J, rtol=1e-9) <= full_rank(*figure)


def test_the_smallest_sigma_is_that_of_the_rank():
    tree, hand = figures.planar_arm(3)
    theta = np.array([[0.3, 0.5, 0.7], [0.2, 0, 0], [0, np.pi, 0]])
    sigma = np.linalg.svdvals(jacobian(tree, forward(tree, theta), hand)[:, :2])
    assert_allclose(smallest_sigma(tree, hand, theta), sigma[:, 1], atol=1e-15)
    assert smallest_sigma(tree, hand, theta)[0] > 0.3
    still = body(Joint("a"), end=("a", (0, 0, 1)))
    assert_array_equal(smallest_sigma(*still, np.zeros((4, 1))), np.zeros(4))


@pytest.mark.parametrize("far", [1.0, 1e6, 1e10])
def test_a_plane_that_is_tilted_and_far_away_is_a_plane(far):
    rng = np.random.default_rng(0)
    case = Case(*figures.planar_arm(3), np.zeros(3), np.zeros((1, 3)))
    _, turned, _ = BODY["ground turned"](case, rng)
    _, there, _ = ground_moved(turned, rng, far=far)
    assert full_rank(*there[:2]) == 2
