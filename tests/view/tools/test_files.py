"""Saving and opening by buttons."""

import pytest
from numpy.testing import assert_array_equal

from ikteach.motion.live.session import Session
from ikteach.view.tools.files import Keeper


@pytest.fixture
def session():
    session = Session(keep=4)
    for _ in range(6):
        session.tick()
    session.show("sdls")
    return session


def test_what_is_saved_is_opened(session, tmp_path):
    opened = []
    keeper = Keeper(session, opened.append, folder=tmp_path)
    keeper.saving.click()
    assert keeper.status.said == (
        f"4 ticks and 1 events are saved in {tmp_path / 'session.json'} and "
        f"{tmp_path / 'session.csv'}. "
        "The log is bounded: the 2 earliest ticks were dropped."
    )
    keeper.opening.click()
    assert_array_equal(opened[0].theta, session.log().theta)
    assert keeper.status.said.startswith("4 ticks and 1 events are open.")
    keeper.close()


def test_it_replays_by_itself(session, tmp_path):
    keeper = Keeper(session, folder=tmp_path)
    keeper.saving.click()
    for _ in range(2):
        keeper.opening.click()
        assert len(keeper.place.children) == 1
    assert keeper.place.children[0].slider.max == 3
    keeper.close()


def test_what_goes_wrong_is_said(session, tmp_path):
    keeper = Keeper(session, folder=tmp_path)
    keeper.opening.click()
    assert "That did not work: there is no session" in keeper.status.wrong
    keeper.saving.click()
    before = (tmp_path / "session.csv").read_bytes()
    session.tick()
    keeper.saving.click()
    assert "already; tick the box to replace it" in keeper.status.wrong
    assert (tmp_path / "session.csv").read_bytes() == before
    keeper.replace.value = True
    keeper.saving.click()
    assert keeper.status.wrong == ""
    assert (tmp_path / "session.csv").read_bytes() != before
    keeper.name.value = " "
    keeper.saving.click()
    assert "needs a file name" in keeper.status.wrong
