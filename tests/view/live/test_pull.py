"""Chapters 0 to 2 by dragging: what the handles ask for, the sliders do."""

import numpy as np
import pytest

from ikteach import figures, forward, locate
from ikteach.view import BendBench, ColumnPoser, Poser


@pytest.mark.parametrize("make", [Poser, ColumnPoser])
def test_a_pulled_hand_takes_the_sliders_along_and_the_feet_stay(make):
    poser = make(figures.human())
    tree, effectors = poser.joints.figure
    hand = effectors.names.index("hand.l")
    before = poser.targets.positions
    goal = before[hand] + [0.05, 0.25, 0.2]
    for share in np.linspace(0.1, 1, 10):  # as a mouse goes
        poser.targets.move(hand, before[hand] + share * (goal - before[hand]))
    s = locate(forward(tree, poser.theta()), effectors)
    assert np.linalg.norm(s[hand] - goal) < 0.01
    feet = [effectors.names.index(name) for name in ("foot.l", "foot.r")]
    assert np.linalg.norm(s[feet] - before[feet], axis=-1).max() < 0.01
    np.testing.assert_allclose(poser.targets.positions, s, atol=1e-9)
    assert poser.status.wrong == ""
    poser.close()


def test_beyond_reach_the_hand_stops_and_limits_hold():
    poser = Poser(figures.human())
    tree, effectors = poser.joints.figure
    hand = effectors.names.index("hand.r")
    for _ in range(10):
        poser.targets.move(hand, poser.targets.low[hand])
    theta = poser.theta()
    assert (theta >= tree.lower - 1e-9).all()
    assert (theta <= tree.upper + 1e-9).all()
    s = locate(forward(tree, theta), effectors)
    np.testing.assert_allclose(poser.targets.positions, s, atol=1e-9)
    poser.close()


def test_two_rows_of_one_angle_stay_one():
    poser = Poser(figures.simulator(), slot="simulator")
    tree = poser.joints.figure.tree
    poser.targets.move(3, poser.targets.positions[3] + [0.0, 0.3, 0.3])
    theta = dict(zip(tree.names, poser.theta(), strict=True))
    for a, b in figures.TOGETHER:
        assert theta[a] == theta[b]
    assert poser.status.wrong == ""
    poser.close()


def test_the_error_is_turned_by_its_end():
    bench = BendBench()
    bench.controls["bend"].value = 0
    for degrees in (90, -45):
        way = np.radians(degrees)
        bench.targets.move(0, [2 + 0.5 * np.cos(way), 0.5 * np.sin(way), 0])
        assert bench.values["way"] == degrees
        assert f"in the direction {degrees}°" in bench.words
    bench.close()
