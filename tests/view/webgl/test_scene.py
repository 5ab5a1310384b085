"""Both renderers, without a page: what they are told, what they send, what they leave behind."""

import inspect
import io

import numpy as np
import pytest
import pythreejs as three
from ipywidgets.widgets.widget import _instances
from PIL import Image

from ikteach.body import figures, forward, jacobian, locate
from ikteach.body.rotation import transforms
from ikteach.motion.reachable import annulus
from ikteach.solvers.singularity import ellipsoid
from ikteach.view import Scene, StillScene
from ikteach.view.stage.forms import Ball
from ikteach.view.stage.layer import Layer, upright
from ikteach.view.stage.layers import BONES, LAYERS
from ikteach.view.stage.stage import CAMERAS, Stage, View, picture_axes
from ikteach.view.stage.trails import Prints, Trail
from ikteach.view.stage.views import VIEWS, tiles
from ikteach.view.webgl.cameras import looking, quaternion

TREE, EFFECTORS = figures.human()
THETA = np.clip(0.3, TREE.lower, TREE.upper)
FRAMES = forward(TREE, THETA)
HERE = locate(FRAMES, EFFECTORS)
TARGETS = HERE + [0.1, 0.05, 0]
J = jacobian(TREE, FRAMES, EFFECTORS)[6:9]
DRAWN = {
    "effector": 2, "columns": J, "ellipsoid": ellipsoid(J), "reach": [((0.2, 0.4, 0), 0.1, 0.7)],
    "skeletons": [[[(0, 0, 0), (0, 0.5, 0)], [(0, 0.5, 0), (0.4, 0.5, 0)]]],
}  # fmt: skip


@pytest.fixture
def make():
    """Make scenes, and close them after the test."""
    made = []

    def one(kind=Scene, figure=(TREE, EFFECTORS), **options):
        made.append(kind(*figure, **options))
        return made[-1]

    yield one
    for scene in made:
        scene.close()


def message(scene, theta=THETA, targets=TARGETS, **options):
    """The rows (rows, 3, 4) of the frame that `show` sends."""
    sent = []
    scene.driver.send = lambda content, buffers: sent.append((content, buffers))
    scene.show(theta, targets, **options)
    ((content, (numbers,)),) = sent
    matrices = np.frombuffer(numbers, "<f4").reshape(-1, 4, 3).swapaxes(1, 2)
    assert len(matrices) == scene.driver.rows
    return content, matrices


def test_a_lone_human_sends_what_moves_and_no_more(make):
    scene = make()
    content, matrices = message(scene, floor=-0.9, advance=0.7, change=5)
    assert content == {"frame": 0, "change": 5}
    floor, targets, ground, joints, gaps = np.split(matrices, [1, 5, 6, 26])
    assert len(gaps) == 4
    assert ground[0] == pytest.approx(np.eye(3, 4))
    assert floor[0, :, 3] == pytest.approx([0, -0.9, -0.2])
    assert joints == pytest.approx(transforms(FRAMES.orientations, FRAMES.positions), abs=1e-6)
    assert targets[:, :, 3] == pytest.approx(TARGETS, abs=1e-6)
    assert gaps[:, :, 3] == pytest.approx(HERE, abs=1e-6)
    assert gaps[:, :, 1] == pytest.approx(TARGETS - HERE, abs=1e-6)


@pytest.mark.parametrize("names", [[""], ["a", "b", "c", "d"]])
def test_what_is_drawn_takes_few_calls_and_few_models(make, names):
    before = len(_instances)
    scene = make(names=names)
    for layer in LAYERS:
        scene.switch(layer)
    drawn = [node for node in list(_instances.values())[before:]
             if isinstance(node, three.Mesh | three.Line | three.Sprite)]  # fmt: skip
    assert len(drawn) <= 13 + 12 * len(names)
    assert len(_instances) - before < 120 + 30 * len(names)


