"""Movies: what is asked is what is read back, and nothing broken is ever left behind."""

import os
import subprocess
import sys

import numpy as np
import pytest

from ikteach.formats import movie

ENDINGS = [".mp4", ".avi", ".gif"]
RED, PAPER = (200, 40, 30), (240, 240, 236)


def frames(count, size=(64, 48), fail_at=None):
    """A red square that moves 4 pixels to the right in each frame."""
    width, height = size
    for i in range(count):
        if i == fail_at:
            raise RuntimeError("the figure fell over")
        picture = np.full((height, width, 3), PAPER, dtype=np.uint8)
        picture[16:32, 4 * i : 4 * i + 16] = RED
        yield picture


@pytest.mark.parametrize("ending", ENDINGS)
@pytest.mark.parametrize(("rate", "size"), [(30, (64, 48)), (12.5, (96, 64)), (24, (64, 48))])
def test_size_rate_and_frames_are_those_asked_for(tmp_path, ending, rate, size):
    path = movie.write(tmp_path / f"walk{ending}", frames(11, size), rate=rate, size=size, count=11)
    facts = movie.facts(path)
    assert facts.size == size
    assert facts.frames == 11
    assert facts.rate == pytest.approx(rate, rel=0.02 if ending == ".gif" else 1e-6)
    assert os.listdir(tmp_path) == [f"walk{ending}"]


@pytest.mark.parametrize("ending", ENDINGS)
def test_the_pixels_come_back(tmp_path, ending):
    path = movie.write(tmp_path / f"walk{ending}", frames(10), rate=25)
    seen = list(movie.read(path))
    for i, (picture, asked) in enumerate(zip(seen, frames(10), strict=True)):
        inside = picture[20:28, 4 * i + 4 : 4 * i + 12].reshape(-1, 3).mean(axis=0)
        assert abs(inside - RED).max() < 25, i
        assert abs(picture[40:, 40:].reshape(-1, 3).mean(axis=0) - PAPER).max() < 12
        assert abs(picture.astype(float) - asked).mean() < (1 if ending == ".gif" else 8)


def test_frames_are_taken_one_by_one_and_no_more_than_asked(tmp_path):
    taken = []

    def endless():
        for picture in frames(1000, (64, 48)):
            taken.append(1)
            yield picture

    movie.write(tmp_path / "a.avi", endless(), rate=30, count=5)
    assert len(taken) <= 6
    assert movie.facts(tmp_path / "a.avi").frames == 5


def test_equal_frames_are_not_put_together(tmp_path):
    still = [next(frames(1))] * 7
    for ending in ENDINGS:
        path = movie.write(tmp_path / f"still{ending}", still, rate=20)
        assert movie.facts(path).frames == 7


def interrupted(path):
    with movie.writing(path, size=(64, 48), rate=30) as add:
        add(next(frames(1)))
        raise KeyboardInterrupt


@pytest.mark.parametrize("ending", ENDINGS)
def test_what_fails_or_stops_leaves_nothing(tmp_path, ending):
    path = tmp_path / f"walk{ending}"
    with pytest.raises(RuntimeError, match="fell over"):
        movie.write(path, frames(9, fail_at=5))
    assert os.listdir(tmp_path) == []
    with pytest.raises(KeyboardInterrupt):
        interrupted(path)
    assert os.listdir(tmp_path) == []
    with pytest.raises(ValueError, match="was to have 9 frames, but only 4 came"):
        movie.write(path, frames(4), count=9)
    with pytest.raises(ValueError, match="frame 1 is 32 × 32 pixels in a movie of 64 × 48"):
        movie.write(path, [next(frames(1)), next(frames(1, (32, 32)))])
    with pytest.raises(ValueError, match="at least one frame"):
        movie.write(path, [])
    with (
        pytest.raises(ValueError, match="at least one frame"),
        movie.writing(path, size=(64, 48), rate=30),
    ):
        pass
    assert os.listdir(tmp_path) == []


def test_no_file_is_overwritten_unasked(tmp_path):
    path = tmp_path / "walk.gif"
    path.write_bytes(b"mine")
    with pytest.raises(FileExistsError, match=r"walk.gif' already; overwrite=True would replace"):
        movie.write(path, frames(3))
    assert path.read_bytes() == b"mine"
    with pytest.raises(RuntimeError):
        movie.write(path, frames(9, fail_at=5), overwrite=True)
    assert path.read_bytes() == b"mine"  # the old one stays until the new one is complete
    movie.write(path, frames(3), overwrite=True)
    assert movie.facts(path).frames == 3


def test_a_file_that_comes_meanwhile_is_kept(tmp_path):
    path = tmp_path / "walk.avi"

    def meanwhile():
        yield from frames(3)
        path.write_bytes(b"mine")

    with pytest.raises(FileExistsError):
        movie.write(path, meanwhile())
    assert path.read_bytes() == b"mine"
    assert os.listdir(tmp_path) == ["walk.avi"]


