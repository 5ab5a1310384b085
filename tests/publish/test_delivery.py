"""Opening the course: nothing of the student's is lost, and JupyterLab opens the first chapter."""

import errno
import importlib.metadata
import importlib.util
import json
import os
import re
import shutil
import signal
import socket
import subprocess
import sys
import sysconfig
import tempfile
import time
import urllib.error
import urllib.request
import venv
import zipfile
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from ikteach import __main__ as cli
from ikteach.publish import delivery as opening
from ikteach.publish.delivery import MANIFEST, Delivery, chapters, deliver, find_course, report
from ikteach.serve import lab as serve

ROOT = Path(__file__).resolve().parents[2]
GAIT, STUDY = "07_gait.ipynb", "08_comparison.ipynb"


def notebook(*markdown: str) -> str:
    code = {"cell_type": "code", "source": ["# not a title\n"], "metadata": {}, "outputs": []}
    prose = [{"cell_type": "markdown", "source": text, "metadata": {}} for text in markdown]
    cells = [code | {"execution_count": None}, *prose]
    return json.dumps({"cells": cells, "metadata": {}, "nbformat": 4, "nbformat_minor": 4})


def outcomes(deliveries: list[Delivery]) -> dict[str, str]:
    return {delivery.name: delivery.outcome for delivery in deliveries}


def tree(folder: Path) -> dict[str, bytes]:
    paths = (path for path in folder.rglob("*") if path.is_file())
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in paths}


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


@pytest.fixture
def course(tmp_path: Path) -> Path:
    """Notebooks as they are in an installed package; `clone` makes a clone of it."""
    folder = tmp_path / "site" / "ikteach" / "notebooks"
    (folder / "data").mkdir(parents=True)
    (folder / ".ipynb_checkpoints").mkdir()
    (folder / GAIT).write_text(notebook(["Walk.\n", "# Gait: walking with σ\n"], "# no"), "utf-8")
    (folder / STUDY).write_text(notebook("# Comparison\n\n# second"), "utf-8")
    (folder / "data" / "walk.csv").write_text("1,2\n")
    (folder / ".ipynb_checkpoints" / GAIT).write_text("{}")
    (folder / ".hidden.ipynb").write_text("{}")
    return folder


@pytest.fixture
def home(tmp_path: Path) -> Path:
    return tmp_path / "students" / "my course"


@pytest.fixture
def clone(course: Path) -> Path:
    root = course.parents[1]
    course.rename(root / "notebooks")
    (root / "pyproject.toml").touch()
    return root / "notebooks"