def test_a_body_is_one_mesh_whose_parts_follow_their_joints(make):
    scene = make()
    # Targets, then the body, then the rods from effectors to targets.
    (body, runs), _ = list(zip(scene.driver.nodes, scene.driver.plan, strict=True))[-2:]
    row, points = np.transpose(runs)
    shape = body.geometry.attributes["position"].array
    assert points.sum() == len(shape)
    _, rest = message(scene, TREE.rest)
    assert rest[row, :, :3] == pytest.approx(np.broadcast_to(np.eye(3), (len(row), 3, 3)))
    assert 1.7 < np.ptp(shape[:, 1] + np.repeat(rest[row, 1, 3], points)) < 1.95  # [m], a human
    elbow = TREE.index("elbow.l")
    bent = TREE.rest.copy()
    bent[elbow] = TREE.upper[elbow]
    _, rows = message(scene, bent)
    assert set(row[(rows[row] != rest[row]).any(axis=(1, 2))]) == {6 + elbow}


def test_a_new_page_is_shown_what_was_shown_last(make):
    scene = make()
    _, before = message(scene, floor=-0.9)
    sent = []
    scene.driver.send = lambda content, buffers: sent.append(buffers[0])
    scene.driver._hear(None, {"drawn": 0}, [])
    assert sent == []
    scene.driver._hear(None, {"hello": True}, [])
    assert np.frombuffer(sent[0], "<f4").reshape(-1, 4, 3).swapaxes(1, 2) == pytest.approx(before)


@pytest.mark.parametrize("layer", LAYERS)
def test_a_layer_costs_nothing_before_it_is_wanted(make, layer):
    scene = make()
    plain = scene.driver.rows
    assert not any(scene.layers.values())
    scene.switch(layer)
    assert scene.layers[layer]
    assert (scene.driver.rows > plain) == (layer != "world axes")  # which never move
    _, on = message(scene, **DRAWN)
    assert np.isfinite(on).all()
    scene.switch(layer, False)
    assert not scene.layers[layer]
    _, off = message(scene, **DRAWN)
    assert off == pytest.approx(on[:plain])
    made = len(_instances)
    scene.switch(layer)
    assert len(_instances) == made


def test_columns_and_ellipsoid_stand_at_the_effector(make):
    scene = make()
    plain = scene.driver.rows
    scene.switch("columns of J")
    scene.switch("ellipsoid")
    _, matrices = message(scene, **DRAWN)
    arrows, ball = matrices[plain:-1], matrices[-1]
    moving = np.linalg.norm(J, axis=0) > 1e-6
    assert moving.sum() == 6  # of 20 joints: two of the spine, four of the arm
    assert arrows[moving][:, :, 1] == pytest.approx(0.5 * J.T[moving], abs=1e-6)
    assert arrows[moving][:, :, 3] == pytest.approx(np.tile(HERE[2], (6, 1)), abs=1e-6)
    assert (arrows[~moving][:, 1, 3] < -100).all()
    assert ball[:, :3] @ ball[:, :3].T == pytest.approx(0.25 * J @ J.T, abs=1e-5)
    assert ball[:, 3] == pytest.approx(HERE[2], abs=1e-6)


def test_a_flat_ellipsoid_can_still_be_drawn(make):
    scene = make()
    scene.switch("ellipsoid")
    flat = ellipsoid(np.diag([1.0, 0.5, 0.0]))
    _, matrices = message(scene, ellipsoid=flat)
    assert abs(np.linalg.det(matrices[-1][:, :3])) > 0


def test_several_figures_stand_side_by_side(make):
    scene = make(names=["a", "b", "c"], apart=1.0)
    theta = THETA * np.array([[0.0], [0.5], [1.0]])
    _, matrices = message(scene, theta, TARGETS)
    _, targets, grounds, joints, _ = np.split(matrices, [1, 13, 16, 76])
    assert grounds[:, 0, 3].tolist() == [-1, 0, 1]
    for f, x in enumerate((-1, 0, 1)):
        p = forward(TREE, theta[f]).positions + [x, 0, 0]
        assert joints[20 * f : 20 * f + 20, :, 3] == pytest.approx(p, abs=1e-6)
        assert targets[4 * f : 4 * f + 4, :, 3] == pytest.approx(TARGETS + [x, 0, 0], abs=1e-6)


