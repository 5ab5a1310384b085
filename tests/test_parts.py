"""`tests/run` runs every part and tells what failed."""

import sys
import threading
import time
from pathlib import Path

import kernel
import numpy as np
import parts
import pytest
from parts import Part, Runner


def saying(word: str, status: int = 0) -> list[str]:
    return [sys.executable, "-c", f"import sys; print({word!r}); sys.exit({status})"]


def test_a_part_that_fails_stops_itself_and_no_other(capsys: pytest.CaptureFixture[str]) -> None:
    lane = [
        Part("one", [saying("a", 3), saying("b")]),
        Part("two", [saying("c"), saying("d")]),
        Part("three", [saying("e")], needs=[saying("there is\nnone", 1)]),
        Part("four", [[sys.executable, "-c", "import os; print(os.environ['X'])"]], {"X": "f"}),
    ]
    done = Runner().lane(lane)
    assert [one.result for one in done] == ["FAILED", "passed", "left out", "passed"]
    assert [one.said for one in done] == ["a", "c\nd", "there is\nnone", "f"]
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].startswith("FAILED")
    assert lines[2].endswith("three: none")


def test_the_number_of_failed_parts_is_the_status(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    lanes = [
        [[Part("one", [saying("why", 1)])]],
        [[Part("two", [saying("x")])], [Part("three", [])]],
    ]
    monkeypatch.setattr(parts, "lanes", lambda *_: lanes)
    assert parts.main() == 1
    said = capsys.readouterr().out
    assert "why" in said
    assert "\nx" not in said
    assert [line.split()[-1] for line in said.splitlines()[-3:]] == ["one", "two", "three"]


def test_what_is_under_way_ends_with_the_runner(tmp_path: Path) -> None:
    runner, sign = Runner(), tmp_path / "sign"
    wait = f"import pathlib, time; pathlib.Path({str(sign)!r}).touch(); time.sleep(600)"
    lane = [Part("long", [[sys.executable, "-c", wait]]), Part("next", [saying("x")])]
    done: list[parts.Done] = []
    thread = threading.Thread(target=lambda: done.extend(runner.lane(lane)))
    thread.start()
    while not sign.exists():
        time.sleep(0.01)
    runner.end()
    thread.join()
    assert [one.result for one in done] == ["FAILED", "FAILED"]
    assert done[1].said == "it said nothing"


@pytest.mark.parametrize("full", [False, True])
def test_every_test_is_in_a_part(full: bool, tmp_path: Path) -> None:
    every = [part for group in parts.lanes(tmp_path, full) for lane in group for part in lane]
    assert len({part.name for part in every}) == len(every)
    servers, *others = every
    (asked,) = servers.commands
    ignored = {word.removeprefix("--ignore=") for word in asked if word.startswith("--ignore=")}
    elsewhere = {word for part in others for command in part.commands for word in command}
    assert ignored - elsewhere == (set() if full else {"tests/engines", "tests/wasm"})
    places = {word for part in every for one in part.commands for word in one if "tests/" in word}
    assert all((parts.ROOT / place.removeprefix("--ignore=")).exists() for place in places)


def test_a_kernel_that_cannot_be_had_is_named() -> None:
    if not kernel.taken(None):
        assert kernel.left_out("Haswell") == "numpy has no OpenBLAS here"
        return
    native = kernel.taken(None)
    assert kernel.left_out(native) == f"OpenBLAS takes {native} anyhow"
    assert kernel.left_out("Babbage") == f"asked for Babbage, OpenBLAS takes {native}"


def test_moved_bits_are_last_bits() -> None:
    from rounding import move_all

    A, e = np.random.default_rng(0).normal(size=(2, 30, 30)), np.ones((2, 30, 1))
    plain, moved = np.linalg.svd, move_all()["svd"]
    for one, other in zip(plain(A), moved(A), strict=True):
        assert 0 < abs(other / one - 1).max() <= 5e-16
    assert moved(A).S.shape == (2, 30)
    assert move_all()["solve"](A, e).shape == (2, 30, 1)
