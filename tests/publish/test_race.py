"""The moving picture of the README is what one command records."""

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from ikteach import __main__ as cli
from ikteach.formats import movie
from ikteach.publish import docs

PICTURE = docs.OWN / "walk.gif"
SMALL = ["--size", "160x80", "--rate", "5"]


def test_the_picture_of_the_readme_is_small_and_moves() -> None:
    assert PICTURE.stat().st_size < 1e6
    frames = list(movie.read(PICTURE))
    assert all(np.any(a != b) for a, b in pairwise(frames))


def test_a_film_is_one_period_and_overwrites_nothing(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "a.gif"
    assert cli.main(["film", str(path), *SMALL]) == 0
    assert f"{path}: " in capsys.readouterr().out
    facts = movie.facts(path)
    assert facts.size == (160, 80)
    assert facts.frames == 6  # of a period of 1.12 s
    assert cli.main(["film", str(path), *SMALL]) == 1
    assert "a.gif" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        (["a.txt"], "ends in .mp4, .avi, .gif"),
        (["a.gif", "--rate", "0"], "rate must be more than 0"),
        (["a.gif", "--rate", "nan"], "rate must be more than 0"),
        (["a.mp4", "--size", "161x80"], "must be even"),
        (["a.gif", "--size", "0x0"], "from 2 to"),
        (["gone/a.gif"], "no folder"),
    ],
)
def test_what_cannot_be_filmed_is_said(
    wrong: list[str], words: str, tmp_path: Path, capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:  # fmt: skip
    monkeypatch.chdir(tmp_path)
    assert cli.main(["film", *wrong]) == 1
    assert words in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


def test_a_size_is_two_numbers(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        cli.main(["film", "a.gif", "--size", "large"])
    assert "'large' is not WIDTHxHEIGHT" in capsys.readouterr().err