def test_overlaid_figures_share_the_targets(make):
    scene = make(names=["a", "b"], apart=0)
    assert len(scene.targets) == 4
    _, matrices = message(scene)
    assert len(matrices) == 2 + 1 + 40 + 4 + 8


def test_a_planar_figure_stands_before_a_wall_and_is_seen_from_the_front(make):
    scene = make(figure=figures.planar_arm(3))
    _, matrices = message(scene, np.zeros(3), np.array([[2.0, 1.0, 0.0]]))
    wall = matrices[0]
    assert wall[:, 1].tolist() == [0, 0, 1]  # what was up points to the eye
    assert wall[2, 3] < 0
    x, y, z = scene.camera.position
    assert (x, y) == (0, 0)
    assert z * np.tan(np.radians(22.5)) >= 3.1  # an arm of 3 m fits, stretched any way


@pytest.mark.parametrize("kind", [Scene, StillScene])
def test_what_does_not_fit_is_refused_in_words(make, kind):
    scene = make(kind)
    with pytest.raises(ValueError, match=r"targets must have the shape \(4, 3\)"):
        scene.show(THETA, TARGETS[:3])
    with pytest.raises(ValueError, match="theta must have the shape"):
        scene.show(THETA[:4], TARGETS)
    with pytest.raises(ValueError, match="columns must have the shape"):
        scene.show(THETA, TARGETS, columns=np.zeros((12, 20)))
    with pytest.raises(ValueError, match="effector must be from 0 to 3, not 4"):
        scene.show(THETA, TARGETS, effector=4)
    with pytest.raises(LookupError, match="no layer 'trail'; did you mean 'trails'"):
        scene.switch("trail")
    with pytest.raises(LookupError, match="no camera 'fron'; did you mean 'front'"):
        scene.look_from("fron")
    with pytest.raises(ValueError, match="at least one figure"):
        kind(TREE, EFFECTORS, names=[])


@pytest.mark.parametrize("kind", [Scene, StillScene])
@pytest.mark.parametrize(
    ("told", "sentence"),
    [
        ({"theta": "up"}, "theta must be made of numbers, not 'up'"),
        ({"theta": np.full(20, np.nan)}, "theta must be finite, not nan"),
        ({"targets": [["a", 1, 2]] * 4}, "targets must be made of numbers"),
        ({"targets": TARGETS + np.inf}, "targets must be finite, not inf"),
        ({"floor": "low"}, "floor must be made of numbers, not 'low'"),
        ({"advance": np.nan}, "advance must be one number, and finite, not nan"),
        ({"columns": J * np.nan}, "columns must be finite, not nan"),
        ({"effector": "hand.l"}, "effector must be from 0 to 3, not 'hand.l'"),
    ],
)
def test_what_is_no_number_is_refused_in_words(make, kind, told, sentence):
    scene = make(kind)
    with pytest.raises(ValueError, match=sentence):
        scene.show(**{"theta": THETA, "targets": TARGETS} | told)
    with pytest.raises(TypeError, match="no option of show 'colums'; did you mean 'columns'"):
        scene.show(THETA, TARGETS, colums=J)


@pytest.mark.parametrize("kind", [Scene, StillScene])
def test_a_chain_without_end_has_no_surface(make, kind):
    scene = make(kind)
    scene.switch("reach")
    scene.show(THETA, TARGETS, reach=[((0, 0, 0), 0.0, np.inf), ((0, 0, 0), np.nan, 0.5)])
    layer = LAYERS["reach"](scene.stage)
    now = scene.stage.now(THETA, TARGETS, reach=[((0, 0, 0), 0.0, np.inf), ((0, 0, 0), 0.1, 0.5)])
    assert (~np.isnan(layer.place(now)[:, 0, 3])).tolist() == [False, False, True, True] + [
        False
    ] * 4


