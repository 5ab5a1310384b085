"""Recorder, replay and glass as a student has them: in a page, with mouse and keys."""

import os
from collections.abc import Iterator
from typing import Any

import nbformat
import numpy as np
import pytest
from PIL import Image

from ikteach.formats import movie
from tests.browser.conftest import READY, SHOTS, Lab, Notebook, pixels

CELLS = [
    """import asyncio
from ikteach.motion.live.session import Session
from ikteach.view.tools.inspector import Glass
from ikteach.view.tools.files import Keeper
from ikteach.view.tools.recorder import Recorder
from ikteach.view.tools.replay import Replay
session = Session(max_step=0.1)
async def walk():
    while True:
        session.tick()
        await asyncio.sleep(session.dt)
walking = asyncio.get_running_loop().create_task(walk())
recorder = Recorder(session)
recorder""",
    "replay = Replay(session.log(last=60))\nreplay",
    "glass = Glass(session, stop=walking.cancel)\nglass",
    "keeper = Keeper(session)\nkeeper",
]
SAID = ".ikteach-status [role=status]"
ALERT = ".ikteach-status [role=alert]"


@pytest.fixture(scope="module")
def book(lab: Lab, open_notebook: Any) -> Iterator[Notebook]:
    cells = [nbformat.v4.new_code_cell(source) for source in CELLS]
    kernel = {"name": "python3", "display_name": "Python 3"}
    written = nbformat.v4.new_notebook(cells=cells, metadata={"kernelspec": kernel})
    nbformat.write(written, lab.folder / "record.ipynb")
    notebook = open_notebook("record.ipynb")
    notebook.run_cell("recorder = Recorder(session)")
    notebook.page.get_by_role("button", name="Start recording").wait_for(timeout=READY)
    yield notebook
    assert notebook.errors == []


def wait_for(book: Notebook, selector: str, text: str) -> str:
    found = book.page.locator(selector, has_text=text).first
    found.wait_for(timeout=READY)
    return found.inner_text()


def fill(book: Notebook, label: str, value: str) -> None:
    box = book.page.get_by_label(label, exact=True)
    box.fill(value)
    box.press("Tab")


def folder(lab: Lab) -> set[str]:
    return {name for name in os.listdir(lab.folder) if "stroll" in name}


def test_a_movie_is_recorded_while_the_notebook_goes_on(book: Notebook, lab: Lab) -> None:
    fill(book, "Movie file", "stroll")
    fill(book, "Width [pixels]", "320")
    fill(book, "Height", "240")
    fill(book, "Seconds", "1.5")
    fill(book, "Frames per s", "20")
    book.press("Start recording")
    wait_for(book, SAID, "Recording")
    assert book.kernel("6 * 7") == 42  # a cell runs meanwhile
    ticks = book.kernel("session.ticks")
    assert book.page.get_by_role("button", name="Start recording").is_disabled()
    book.shot("09_recording")
    wait_for(book, SAID, "stroll.mp4 is complete: 30 frames")
    assert book.kernel("session.ticks") > ticks  # and the figure went on
    assert folder(lab) == {"stroll.mp4"}
    assert movie.facts(lab.folder / "stroll.mp4") == ((320, 240), 20, 30)
    first, *_, last = movie.read(lab.folder / "stroll.mp4")
    figure = np.ptp(last.astype(int), axis=-1) > 25  # skin, shirt, targets: the paper is grey
    assert 0.01 < figure.mean() < 0.5
    assert (abs(first.astype(int) - last).max(axis=-1) > 40).mean() > 0.003
    Image.fromarray(last).save(book_shot("09_movie"))


def book_shot(name: str) -> Any:
    SHOTS.mkdir(exist_ok=True)
    return SHOTS / f"{name}.png"


def test_a_file_is_replaced_only_when_asked(book: Notebook, lab: Lab) -> None:
    before = (lab.folder / "stroll.mp4").read_bytes()
    fill(book, "Seconds", "0.5")
    book.press("Start recording")
    assert "tick the box to replace it" in wait_for(book, ALERT, "already")
    book.shot("09_recorder_refuses")
    assert (lab.folder / "stroll.mp4").read_bytes() == before
    book.page.get_by_role("checkbox", name="replace a file of that name").check()
    book.press("Start recording")
    wait_for(book, SAID, "is complete: 10 frames")
    assert book.page.locator(ALERT, has_text="already").count() == 0
    assert movie.facts(lab.folder / "stroll.mp4").frames == 10


def test_stop_leaves_no_file(book: Notebook, lab: Lab) -> None:
    fill(book, "Movie file", "stroll on")
    book.press("GIF")
    fill(book, "Seconds", "30")
    book.press("Start recording")
    wait_for(book, SAID, "Recording")
    book.press("Stop recording")
    wait_for(book, SAID, "Stopped: no file was written")
    assert folder(lab) == {"stroll.mp4"}
    fill(book, "Seconds", "0.5")
    book.page.get_by_label("Film", exact=True).select_option("what has been")
    book.press("Start recording")
    wait_for(book, SAID, "stroll on.gif is complete: 10 frames")
    assert movie.facts(lab.folder / "stroll on.gif").size == (320, 240)


