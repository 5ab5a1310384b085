"""Skins: each part on a row of the body that it was made for."""

import numpy as np
import pytest

from ikteach import figures, forward
from ikteach.view.stage import skin

FIGURES = {
    "human": figures.human(),
    "simulator": figures.simulator(),
    "floating human": figures.floating(figures.human()),
    "walker": figures.walker(),
}


@pytest.mark.parametrize("name", FIGURES)
def test_the_figures_have_their_skins(name):
    tree = FIGURES[name].tree
    found = skin.skin_of(tree)
    assert {part.joint for part in found.parts} - {None} <= set(tree.names)
    assert found.unit == pytest.approx(1)


@pytest.mark.parametrize("name", ["floating human", "walker"])
def test_a_free_pelvis_takes_all_of_the_skin_along(name):
    tree = FIGURES[name].tree
    parts = skin.skin_of(tree).parts
    assert all(part.joint for part in parts)
    gone = tree.rest + [1, 2, 3, *[0] * (len(tree) - 3)]
    here, there = (forward(tree, theta).positions for theta in (tree.rest, gone))
    rows = [tree.index(part.joint) for part in parts]
    np.testing.assert_allclose(there[rows] - here[rows], np.tile([1, 2, 3], (len(rows), 1)))


def test_a_direction_is_no_rod():
    tree = figures.planar_arm(2).tree
    points = figures.Effectors.of(tree, {"hand": ("joint2", (1, 0, 0))})
    both = figures.Effectors.of(
        tree, {"hand": ("joint2", (1, 0, 0))}, directions={"gaze": ("joint1", (0, 1, 0))}
    )
    assert skin.stick_skin(tree, both, 0.1) == skin.stick_skin(tree, points, 0.1)