class Balloon(Layer):
    """A ball over the head."""

    name = "balloon"

    def build(self):
        self.add([Ball((0, 0, 0), (0.1, 0.1, 0.1))] * len(self.stage), ["#ff0000"])

    def place(self, now):
        return upright(now.positions[:, 0] + self.stage.places + [0, 1, 0])


@pytest.mark.parametrize("kind", [Scene, StillScene])
def test_a_new_layer_is_one_class(make, kind, monkeypatch):
    monkeypatch.setitem(LAYERS, "balloon", Balloon)
    scene = make(kind)
    scene.show(THETA, TARGETS)
    scene.switch("balloon")
    assert scene.layers["balloon"]
    png = scene.png if kind is StillScene else scene.still().png
    pixels = np.asarray(Image.open(io.BytesIO(png)).convert("RGB")).astype(int)
    assert (pixels[..., 0] - pixels[..., 1:].max(axis=-1) > 120).sum() > 100


@pytest.mark.parametrize("kind", [Scene, StillScene])
def test_both_renderers_are_views(make, kind):
    scene = make(kind)
    assert scene.widget is not None
    assert scene.stage.unit == 1
    assert scene.dark is False
    assert list(scene.layers) == list(LAYERS)
    for name, method in inspect.getmembers(View, inspect.isfunction):
        if not name.startswith("_"):
            assert inspect.signature(getattr(kind, name)) == inspect.signature(method), name


def test_closing_frees_every_widget(make):
    before = set(_instances)
    scene = make(names=["a", "b"])
    for layer in LAYERS:
        scene.switch(layer)
    scene.dark = True
    scene.cameras.orthographic = True
    scene.views = 4
    scene.show(THETA, TARGETS, **DRAWN)
    scene.still()
    assert len(_instances) > len(before) + 60
    scene.close()
    assert set(_instances) - before == set()


def test_the_output_of_a_cell_has_a_picture_too(make):
    scene = make(dark=True)
    scene.show(THETA, TARGETS)
    bundle = scene._repr_mimebundle_()
    picture = Image.open(io.BytesIO(bundle["image/png"]))
    assert picture.size == (540, 480)
    assert np.median(np.asarray(picture.convert("L"))) < 40
    assert "human" in bundle["text/plain"]
    assert "application/vnd.jupyter.widget-view+json" in bundle


@pytest.mark.parametrize("layer", LAYERS)
def test_the_still_renderer_draws_every_layer(make, layer):
    still = make(StillScene)
    for turn in np.linspace(0, 7, 12):
        still.show(TREE.rest + 0.4 * np.sin(turn), TARGETS, **DRAWN)
    plain = np.asarray(Image.open(io.BytesIO(still.png)).convert("RGB")).astype(int)
    still.switch(layer)
    layered = np.asarray(Image.open(io.BytesIO(still.png)).convert("RGB")).astype(int)
    assert (abs(plain - layered).max(axis=-1) > 24).mean() > 0.0002
    assert layer in still.alt
    assert still.widget.png == still.png


def test_the_still_says_how_far_everything_is():
    still = StillScene(TREE, EFFECTORS)
    still.show(THETA, HERE + [0.03, 0.04, 0])
    assert still.alt.count("5.0 cm") == 4


@pytest.mark.parametrize("side", CAMERAS)
def test_the_camera_looks_at_the_figure(make, side):
    scene = make()
    scene.look_from(side)
    eye = np.array(scene.camera.position)
    back = eye - scene.stage.extent.centre
    axes = picture_axes(back)
    assert axes.T @ axes == pytest.approx(np.eye(3))
    assert np.cross(axes[:, 0], axes[:, 1]) == pytest.approx(axes[:, 2])
    x, y, z, w = scene.camera.quaternion
    away = [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)]
    assert away == pytest.approx(back / np.linalg.norm(back))


