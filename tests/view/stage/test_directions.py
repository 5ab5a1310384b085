"""Directions in a scene: where they are drawn, what is said of them, what they leave alone."""

import numpy as np
import pytest

from ikteach.body import Effectors, figures, forward, locate
from ikteach.motion.live.session import Session
from ikteach.view import Scene, StillScene
from ikteach.view.charts import outline
from ikteach.view.raster.drawing import Drawing
from ikteach.view.stage.basics import Figures, Gaps, Pointers, TargetMarks
from ikteach.view.stage.layers import LAYERS
from ikteach.view.stage.lengths import misses, units
from ikteach.view.stage.stage import Stage, angle
from ikteach.view.stage.trails import feet
from ikteach.view.tools.replay import Replay
from ikteach.view.tools.runs import error_words

WALKER = figures.walker()
THETA = WALKER.tree.rest + np.r_[0.4, 0.1, 0.7, np.full(len(WALKER.tree) - 3, 0.1)]
FRAMES = forward(WALKER.tree, THETA)
HERE = locate(FRAMES, WALKER.effectors)
ENDS = WALKER.effectors
WAYS = np.flatnonzero(WALKER.effectors.w == 0)
JOINT = FRAMES.positions[WALKER.effectors.joints[WAYS]]


def with_directions(figure, **directions):
    tree, ends = figure
    points = {
        name: (tree.names[joint], offset)
        for name, joint, offset in zip(ends.names, ends.joints, ends.offsets.tolist(), strict=True)
    }
    return figures.Figure(tree, Effectors.of(tree, points, directions=directions))


ARM = with_directions(figures.planar_arm(2), gaze=("joint2", (0, 0.5, 0)))


def test_a_direction_begins_at_its_joint():
    now = Stage(*WALKER).now(THETA, HERE)
    np.testing.assert_allclose(now.effectors[0, WAYS], JOINT + HERE[WAYS])
    np.testing.assert_allclose(now.targets[0, WAYS], JOINT + HERE[WAYS])
    points = WALKER.effectors.w == 1
    np.testing.assert_array_equal(now.effectors[0, points], HERE[points])
    np.testing.assert_array_equal(now.targets[0, points], HERE[points])


@pytest.mark.parametrize("apart", [None, 0])
def test_rods_and_arrows_of_every_figure_are_at_its_joints(apart):
    stage = Stage(*WALKER, names=("a", "b"), apart=apart)
    poses = np.stack([THETA, WALKER.tree.rest])
    targets = HERE.copy()
    targets[WAYS] = targets[WAYS[::-1]]
    now = stage.now(poses, targets)
    joints = forward(WALKER.tree, poses).positions[:, WALKER.effectors.joints[WAYS]]
    begin = joints + stage.places[:, None]
    rods = Pointers(stage).place(now).reshape(2, len(WAYS), 3, 4)
    np.testing.assert_allclose(rods[..., 3], begin)
    ways = locate(forward(WALKER.tree, poses), WALKER.effectors)[:, WAYS]
    np.testing.assert_allclose(rods[..., 1], ways)
    marks = TargetMarks(stage).place(now).reshape(2, -1, 3, 4)
    np.testing.assert_allclose(marks[:, WAYS][..., 3], begin)
    np.testing.assert_allclose(marks[:, WAYS][..., 1], targets[None, WAYS].repeat(2, axis=0))
    gaps = Gaps(stage).place(now).reshape(2, -1, 3, 4)[:, WAYS]
    np.testing.assert_allclose(gaps[..., 3], begin + ways)
    hidden = np.isnan(np.delete(marks[1], WAYS, axis=0)).all()
    assert hidden == (apart == 0)  # overlaid figures share the targets that are points


def test_arrows_are_told_by_their_shape():
    meshes = TargetMarks(Stage(*WALKER)).meshes
    forms = [type(piece.form).__name__ for mesh in meshes for piece in mesh.pieces]
    assert forms == ["Ball", "Ball", "Ball", "Box", "Box", "Arrow", "Arrow"]


@pytest.mark.parametrize("phi", [0.0, 1e-9, 1.0, np.pi / 2, 3.0, np.pi])
def test_an_angle_is_said_beside_the_metres(phi):
    targets = HERE + [0.03, 0.04, 0]
    up, ahead = HERE[WAYS] / np.linalg.norm(HERE[WAYS], axis=-1, keepdims=True)
    across = np.cross(np.cross(up, ahead), HERE[WAYS])
    targets[WAYS] = np.cos(phi) * HERE[WAYS] + np.sin(phi) * across
    stage = Stage(*WALKER)
    now = stage.now(THETA, targets)
    assert angle(HERE[WAYS], targets[WAYS]) == pytest.approx([phi, phi], abs=1e-7)
    (row,) = stage.far(now)
    assert row == ["5.0 cm"] * 5 + [f"{np.degrees(phi):.1f}°"] * 2
    still = StillScene(*WALKER)
    still.show(THETA, targets)
    assert f"pelvis.up {np.degrees(phi):.1f}°" in still.alt
    still.close()


