"""A stroke of a hand: closed, even, round; and what of it can be reached."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from ikteach import figures, forward, locate
from ikteach.motion.paths.stroke import POINTS, anchored, closed, evenly, heart, missed, rounded
from ikteach.motion.reachable import reachable

ROUND = np.linspace(0, 2 * np.pi, 300, endpoint=False)


def circle(radius=0.3, at=(0.0, 0.0, 0.0)):
    return np.stack([radius * np.cos(ROUND), radius * np.sin(ROUND), 0 * ROUND], axis=-1) + at


def test_a_trembling_circle_becomes_a_circle():
    tremble = np.random.default_rng(0).normal(size=(300, 3)) * [0.003, 0.003, 0]
    curve = closed(circle() + tremble)
    assert curve.shape == (POINTS, 3)
    assert_allclose(np.linalg.norm(curve, axis=1), 0.3, atol=0.006)


@given(st.lists(st.tuples(*3 * [st.floats(-5, 5)]), min_size=2, max_size=40))
def test_any_stroke_is_closed_even_and_no_larger(stroke):
    if np.ptp(stroke, axis=0).max() < 1e-3:
        return
    curve = closed(stroke)
    assert np.isfinite(curve).all()
    low, high = np.min(stroke, axis=0), np.max(stroke, axis=0)
    assert (curve >= low - 1e-9).all()
    assert (curve <= high + 1e-9).all()
    steps = np.linalg.norm(curve - np.roll(curve, 1, axis=0), axis=1)
    assert steps.max() <= 1.5 * np.linalg.norm(np.diff([*stroke, stroke[0]], axis=0), axis=1).sum()


def test_a_square_is_gone_round_in_even_steps():
    square = [[0, 0], [1, 0], [1, 1], [1, 1], [0, 1]]
    at = evenly(square, 8)
    assert_allclose(at[::2], [[0, 0], [1, 0], [1, 1], [0, 1]], atol=1e-12)
    assert_allclose(np.linalg.norm(np.diff(at, axis=0), axis=1), 0.5)


def test_rounding_keeps_the_mean_and_takes_what_trembles():
    u = np.arange(64) / 64
    slow, fast = np.cos(2 * np.pi * u), np.cos(2 * np.pi * 20 * u)
    assert_allclose(rounded(2 + 0 * u, 0.01), 2)
    assert_allclose(rounded(slow, 0.01), slow * np.exp(-0.5 * (2 * np.pi * 0.01) ** 2), atol=1e-12)
    assert abs(rounded(fast, 0.02)).max() < 0.1


@pytest.mark.parametrize(
    ("stroke", "words"),
    [
        ([[0, 0]], "a stroke is points"),
        (np.zeros((5, 3)), "all in one place"),
        ([[0, 0, np.nan], [1, 1, 1]], "a stroke is points"),
        (np.zeros((0, 3)), "all in one place"),
    ],
)
def test_a_stroke_that_is_none_is_refused(stroke, words):
    with pytest.raises(ValueError, match=words):
        closed(stroke)


def test_what_is_missed_is_what_cannot_be_reached():
    arm = figures.planar_arm([1, 1])
    points = [[1.5, 0, 0], [2.5, 0, 0], [0, 0, 1]]
    assert_allclose(missed(arm, "hand", points, within=0.01), [0, 0.5, 1], atol=1e-6)


def test_a_body_that_floats_stands_while_it_is_asked():
    walker, hand = figures.walker(), [[0, 50, 0]]
    assert missed(walker, "ball.l", hand, within=0.01)[0] > 45
    tree = anchored(walker.tree)
    assert_allclose(forward(tree, tree.rest).positions[0], 0, atol=1e-12)
    with pytest.raises(LookupError, match=r"did you mean 'ball\.l'"):
        missed(walker, "bal.l", hand, within=0.01)
    with pytest.raises(ValueError, match=r"'pelvis\.up' is a direction"):
        missed(walker, "pelvis.up", hand, within=0.01)


@pytest.mark.parametrize("figure", [figures.human(), figures.planar_arm(3), figures.walker()])
def test_around_the_middle_of_a_reach_there_is_room(figure):
    name = figure.effectors.names[2 % len(figure.effectors)]
    middle = heart(figure, name)
    i = figure.effectors.names.index(name)
    targets = locate(forward(figure.tree, figure.tree.rest), figure.effectors)
    targets[i] = middle
    assert reachable(*figure, targets, within=0.3)[i]