def test_quaternions_turn_as_their_matrices():
    for way in ([0, 3, 0.0], [0, 0, -2.0], [1, 2, 3.0]):
        x, y, z, w = looking(np.array(way), np.zeros(3))
        assert x * x + y * y + z * z + w * w == pytest.approx(1)
    assert np.abs(quaternion(np.diag([1.0, -1, -1]))) == pytest.approx([1, 0, 0, 0])


def test_turning_keeps_its_distance(make):
    scene = make()
    distance = scene.cameras.distance
    scene.cameras.turn(30, 20)
    assert scene.cameras.angles == pytest.approx((30, 20))
    assert scene.cameras.distance == pytest.approx(distance)
    scene.cameras.orthographic = True
    assert scene.renderer.camera is scene.cameras.parallel
    assert scene.cameras.angles == pytest.approx((30, 20))
    assert scene.renderer.controls[0].controlling is scene.cameras.parallel
    scene.cameras.turn(-40, 10, 3.0)
    scene.cameras.orthographic = False
    assert scene.cameras.angles == pytest.approx((-40, 10))
    assert scene.cameras.distance == pytest.approx(3)


@pytest.mark.parametrize("count", VIEWS)
def test_several_views_look_from_their_sides(make, count):
    scene = make()
    scene.views = count
    names = [pane["name"] for pane in scene.driver.panes]
    cameras = [one.controlling for one in scene.renderer.controls]
    assert names == list(VIEWS[count])
    assert cameras[0] is scene.renderer.camera is scene.camera
    centre = scene.stage.extent.centre
    for name, camera in zip(names[1:], cameras[1:], strict=True):
        back = np.array(camera.position) - centre
        assert np.cross(back, CAMERAS[name]) == pytest.approx(np.zeros(3), abs=1e-9)
        assert back @ CAMERAS[name] > 0
        assert camera in scene.scene.children  # which has it drawn again when it turns
    scene.views = 1
    assert len(scene.renderer.controls) == len(scene.driver.panes) == 1


def test_a_recorded_skeleton_has_its_longest_bones_and_hangs_on_its_figure():
    stage = Stage(TREE, EFFECTORS, ["a", "b"])
    layer = LAYERS["recorded skeleton"](stage)
    start = np.random.default_rng(0).normal(size=(BONES + 9, 3))
    length = np.arange(BONES + 9) / 100  # the first has none
    bones = np.stack([start, start + length[:, None] * [0, 1, 0]], axis=1)
    now = stage.now(THETA, TARGETS, skeletons=[None, bones])
    rows = layer.place(now).reshape(2, BONES, 3, 4)
    assert np.isnan(rows[0]).all()
    along = rows[1, :, :, 1]
    assert sorted(along[:, 1]) == pytest.approx(length[-BONES:])
    assert rows[1, 0, :, 3] == pytest.approx(start[-1] + stage.places[1])
    few = layer.place(stage.now(THETA, TARGETS, skeletons=[bones[:3]])).reshape(2, BONES, 3, 4)
    assert np.isfinite(few[0, :, 0, 0]).sum() == 2
    wrong = {"shape": [bones[0]], "finite": [bones * np.nan], "2 figures": [None] * 3}
    for words, skeletons in wrong.items():
        with pytest.raises(ValueError, match=words):
            stage.now(THETA, TARGETS, skeletons=skeletons)


def test_a_key_goes_through_the_numbers_of_views_and_one_puts_a_view_back(make):
    scene, seen = make(), []
    for _ in range(4):
        seen.append(scene.views)
        scene.driver.on_act("v")
    assert seen == [1, 2, 4, 1]
    scene.views, scene.driver.view = 4, 2
    side = scene.renderer.controls[2].controlling
    was, free = side.position, scene.camera.position
    side.position, scene.camera.position = (1.0, 2, 3), (3.0, 2, 1)
    scene.driver.on_act("0")
    assert side.position == was
    assert scene.camera.position == (3, 2, 1)
    scene.driver.view = 0
    scene.driver.on_act("0")
    assert scene.camera.position == free


