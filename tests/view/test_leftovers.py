"""What a long run leaves behind: no memory, no loops. `tests/bench/memory.py` is the long one."""

import asyncio
import gc
import os
import time
import tracemalloc

import pytest
from ipywidgets.widgets.widget import _instances

from ikteach.view.chapters.workbench import Workbench
from ikteach.view.live import live

KEEP, WARM = 40, 100  # ticks: in the record, and until all that is made once has been made
TICKS = 20_000 if os.environ.get("IKTEACH_FULL") else 150
ALLOWED = 20e6 / (30 * 60 * 30)  # [bytes a tick]: 20 MB in half an hour at 30 ticks a second


def loops():
    return sum("Live._run" in task.get_coro().__qualname__ for task in asyncio.all_tasks())


async def reach(bench, ticks):
    """Let the loop run until there are so many ticks; the memory then [bytes]."""
    while bench.session.ticks < ticks:
        await asyncio.sleep(0.02)
    gc.collect()
    return tracemalloc.get_traced_memory()[0]


@pytest.fixture
def played(tmp_path, monkeypatch):
    """Play a workbench that a page looks at, which draws all it is sent, and no tick is waited for.

    What is to be done with it is given as a coroutine function.
    """
    monkeypatch.setattr(live, "monotonic", lambda: 1000 * time.monotonic())
    monkeypatch.setattr(live.Live, "SELDOM", 1)  # by this clock it is always late

    def look(bench):
        driver = bench.scene.driver
        driver.send = lambda content, buffers: driver._hear(None, {"drawn": content["frame"]}, [])
        driver._hear(None, {"hello": True}, [])

    def play(act):
        async def main():
            bench = Workbench(folder=tmp_path, keep=KEEP)
            look(bench)
            try:
                await act(bench)
            finally:
                bench.close()
                await asyncio.sleep(0.01)
            assert loops() == 0

        asyncio.run(main())

    return play


def test_memory_does_not_grow(played):
    async def run(bench):
        for layer in bench.scene.layers:
            bench.scene.switch(layer)
        tracemalloc.start()
        try:
            warm = await reach(bench, WARM)
            grown = await reach(bench, WARM + TICKS) - warm
        finally:
            tracemalloc.stop()
        assert grown < ALLOWED * TICKS

    played(run)


def test_a_workbench_that_is_closed_frees_every_widget(tmp_path):
    before = set(_instances)
    Workbench(folder=tmp_path).close()
    assert set(_instances) == before


def test_quit_ends_the_loop(played):
    async def run(bench):
        await reach(bench, 3)
        assert loops() == 1
        bench.quit()
        await asyncio.sleep(0.05)
        assert loops() == 0

    played(run)


def test_the_loop_ends_when_nobody_looks_and_goes_on_when_somebody_does(played, monkeypatch):
    monkeypatch.setattr("ikteach.view.webgl.driver.PATIENCE", 0.05)

    async def run(bench):
        await reach(bench, 3)
        driver = bench.scene.driver
        sent = []
        driver.send = lambda content, buffers: sent.append(content)  # the page has gone
        while loops():
            await asyncio.sleep(0.02)
        assert len(sent) <= 31  # of what was sent for nobody: a second's worth, and no more
        ticks = bench.session.ticks
        driver._hear(None, {"hello": True}, [])
        await reach(bench, ticks + 3)
        assert loops() == 1

    played(run)
