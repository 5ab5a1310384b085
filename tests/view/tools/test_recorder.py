"""The recorder without a page: what its buttons do in a running loop."""

import asyncio
import os
import sys

import pytest

from ikteach.formats import movie
from ikteach.motion.live.session import Session
from ikteach.view.tools.recorder import NOW, PAST, Recorder
from ikteach.view.widgets.closing import occupant


def recorder(tmp_path, **values):
    session = Session()
    panel = Recorder(session, folder=tmp_path)
    asked = {"width": 96, "height": 64, "seconds": 0.3, "which": PAST} | values
    for name, value in asked.items():
        getattr(panel, name).value = value
    return session, panel


def run(session, ticks):
    for _ in range(ticks):
        session.tick()


def in_a_loop(story, tmp_path, **values):
    """Run a story told as async def (session, panel) and give back the panel."""

    async def told():
        session, panel = recorder(tmp_path, **values)
        await story(session, panel)
        panel.close()
        assert occupant("movie") is None
        return panel

    return asyncio.run(told())


@pytest.mark.parametrize("kind", movie.KINDS)
def test_what_has_been_becomes_a_movie(tmp_path, kind):
    async def story(session, panel):
        run(session, 15)
        panel.start.click()
        await asyncio.sleep(0.01)
        assert panel.start.disabled
        assert not panel.stop.disabled
        await panel._task
        assert panel.status.said == f"{tmp_path / 'walk'}{kind} is complete: 9 frames."
        assert panel.progress.value == panel.progress.max == 9
        assert panel.stop.disabled

    in_a_loop(story, tmp_path, kind=kind)
    facts = movie.facts(tmp_path / f"walk{kind}")
    assert (facts.size, facts.frames) == ((96, 64), 9)
    assert facts.rate == pytest.approx(30, rel=0.03)
    assert os.listdir(tmp_path) == [f"walk{kind}"]


def test_from_now_on_it_waits_for_the_figure(tmp_path):
    async def story(session, panel):
        panel.begin()
        await asyncio.sleep(0.15)
        assert "the figure must move" in panel.status.said
        assert list(tmp_path.glob("*.mp4")) == []
        for _ in range(12):
            session.tick()
            await asyncio.sleep(0.01)
        await asyncio.wait_for(panel._task, 20)
        assert "is complete: 9 frames" in panel.status.said

    in_a_loop(story, tmp_path, which=NOW)
    pictures = list(movie.read(tmp_path / "walk.mp4"))
    assert len(pictures) == 9
    assert (pictures[0] != pictures[-1]).any()


def test_the_loop_goes_on_meanwhile(tmp_path):
    beats = []

    async def story(session, panel):
        run(session, 30)
        panel.begin()
        while not panel._task.done():
            beats.append(panel.progress.value)
            await asyncio.sleep(0.005)

    in_a_loop(story, tmp_path, seconds=0.9, width=320, height=240)
    assert len(beats) > 10


def test_stop_leaves_no_file(tmp_path):
    async def story(session, panel):
        run(session, 30)
        panel.begin()
        while panel._task.done() or not os.listdir(tmp_path):
            await asyncio.sleep(0.001)
        panel.stop.click()
        await asyncio.wait_for(panel._task, 20)
        assert panel.status.said == "Stopped: no file was written."
        assert os.listdir(tmp_path) == []
        panel.begin()  # and it can be started again
        await asyncio.wait_for(panel._task, 30)
        assert "is complete" in panel.status.said

    in_a_loop(story, tmp_path, seconds=0.9)


def test_closing_stops_it_and_so_does_a_second_recorder(tmp_path):
    async def story(session, panel):
        panel.begin()
        await asyncio.sleep(0.02)
        second = Recorder(session, folder=tmp_path)
        await asyncio.wait_for(panel._task, 20)
        assert os.listdir(tmp_path) == []
        second.close()

    in_a_loop(story, tmp_path, which=NOW)


@pytest.mark.parametrize(
    ("values", "sentence"),
    [
        ({"name": "old"}, "there is a file '.*old.mp4' already; tick the box to replace it."),
        ({"name": "  "}, "the movie needs a file name."),
        ({"name": "no/walk"}, "there is no folder"),
        ({"width": 97}, "must be even: not 97 × 64, but 98 × 64"),
        ({"rate": 0.0}, "rate must be more than 0"),
        ({"seconds": 0.0}, "seconds must be more than 0 and at most 100, not 0.0."),
        ({"seconds": 1e6}, "at most 100, not"),
    ],
)
def test_what_cannot_be_is_said_in_the_panel(tmp_path, values, sentence):
    (tmp_path / "old.mp4").write_bytes(b"mine")

    async def story(session, panel):
        run(session, 2)
        panel.begin()
        await panel._task
        assert panel.status.said == ""
        assert not panel.start.disabled
        panel.name.value, panel.width.value, panel.rate.value = "new", 96, 30.0
        panel.seconds.value = 0.1
        wrong = panel.status.wrong
        panel.begin()
        await panel._task
        assert panel.status.wrong == ""
        panel.status.wrong = wrong

    panel = in_a_loop(story, tmp_path, **values)
    assert panel.status.wrong.startswith("No movie was made: ")
    import re

    assert re.search(sentence, panel.status.wrong)
    assert (tmp_path / "old.mp4").read_bytes() == b"mine"


def test_replacing_and_endings_and_an_empty_past(tmp_path):
    (tmp_path / "old.mp4").write_bytes(b"mine")

    async def story(session, panel):
        panel.begin()
        await panel._task
        assert "nothing to film yet" in panel.status.wrong
        run(session, 3)
        panel.begin()
        await panel._task
        assert panel.status.said.endswith("is complete: 3 frames.")  # there was no more

    in_a_loop(story, tmp_path, name="old.avi", replace=True)
    assert movie.facts(tmp_path / "old.mp4").frames == 3


def test_a_reset_ends_it(tmp_path):
    async def story(session, panel):
        run(session, 3)
        panel.begin()
        await asyncio.sleep(0.05)
        session.reset()
        await asyncio.wait_for(panel._task, 20)
        assert "the session was reset while it was recorded" in panel.status.wrong
        assert os.listdir(tmp_path) == []

    in_a_loop(story, tmp_path, which=NOW, seconds=5.0)


def test_without_the_library_or_a_loop_it_says_so(tmp_path, monkeypatch):
    _, panel = recorder(tmp_path)
    panel.start.click()
    assert "none runs here" in panel.status.wrong
    panel.close()
    monkeypatch.setitem(sys.modules, "av", None)
    _, panel = recorder(tmp_path)
    assert panel.start.disabled
    assert "pip install 'ikteach[movie]'" in panel.status.wrong
    panel.close()