def test_scrubbing_rows_and_the_plot_show_the_pose(book: Notebook) -> None:
    page = book.page
    book.run_cell("replay = Replay")
    page.locator(".ikteach-rows tr[data-row]").first.wait_for(timeout=READY)
    picture = page.locator(".jp-OutputArea img").first
    seen = [picture.get_attribute("src")]

    def shows(row: int) -> None:
        """All say the same row, and the figure has been drawn anew."""
        book.settle("[replay.at, replay.slider.value, replay.curve.chosen]", [row] * 3)
        chosen = page.locator(".ikteach-rows tr[aria-selected=true]")
        page.wait_for_selector(f".ikteach-rows tr[data-row='{row}'][aria-selected=true]")
        assert chosen.count() == 1
        plot = page.locator(".ikteach-curve")
        page.wait_for_selector(f".ikteach-curve[aria-valuenow='{row}']", timeout=READY)
        assert f"tick {book.kernel(f'int(replay.run.tick[{row}])')}," in (
            plot.get_attribute("aria-valuetext") or ""
        )
        page.wait_for_function(
            "was => document.querySelector('.jp-OutputArea img').src !== was",
            arg=seen[-1],
            timeout=READY,
        )
        seen.append(picture.get_attribute("src"))

    page.locator(".widget-slider .noUi-handle").focus()
    page.keyboard.press("End")
    shows(59)
    page.locator(".ikteach-rows tr[data-row='40'] td").first.click()
    shows(40)
    page.keyboard.press("ArrowUp")
    shows(39)
    page.keyboard.press("PageDown")
    shows(49)
    plot = page.locator(".ikteach-curve")
    plot.scroll_into_view_if_needed()
    box = plot.bounding_box()
    assert box is not None
    left, right = book.kernel("replay.curve.span")
    place = left + (right - left) * book.kernel("replay.curve.places[20]")
    page.mouse.click(box["x"] + box["width"] * place, box["y"] + box["height"] / 2)
    shows(20)
    page.keyboard.press("ArrowRight")
    shows(21)
    page.keyboard.press("Home")
    shows(0)
    assert "From its target: foot.l" in wait_for(book, SAID, "Tick")
    assert "Distance to target from" in (
        page.locator(".ikteach-curve img").get_attribute("alt") or ""
    )
    book.shot("09_replay")
    page.get_by_role("button", name="Play", exact=True).click()
    book.settle("replay.at", 59)
    book.settle("replay.playing.value", False)


def test_the_glass_is_leafed_through(book: Notebook) -> None:
    book.run_cell("glass = Glass")
    book.press("Stop the clock and look")
    wait_for(book, SAID, "Page 1 of 6")
    book.settle("walking.done()", True)
    ticks = book.kernel("session.ticks")
    picture = book.page.locator("img[alt^='Bars of the error']")
    assert picture.count() == 1
    alts = {picture.get_attribute("alt")}
    for number in range(2, 7):
        book.press("Next")
        wait_for(book, SAID, f"Page {number} of 6")
        book.shot(f"09_glass_{number}")
        alts.add(book.kernel("glass.picture.alt"))
    assert len(alts) == 6
    assert book.page.get_by_role("button", name="Next", exact=True).is_disabled()
    book.press("Back")
    wait_for(book, SAID, "Page 5 of 6")
    shown = book.page.locator("img[alt^='Bars of the step']")
    shown.wait_for(timeout=READY)
    assert (np.ptp(pixels(shown.screenshot()), axis=-1) > 40).mean() > 0.005
    book.page.get_by_text("The numbers as a table").click()
    table = book.page.locator("table.ikteach-glass")
    assert table.locator("tbody tr").count() == 20
    book.shot("09_glass_table")
    assert book.kernel("session.ticks") == ticks
    book.press("Do this tick")
    book.settle("session.ticks", ticks + 1)


def test_a_session_is_saved_and_opened(book: Notebook, lab: Lab) -> None:
    book.run_cell("keeper = Keeper")
    book.press("Save the session")
    said = wait_for(book, SAID, "are saved in")
    assert {"session.json", "session.csv"} <= set(os.listdir(lab.folder))
    assert said.startswith(f"{book.kernel('len(session.record)')} ticks")
    book.press("Open and replay")
    wait_for(book, SAID, "are open")
    last = book.kernel("len(session.record)") - 1
    book.page.locator(f".ikteach-rows tr[data-row='{last}']").last.click()
    book.settle("keeper.place.children[0].at", last)
    book.shot("09_opened")
