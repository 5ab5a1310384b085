"""The pad on which a path is drawn, without a page: what the page would tell it."""

import numpy as np
import pytest

from ikteach import figures, forward, locate
from ikteach.motion.live.session import Session
from ikteach.view.chapters.gait import GaitPlayer
from ikteach.view.tools.drawing import SIDES, DrawingPad

ROUND = np.linspace(0, 6, 80)


def ring(radius=0.15, at=(0.3, 0.2)):
    return (np.stack([np.cos(ROUND), np.sin(ROUND)], axis=-1) * radius + at).tolist()


def tell(pad, **content):
    pad.plane._handle_custom_msg(content, [])


@pytest.fixture
def pad():
    pad = DrawingPad(slot=None)
    yield pad
    pad.close()


@pytest.mark.parametrize("side", SIDES)
def test_a_stroke_is_the_path_of_the_effector_in_the_plane_of_the_picture(pad, side):
    pad.controls["plane"].value = side
    depth = pad.panel.values["depth"]
    tell(pad, stroke=ring())
    gait = pad.session.gait
    assert (gait.name, gait.period) == ("drawn", pytest.approx(2))
    hand = gait.names.index("hand.l")
    places = gait.targets[:, hand]
    assert np.ptp(gait.targets[:, :hand], axis=0).max() == 0  # the others stay
    assert places @ pad.axes[:, 2] == pytest.approx(depth)
    far = np.linalg.norm(pad.seen(places) - [0.3, 0.2], axis=-1)
    assert far == pytest.approx(0.15, abs=0.02)
    assert pad.status.wrong == ""


def test_the_plane_shows_what_stands_there(pad):
    tree, effectors = pad.figure
    s = locate(forward(tree, tree.rest), effectors)[3]
    pad.controls["plane"].value = "front"
    assert pad.place(pad.seen(s))[:2] == pytest.approx(s[:2])
    tips = [line["points"][-1] for line in pad.plane.lines]
    assert any(np.allclose(tip, pad.seen(s)) for tip in tips)


def test_points_are_set_taken_back_and_gone_along(pad):
    corners = [[0.2, 0.1], [0.4, 0.1], [0.4, 0.3], [0.9, 0.9]]
    for corner in corners:
        tell(pad, point=corner)
    tell(pad, back=True)
    assert pad.status.said == "3 points."
    assert pad.session.gait.name == "walking"
    pad.controls["along"].click()
    assert pad.session.gait.name == "drawn"
    assert pad.session.targets[3] == pytest.approx(pad.place(np.array(corners[0])))
    tell(pad, stroke=[[0.1, 0.1], [0.101, 0.1]])  # a click is a point, too
    assert pad.status.said.startswith("4 points at x")
    tell(pad, stroke=ring())
    tell(pad, back=True)
    assert len(pad.points) == 0


def test_what_is_out_of_reach_is_said_and_drawn(pad):
    pad.controls["plane"].value = "front"
    tell(pad, stroke=ring())
    assert pad.status.said.endswith("All of it is within reach.")
    assert not any(line["dashes"] for line in pad.plane.lines)
    tell(pad, stroke=ring(0.8))
    assert "of it is out of reach, by up to" in pad.status.said
    assert any(line["dashes"] for line in pad.plane.lines)
    assert pad.status.said.partition(". ")[2] in pad.plane.alt


def test_each_stroke_is_a_change_and_undo_shows_the_one_before(pad):
    tell(pad, stroke=ring(0.1))
    tell(pad, stroke=ring(0.2))
    assert [str(e) for e in pad.session.events] == 2 * ["gait: motion drawn"]
    pad.session.undo()
    pad.agree()
    far = np.linalg.norm(pad.seen(pad.points) - [0.3, 0.2], axis=-1)
    assert far == pytest.approx(0.1, abs=0.02)
    pad.session.undo()
    assert pad.session.gait.name == "walking"


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ({"stroke": [[0, "a"]]}, "what was drawn"),
        ({"stroke": [[0, 0, 0], [1, 1, 1]]}, "points"),
        ({"stroke": [[0, None], [1, 1]]}, "drawn"),
        ({}, "drawn"),
        ({"stroke": []}, "points"),
    ],
)
def test_nonsense_from_a_page_is_refused_in_a_sentence(pad, content, words):
    tell(pad, **content)
    assert words in pad.status.wrong
    tell(pad, stroke=ring())
    assert pad.status.wrong == ""


def test_one_point_is_no_curve(pad):
    pad.controls["along"].click()
    assert "two points or more" in pad.status.wrong
    tell(pad, point=[9e9, 0])  # beyond the edge
    assert abs(pad.points).max() < 3


@pytest.mark.parametrize(
    "figure", [figures.planar_arm(3), figures.planar_arm([4e-4, 4e-4, 2e-4]), figures.walker()]
)
def test_any_body_has_a_plane(figure):
    pad = DrawingPad(Session(figure), slot=None)
    half = pad.plane.half
    tell(pad, stroke=(half * np.array(ring(0.2, (0.2, 0.2)))).tolist())
    assert pad.status.wrong == ""
    assert pad.session.gait.name == "drawn"
    pad.session.tick()
    pad.close()


def test_another_effector_and_another_time():
    with pytest.raises(LookupError, match=r"did you mean 'hand\.[lr]'"):
        DrawingPad(effector="hadn.l", slot=None)
    taken = []
    pad = DrawingPad(effector="foot.l", take=taken.append, slot=None)
    tell(pad, stroke=ring())
    assert taken == [pad.motion]
    assert pad.motion.names[np.ptp(pad.motion.targets, axis=0).max(axis=-1).argmax()] == "foot.l"
    pad.close()


def test_a_player_goes_along_what_is_drawn_and_offers_it():
    player = GaitPlayer(pad=True, slot=None)
    tell(player.motion.pad, stroke=ring())
    assert player.controls["motion"].value == "drawn"
    assert player.controls["speed"].disabled
    player.controls["seconds"].value = 4.0
    assert player.session.gait.period == pytest.approx(4)
    player.controls["motion"].value = "walking"
    assert not player.controls["speed"].disabled
    player.controls["motion"].value = "drawn"
    assert player.session.gait.period == pytest.approx(4)
    player.step()
    assert player.status.wrong == ""
    player.close()
