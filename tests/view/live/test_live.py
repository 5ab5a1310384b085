"""The loop of a live figure, by a clock that moves when the loop sleeps or a tick takes time."""

import asyncio
from itertools import pairwise

import pytest

from ikteach.view.chapters.gait import GaitPlayer
from ikteach.view.live import live

sleep = asyncio.sleep


@pytest.mark.parametrize(("share", "often"), [(0.1, 1), (0.9, 1), (1.5, 3), (4.0, 3)])
def test_a_slow_machine_draws_first_and_reports_seldom(monkeypatch, share, often):
    player, now, done = GaitPlayer(slot="late"), [0.0], []
    session, tick = player.session, player.session.tick

    async def sleep_by_the_clock(seconds):
        now[0] += seconds
        await sleep(0)

    def tick_by_the_clock():
        now[0] += share * session.dt
        tick()

    def note(what):
        return lambda *_: done.append((what, session.ticks))

    monkeypatch.setattr(live, "monotonic", lambda: now[0])
    monkeypatch.setattr(asyncio, "sleep", sleep_by_the_clock)
    monkeypatch.setattr(session, "tick", tick_by_the_clock)
    monkeypatch.setattr(player.strips, "send_new", note("curves"))
    monkeypatch.setattr(player, "report", note("words"))

    async def play():
        driver = player.scene.driver
        driver.send = lambda content, buffers: driver._hear(None, {"drawn": content["frame"]}, [])
        driver._hear(None, {"hello": True}, [])
        drawn = driver.sent
        player._start()
        while session.ticks < 400:
            await sleep(0)
        assert driver.sent - drawn >= session.ticks
        player.stop()

    try:
        asyncio.run(play())
    finally:
        player.close()
    for what, every in (("curves", live.EVERY), ("words", player.REPORT_EVERY)):
        ticks = [tick for one, tick in done if one == what]
        assert len(ticks) > 3
        assert {later - one for one, later in pairwise(ticks[1:])} == {often * every}
