"""Pictures of a run: solid, in front of each other as in the world, and as many as asked for."""

from itertools import pairwise

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from ikteach import figures, forward, locate
from ikteach.body.rotation import sticks
from ikteach.motion.live.session import Session
from ikteach.view.raster.film import Film, film, shot, shots
from ikteach.view.raster.raycast import (
    Eye,
    draw,
    homogeneous,
    solid_box,
    solid_ellipsoid,
    solid_rod,
)
from ikteach.view.stage.colours import EFFECTOR_COLOURS, SHIRT, SKIN, TROUSERS
from ikteach.view.stage.stage import CAMERAS

STILL = np.eye(4)[None]
RED, BLUE = "#ff0000", "#0000ff"


def picture(parts, frames=STILL, eye=None, size=(120, 120)):
    pixels = np.zeros((size[1], size[0], 3), dtype=np.uint8)
    draw(pixels, eye or Eye((0, 0, 3), (0, 0, 0), size), parts, frames)
    return pixels


def covered(pixels):
    return (pixels > 0).any(axis=-1)


def hue(pixels, colour):
    """Where the pixels have the hue of a colour, whatever its shade."""
    wanted = np.array([int(colour[i : i + 2], 16) for i in (1, 3, 5)], dtype=float)
    length = np.linalg.norm(pixels.astype(float), axis=-1)
    return (pixels @ (wanted / np.linalg.norm(wanted)) > 0.995 * length) & (length > 30)


def test_a_ball_covers_its_outline_and_no_more():
    seen = covered(picture([solid_ellipsoid((0, 0, 0), (0.5,) * 3, RED, 0)]))
    # The cone of rays that touch a ball of radius r at distance d has tan = r / √(d² − r²).
    radius = 0.5 / np.sqrt(3**2 - 0.5**2) / (2 * np.tan(np.radians(22.5)) / 120)
    y, x = np.mgrid[:120, :120] + 0.5
    assert_array_equal(seen, np.hypot(x - 60, y - 60) < radius)


def test_every_solid_is_found_within_its_window():
    """The window is only to save time: nothing that a larger one would show is cut off."""
    rng = np.random.default_rng(0)
    eye = Eye((1.2, 0.4, 2.0), (0, 0, 0), (160, 120))
    for _ in range(20):
        start, end = rng.normal(size=(2, 3)) * 0.4
        alone = solid_rod(start, end, 0.12, 0.05, RED, 0)
        wide = alone._replace(balls=np.array([[0, 0, 0, 50.0]] * 2))
        assert_array_equal(
            picture([alone], eye=eye, size=(160, 120)), picture([wide], eye=eye, size=(160, 120))
        )
        ball = solid_ellipsoid(start, (0.3, 0.1, 0.2), BLUE, 0)
        wide = ball._replace(balls=np.array([[0, 0, 0, 50.0]] * 2))
        assert_array_equal(
            picture([ball], eye=eye, size=(160, 120)), picture([wide], eye=eye, size=(160, 120))
        )


def test_what_is_nearer_hides_what_is_behind_in_any_order():
    near = solid_ellipsoid((0, 0, 1), (0.2,) * 3, RED, 0)
    far = solid_ellipsoid((0, 0, -1), (0.6,) * 3, BLUE, 0)
    for parts in ([near, far], [far, near]):
        pixels = picture(parts)
        assert hue(pixels, RED)[60, 60]
        assert hue(pixels, BLUE)[60, 40]


def test_a_rod_ends_where_it_ends_and_frames_move_it():
    upright = solid_rod(np.zeros(3), np.array([0.0, 1, 0]), 0.1, 0.1, RED, 0)
    seen = covered(picture([upright]))
    rows = np.flatnonzero(seen.any(axis=1))
    assert rows[-1] < 64
    assert rows[0] == pytest.approx(60 - 1 / (3 * np.tan(np.radians(22.5)) / 60), abs=3)
    lying = homogeneous(sticks(np.zeros((1, 3)), np.array([[1.0, 0, 0]])))
    seen = covered(picture([upright], frames=lying))
    assert seen[:, 62:].any()
    assert not seen[:, :55].any()