@pytest.fixture
def lab(course: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> list[list[str]]:
    """The commands with which JupyterLab would be run, in place of running it."""
    commands: list[list[str]] = []
    monkeypatch.setattr(opening, "PACKAGE", course.parent)
    monkeypatch.setattr(serve, "run", lambda command, environment: commands.append(command) or 0)
    monkeypatch.chdir(tmp_path)
    return commands


# ---- the copy


def test_first_copy_has_everything_but_what_is_hidden(course: Path, home: Path) -> None:
    deliveries = deliver(course, home)
    assert outcomes(deliveries) == dict.fromkeys([GAIT, STUDY, "data/walk.csv"], "copied")
    assert set(tree(home)) == {GAIT, STUDY, "data/walk.csv", MANIFEST}
    assert (home / GAIT).read_bytes() == (course / GAIT).read_bytes()
    assert report(deliveries, home) == [f"copied 2 notebooks to {home}, other files: 1"]


def test_second_copy_writes_nothing(course: Path, home: Path) -> None:
    deliver(course, home)
    before = {path: path.stat() for path in home.rglob("*")}
    deliveries = deliver(course, home)
    assert set(outcomes(deliveries).values()) == {"current"}
    assert report(deliveries, home) == [f"nothing new for {home}"]
    after = {path: path.stat() for path in home.rglob("*")}
    assert {p: (s.st_ino, s.st_mtime_ns) for p, s in after.items() if p.is_file()} == {
        p: (s.st_ino, s.st_mtime_ns) for p, s in before.items() if p.is_file()
    }


def test_changed_file_is_kept(course: Path, home: Path) -> None:
    deliver(course, home)
    (home / GAIT).write_text("mine")
    deliveries = deliver(course, home)
    assert (home / GAIT).read_text() == "mine"
    assert set(tree(home)) == {GAIT, STUDY, "data/walk.csv", MANIFEST}  # our version is not newer
    assert report(deliveries, home) == [f"kept yours: {GAIT}"]


def test_unchanged_file_is_updated(course: Path, home: Path) -> None:
    deliver(course, home)
    (course / GAIT).write_text("second edition")
    deliveries = deliver(course, home)
    assert (home / GAIT).read_text() == "second edition"
    assert report(deliveries, home) == [f"updated: {GAIT}"]


def test_deleted_file_is_restored(course: Path, home: Path) -> None:
    deliver(course, home)
    (home / GAIT).unlink()
    shutil.rmtree(home / "data")
    deliveries = deliver(course, home)
    assert tree(home)[GAIT] == (course / GAIT).read_bytes()
    assert report(deliveries, home) == [f"restored: {GAIT}", "restored: data/walk.csv"]


def test_new_chapter_is_copied_and_counted(course: Path, home: Path) -> None:
    deliver(course, home)
    (course / "09_workbench.ipynb").write_text(notebook("# Workbench"))
    assert report(deliver(course, home), home) == [f"copied 1 notebook to {home}"]


def test_newer_version_goes_beside_a_changed_file_once(course: Path, home: Path) -> None:
    deliver(course, home)
    (home / GAIT).write_text("mine")
    (course / GAIT).write_text("second edition")
    deliveries = deliver(course, home)
    assert (home / GAIT).read_text() == "mine"
    assert (home / "07_gait.new.ipynb").read_text() == "second edition"
    assert report(deliveries, home) == [
        f"kept yours: {GAIT}; the newer version is beside it: 07_gait.new.ipynb"
    ]
    (home / "07_gait.new.ipynb").unlink()  # read and thrown away: not brought back
    assert report(deliver(course, home), home) == [f"kept yours: {GAIT}"]
    assert not (home / "07_gait.new.ipynb").exists()


def test_version_beside_is_updated_too(course: Path, home: Path) -> None:
    deliver(course, home)
    (home / "data" / "walk.csv").write_text("mine")
    for edition in ("second", "third"):
        (course / "data" / "walk.csv").write_text(edition)
        deliver(course, home)
        assert (home / "data" / "walk.new.csv").read_text() == edition
    assert (home / "data" / "walk.csv").read_text() == "mine"


def test_changed_version_beside_is_kept(course: Path, home: Path) -> None:
    deliver(course, home)
    (home / GAIT).write_text("mine")
    (home / "07_gait.new.ipynb").write_text("mine too")
    (course / GAIT).write_text("second edition")
    for _ in range(2):
        assert report(deliver(course, home), home) == [
            f"kept yours: {GAIT}",
            "kept yours: 07_gait.new.ipynb",
        ]
    assert (home / "07_gait.new.ipynb").read_text() == "mine too"
    (home / "07_gait.new.ipynb").unlink()  # there is room now, and the edition is still owed
    assert "beside" in report(deliver(course, home), home)[0]
    assert (home / "07_gait.new.ipynb").read_text() == "second edition"


def test_taking_over_the_newer_version_makes_the_file_ours_again(course: Path, home: Path) -> None:
    deliver(course, home)
    (home / GAIT).write_text("mine")
    (course / GAIT).write_text("second edition")
    deliver(course, home)
    (home / "07_gait.new.ipynb").replace(home / GAIT)
    (course / GAIT).write_text("third edition")
    assert outcomes(deliver(course, home))[GAIT] == "updated"


def test_file_that_was_there_before_us_is_kept(course: Path, home: Path) -> None:
    home.mkdir(parents=True)
    (home / GAIT).write_text("mine")
    (home / "notes.txt").write_text("mine")
    assert outcomes(deliver(course, home))[GAIT] == "kept"
    assert (home / GAIT).read_text() == (home / "notes.txt").read_text() == "mine"


@pytest.mark.parametrize(
    "damage", [b"", b"{", b"[]", b"null", b"\xff\xfe", b'{"07_gait.ipynb": 3}', b'"07"']
)
def test_damaged_manifest_counts_as_empty(course: Path, home: Path, damage: bytes) -> None:
    deliver(course, home)
    (home / MANIFEST).write_bytes(damage)
    (home / STUDY).write_text("mine")
    (course / GAIT).write_text("second edition")
    first_edition = (home / GAIT).read_bytes()
    assert outcomes(deliver(course, home)) == {
        GAIT: "kept",  # whether the student changed it is no longer known
        STUDY: "kept",
        "data/walk.csv": "current",
    }
    assert (home / GAIT).read_bytes() == first_edition
    assert (home / STUDY).read_text() == "mine"
    assert (home / "07_gait.new.ipynb").read_text() == "second edition"
    assert set(json.loads((home / MANIFEST).read_text())) > {GAIT, STUDY, "data/walk.csv"}


def test_interrupted_write_leaves_the_old_file_and_no_draft(
    course: Path, home: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    deliver(course, home)
    (course / GAIT).write_text("second edition")
    before = tree(home)

    def full(draft: Path, path: Path) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), str(draft))

    with monkeypatch.context() as patch:
        patch.setattr(os, "replace", full)
        with pytest.raises(OSError, match=rf"^{GAIT} cannot be written \(No space"):
            deliver(course, home)
    assert tree(home) == before
    assert outcomes(deliver(course, home))[GAIT] == "updated"


