"""The glass without a page: six pages of one tick, in pictures, words and tables."""

import io
import re

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from PIL import Image

from ikteach.motion.live.session import Session
from ikteach.view.tools.inspector import Glass
from ikteach.view.tools.inspector_pages import PAGES


@pytest.fixture(scope="module")
def session():
    session = Session(max_step=0.08)
    for _ in range(14):
        session.tick()
    session.change(speed=9.0, hand_z=0.9)
    for _ in range(14):
        session.tick()
    return session


@pytest.fixture(scope="module")
def glass(session):
    """One for all: a page is drawn when it is first opened, and not again for the same tick."""
    glass = Glass(session)
    glass.look()
    yield glass
    glass.close()


def open_page(glass, number):
    glass.number = number
    return glass.page


def test_looking_stops_the_clock_and_changes_nothing(session):
    stopped = []
    before = session.settings(), session.ticks, {m: p.copy() for m, p in session.theta.items()}
    glass = Glass(session, stop=lambda: stopped.append(True))
    with pytest.raises(LookupError, match="look first"):
        _ = glass.page
    glass.look_button.click()
    assert stopped == [True]
    assert (session.settings(), session.ticks) == before[:2]
    for method, pose in session.theta.items():
        assert_array_equal(pose, before[2][method])


def test_what_is_shown_is_what_the_next_tick_does():
    session = Session(max_step=0.1)
    shown = []
    glass = Glass(session, show=lambda: shown.append(session.ticks))
    glass.look()
    for _ in range(2):
        to = glass.tick.theta
        glass.do.click()
        assert_array_equal(session.theta["dls"], to)
    assert shown == [1, 2]
    session.change(slowdown=3)
    glass.look()
    to = glass.tick.theta
    glass.advance()
    assert_array_equal(session.theta["dls"], to)
    assert session.ticks == 5


def test_next_and_back_go_through_all_pages(glass):
    titles = []
    glass.turn(-6)
    assert glass.back.disabled
    for number in range(len(PAGES)):
        assert glass.number == number
        said = re.match(r"Page (\d) of 6: (.+?)\. Tick 29 by dls", glass.status.said)
        assert int(said[1]) == number + 1
        titles.append(said[2])
        assert glass.picture.alt == glass.page.alt
        assert "<table" in glass.table.value
        glass.next.click()
    assert len(set(titles)) == 6
    assert glass.next.disabled
    glass.next.click()
    assert glass.number == 5
    glass.back.click()
    assert glass.number == 4


def test_every_page_is_a_picture(glass):
    for number in range(len(PAGES)):
        page = open_page(glass, number)
        pixels = np.asarray(Image.open(io.BytesIO(page.png)).convert("RGB")).astype(int)
        assert pixels.shape[1] == 1000
        assert (np.ptp(pixels, axis=-1) > 40).mean() > 0.01, page.title  # there is colour in it


def test_the_words_carry_the_numbers(glass):
    one = glass.tick
    far = np.linalg.norm(one.e.reshape(-1, 3), axis=1)
    assert f"hand.r {100 * far[2]:.1f} cm" in open_page(glass, 0).alt
    alt = open_page(glass, 1).alt
    assert "12 rows by 20 columns" in alt
    assert f"{abs(one.J).max():.3f} m/rad" in alt
    assert ", ".join(f"{s:.3g}" for s in one.sigma) in open_page(glass, 2).alt
    alt = open_page(glass, 3).alt
    for method in ("transpose", "pseudoinverse", "dls", "sdls"):
        assert ", ".join(f"{f:.2f}" for f in one.filters[method]) in alt
    alt = open_page(glass, 4).alt
    assert "The cap shortened the step" in alt
    held = [name for name, h in zip(glass.names.joints, one.held, strict=True) if h]
    assert held
    assert f"Held by limits: {', '.join(held)}" in alt
    miss = 100 * np.linalg.norm(one.actual - one.predicted, axis=1)[3]
    assert f"{miss:.2f} cm from where J had said" in open_page(glass, 5).alt


def test_the_tables_are_the_numbers(glass):
    one = glass.tick
    assert_allclose(open_page(glass, 0).table[["x", "y", "z"]].to_numpy().ravel(), one.e)
    J = open_page(glass, 1).table
    assert_array_equal(J.to_numpy(), one.J)
    assert J.loc["foot.l z", "knee.l"] == one.J[2, glass.session.tree.index("knee.l")]
    assert_array_equal(open_page(glass, 2).table["σ"], one.sigma)
    assert_array_equal(open_page(glass, 3).table["σ f of sdls"], one.filters["sdls"])
    steps = open_page(glass, 4).table
    assert_allclose(np.radians(steps["wanted"]), one.wanted)
    assert_array_equal(steps["held"], one.held)
    assert_allclose(open_page(glass, 5).table["actual"], one.actual.ravel())


def test_another_method_under_the_glass(session):
    glass = Glass(session)
    glass.method.value = "transpose"  # nothing is there yet to be looked at again
    assert glass.tick is None
    glass.look()
    assert glass.tick.method == "transpose"
    glass.method.value = "sdls"
    assert glass.tick.method == "sdls"
    assert "by sdls" in glass.status.said


def test_an_error_is_said_and_the_glass_goes_on(session):
    glass = Glass(session)
    good = session.methods["dls"]
    session.methods["dls"] = lambda J, e: J[0] * np.nan
    glass.look_button.click()
    assert "not finite" in glass.status.wrong
    session.methods["dls"] = good
    glass.look_button.click()
    assert glass.status.wrong == ""
