"""Replay without a page: slider, plot, rows and pose always mean the same tick."""

import asyncio
import io

import numpy as np
import pytest
from numpy.testing import assert_array_equal
from PIL import Image

from ikteach import SOLVERS
from ikteach.motion import gait
from ikteach.motion.live.session import Session
from ikteach.view.tools.replay import AS_SHOWN, Replay


class Watcher:
    """A scene that remembers what it was told."""

    def __init__(self):
        self.seen = []

    def show(self, theta, targets, *, floor, advance=0.0):
        self.seen.append((theta, targets, floor, advance))


@pytest.fixture
def log():
    session = Session()
    for _ in range(6):
        session.tick()
    session.show("sdls")
    session.gait = gait.running
    for _ in range(6):
        session.tick()
    return session.log()


def agree(replay, tick):
    said = {replay.at, replay.slider.value, replay.curve.chosen, replay.rows.chosen}
    assert said == {tick}


async def until(holds):
    """Wait for it, on however slow a machine."""
    async with asyncio.timeout(20):
        while not holds():
            await asyncio.sleep(0.005)


def test_all_ways_to_a_tick_are_one(log):
    scene = Watcher()
    replay = Replay(log, scene)
    agree(replay, 0)
    ways = [
        lambda: replay.go(3),
        lambda: setattr(replay.slider, "value", 8),
        lambda: setattr(replay.curve, "chosen", 11),
        lambda: setattr(replay.rows, "chosen", 2),
    ]
    for way, tick in zip(ways, (3, 8, 11, 2), strict=True):
        way()
        agree(replay, tick)
        theta, targets, floor, advance = scene.seen[-1]
        assert_array_equal(theta, log.theta[tick, log.shown[tick]])
        assert_array_equal(targets, log.targets[tick])
        assert (floor, advance) == (log.floor[tick], log.advance[tick])
        assert f"Tick {log.tick[tick]}, {log.clock[tick]:.2f} s" in replay.status.said
    with pytest.raises(IndexError, match="rows 0 to 11, not 12"):
        replay.go(12)
    replay.close()


def test_another_method_can_be_seen(log):
    scene = Watcher()
    replay = Replay(log, scene)
    replay.go(4)
    replay.method.value = "transpose"
    assert_array_equal(scene.seen[-1][0], log.theta[4, 0])
    assert "by transpose" in replay.status.said
    assert {row[2] for row in replay.rows.rows} == {"transpose"}
    replay.method.value = AS_SHOWN
    assert [row[2] for row in replay.rows.rows] == ["dls"] * 6 + ["sdls"] * 6
    assert_array_equal(scene.seen[-1][0], log.theta[4, 2])


def test_the_table_says_what_happened(log):
    replay = Replay(log, Watcher())
    assert replay.rows.header[:3] == ["tick", "clock [s]", "method"]
    assert len(replay.rows.rows) == len(log)
    error = [f"{100 * d:.2f}" for d in log.error[7, 3]]
    assert replay.rows.rows[7][3:-1] == error
    changes = [i for i, row in enumerate(replay.rows.rows) if row[-1]]
    assert changes == [6]  # both changes came between the sixth and the seventh tick
    assert replay.rows.rows[6][-1] == "method: shown sdls; gait: motion running"


def test_the_plot_is_a_picture_with_its_numbers_in_words(log):
    replay = Replay(log, Watcher())
    pixels = np.asarray(Image.open(io.BytesIO(replay.curve.png)).convert("RGB")).astype(int)
    assert (pixels.min(axis=-1) < 100).mean() > 0.005
    left, right = replay.curve.span
    assert 0 < left < 0.2 < 0.9 < right <= 1
    worst = 100 * log.error[np.arange(12), log.shown][:, 3].max()
    assert f"at most {worst:.1f} cm" in replay.curve.alt
    assert replay.curve.places[0] == 0
    assert replay.curve.places[-1] == 1
    assert replay.curve.labels[2] == f"tick 3, {3 / 30:.2f} s"


def test_it_plays_to_the_end_and_from_the_beginning_again():
    session = Session(methods={"dls": SOLVERS["dls"]})
    for _ in range(600):  # 20 s, so that a slow machine does not come to the end
        session.tick()
    last = 599

    async def story():
        replay = Replay(session.log(), Watcher())
        replay.go(last - 3)
        await asyncio.sleep(0.01)
        replay.playing.value = True
        await asyncio.sleep(0.01)
        assert replay.playing.description == "Pause"
        await asyncio.wait_for(replay._task, 20)
        agree(replay, last)
        assert not replay.playing.value
        replay.playing.value = True
        await until(lambda: 0 < replay.at < last)
        replay.playing.value = False
        await asyncio.wait_for(replay._task, 20)
        here = replay.at
        agree(replay, here)
        await asyncio.sleep(0.1)
        assert replay.at == here
        replay.playing.value = True
        await asyncio.sleep(0.02)
        replay.slider.value = 300  # moved on the way: it goes on from there
        await until(lambda: 300 <= replay.at < last)
        replay.slider.value = 1
        await until(lambda: 1 <= replay.at < 300)
        replay.close()

    asyncio.run(story())


def test_it_draws_for_itself_where_there_is_no_scene(log):
    replay = Replay(log)
    first = replay.scene.widget.png
    replay.go(9)
    second = replay.scene.widget.png
    assert first[:4] == second[:4] == b"\x89PNG"
    assert first != second
    replay.close()


def test_nothing_to_replay_and_no_loop(log):
    with pytest.raises(ValueError, match="nothing to replay"):
        Replay(Session().log())
    replay = Replay(log, Watcher())
    replay.playing.value = True
    assert "in a notebook only" in replay.status.wrong


def test_one_tick_is_a_run():
    session = Session()
    session.tick()
    agree(Replay(session.log(), Watcher()), 0)


def test_what_goes_wrong_is_told_and_the_replay_goes_on(log):
    class Breaks(Watcher):
        wrong = False

        def show(self, theta, targets, *, floor, advance=0.0):
            if self.wrong:
                raise ValueError("no picture")
            super().show(theta, targets, floor=floor, advance=advance)

    async def story():
        replay = Replay(log, scene := Breaks())
        asks = (
            lambda: setattr(replay.slider, "value", 5),
            lambda: setattr(replay.method, "value", "sdls"),
            lambda: setattr(replay.playing, "value", True),
        )
        for tick, ask in enumerate(asks, start=1):
            scene.wrong = True
            ask()
            await until(lambda: replay.status.wrong == "That did not work: no picture")
            await until(lambda: not replay.playing.value)
            scene.wrong = False
            replay.go(tick)
            await until(lambda tick=tick: replay.at == tick and replay.status.wrong == "")
        replay.rows.chosen = 99
        assert replay.status.wrong == "That did not work: the log has rows 0 to 11, not 99"
        replay.close()

    asyncio.run(story())