Step = tuple[str, str]
steps = st.tuples(
    st.sampled_from(["edit", "edit new", "delete", "delete new", "release", "lose manifest"]),
    st.sampled_from(["a", "b", "c"]),
)


@given(st.lists(steps, max_size=12))
@settings(max_examples=150, deadline=None)
def test_no_text_of_the_students_is_ever_lost(history: list[Step]) -> None:
    with tempfile.TemporaryDirectory() as scratch:
        course, home = Path(scratch, "course"), Path(scratch, "home")
        course.mkdir()
        (course / "1.md").write_text("edition 0")
        deliver(course, home)
        for number, (action, letter) in enumerate(history):
            name = "1.new.md" if "new" in action else "1.md"
            mine = f"mine {letter}"
            if action.startswith("edit"):
                (home / name).write_text(mine)
            elif action.startswith("delete"):
                (home / name).unlink(missing_ok=True)
            elif action == "release":
                (course / "1.md").write_text(f"edition {number} {letter}")
            else:
                (home / MANIFEST).write_text("damaged")
            before = tree(home)
            deliver(course, home)
            after = tree(home)
            kept = {name for name, text in before.items() if text.startswith(b"mine")}
            assert all(after[name] == before[name] for name in kept)
            assert (course / "1.md").read_bytes() in after.values() or kept


# ---- the chapters


def test_titles_are_the_first_headings_of_the_first_prose(course: Path) -> None:
    assert chapters(course) == {GAIT: "Gait: walking with σ", STUDY: "Comparison"}


@pytest.mark.parametrize(
    ("text", "title"),
    [
        (notebook(), ""),
        (notebook("no heading", "# too late"), ""),
        ("{", "(not a readable notebook)"),
        ("[]", "(not a readable notebook)"),
        ('{"cells": [{}]}', "(not a readable notebook)"),
    ],
)
def test_title_of_an_odd_notebook(tmp_path: Path, text: str, title: str) -> None:
    (tmp_path / GAIT).write_text(text)
    assert chapters(tmp_path) == {GAIT: title}


