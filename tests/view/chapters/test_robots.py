"""Chapter 12's figures, without a page, and what they are made of."""

import re

import numpy as np
import pytest

from ikteach import forward, jacobian, locate
from ikteach.body.partials import by_differences
from ikteach.formats.urdf import ARM, read_urdf
from ikteach.study.poses import feet_off, ticks_to_turn
from ikteach.view.chapters.robots import (
    ARROW,
    as_points,
    robot_player,
    standing_player,
    with_y_up,
)


@pytest.fixture(params=[robot_player, standing_player], ids=["robot", "standing"])
def player(request):
    made = request.param(slot=None)
    yield made
    assert made.status.wrong == ""
    made.close()


def test_every_slider_moves_a_target_or_a_weight_and_is_undone(player):
    session = player.session
    for name, control in player.controls.items():
        if not hasattr(control, "step") or name == "step":
            continue
        before, weights = session.targets.copy(), session.options["weights"]
        control.value = control.min if control.value != control.min else control.max
        moved = not np.array_equal(before, session.targets)
        weighed = not np.array_equal(weights, session.options["weights"])
        assert moved != weighed, name
        player.step()
        player.draw()
    player.report()
    for name, w in zip(session.effectors.names, session.effectors.w, strict=True):
        assert re.search(rf"{re.escape(name)} [\d.]+{' cm' if w else '°'}", player.words)


def test_it_starts_where_its_targets_are(player):
    for _ in range(60):
        player.session.tick()
    player.report()
    assert player.session.error.max() < 0.01


def test_a_direction_is_drawn_on_its_body(player):
    player.session.tick()
    player.draw()
    now, effectors = player.scene.now, player.session.effectors
    gaps = np.linalg.norm(now.targets[0] - now.effectors[0], axis=-1)
    wanted = np.where(effectors.w == 1, 1, ARROW) * player.session.error
    assert gaps == pytest.approx(wanted, abs=1e-9)
    assert (as_points(player.rest[0]).w == 1).all()


def test_an_upright_robot_is_the_same_robot():
    robot = read_urdf(ARM)
    turned = with_y_up(robot)
    rng = np.random.default_rng(5)
    theta = rng.uniform(-1, 1, (5, len(robot.tree)))
    ours = locate(forward(turned.tree, theta), turned.effectors)
    theirs = locate(forward(robot.tree, theta), robot.effectors)
    assert ours == pytest.approx(theirs[..., [0, 2, 1]] * [1, 1, -1], abs=1e-9)
    tree = turned.tree
    J = jacobian(tree, forward(tree, theta[0]), turned.effectors)
    assert pytest.approx(by_differences(tree, theta[0], turned.effectors), abs=1e-6) == J


def test_short_directions_take_longer_and_heavy_feet_stay():
    arm, walker = robot_player(slot=None), standing_player(slot=None)
    ticks = [ticks_to_turn(*arm.rest, length) for length in (0.2, 0.1, 0.05)]
    assert ticks == sorted(set(ticks))
    assert ticks_to_turn(*arm.rest, 0.0) == 1000  # never: nothing asks
    assert feet_off(*walker.rest, 1) > 10 * feet_off(*walker.rest, 10)
    arm.close()
    walker.close()