@pytest.mark.parametrize(
    ("name", "asked", "sentence"),
    [
        ("walk.mov", {}, r"ends in .mp4, .avi, .gif, and that of 'walk.mov' has '.mov'"),
        ("walk", {}, "has no ending"),
        ("walk.mp4", {"size": (63, 48)}, "must be even: not 63 × 48, but 64 × 48"),
        ("walk.avi", {"size": (64, 47)}, "AVI must be even: not 64 × 47, but 64 × 48"),
        ("walk.mp4", {"size": (0, 48)}, "from 2 to 4096 pixels"),
        ("walk.mp4", {"size": (64.5, 48)}, "from 2 to 4096 pixels"),
        ("walk.mp4", {"rate": 0}, "more than 0 and at most 240 frames a second, not 0"),
        ("walk.mp4", {"rate": -3}, "more than 0"),
        ("walk.mp4", {"rate": float("nan")}, "more than 0"),
        ("walk.gif", {"rate": 60}, "at most 50 frames a second, not 60"),
    ],
)
def test_what_cannot_be_made_is_refused_before_it_costs_time(tmp_path, name, asked, sentence):
    asked = {"size": (64, 48), "rate": 30} | asked
    with pytest.raises(ValueError, match=sentence):
        movie.kind_of(tmp_path / name, **asked)
    with pytest.raises(ValueError, match=sentence):
        movie.write(tmp_path / name, frames(2), **asked)
    assert os.listdir(tmp_path) == []


def test_a_gif_can_be_odd(tmp_path):
    path = movie.write(tmp_path / "odd.gif", frames(3, (63, 41)))
    assert movie.facts(path).size == (63, 41)


def test_folders(tmp_path, monkeypatch):
    with pytest.raises(FileNotFoundError, match=r"no folder .*nowhere"):
        movie.write(tmp_path / "nowhere" / "walk.mp4", frames(2))
    (tmp_path / "walk.mp4").mkdir()
    with pytest.raises(IsADirectoryError, match="is a folder"):
        movie.write(tmp_path / "walk.mp4", frames(2))
    monkeypatch.setattr(os, "access", lambda path, mode: False)  # root may write anywhere
    with pytest.raises(PermissionError, match="nothing can be written in the folder"):
        movie.write(tmp_path / "b.mp4", frames(2))


@pytest.mark.parametrize(
    ("picture", "sentence"),
    [
        (np.zeros((48, 64), dtype=np.uint8), r"an array \(height, width, 3\), not \(48, 64\)"),
        (np.zeros((48, 64, 3)), "made of uint8, 0 to 255, not of float64"),
        ("picture", "not str"),
    ],
)
def test_what_is_no_frame(tmp_path, picture, sentence):
    with pytest.raises(ValueError, match=sentence):
        movie.write(tmp_path / "a.gif", [picture])


def test_what_is_no_movie(tmp_path):
    (tmp_path / "a.mp4").write_text("no movie")
    with pytest.raises(ValueError, match="is not a movie that can be read"):
        movie.facts(tmp_path / "a.mp4")
    with pytest.raises(FileNotFoundError, match="there is no movie"):
        list(movie.read(tmp_path / "b.mp4"))


def test_without_the_library_it_says_how_to_get_it(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "av", None)
    with pytest.raises(ImportError, match=r"pip install 'ikteach\[movie\]'"):
        movie.write(tmp_path / "a.mp4", frames(2))
    assert os.listdir(tmp_path) == []


def test_the_file_can_be_read_by_others(tmp_path):
    """A draft is private; the movie has the rights that any new file has."""
    (tmp_path / "plain").touch()
    path = movie.write(tmp_path / "a.gif", frames(2))
    assert path.stat().st_mode == (tmp_path / "plain").stat().st_mode


@pytest.mark.parametrize("ending", ENDINGS)
def test_a_damaged_movie_is_read_or_named(tmp_path, ending):
    whole = movie.write(tmp_path / f"a{ending}", frames(6)).read_bytes()
    rng, path = np.random.default_rng(0), tmp_path / f"b{ending}"
    said = set()
    for _ in range(60):
        data = bytearray(whole[: rng.integers(1, len(whole) + 1)])
        for place in rng.integers(0, len(data), size=rng.integers(0, 20)):
            data[place] = rng.integers(256)
        path.write_bytes(data)
        try:
            facts, seen = movie.facts(path), list(movie.read(path))
        except ValueError as error:
            said.add(str(error).rpartition("' ")[2])
        else:
            assert facts.frames == len(seen)
    assert said  # else none was damaged
    assert said <= {"is not a movie that can be read", "has no pictures in it"}


def test_a_movie_on_a_full_disk_is_a_sentence_and_no_file(tmp_path, monkeypatch):
    def full(_):
        raise OSError(28, "No space left on device")

    (tmp_path / "walk.gif").write_bytes(b"mine")
    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(OSError, match=r"^walk.gif cannot be written \(No space left on device\)"):
        movie.write(tmp_path / "walk.gif", frames(3), overwrite=True)
    assert (tmp_path / "walk.gif").read_bytes() == b"mine"
    assert os.listdir(tmp_path) == ["walk.gif"]


def test_the_draft_of_a_movie_that_was_killed_is_known_and_goes(tmp_path):
    code = """
import os, sys
import numpy as np
from ikteach.formats import movie
with movie.writing(sys.argv[1], size=(64, 48), rate=30) as add:
    add(np.zeros((48, 64, 3), dtype=np.uint8))
    os._exit(9)
"""
    path = tmp_path / "walk.avi"
    assert subprocess.run([sys.executable, "-B", "-c", code, str(path)]).returncode == 9
    (left,) = tmp_path.iterdir()
    assert left.name.startswith(".walk.avi.")
    assert left.suffix == ".part"
    os.utime(left, (0, 0))
    movie.write(path, frames(3))
    assert os.listdir(tmp_path) == ["walk.avi"]