def test_course_of_a_wheel_and_of_a_clone(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    package = tmp_path / "ikteach"
    monkeypatch.setattr(opening, "PACKAGE", package)
    (package / "notebooks").mkdir(parents=True)
    (tmp_path / "notebooks").mkdir()  # somebody's folder in site-packages: no clone
    assert find_course() == (package / "notebooks", False)
    (tmp_path / "pyproject.toml").touch()
    assert find_course() == (tmp_path / "notebooks", True)
    (tmp_path / "notebooks").rmdir()  # somebody's project that has the package copied into it
    assert find_course() == (package / "notebooks", False)


# ---- the command line


def test_list_needs_no_jupyterlab_and_writes_nothing(
    lab: list[list[str]],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    before = tree(tmp_path)
    assert cli.main(["somewhere", "--list"]) == 0
    assert capsys.readouterr().out.splitlines() == [
        "07_gait.ipynb        Gait: walking with σ",
        "08_comparison.ipynb  Comparison",
    ]
    assert tree(tmp_path) == before
    assert not lab


def test_installed_course_is_copied_and_opened(
    lab: list[list[str]], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert cli.main([]) == 0
    folder = tmp_path / "ikteach-course"
    assert (folder / GAIT).is_file()
    said = capsys.readouterr().out.splitlines()
    assert said[0].startswith(f"copied 2 notebooks to {folder}")
    assert said[-1].startswith(f"opening {folder / GAIT} ")
    [command] = lab
    assert command[:3] == [sys.executable, "-m", "jupyterlab"]
    assert f"--ServerApp.root_dir={folder}" in command
    assert f"--LabApp.default_url=/lab/tree/{GAIT}" in command
    assert not any("port" in option or "token" in option for option in command)


def test_clone_is_opened_itself_uncopied(clone: Path, lab: list[list[str]], tmp_path: Path) -> None:
    before = tree(tmp_path)
    assert cli.main([]) == cli.main([str(clone)]) == 0
    assert all(f"--ServerApp.root_dir={clone}" in command for command in lab)
    assert len(lab) == 2
    assert tree(tmp_path) == before


def test_clone_is_copied_into_a_named_folder(
    clone: Path, lab: list[list[str]], tmp_path: Path
) -> None:
    assert cli.main(["mine"]) == 0
    assert (tmp_path / "mine" / GAIT).read_bytes() == (clone / GAIT).read_bytes()
    assert f"--ServerApp.root_dir={tmp_path / 'mine'}" in lab[0]


def test_kernels_of_a_clone_find_its_package(course: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PYTHONPATH", "before")
    monkeypatch.setattr(opening, "PACKAGE", course.parent)
    in_wheel, in_clone = opening.CourseFolder(course, False), opening.CourseFolder(course, True)
    assert serve.environment(in_wheel)["PYTHONPATH"] == "before"
    paths = serve.environment(in_clone)["PYTHONPATH"].split(os.pathsep)
    assert paths == [str(course.parents[1]), "before"]


def test_first_chapter_is_quoted_in_the_address(lab: list[list[str]], course: Path) -> None:
    (course / "00 the figure & θ.ipynb").write_text(notebook("# Figure"))
    assert cli.main([]) == 0
    assert "--LabApp.default_url=/lab/tree/00%20the%20figure%20%26%20%CE%B8.ipynb" in lab[0]


def test_what_follows_two_dashes_is_jupyterlabs(lab: list[list[str]], tmp_path: Path) -> None:
    assert cli.main(["--no-browser", "--", "--allow-root", "--port=1"]) == 0
    assert lab[0][-3:] == ["--no-browser", "--allow-root", "--port=1"]
    assert (tmp_path / "ikteach-course").is_dir()


def test_missing_jupyterlab(
    lab: list[list[str]],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    assert cli.main([]) == 1
    said = capsys.readouterr()
    assert said.err == "JupyterLab is not installed. Install it with: pip install 'ikteach[lab]'\n"
    assert said.out == ""
    assert not lab
    assert not (tmp_path / "ikteach-course").exists()


@pytest.mark.parametrize("port", ["0", "65536", "-1", "1e3", "eight", ""])
def test_impossible_port(
    lab: list[list[str]], port: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as ended:
        cli.main(["--port", port])
    assert ended.value.code == 2
    assert f"--port: {port!r} is not a port; ports are 1 to 65535" in capsys.readouterr().err


def test_port_is_used_exactly(lab: list[list[str]]) -> None:
    port = free_port()
    assert cli.main(["--port", str(port)]) == 0
    assert {f"--ServerApp.port={port}", "--ServerApp.port_retries=0"} < set(lab[0])


def test_taken_port(
    lab: list[list[str]], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        assert cli.main(["--port", str(port)]) == 1
    assert capsys.readouterr().err == (
        f"Port {port} is taken; leave out --port to let JupyterLab find a free one, "
        "or name another.\n"
    )
    assert not lab
    assert not (tmp_path / "ikteach-course").exists()


def test_forbidden_port(
    lab: list[list[str]], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def forbidden(*_: object) -> socket.socket:
        raise PermissionError(errno.EACCES, "Permission denied (while attempting to bind)")

    monkeypatch.setattr(socket, "create_server", forbidden)
    assert cli.main(["--port", "80"]) == 1
    assert "Port 80 cannot be used (Permission denied); leave out" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("folder", "reason"),
    [("file", "It is a file, not a folder"), ("file/below", "Not a directory")],
)
def test_folder_that_cannot_be_one(
    lab: list[list[str]],
    tmp_path: Path,
    folder: str,
    reason: str,
    capsys: pytest.CaptureFixture[str],
) -> None:
    (tmp_path / "file").write_text("mine")
    assert cli.main([folder]) == 1
    sentence = f"The course cannot be opened: {tmp_path / folder}: {reason}.\n"
    assert capsys.readouterr() == ("", sentence)
    assert (tmp_path / "file").read_text() == "mine"
    assert not lab


def test_folder_without_permission(
    lab: list[list[str]],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    def denied(path: Path, *_: object, **__: object) -> None:
        raise PermissionError(errno.EACCES, "Permission denied", str(path))

    monkeypatch.setattr(Path, "mkdir", denied)
    assert cli.main(["mine"]) == 1
    sentence = f"The course cannot be opened: {tmp_path / 'mine'}: Permission denied.\n"
    assert capsys.readouterr().err == sentence
    assert not lab


def test_copy_among_the_originals_is_refused(
    lab: list[list[str]], course: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    before = tree(course)
    assert cli.main([str(course / "mine")]) == 1
    assert "A copy cannot go among the originals" in capsys.readouterr().err
    assert tree(course) == before


def test_package_without_notebooks(
    lab: list[list[str]], course: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    shutil.rmtree(course)
    assert cli.main(["--list"]) == cli.main([]) == 1
    assert capsys.readouterr().err == f"There are no notebooks in {course}.\n" * 2


@pytest.mark.parametrize(
    ("user", "code", "extra", "hinted"),
    [
        (0, 1, [], True),
        (0, 1, ["--allow-root"], False),
        (0, 0, [], False),
        (1000, 1, [], False),
        (None, 1, [], False),
    ],
)
def test_refusal_of_root_is_explained(
    lab: list[list[str]],
    user: int | None,
    code: int,
    extra: list[str],
    hinted: bool,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.delattr(os, "geteuid", raising=False)  # as on Windows
    if user is not None:
        monkeypatch.setattr(os, "geteuid", lambda: user, raising=False)
    monkeypatch.setattr(serve, "run", lambda command, environment: code)
    assert cli.main(["--", *extra]) == code
    assert ("python -m ikteach -- --allow-root" in capsys.readouterr().err) == hinted


def test_command_line_loads_nothing_heavy() -> None:
    heavy = ["pandas", "matplotlib", "ipywidgets", "pythreejs", "jupyterlab", "scipy"]
    code = f"import sys, ikteach.__main__; print([name for name in {heavy} if name in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True)
    assert (done.stdout.strip(), done.stderr) == ("[]", "")


# ---- the real thing: a wheel, and JupyterLab


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The wheel of this tree, built from a copy, with a chapter added if there is none yet."""
    source = tmp_path_factory.mktemp("source")
    litter = shutil.ignore_patterns("__pycache__", ".ipynb_checkpoints", MANIFEST)
    for name in ("ikteach", "notebooks"):
        (source / name).mkdir()
        if (ROOT / name).is_dir():
            shutil.copytree(ROOT / name, source / name, ignore=litter, dirs_exist_ok=True)
    for name in ("pyproject.toml", "README.md", "LICENSE", "LICENSE-CC-BY-4.0"):
        (source / name).write_bytes((ROOT / name).read_bytes() if (ROOT / name).exists() else b"#")
    if not chapters(source / "notebooks"):
        (source / "notebooks" / GAIT).write_text(notebook("# Gait"))
    # With hatchling at hand the build needs no network.
    isolation = ["--no-build-isolation"] if importlib.util.find_spec("hatchling") else []
    build = [sys.executable, "-m", "pip", "wheel", "--no-deps", *isolation]
    subprocess.run([*build, "--wheel-dir", source, source], check=True, capture_output=True)
    [built] = source.glob("*.whl")
    return built


class Installed(NamedTuple):
    """A fresh environment's command `ikteach`, and the folder of its packages."""

    command: Path
    site: Path


@pytest.fixture(scope="module")
def installed(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Installed:
    """The wheel in a fresh environment; what it depends on is borrowed from ours."""
    place = tmp_path_factory.mktemp("fresh")
    venv.create(place, with_pip=False)
    scripts, end = (place / "Scripts", ".exe") if os.name == "nt" else (place / "bin", "")
    python = scripts / f"python{end}"
    pip = [sys.executable, "-m", "pip", "--python", python, "install", "--no-deps", "--no-index"]
    subprocess.run([*pip, wheel], check=True, capture_output=True)
    where = [python, "-c", "import sysconfig; print(sysconfig.get_path('purelib'))"]
    site = Path(subprocess.run(where, check=True, capture_output=True, text=True).stdout.strip())
    # A path in a .pth file comes last, so that `ikteach` is the wheel's, not ours.
    (site / "borrowed.pth").write_text(sysconfig.get_path("purelib"), "utf-8")
    return Installed(scripts / f"ikteach{end}", site)


def test_wheel_carries_every_notebook(wheel: Path) -> None:
    with zipfile.ZipFile(wheel) as archive:
        names = archive.namelist()
    expected = chapters(wheel.parent / "notebooks")
    assert {f"ikteach/notebooks/{name}" for name in expected} <= set(names)
    assert "ikteach/course/checking.py" in names
    for name in ("pages/workbench.ipynb", "look/index.html.j2"):
        assert f"ikteach/serve/lecture/{name}" in names
    assert not any("/solutions/" in name for name in names)


def test_installed_command_lists_copies_and_refuses(installed: Installed, tmp_path: Path) -> None:
    def ikteach(*arguments: str) -> subprocess.CompletedProcess[str]:
        command = [installed.command, *arguments]
        return subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)

    listed = ikteach("--list")
    assert (listed.returncode, listed.stderr) == (0, "")
    names = [line.split()[0] for line in listed.stdout.splitlines()]
    assert names[0] == "prerequisites.ipynb"  # then the chapters, by their numbers
    assert names[1:] == sorted(names[1:])
    assert len(names) > 10
    assert not list(tmp_path.iterdir())
    # `--version` makes JupyterLab end at once, after the copy is made.
    copied = ikteach("mine", "--no-browser", "--", "--version")
    assert copied.returncode == 0, copied.stderr
    assert copied.stdout.startswith(f"copied {len(names)} notebook")
    assert importlib.metadata.version("jupyterlab") in copied.stdout
    assert set(names) <= set(tree(tmp_path / "mine"))
    (tmp_path / "mine" / names[0]).write_text("mine")
    again = ikteach("mine", "--no-browser", "--", "--version")
    assert again.stdout.startswith(f"kept yours: {names[0]}\n")
    assert (tmp_path / "mine" / names[0]).read_text() == "mine"
    refused = ikteach(f"mine/{names[0]}")
    assert (refused.returncode, refused.stdout) == (1, "")
    assert "It is a file, not a folder" in refused.stderr
    assert "Traceback" not in refused.stderr


class Server:
    """JupyterLab as opened by the installed wheel at a terminal; what it says goes to a file."""

    def __init__(self, site: Path, folder: Path) -> None:
        self.port, self.said = free_port(), folder / "said.txt"
        places = {f"JUPYTER_{name}_DIR": str(folder / name) for name in ("CONFIG", "RUNTIME")}
        command = [sys.executable, "-m", "ikteach", "course", "--no-browser", f"--port={self.port}"]
        self.keyboard, terminal = os.openpty()
        with self.said.open("w") as said:
            self.process = subprocess.Popen(
                [*command, "--", "--allow-root", "--IdentityProvider.token=test"],
                cwd=folder,
                env=os.environ | places | {"PYTHONPATH": str(site)},
                stdin=terminal,
                stdout=said,
                stderr=subprocess.STDOUT,
                start_new_session=True,
            )
        os.close(terminal)

    def get(self, path: str, method: str = "GET") -> tuple[str, bytes]:
        """The address that the answer came from in the end, and the answer."""
        address, key = f"http://127.0.0.1:{self.port}{path}", {"Authorization": "token test"}
        request = urllib.request.Request(address, headers=key, method=method)
        with urllib.request.urlopen(request, timeout=10) as answer:
            assert answer.status == 200
            return answer.url, answer.read()

    def wait_until_up(self, seconds: float = 90) -> None:
        end = time.monotonic() + seconds
        while time.monotonic() < end and self.process.poll() is None:
            try:
                self.get("/api/status")
                return
            except OSError:
                time.sleep(0.1)
        raise AssertionError(self.said.read_text())

    def wait_until_said(self, words: str, seconds: float = 30) -> None:
        end = time.monotonic() + seconds
        while words not in self.said.read_text():
            assert time.monotonic() < end, self.said.read_text()
            time.sleep(0.02)


@pytest.fixture
def server(installed: Installed, tmp_path: Path) -> Iterator[Server]:
    server = Server(installed.site, tmp_path)
    yield server
    if server.process.poll() is None:
        server.wait_until_up()
        server.get("/api/shutdown", "POST")
    server.process.wait(30)
    os.close(server.keyboard)


@pytest.mark.skipif(os.name == "nt", reason="Windows can send SIGINT to nobody")
def test_jupyterlab_serves_the_first_chapter_and_stops_on_ctrl_c(
    server: Server, tmp_path: Path
) -> None:
    server.wait_until_up()
    first = next(name for name in chapters(tmp_path / "course") if name[0].isdigit())
    said = server.said.read_text()
    assert f"opening {tmp_path / 'course' / first} in JupyterLab" in said
    address, page = server.get("/")
    assert address.endswith(f"/lab/tree/{first}")
    assert b'"news": {"disabled": true}' in page
    (off,) = re.findall(rb'"disabledExtensions": \[(.*?)\]', page)
    assert b"apputils-extension:announcements" in off  # which asks whether news are wanted
    assert json.loads(server.get("/lab/api/update")[1]) == {"notification": None}
    served = json.loads(server.get(f"/api/contents/{first}?format=text&type=file")[1])
    assert served["content"] == (tmp_path / "course" / first).read_text("utf-8")
    with pytest.raises(urllib.error.HTTPError, match="403") as refused:
        urllib.request.urlopen(f"http://127.0.0.1:{server.port}/api/contents")
    refused.value.close()  # without the token nothing is given out

    server.process.send_signal(signal.SIGINT)
    assert server.process.wait(30) == 0
    later = server.said.read_text().removeprefix(said)
    assert "Traceback" not in later
    assert "KeyboardInterrupt" not in later
    with pytest.raises(OSError, match="refused"):
        server.get("/api/status")  # nothing is left behind


@pytest.mark.skipif(os.name == "nt", reason="Windows can send SIGINT to nobody")
def test_ctrl_c_of_a_terminal_reaches_the_whole_group_and_ends_all(server: Server) -> None:
    server.wait_until_up()
    os.killpg(server.process.pid, signal.SIGINT)
    assert server.process.wait(30) == 0
    said = server.said.read_text()
    assert "Shut down this Jupyter server" not in said  # JupyterLab's question, which waits for y
    assert "Traceback" not in said
    with pytest.raises(OSError, match="refused"):
        server.get("/api/status")


@pytest.mark.skipif(os.name == "nt", reason="Windows can send SIGINT to nobody")
def test_ctrl_c_while_jupyterlab_is_still_starting(server: Server) -> None:
    server.wait_until_said("opening ")
    time.sleep(0.3)  # now Python is importing JupyterLab, which would answer with a traceback
    os.killpg(server.process.pid, signal.SIGINT)
    assert server.process.wait(30) in (0, 128 + signal.SIGTERM)
    assert "Traceback" not in server.said.read_text()