def test_there_are_one_two_or_four_views_and_of_a_plane_one(make):
    scene = make()
    for count in (3, 0, True, "2"):
        with pytest.raises(ValueError, match="number of views"):
            scene.views = count
    assert scene.views == 1
    plane = make(figure=figures.planar_arm(3))
    assert not plane.driver.splits
    with pytest.raises(ValueError, match="number of views"):
        plane.views = 2


@pytest.mark.parametrize("kind", [Scene, StillScene])
@pytest.mark.parametrize("count", VIEWS)
def test_a_still_has_every_view(make, kind, count):
    scene = make(kind)
    scene.views = count
    scene.show(THETA, TARGETS)
    picture = scene.png if kind is StillScene else scene.still().png
    image = np.asarray(Image.open(io.BytesIO(picture)).convert("RGB")).astype(int)
    assert image.shape == (480, 540, 3)
    columns, rows = tiles(count, 540 / 480, 1.0)
    shirt = abs(image - [95, 143, 180]).max(axis=-1) < 60
    parts = [part.sum() for row in np.split(shirt, rows) for part in np.split(row, columns, axis=1)]
    assert len(parts) == count
    assert min(parts) > 200


def test_a_trail_leaves_a_mark_each_gap_and_forgets_the_oldest():
    trail = Trail((1, 1), 4, 0.1)
    for z in np.arange(0, 1.01, 0.04):
        marks = trail.pass_through(np.array([[[0.0, 0.0, z]]]), advance=0.0)
    assert np.diff(np.sort(marks[0, 0, :, 2])) == pytest.approx(0.12)
    assert marks[0, 0, :, 2].max() >= 0.9
    later = trail.pass_through(np.array([[[0.0, 0.0, 1.0]]]), advance=0.02)
    assert later[0, 0, :, 2] == pytest.approx(marks[0, 0, :, 2] - 0.02)  # the ground went back
    trail.clear()
    assert np.isnan(trail.marks).all()


def test_a_foot_leaves_a_print_where_it_stops_going_forward():
    prints = Prints((1, 1), 3)
    for t in np.linspace(0, 4 * np.pi, 200):
        marks = prints.pass_through(np.array([[[0.1, -1.0, 0.4 * np.sin(t)]]]), 0.0)
    found = marks[0, 0][~np.isnan(marks[0, 0, :, 2])]
    assert found[:, 2] == pytest.approx([0.4, 0.4], abs=1e-3)


@pytest.mark.parametrize("lengths", [[1, 1, 1], [2, 0.5, 0.4], [0.2, 3.0, 0.5]])
def test_a_chain_reaches_between_its_two_circles(lengths):
    tree, effectors = figures.planar_arm(lengths)
    centre, inner, outer = annulus(tree, effectors, 0)
    straight = locate(forward(tree, np.zeros(3)), effectors)[0]
    assert np.linalg.norm(straight - centre) == pytest.approx(outer)
    theta = np.random.default_rng(0).uniform(-np.pi, np.pi, (4000, 3))
    far = np.linalg.norm(locate(forward(tree, theta), effectors)[:, 0] - centre, axis=-1)
    assert inner <= far.min() + 1e-9 <= inner + 0.1
    assert far.max() <= outer + 1e-9


def test_the_reach_of_the_humans_hand_holds_every_pose():
    centre, inner, outer = annulus(TREE, EFFECTORS, 3)
    theta = np.random.default_rng(1).uniform(TREE.lower, TREE.upper, (2000, len(TREE)))
    far = np.linalg.norm(locate(forward(TREE, theta), EFFECTORS)[:, 3] - centre, axis=-1)
    assert inner <= far.min()
    assert far.max() <= outer