def test_the_words_tell_points_from_directions():
    assert Stage(*ARM).words == "A planar figure with targets for hand and directions for gaze."
    alone = Effectors.of(ARM.tree, {}, directions={"gaze": ("joint1", (0, 1, 0))})
    assert Stage(ARM.tree, alone).words == "A planar figure with directions for gaze."


@pytest.mark.parametrize("length", [0.01, 1.0, 300.0])
def test_floor_and_extent_do_not_count_a_direction(length):
    tree, points = figures.planar_arm(3)
    both = with_directions((tree, points), gaze=("joint3", (0, -length, 0)))
    one, other = Stage(tree, points), Stage(*both)
    assert one.floor == other.floor
    assert one.extent.radius == other.extent.radius
    np.testing.assert_array_equal(one.extent.centre, other.extent.centre)
    np.testing.assert_array_equal(outline(tree, points, tree.rest), outline(*both, tree.rest))


def test_a_direction_leaves_no_footprint():
    tree, ends = figures.human()
    both = with_directions((tree, ends), **{"foot.l.ahead": ("ankle.l", (0, 0, 0.1))})
    assert feet(both.effectors) == feet(ends)


def test_layers_at_an_effector_are_at_the_tip():
    stage = Stage(*WALKER)
    columns = np.ones((3, len(WALKER.tree)))
    which = int(WAYS[1])
    ball = (np.eye(3), np.ones(3))
    reach = [((0, 0, 0), 0.1, 0.3)]
    now = stage.now(THETA, HERE, effector=which, columns=columns, ellipsoid=ball, reach=reach)
    tip = JOINT[1] + HERE[which]
    begin = LAYERS["columns of J"](stage).place(now)[..., 3]
    np.testing.assert_allclose(begin, np.broadcast_to(tip, begin.shape))
    np.testing.assert_allclose(LAYERS["ellipsoid"](stage).place(now)[0, :, 3], tip)
    np.testing.assert_allclose(LAYERS["reach"](stage).place(now)[0, :, 3], JOINT[1])
    trail = LAYERS["trails"](stage)
    trail.note(now)
    marks = trail.place(now).reshape(len(HERE), -1, 3, 4)[which, :, :, 3]
    np.testing.assert_allclose(marks[~np.isnan(marks[:, 0])], [tip])


@pytest.mark.parametrize("phi", [0.0, 1e-6, 1.0, np.pi])
def test_the_error_of_a_direction_is_read_as_its_angle(phi):
    ends = ARM.effectors
    chord = 2 * 0.5 * np.sin(phi / 2)
    read = misses(ends, np.array([[0.3, chord]]))
    np.testing.assert_allclose(read, [[0.3, phi]], atol=1e-7)
    point, way = units(*ARM)
    assert (point(0.3), way(read[0, 1])) == ("30.0 cm", f"{np.degrees(phi):.1f}°")


def test_a_run_tells_points_in_lengths_and_directions_in_degrees():
    session = Session(figure=WALKER)
    for _ in range(5):
        session.tick()
    run = session.log()
    error = run.error[:, 0]
    words = error_words(run, error)
    largest = np.degrees(misses(run.effectors, error)[:, WAYS[0]].max())
    assert f"at most {largest:.1f}° at" in words.split("pelvis.up")[1].split(";")[0]
    assert "°" not in words.split("pelvis.up")[0]
    replay = Replay(run)
    assert replay.rows.header[3:-1][-2:] == ["pelvis.up [°]", "pelvis.ahead [°]"]
    replay.close()


def test_a_direction_is_seen_through_the_body():
    stage = Stage(*WALKER)
    now = stage.now(WALKER.tree.rest, locate(forward(WALKER.tree, WALKER.tree.rest), ENDS))
    alone, body, both = (
        np.asarray(
            Drawing(stage, (320, 280), finer=1).picture([kind(stage) for kind in kinds], now)
        )
        for kinds in ([Pointers], [Figures], [Pointers, Figures])
    )
    here = (alone != Drawing(stage, (320, 280), finer=1).picture([], now)).any(axis=-1)
    assert here.sum() > 50
    np.testing.assert_array_equal(both[here], alone[here])
    assert (body[here] != alone[here]).any(axis=-1).mean() > 0.9
    np.testing.assert_array_equal(both[~here], body[~here])


def test_the_page_draws_a_direction_last_and_through_the_body():
    scene = Scene(*WALKER)
    arrows = [scene.targets[i] for i in WAYS]
    rods = [
        thing for one in scene._basics if one.layer.name == "directions" for thing in one.things
    ]
    assert len(rods) == 1
    for thing in [*arrows, *rods]:
        assert not thing.material.depthTest
        assert thing.material.transparent
        assert thing.renderOrder > 0
    assert all(scene.targets[i].material.depthTest for i in range(WAYS[0]))
    scene.close()
