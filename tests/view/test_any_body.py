"""The same picture of a body however it is told: in other units, elsewhere, under other names."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from metamorphic import BODY, Case, in_units
from numpy.testing import assert_allclose
from strategies import SEEDS, anybody, poses

from ikteach import Effectors, Joint, Tree, figures, forward, locate
from ikteach.view import Scene
from ikteach.view.raster.film import Film, Shot
from ikteach.view.stage.stage import CAMERAS, ROOM, Stage

SIZE = WIDTH, HEIGHT = 640, 480
TURN = np.array([[0.6, 0, 0.8], [0, 1, 0], [-0.8, 0, 0.6]])  # about the vertical
# The flesh of a human is not turned with its ground: then it is seen as rods.
ALONG = [change for change in BODY if change != "ground turned"]


def slides(*travels):
    """A body of slides, and at the end of them its tool."""
    joints = [
        Joint(f"s{i}", f"s{i - 1}" if i else None, axis=np.eye(3)[i], slide=True, lower=low,
              upper=high)
        for i, (low, high) in enumerate(travels)
    ]  # fmt: skip
    tree = Tree.of(joints)
    return figures.Figure(tree, Effectors.of(tree, {"tool": (tree.names[-1], (0, 0, 0))}))


def thing(*joints, at):
    tree = Tree.of(joints)
    return figures.Figure(tree, Effectors.of(tree, {"tool": (tree.names[-1], at)}))


KNOWN = {
    "human": figures.human(),
    "simulator": figures.simulator(),
    "planar_arm(3)": figures.planar_arm(3),
    "planar_arm in mm": figures.planar_arm([300, 300]),
    "planar_arm of 6 cm": figures.planar_arm([0.03, 0.03]),
    "planar_arm of 3 µm": figures.planar_arm([1e-6, 2e-6]),
    "planar_arm of 2,000 km": figures.planar_arm([1e6, 1e6]),
    "y_shape": figures.y_shape(),
    "double_y": figures.double_y(),
    "two slides": slides((0, 0.5), (0, 0.5)),
    "three slides": slides((-1, 0), (2, 9), (-1e-3, 0)),
    "far away": thing(
        Joint("a", None, (300, -50, 20), axis=(0, 1, 0)), Joint("b", "a", (0, 1, 0)), at=(1, 0, 0)
    ),
    "narrow": thing(Joint("a", lower=0, upper=1e-6), at=(1, 0, 0)),
}


def everything(tree, effectors, theta):
    frames = forward(tree, theta)
    return np.concatenate([frames.positions, locate(frames, effectors)], axis=-2)


def extremes(tree, rng, count=300):
    """The rest, and poses in which every joint stands at a limit or anywhere."""
    theta = poses(tree, rng, (count,))
    bounded = np.isfinite(tree.lower) & np.isfinite(tree.upper)
    corner = bounded & (rng.random(theta.shape) < 0.5)
    theta = np.where(corner, np.where(rng.random(theta.shape) < 0.5, tree.lower, tree.upper), theta)
    return np.concatenate([tree.rest[None], theta])


def through(camera, points, size=SIZE):
    """Pixels (..., 2) of points as three.js has them, and which lie between near and far (...)."""
    x, y, z, w = camera.quaternion
    turn = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )
    seen = (points - np.array(camera.position)) @ turn
    away = -seen[..., 2]
    tall = np.tan(np.radians(camera.fov / 2))
    flat = seen[..., :2] / away[..., None] / [tall * camera.aspect, tall]
    width, height = size
    between = (away > camera.near) & (away < camera.far)
    return (flat * [1, -1] + 1) / 2 * [width, height], between


def inside(pixels, size=SIZE):
    return ((pixels >= 0) & (pixels <= size)).all(axis=-1)


def projected(film, points):
    flat, away = film.drawing.eye.project(points)
    return flat / film.drawing.finer, away > 0.05  # its own near plane, in its own units


@pytest.fixture
def make():
    made = []

    def one(figure, **options):
        made.append(Scene(*figure, **{"width": WIDTH, "height": HEIGHT} | options))
        return made[-1]

    yield one
    for scene in made:
        scene.close()


@pytest.mark.parametrize("name", KNOWN)
@pytest.mark.parametrize("side", [None, *CAMERAS])
def test_every_pose_is_in_the_picture(make, name, side):
    tree, effectors = figure = KNOWN[name]
    points = everything(tree, effectors, extremes(tree, np.random.default_rng(0)))
    scene = make(figure)
    if side:
        scene.look_from(side)
    pixels, between = through(scene.camera, points)
    assert between.all()
    assert inside(pixels).all()
    film = Film(tree, effectors, size=SIZE, side=side)
    pixels, between = projected(film, points)
    assert between.all()
    assert inside(pixels).all()
    if side is None and name != "narrow":  # and it is not looked at from the moon
        assert np.ptp(pixels, axis=(0, 1)).max() > 0.4 * HEIGHT


@pytest.mark.parametrize("size", [(200, 480), (960, 400), (480, 200), (300, 300)])
@pytest.mark.parametrize("names", [[""], list("abcd")])
def test_in_pictures_of_any_shape_and_side_by_side(make, size, names):
    for name in ("human", "planar_arm(3)", "y_shape", "far away"):
        tree, effectors = figure = KNOWN[name]
        points = everything(tree, effectors, extremes(tree, np.random.default_rng(1)))
        scene = make(figure, names=names, width=size[0], height=size[1])
        for place in scene.stage.places:
            pixels, between = through(scene.camera, points + place, size)
            assert between.all()
            assert inside(pixels, size).all()


@given(anybody(limits=True), SEEDS, st.sampled_from(ALONG), st.sampled_from(list(CAMERAS)))
def test_the_same_picture_however_the_body_is_told(figure, seed, change, side):
    rng = np.random.default_rng(seed)
    theta = poses(figure.tree, rng)
    s = locate(forward(figure.tree, theta), figure.effectors)
    one, other, along = BODY[change](Case(*figure, theta, s), rng)
    films = [Film(*case[:2], size=SIZE, side=side) for case in (one, other)]
    (flat, seen), (moved, seen_too) = (
        projected(film, case.targets) for film, case in zip(films, (one, other), strict=True)
    )
    assert (seen & seen_too[np.argsort(along.effectors)]).all()
    assert_allclose(moved, flat[along.effectors], atol=0.5)
    stages = [film.stage for film in films]
    assert stages[1].unit == pytest.approx(along.length * stages[0].unit, rel=2e-3)
    assert (stages[0].normal is None) == (stages[1].normal is None)


@given(anybody(limits=True), SEEDS)
def test_a_body_that_is_turned_is_seen_so_by_a_camera_that_is(figure, seed):
    """About any axis for one that is looked at in its plane, else about the vertical."""
    theta = poses(figure.tree, np.random.default_rng(seed))
    stage = Stage(*figure)
    joints = [
        Joint(
            name, figure.tree.names[p] if p >= 0 else None, TURN @ offset, TURN @ axis, bool(slide),
            low, high, rest,
        )
        for name, p, offset, axis, slide, low, high, rest in zip(
            figure.tree.names, figure.tree.parents, figure.tree.offsets, figure.tree.axes,
            figure.tree.slide, figure.tree.lower, figure.tree.upper, figure.tree.rest, strict=True,
        )
    ]  # fmt: skip
    tree = Tree.of(joints)
    points = zip(figure.effectors.joints, figure.effectors.offsets, strict=True)
    ends = {f"e{i}": (tree.names[j], TURN @ at) for i, (j, at) in enumerate(points)}
    turned = Stage(tree, Effectors.of(tree, ends))
    assert (stage.normal is None) == (turned.normal is None)
    if not stage.human:  # rods; a human's flesh is known to reach less far
        assert turned.unit == pytest.approx(stage.unit, rel=2e-3)
        assert_allclose(
            turned.extent.centre, TURN @ stage.extent.centre, atol=5e-3 * stage.extent.radius
        )
    s = locate(forward(tree, theta), turned.effectors)
    away = np.linalg.norm(s - turned.extent.centre, axis=-1)
    assert (away <= ROOM * turned.extent.radius).all()


@settings(max_examples=15)
@given(anybody(limits=True), SEEDS, st.sampled_from(ALONG))
def test_the_live_camera_moves_along(figure, seed, change):
    rng = np.random.default_rng(seed)
    theta = poses(figure.tree, rng)
    s = locate(forward(figure.tree, theta), figure.effectors)
    one, other, along = BODY[change](Case(*figure, theta, s), rng)
    scenes = [Scene(*case[:2], width=WIDTH, height=HEIGHT) for case in (one, other)]
    try:
        flat, moved = (
            through(scene.camera, case.targets)[0]
            for scene, case in zip(scenes, (one, other), strict=True)
        )
        assert_allclose(moved, flat[along.effectors], atol=0.5)
        for what in ("near", "far"):
            before, after = (getattr(scene.camera, what) for scene in scenes)
            assert after == pytest.approx(along.length * before, rel=2e-3)
        before, after = (scene.renderer.controls[0].maxDistance for scene in scenes)
        assert after == pytest.approx(along.length * before, rel=2e-3)
    finally:
        for scene in scenes:
            scene.close()


@pytest.mark.parametrize("unit", [1e-6, 1e-3, 1e3, 1e6])
@pytest.mark.parametrize("name", ["human", "planar_arm(3)", "y_shape", "far away", "two slides"])
def test_the_pixels_are_the_same_in_other_units(name, unit):
    """Not only points: limbs, marks, rods to targets, floor and shade."""
    figure = KNOWN[name]
    theta = poses(figure.tree, np.random.default_rng(3))
    stage = Stage(*figure)
    s = locate(forward(figure.tree, theta), figure.effectors) + 0.1 * stage.unit * stage.free
    one, other, _ = in_units(Case(*figure, theta, s), None, unit)
    pictures = []
    for (tree, effectors, pose, targets), size in ((one, 1), (other, unit)):
        film = Film(tree, effectors, size=(160, 120), finer=1)
        shot = Shot(pose, targets, size * stage.floor, 0.3 * size, "a caption")
        pictures.append(film.picture(shot).astype(int))
    differ = abs(pictures[0] - pictures[1]).max(axis=-1) > 8
    assert differ.mean() < 0.004  # pixels at edges, decided by the last bit
    assert (np.ptp(pictures[0], axis=-1) > 12).mean() > 0.003  # there is something to be seen


def test_a_human_is_known_by_its_shape(make):
    """In any size and place, under any names; rods where limbs are longer than a human's."""
    case = Case(*figures.human(), figures.human().tree.rest, np.zeros((4, 3)))
    for change in ("units 1e-06", "units 1000", "ground moved", "renamed and reordered"):
        _, other, along = BODY[change](case, np.random.default_rng(0))
        stage = Stage(*other[:2])
        assert stage.human, change
        assert stage.unit == pytest.approx(along.length)
        assert_allclose(stage.base, along.shift, atol=1e-9)
    tree = case.tree
    offsets = tree.offsets.copy()
    offsets[tree.index("elbow.l")] *= 1.2
    long_arm = Tree(
        tree.names, tree.parents, offsets, tree.axes, tree.slide, tree.lower, tree.upper,
        tree.rest, tree.mobility,
    )  # fmt: skip
    assert not Stage(long_arm, case.effectors).human


@pytest.mark.parametrize("axis", [(0, 0, 1), (0, 0, -1), (0, 1, 0), (1, 0, 0), (1, 2, -3)])
def test_a_body_in_any_plane_is_looked_at_from_in_front_of_it(axis):
    across = np.cross(axis, [0.3, 0.5, 0.7])
    across /= np.linalg.norm(across)
    tree, effectors = thing(
        Joint("a", None, (5, 5, 5), axis), Joint("b", "a", across, axis), at=across
    )
    stage = Stage(tree, effectors)
    assert stage.side == "plane"
    assert abs(stage.normal @ axis) == pytest.approx(np.linalg.norm(axis))
    film = Film(tree, effectors, size=SIZE)
    circle = everything(tree, effectors, np.linspace([-np.pi, 0], [np.pi, 0], 60))[:, 2]
    pixels, _ = projected(film, circle)
    assert_allclose(np.ptp(pixels, axis=0), np.ptp(pixels, axis=0).mean(), rtol=0.01)
    assert stage.ground(0, 0)[:, 1] == pytest.approx(stage.normal)  # squares behind it
    assert (stage.ground(0, 0)[:, 3] - (5, 5, 5)) @ stage.normal < 0
