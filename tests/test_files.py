"""Files are written whole or not at all, and by one process after the other."""

import json
import os
import subprocess
import sys
import threading
import time
import types
from errno import EACCES, ENOLCK, ENOSPC, EPERM
from pathlib import Path

import numpy as np
import pytest

from ikteach import files
from ikteach.course import record


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def fails(number):
    def fail(*_, **__):
        raise OSError(number, os.strerror(number))

    return fail


# ---- whole or not at all


@pytest.mark.parametrize("step", ["open", "fsync", "replace"])
@pytest.mark.parametrize("number", [ENOSPC, EACCES])
def test_what_fails_leaves_the_old_file_and_no_draft(monkeypatch, step, number):
    Path("a.txt").write_text("old")
    with monkeypatch.context() as patch:
        patch.setattr(os, step, fails(number))
        with pytest.raises(OSError, match=r"^a.txt cannot be written \(") as refused:
            files.write_whole("a.txt", "new", overwrite=True)
    assert type(refused.value) is (PermissionError if number == EACCES else OSError)
    assert os.listdir() == ["a.txt"]
    assert Path("a.txt").read_text() == "old"
    files.write_whole("a.txt", "new", overwrite=True)
    assert Path("a.txt").read_text() == "new"


def test_a_draft_that_is_left_by_an_exception_goes():
    def leave(error):
        with files.drafted("a.txt") as draft:
            draft.write_text("half")
            raise error

    for error in (KeyboardInterrupt, ZeroDivisionError):
        with pytest.raises(error):
            leave(error)
    with pytest.raises(FileNotFoundError, match="other"), files.drafted("a.txt"):
        raise FileNotFoundError(2, "another file's trouble", "other")
    assert os.listdir() == []


def test_nothing_is_overwritten_unasked():
    files.write_whole("a.txt", "mine")
    with pytest.raises(FileExistsError, match=r"'a.txt' already|/a.txt' already"):
        files.write_whole("a.txt", "new")
    with pytest.raises(FileExistsError, match="would replace it"), files.drafted("b.txt"):
        Path("b.txt").write_text("mine")  # it comes meanwhile
    assert Path("a.txt").read_text() == Path("b.txt").read_text() == "mine"
    assert sorted(os.listdir()) == ["a.txt", "b.txt"]


def test_on_a_disk_without_links(monkeypatch):
    monkeypatch.setattr(os, "link", fails(EPERM))
    files.write_whole("a.txt", "mine")
    with pytest.raises(FileExistsError), files.drafted("b.txt"):
        Path("b.txt").write_text("mine")
    assert Path("b.txt").read_text() == "mine"
    assert sorted(os.listdir()) == ["a.txt", "b.txt"]


def test_rights_links_and_long_names(folder, monkeypatch):
    Path("plain").touch()
    files.write_whole("new", b"x")
    assert os.stat("new").st_mode == os.stat("plain").st_mode
    os.chmod("new", 0o640)
    files.write_whole("new", b"y", overwrite=True)
    assert os.stat("new").st_mode & 0o777 == 0o640
    Path("there").mkdir()
    Path("there/real").write_text("old")
    Path("link").symlink_to("there/real")
    files.write_whole("link", "new", overwrite=True)
    assert Path("link").is_symlink()
    assert Path("there/real").read_text() == "new"
    for long in ("n" * 255, "ö" * 127):
        files.write_whole(long, "x")
        assert Path(long).read_text() == "x"
    with pytest.raises(OSError, match="cannot be written") as refused:
        files.write_whole("n" * 256, "x")
    assert len(str(refused.value)) < 300


def test_what_cannot_be_written_to(monkeypatch):
    os.mkfifo("pipe")
    Path("dir").mkdir()
    for name in ("pipe", "dir"):
        with pytest.raises(IsADirectoryError, match="is not an ordinary file"):
            files.write_whole(name, "x", overwrite=True)
    with pytest.raises(FileNotFoundError, match="there is no folder"):
        files.write_whole("nowhere/a", "x")
    Path("a").write_text("old")
    monkeypatch.setattr(os, "access", lambda *_: False)  # root may write to anything
    with pytest.raises(PermissionError, match=r"a cannot be written \(it is read-only"):
        files.write_whole("a", "new", overwrite=True)
    assert Path("a").read_text() == "old"


KILLED = """
import os
from ikteach import files
os.fsync = lambda _: os._exit(9)
files.write_whole("a.txt", "new", overwrite=True)
"""