def test_a_box_has_straight_sides():
    seen = covered(picture(solid_box(0.4, RED, 0)))
    rows, columns = np.flatnonzero(seen.any(axis=1)), np.flatnonzero(seen.any(axis=0))
    assert seen[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1].all()
    half = 0.4 / (3 - 0.4) / (2 * np.tan(np.radians(22.5)) / 120)
    assert len(rows) == len(columns) == pytest.approx(2 * half, abs=1.5)


def test_what_is_behind_the_eye_is_not_seen():
    assert not covered(picture([solid_ellipsoid((0, 0, 6), (0.5,) * 3, RED, 0)])).any()
    behind = STILL.copy()
    behind[0, 2, 3] = 6
    assert not covered(picture(solid_box(0.2, RED, 0), frames=behind)).any()


def test_the_eye_projects_where_it_draws():
    eye = Eye((2.0, 1.0, 2.5), (0, 0, 0), (160, 120))
    point = np.array([0.3, -0.2, 0.1])
    seen = covered(picture([solid_ellipsoid(point, (0.06,) * 3, RED, 0)], eye=eye, size=(160, 120)))
    y, x = (axis.mean() + 0.5 for axis in np.nonzero(seen))
    assert_allclose(eye.project(point)[0], [x, y], atol=0.6)


@pytest.fixture(scope="module")
def log():
    session = Session()
    for _ in range(20):
        session.tick()
    session.show("sdls")
    for _ in range(10):
        session.tick()
    return session.log()


@pytest.mark.parametrize("side", CAMERAS)
def test_the_figure_its_targets_and_the_floor_are_seen(log, side):
    pixels = next(film(log, side=side, size=(320, 240)))
    assert pixels.shape == (240, 320, 3)
    assert pixels.dtype == np.uint8
    for colour in (SHIRT, SKIN, TROUSERS):
        assert hue(pixels, colour).mean() > 0.001, colour
    for colour in EFFECTOR_COLOURS[2:4] if side != "side" else ():  # one hides the other there
        assert hue(pixels, colour).sum() >= 8, colour
    assert (np.ptp(pixels, axis=-1) > 12).mean() < 0.5  # most is paper


def test_a_target_where_it_is_reached_needs_no_gap():
    tree, effectors = figures.human()
    s = locate(forward(tree, tree.rest), effectors)
    camera = Film(tree, effectors, size=(160, 120), finer=1)
    session = Session()
    session.tick()
    one = shot(session.log(), 0)
    assert camera.picture(one._replace(theta=tree.rest, targets=s)).shape == (120, 160, 3)


def test_the_shots_are_those_of_the_clock(log):
    by_ticks = list(shots(log, rate=30))
    assert len(by_ticks) == 30
    for i, one in enumerate(by_ticks):
        assert_array_equal(one.theta, log.theta[i, 2 if i < 20 else 3])
    assert by_ticks[0].caption.startswith("dls")
    assert by_ticks[-1].caption == "sdls   1.00 s"
    assert len(list(shots(log, rate=12))) == 12
    part = list(shots(log, rate=30, start=0.5, seconds=0.2, method="transpose", title="walking"))
    assert len(part) == 6
    assert_array_equal(part[0].theta, log.theta[14, 0])
    assert part[0].caption == "walking by transpose   0.50 s"


def test_it_moves_and_the_floor_glides(log):
    pictures = list(film(log, rate=10, size=(160, 120), finer=1))
    for one, next_one in pairwise(pictures):
        assert (one != next_one).any(axis=-1).mean() > 0.005
    camera = Film(log.tree, log.effectors, size=(160, 120), finer=1)
    one = shot(log, 0.5)
    assert (camera.picture(one) != camera.picture(one._replace(advance=0.25))).any()
    assert_array_equal(
        camera.picture(one._replace(advance=1.0)), camera.picture(one._replace(advance=0.0))
    )


def test_any_body_can_be_filmed():
    session = Session(figures.planar_arm(3), methods="dls")
    session.tick()
    assert hue(next(film(session.log(), size=(160, 120))), SHIRT).mean() > 0.001


def test_what_cannot_be_filmed(log):
    with pytest.raises(LookupError, match="no view 'behind'"):
        next(film(log, side="behind"))
    with pytest.raises(LookupError, match="no method 'dsl'; did you mean 'dls'"):
        next(film(log, method="dsl"))
    with pytest.raises(ValueError, match="nothing to film"):
        next(film(Session().log()))
