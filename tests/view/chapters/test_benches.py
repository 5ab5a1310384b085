"""The widgets of chapters 3 to 6 and 8, without a page: every control to both ends."""

import io
from typing import Any

import ipywidgets as widgets
import numpy as np
import pandas as pd
import pytest
from PIL import Image

from ikteach.view import charts
from ikteach.view.chapters.comparison import OWN, Race
from ikteach.view.chapters.dls import tradeoff_bench
from ikteach.view.chapters.gait import GaitPlayer
from ikteach.view.chapters.pseudoinverse import CapPlayer
from ikteach.view.chapters.sdls import spectrum_bench
from ikteach.view.chapters.transpose import slope_bench
from ikteach.view.live.bench import Bench, Shown
from ikteach.view.live.panel import slider
from ikteach.view.widgets.closing import occupant

BENCHES = [slope_bench, tradeoff_bench, spectrum_bench]


def pixels(png: bytes) -> np.ndarray:
    return np.asarray(Image.open(io.BytesIO(png)).convert("RGB")).astype(int)


def ends(control: Any) -> list[Any]:
    if isinstance(control, widgets.ToggleButtons):
        return list(control.options)
    logarithmic = isinstance(control, widgets.FloatLogSlider)
    return [10.0**end if logarithmic else end for end in (control.min, control.max)]


@pytest.mark.parametrize("make", BENCHES)
def test_every_control_to_both_ends(make: Any) -> None:
    bench = make()
    pictures = set()
    for control in bench.controls.values():
        before = control.value
        for end in ends(control):
            control.value = end
            assert bench.status.wrong == ""
            assert pixels(bench._picture.png).std() > 5
            assert "nan" not in bench.words
            pictures.add(bench._picture.png)
        control.value = before
    assert len(pictures) > len(bench.controls)
    assert bench._repr_mimebundle_()["text/plain"] == bench.words
    bench.close()


def test_a_bench_tells_what_went_wrong_and_goes_on() -> None:
    def show(x: float) -> Shown:
        if x > 1:
            raise ValueError("x is <too> large")
        return Shown(b"png", f"x is {x:g}")

    pressed: list[int] = []
    x = slider("x", 0.5, 0.0, 2.0, 0.1)
    bench = Bench(show, {"x": x}, slot="test", buttons={"Go": lambda: pressed.append(1)})
    assert bench.words == "x is 0.5"
    x.value = 2.0
    assert bench.status.wrong == "That did not work: x is <too> large"
    x.value = 1.0
    assert (bench.status.wrong, bench.words) == ("", "x is 1")
    bench.buttons["Go"].click()
    assert pressed == [1]
    other = Bench(show, {"x": slider("x", 0.0, 0.0, 2.0, 0.1)}, slot="test")
    assert bench.comm is None
    assert occupant("test") is other
    other.close()
    assert occupant("test") is None


def test_the_arm_steps_downhill_and_starts_again() -> None:
    bench = slope_bench()
    first = bench.words
    for n in (1, 2, 3):
        bench.buttons["Take the step"].click()
        assert f"after {n} steps" in bench.words
    bench.buttons["Start again"].click()
    assert bench.words == first
    bench.close()


@pytest.mark.parametrize("make", [CapPlayer, Race])
def test_every_control_of_a_player_to_both_ends(make: Any) -> None:
    player = make()
    figure = getattr(player, "player", player)
    for control in player.controls.values():
        before = control.value
        for end in ends(control):
            control.value = end
            figure.session.tick()
            figure.report()
            assert player.status.wrong == ""
            assert len(player.words) > 20
        control.value = before
    player.close()


def test_the_cap_player_obeys() -> None:
    player = CapPlayer()
    session = player.player.session
    for value in (0.5, 45.0):
        player.controls["cap"].value = value
        session.reset()
        session.tick()
        peak = abs(session.theta["each chain"] - session.tree.rest).max()
        assert peak <= np.radians(value) + 1e-9
    player.controls["x_hand"].value = 2.0
    assert session.gait.x_hand == 2.0
    second = CapPlayer()
    assert player.comm is None
    second.close()


def test_curves_have_what_each_single_step_did(monkeypatch: pytest.MonkeyPatch) -> None:
    player = GaitPlayer()
    session, sent = player.session, []
    monkeypatch.setattr(
        player.strips, "send", lambda _, buffers: sent.append(np.frombuffer(buffers[0], "<f4"))
    )
    for _ in range(4):
        player.step()
        player.strips.send_new()
        far = [row.error.mean() for row in session.tracks(last=1).values()]
        shaken = [np.degrees(one[0]) for one in session.jitter().values()]
        told = [session.ticks * session.dt, *session.error, *far, *shaken]
        np.testing.assert_allclose(sent[-1], told, rtol=1e-6)
    assert len(sent) == 4
    player.close()


def test_the_race_obeys() -> None:
    race = Race()
    session = race.session
    race.controls["degrees"].value = 1.0
    session.tick()
    for theta in session.theta.values():
        assert abs(theta - session.tree.rest).max() <= np.radians(1) + 1e-9
    race.controls["caps"].value = OWN
    session.reset()
    session.tick()
    far = {name: abs(theta - session.tree.rest).max() for name, theta in session.theta.items()}
    assert far["pseudoinverse"] <= np.radians(5) + 1e-9 < far["dls"]
    race.controls["motion"].value = "running"
    assert session.gait.name == "running"
    assert race.controls["speed"].value == session.gait.speed
    race.controls["speed"].value = 0.0
    session.tick()
    race.report()
    assert "running, each author's caps" in race.words
    assert "sdls" in race._table.value
    assert race.status.wrong == ""
    race.close()


def test_charts_carry_their_numbers() -> None:
    table = pd.DataFrame({"near": [3.0, 1.0], "calm": [2.0, 4.0]}, index=[0.1, 1.0])
    drawn = charts.lines(table, title="Trade", xlabel="λ", ylabel="size", log="x")
    assert "near from 3 to 1, least 1 at 1" in drawn.alt
    bars = charts.bars(table, title="Trade", ylabel="size", spread=0.1 * table)
    assert "0.1: near 3, calm 2; 1.0: near 1, calm 4" in bars.alt
    for still in (drawn, bars):
        assert pixels(still.png).std() > 5