def python(code, **options):
    return subprocess.Popen([sys.executable, "-B", "-c", code], **options)


def test_a_draft_of_who_was_killed_is_known_and_goes_when_it_is_old():
    Path("a.txt").write_text("old")
    assert python(KILLED).wait() == 9
    (left,) = [name for name in os.listdir() if name != "a.txt"]
    assert left.startswith(".a.txt.")
    assert left.endswith(".part")
    assert Path("a.txt").read_text() == "old"
    files.write_whole("a.txt", "new", overwrite=True)
    assert Path(left).exists()  # it may be that of another process
    long_ago = time.time() - 2 * files.LEFT_BEHIND
    os.utime(left, (long_ago, long_ago))
    files.write_whole("a.txt", "newer", overwrite=True)
    assert os.listdir() == ["a.txt"]


def test_windows_is_asked_again(monkeypatch):
    """There nothing can be replaced while another program has it open, if only for a moment."""
    monkeypatch.setattr(sys, "platform", "win32")
    replace, calls = os.replace, []

    def busy(draft, path):
        calls.append(path)
        if len(calls) < 3:
            raise PermissionError(EACCES, "Access is denied")
        replace(draft, path)

    monkeypatch.setattr(os, "replace", busy)
    files.write_whole("a.txt", "new", overwrite=True)
    assert Path("a.txt").read_text() == "new"
    assert len(calls) == 3


# ---- words


def test_words_are_bounded_and_can_be_written():
    assert len(files.quoted("x" * 500_000)) <= 200
    assert len(files.quoted([["x" * 1000] * 1000] * 1000)) <= 200
    assert files.quoted(10**10_000) == "<int>"
    assert len(files.bounded("y" * 500_000, 100)) <= 100
    assert files.bounded("a\ud800b") == "a?b"

    class Mute:
        def __str__(self):
            raise RuntimeError

        __repr__ = __str__

    value = {"a": np.float64(0.1), 3: np.array([1, np.nan, np.inf]), "t": (1, None, True),
             "big": 10**400, "odd": Mute(), "half": "\ud800", "bool": np.bool_(True)}  # fmt: skip
    plain = files.jsonable(value)
    assert json.loads(json.dumps(plain, allow_nan=False)) == plain
    assert plain["a"] == 0.1
    assert plain["3"] == [1.0, "nan", "inf"]
    assert plain["t"] == [1, None, True]
    assert plain["half"] == "?"


# ---- one after the other

STORE = """
import sys
from ikteach import files
from ikteach.course import record
if sys.argv[2:] == ["by name"]:
    files._lock = lambda _: False
for i in range(25):
    assert not record.store("quiz", f"{sys.argv[1]}.{i}", again=True, n=i)
    assert not record.store("quiz", "both", again=True, n=i)
"""


@pytest.mark.parametrize("way", [[], ["by name"]], ids=["lock", "name"])
def test_kernels_in_one_folder_lose_nothing(folder, way):
    kernels = [subprocess.Popen([sys.executable, "-B", "-c", STORE, who, *way]) for who in "abc"]
    assert [one.wait() for one in kernels] == [0, 0, 0]
    kept = json.loads((folder / "predictions.json").read_text())["quiz"]
    for who in "abc":
        assert [key for key in kept if key[0] == who and key != "both"] == [
            f"{who}.{i}" for i in range(25)
        ]
    assert kept["both"]["tries"] == 75
    assert not [name for name in os.listdir() if name.endswith((".part", ".made"))]


HOLD = """
import sys, time
from ikteach import files
if sys.argv[1:] == ["by name"]:
    files._lock = lambda _: False
with files.alone("predictions.json"):
    print("held", flush=True)
    time.sleep(600)
"""


@pytest.mark.parametrize("way", [[], ["by name"]], ids=["lock", "name"])
def test_a_kernel_that_was_killed_holds_nobody_up(folder, monkeypatch, way):
    if way:
        monkeypatch.setattr(files, "_lock", lambda _: False)
        monkeypatch.setattr(files, "ABANDONED", 0.2)
    command = [sys.executable, "-B", "-c", HOLD, *way]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as kernel:
        assert kernel.stdout.readline() == "held\n"
        kernel.kill()
    assert record.store("quiz", "k", answer="a") == ""
    assert record.entry("quiz", "k")["answer"] == "a"


