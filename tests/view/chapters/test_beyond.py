"""Chapter 11's figure, without a page."""

import numpy as np
import pytest

from ikteach.motion.paths import quality
from ikteach.view.chapters.beyond import WalksPlayer
from ikteach.view.live.bands import CYCLE, JOINTS, Bands


@pytest.fixture
def player():
    made = WalksPlayer(slot=None)
    yield made
    assert made.status.wrong == ""
    made.close()


def test_the_norm_itself_lies_on_the_band_and_what_is_off_is_said():
    bands, means = Bands(["norm", "off"]), quality.norms()
    angles = np.stack([means[joint] for joint in JOINTS], axis=-1)
    first = bands.png
    bands.draw({"norm": (CYCLE, angles), "off": (CYCLE, angles + [10, 0, 5])})
    assert "norm hip 0°, knee 0°, ankle 0°" in bands.alt
    assert "off hip 10°, knee 0°, ankle 5°" in bands.alt
    assert bands.png != first
    bands.close()


def test_every_control_acts_and_each_walk_has_its_line(player):
    for _ in range(100):
        player.session.tick()
    player.draw()
    assert all(name in player.bands.alt for name in ("recorded", "thesis", "natural"))
    player.report()
    assert player._table.value.count("–") == 1  # that of the words
    for name, control in player.controls.items():
        if name in ("playing", "step", "reset"):
            continue
        before = player.session.sessions["natural"].settings()
        if hasattr(control, "options"):
            control.value = next(one for one in control.options if one != control.value)
        elif isinstance(control.value, bool):
            control.value = not control.value
        else:
            control.value = control.max if control.value == control.min else control.min
        player.step()
        player.draw()
        assert player.status.wrong == "", name
        if name not in ("view", "ground", "skeleton"):
            assert player.session.sessions["natural"].settings() != before, name
    player.report()


def test_all_stand_on_one_floor(player):
    for _ in range(60):
        player.session.tick()
    player.draw()
    soles = [name.startswith("ball") for name in player._seen_at.names]
    heights = player.scene.now.targets[:, soles, 1].min(axis=1) - player.scene.now.floor
    assert abs(heights).max() < 0.12
    assert player.scene.now.floor == player.session.sessions["natural"].floor


def test_the_recorded_skeleton_walks_through_the_figure_that_follows_it(player):
    player.controls["skeleton"].value = True
    for _ in range(60):
        player.session.tick()
    player.draw()
    now, names = player.scene.now, [*player.session.sessions]
    assert [len(bones) > 20 for bones in now.skeletons] == [name == "recorded" for name in names]
    i = names.index("recorded")
    knee = player.session.sessions["recorded"].tree.index("knee.l")
    far = np.linalg.norm(now.skeletons[i] - now.positions[i, knee], axis=-1)
    assert far.min() < 0.15
    assert abs(now.skeletons[i][..., 1].min() - now.floor) < 0.1
    player.controls["skeleton"].value = False
    assert not any(player.scene.layers.values())


def test_a_target_that_nothing_asks_for_lies_on_the_body(player):
    player.session.tick()
    player.draw()
    now, names = player.scene.now, player._seen_at.names
    natural = [*player.session.sessions].index("natural")
    gaps = np.linalg.norm(now.targets - now.effectors, axis=-1)
    assert gaps[natural, names.index("knee.l")] == 0
    recorded = [*player.session.sessions].index("recorded")
    assert gaps[recorded, names.index("knee.l")] > 0


def test_a_stride_that_is_too_long_is_said_and_what_follows_the_speed_mends_it(player):
    control, walk = player.controls, player.session.sessions["natural"]
    control["speed"].value = 1.6
    assert player.status.said == (
        "The legs are 8 cm too short for a stride of 1.71 m: the feet cannot be where the plan"
        " wants them."
    )
    control["follows"].value = True
    assert player.status.said == ""
    assert walk.gait.spare > 0
    assert control["cadence"].value == pytest.approx(walk.gait.cadence)
    control["speed"].value = 1.0
    assert walk.gait.cadence < 110
    control["follows"].value = False
    control["speed"].value = 1.6
    assert player.status.said != ""