def test_a_kernel_that_holds_on_is_told_of_and_nothing_is_lost(folder, monkeypatch):
    monkeypatch.setattr(files, "PATIENCE", 0.1)
    with files.alone(folder / "predictions.json"):
        said = record.store("quiz", "first", answer="a")
    assert said == (
        "predictions.json cannot be written (another notebook holds it): "
        "your answers are kept until the kernel stops."
    )
    assert record.entry("quiz", "first")["answer"] == "a"
    assert not (folder / "predictions.json").exists()
    assert record.store("quiz", "second", answer="b") == ""
    assert list(json.loads((folder / "predictions.json").read_text())["quiz"]) == [
        "first",
        "second",
    ]


@pytest.mark.parametrize("number", [ENOLCK, EPERM])
def test_where_the_system_has_no_locks_a_name_is_one(folder, monkeypatch, number):
    import fcntl

    if number == ENOLCK:
        monkeypatch.setattr(fcntl, "flock", fails(ENOLCK))
    else:
        monkeypatch.setitem(sys.modules, "fcntl", None)  # as in the browser
    inside = []

    def work(i):
        with files.alone("a"):
            inside.append(("in", i))
            time.sleep(0.01)
            inside.append(("out", i))

    workers = [threading.Thread(target=work, args=(i,)) for i in range(4)]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    for began, ended in zip(inside[::2], inside[1::2], strict=True):
        assert (began[0], ended[0]) == ("in", "out")
        assert began[1] == ended[1]
    assert os.listdir() == [".a.lock"]


def test_on_windows_its_own_lock_is_taken(folder, monkeypatch):
    held, said = set(), []

    def locking(file, what, size):
        where = os.fstat(file).st_ino
        said.append(what)
        if what == "unlock":
            held.remove(where)
        elif where in held:
            raise PermissionError(EACCES, "Permission denied")
        else:
            held.add(where)

    fake = types.SimpleNamespace(locking=locking, LK_NBLCK="lock", LK_UNLCK="unlock")
    monkeypatch.setitem(sys.modules, "msvcrt", fake)
    monkeypatch.setattr(sys, "platform", "win32")
    monkeypatch.setattr(files, "PATIENCE", 0.05)
    with (
        files.alone("a"),
        pytest.raises(TimeoutError, match="another notebook holds it"),
        files.alone("a"),
    ):
        pass
    assert held == set()
    with files.alone("a"):
        assert held
    assert said[-1] == "unlock"


# ---- answers


@pytest.mark.parametrize(
    "content",
    [
        "[" * 100_000,
        '{"quiz": {"k": {"tries": null}}}',
        '{"quiz": {"k": {"tries": "3"}}}',
        '{"quiz": {"k": {"tries": -1}}}',
        '{"quiz": {"k": {"tries": true}}}',
        '{"quiz": {"k": {"at": 3}}}',
        '{"quiz": {"x": {"answer": "\\ud800"}}}',
        '{"quiz": {"x": {"answer": ' + "9" * 400 + "}}}",
        '{"quiz": {"x": {"answer": 1e999}}}',
        '{"quiz": []}',
        "\0",
    ],
)
def test_answers_that_are_none_are_set_aside_and_not_lost(folder, content):
    (folder / "predictions.json").write_text(content)
    assert record.entries("quiz") == {}
    said = record.store("quiz", "k", again=True, answer="a")
    assert said == (
        "predictions.json was damaged; it is now predictions.damaged-1.json, "
        "and a new one was begun."
    )
    assert (folder / "predictions.damaged-1.json").read_text() == content
    assert record.entry("quiz", "k")["tries"] == 1


def test_answers_of_any_age_are_read(folder):
    old = '{"predictions": {"a": {"result": NaN, "answer": 1}}, "quiz": {"k": {"tries": 2}}}'
    (folder / "predictions.json").write_text(old)
    assert record.entry("predictions", "a") == {"result": "NaN", "answer": 1}
    assert record.store("quiz", "k", again=True) == ""
    assert record.entry("quiz", "k")["tries"] == 3
    json.loads(
        (folder / "predictions.json").read_text(), parse_constant=lambda _: pytest.fail("not JSON")
    )


def test_no_answer_makes_the_file_long(folder):
    for value in ("x" * 10**6, [1.5] * 10**6, np.zeros(10**6), {"a": ["b" * 10**6]}):
        assert record.store("predictions", "k", result=value) == ""
        assert (folder / "predictions.json").stat().st_size < 5000
    for value in (float("nan"), "\ud800", 10**400, object()):
        assert record.store("predictions", "k", result=value) == ""
    assert isinstance(record.entry("predictions", "k")["result"], str)
