"""Marks of a class: every answer is judged again, and nobody can mark or harm another."""

import json
import os
import re
import shutil
from pathlib import Path
from typing import Any

import nbformat
import pandas as pd
import pytest

from ikteach.__main__ import main
from ikteach.publish import builds
from ikteach.publish.collect import SKIPPED
from ikteach.publish.grading.handed_in import answers, hand_ins
from ikteach.publish.grading.judging import Judging
from ikteach.publish.grading.scheme import every_exercise

FULL = bool(os.environ.get("IKTEACH_FULL"))
KEYS = ["00.hand", "01.column", "05.bound", "09.mix"]
HEAD = "import numpy as np\n"
NAMES = {"00.hand": "hand", "01.column": "column", "05.bound": "safe_damping", "09.mix": "my_mix"}
RIGHT = {key: builds.solution(key) for key in KEYS}
WRONG = {
    "00.hand": "def hand(t, a):\n    return a @ np.cos(t), a @ np.sin(t)",
    "01.column": "def column(v, p, s):\n    return np.cross(s - p, v)",
    "05.bound": "def safe_damping(e, longest):\n    return np.linalg.norm(e) / longest",
    "09.mix": "my_mix = dict.fromkeys(['foot.l', 'foot.r', 'hand.l', 'hand.r'], 'transpose')",
}
EMPTY = {
    "00.hand": "def hand(theta, lengths):\n    ...",
    "01.column": "def column(v, p, s):\n    return ...",
    "05.bound": "def safe_damping(e, longest):\n    return ...",
    "09.mix": "my_mix = dict.fromkeys(['foot.l', 'foot.r', 'hand.l', 'hand.r'], ...)",
}
POINTS = '[points]\n"00.hand" = 2\n"01.column" = 1\n"05.bound" = 1.5\n"09.mix" = 0.5\n'
ALL = 5.0


def hostile(lines: str) -> str:
    """An answer to 00.hand that does something first, and then gives a wrong hand."""
    body = "".join(f"    {line}\n" for line in lines.splitlines())
    return f"def hand(theta, lengths):\n{body}    return [9.0, 9.0]"


HOSTILE = {
    "never ends": "while True:\n    try:\n        while True: pass\n    except BaseException: pass",
    "takes all memory": "a = []\nwhile True: a.append(np.ones(10**7))",
    "prints": "for i in range(10**5): print('x' * 1000)",
    "leaves": "import os; os._exit(0)",
    "kills": "import os; os.kill(os.getppid(), 9)",
    "kills all": "import os, signal; os.killpg(0, signal.SIGKILL)",
    "patches the checks": "import ikteach.course.forms as f; f.agree = lambda *a, **k: None\n"
    "import ikteach.course.checking as c; c.judge = c.of_form = lambda *a, **k: None",
    "looks at the stack": "import sys; f = sys._getframe()\n"
    "while f:\n    if 'wanted' in f.f_locals: return f.f_locals['wanted']\n    f = f.f_back",
    "imports the solution": "from ikteach.course.solutions import ch00\n"
    "return ch00.hand(theta, lengths)",
    "reads the solution": "import ikteach.course as c; n = {}\n"
    "exec(open(c.__path__[0] + '/solutions/ch00.py').read(), n); return n['hand'](theta, lengths)",
    "imports the check": "from ikteach.course.exercises import ch00\n"
    "return ch00.hand_of(theta, lengths)",
    "runs a program": "import subprocess; subprocess.run(['touch', PLACE])",
    "removes": "import os; os.remove(PLACE)",
    "removes all": "import shutil; shutil.rmtree(PLACE)",
    "writes": "open(PLACE, 'w').write('gone')",
    "forks": "import os\nwhile True: os.fork()",
    "asks the network": "import socket; socket.create_connection(('127.0.0.1', 9), 1)",
    "forges a reply": "import os\nfor n in range(3, 64):\n"
    "    try: os.write(n, b'\\0' * 7 + b'\\5ended')"
    "\n    except OSError: pass",
    "is equal to all": "class Q(float):\n    __eq__ = __le__ = __ge__ = lambda s, o: True\n"
    "    __sub__ = __rsub__ = __abs__ = lambda s, *o: Q(0)\nreturn Q(1), Q(1)",
    "is no array": "class Q:\n    def __array__(s, *a, **k): raise SystemExit\nreturn Q()",
    "calls itself": "import sys; sys.setrecursionlimit(10**9)\ndef f(n): return f(n + 1)\nf(0)",
    "raises ours": "from ikteach.course.checking import WrongError\n"
    "raise WrongError('`hand` passes every check.')",
}


def notebook(parts: dict[str, str], head: str = HEAD) -> str:
    """A notebook in which each answer is checked in a cell of its own."""
    cells = [
        nbformat.v4.new_code_cell(f"{head}%matplotlib inline\nfrom ikteach.course import check")
    ]
    for key, source in parts.items():
        cells.append(nbformat.v4.new_code_cell(f'{source}\n\n\ncheck("{key}", {NAMES[key]})'))
    return nbformat.writes(nbformat.v4.new_notebook(cells=cells))


def record(parts: dict[str, str], passed: bool) -> str:
    """A file of answers that says of each whether it has passed."""
    verdicts = {
        key: {"passed": passed, "tries": 1, "source": f"{HEAD}{source}\nanswer = {NAMES[key]}\n"}
        for key, source in parts.items()
    }
    return json.dumps({"verdicts": verdicts})


def hand_in(folder: Path, name: str, text: str, file: str) -> None:
    (folder / name).mkdir(parents=True)
    (folder / name / file).write_text(text)


@pytest.fixture(scope="module")
def handed_in(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict[str, float]]:
    """A class of 30 and more, and its points counted by hand."""
    folder = tmp_path_factory.mktemp("class")
    victim = folder / "victim" / "predictions.json"
    counted: dict[str, float] = {}
    for i in range(4):
        hand_in(folder, f"good{i}", notebook(RIGHT), "all.ipynb")
        counted[f"good{i}"] = ALL
    hand_in(folder, "victim", record(RIGHT, False), "predictions.json")
    counted["victim"] = ALL
    hand_in(folder, "half", notebook(RIGHT | {k: WRONG[k] for k in KEYS[:2]}), "a.ipynb")
    counted["half"] = 2.0
    hand_in(folder, "two files", notebook({"00.hand": RIGHT["00.hand"]}), "a.ipynb")
    (folder / "two files" / "predictions.json").write_text(
        record({"05.bound": RIGHT["05.bound"]}, True)
    )
    counted["two files"] = 3.5
    for name, parts in (("wrong", WRONG), ("empty", EMPTY), ("unwritten", {})):
        hand_in(folder, name, notebook(parts), "a.ipynb")
        counted[name] = 0
    hand_in(folder, "forger", record(WRONG, True), "predictions.json")
    (folder / "nothing").mkdir()
    (folder / "broken.ipynb").write_text("{")
    (folder / "no python.ipynb").write_text(notebook({"00.hand": "def hand(theta:"}))
    counted |= dict.fromkeys(("forger", "nothing", "broken", "no python"), 0)
    for name, lines in HOSTILE.items():
        source = hostile(lines.replace("PLACE", repr(str(victim))))
        hand_in(
            folder, name, notebook({"00.hand": source, "01.column": RIGHT["01.column"]}), "a.ipynb"
        )
        counted[name] = 1  # for the other answer, which is right
    return folder, counted


def test_totals_are_those_counted_by_hand(
    handed_in: tuple[Path, dict[str, float]],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    folder, counted = handed_in
    before = {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("ikteach.publish.grading.judging.PATIENCE", 1.0)
    Path("points.toml").write_text(f'title = "IK"\ndefault = 0\n{POINTS}')
    command = ["grade", str(folder), "--points", "points.toml"]
    assert main([*command, "--moodle", "m.csv", "--canvas", "c.csv", "--table", "t.csv"]) == SKIPPED
    said = capsys.readouterr()
    moodle = pd.read_csv("m.csv").set_index("Full name")
    assert moodle["Grade"].to_dict() == counted, moodle["Feedback comments"].to_dict()
    assert set(moodle["Maximum grade"]) == {ALL}
    canvas = pd.read_csv("c.csv")
    assert canvas.loc[0, "Student"].strip() == "Points Possible"
    assert canvas.loc[0, "IK"] == ALL
    assert canvas[1:].set_index("Student")["IK"].to_dict() == counted
    table = pd.read_csv("t.csv")
    assert table.groupby("student")["points"].sum().to_dict() == counted
    assert not table["sentence"].str.contains("check itself failed").any()
    sentences = table.set_index(["student", "exercise"])["sentence"]
    assert "With θ₁ = π/2 alone" in sentences["wrong", "00.hand"]
    assert sentences["nothing", "00.hand"] == "Not handed in."
    assert sentences["empty", "00.hand"].startswith("Not yet")
    assert f"of {len(counted)} passed.\n" in said.out
    assert "✗" not in said.out
    assert re.search(r"\d+ ×: With all angles 0 the arm lies along x", said.out)
    assert "broken.ipynb: left out" in said.err
    assert "not passed when judged again:\n  forger: 00.hand" in said.out
    assert f"{len(counted)} students, 4 exercises, 5 points in all." in said.out
    assert {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()} == before


def test_every_solution_passes_from_its_notebook(tmp_path: Path) -> None:
    """As the instructor's build has it, but handed in as a student's own cells."""
    builds.instructor(builds.find_course().notebooks, tmp_path / "built")
    found: dict[str, str] = {}
    for path in sorted((tmp_path / "built").glob("*.ipynb")):
        cells = [c.source for c in nbformat.read(path, as_version=4).cells if c.cell_type == "code"]
        found |= answers(cells)
    assert sorted(found) == every_exercise()
    with Judging() as judging:
        for key in every_exercise() if FULL else ("06.gamma", "07.path", "08.order"):
            verdict = judging.verdict(key, found[key])
            assert verdict.passed, verdict


def test_without_bubblewrap_the_hook_says_no(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr("ikteach.publish.grading.judging.bubblewrap", lambda: "")
    victim = tmp_path / "victim"
    victim.write_text("here")
    with Judging() as judging:
        assert "no bubblewrap" in judging.walls
        for name in (
            "reads the solution",
            "removes",
            "removes all",
            "writes",
            "runs a program",
            "kills",
        ):
            lines = HOSTILE[name].replace("PLACE", repr(str(victim)))
            verdict = judging.verdict("00.hand", f"{HEAD}{hostile(lines)}\nanswer = hand")
            assert "PermissionError" in verdict.sentence, (name, verdict)
        assert judging.verdict("00.hand", f"{HEAD}{RIGHT['00.hand']}\nanswer = hand").passed
    assert victim.read_text() == "here"


@pytest.mark.parametrize(
    ("source", "words"),
    [
        ("raise KeyboardInterrupt", "Its cell cannot be run: KeyboardInterrupt"),
        ("answer = 3", "needs the function itself"),
        ("answer = lambda t, a: {1: 2}", "a dict, where"),
        ("answer = lambda t, a: 'x' * 10**12", "emory"),
        ("def answer(t, a):\n    t += 1\n    return t[:2]", "changed its argument 1"),
        ("answer = lambda t, a: None", "returned None"),
        ("answer = lambda t, a: exit()", "exit()"),
        ("raise SystemExit", "SystemExit"),
        ("x = 1", "it binds no answer"),
        ("\0", "SyntaxError"),
    ],
)
def test_what_cannot_be_judged_is_said(judging: Judging, source: str, words: str) -> None:
    verdict = judging.verdict("00.hand", source)
    assert not verdict.passed
    assert words in verdict.sentence, verdict
    assert "itself failed" not in verdict.sentence


@pytest.fixture(scope="module")
def judging() -> Any:
    with Judging() as one:
        yield one


def test_an_answer_is_found_with_what_it_uses() -> None:
    cells = [
        "import numpy as np\nK = 2\nrest = 1 / 0",
        "%%time\n!ls\ndef twice(x):\n    return K * x",
        "def f(x):\n    ...\ncheck('00.a', f)",
        "K = 3\nf = lambda x: twice(np.abs(x))\nassert course.check('00.a', f, strict=True)",
        "check('00.b', {'a': K})\ncheck('00.c', )",
    ]
    found = answers(cells)
    assert sorted(found) == ["00.a", "00.b"]
    assert "1 / 0" not in found["00.a"]
    names: dict[str, Any] = {}
    exec(found["00.a"], names)
    assert names["answer"](-2) == 6
    exec(found["00.b"], names)
    assert names["answer"] == {"a": 3}


def test_platforms_name_their_students(tmp_path: Path) -> None:
    hand_in(tmp_path, "Ada Lovelace_4711_assignsubmission_file", notebook(RIGHT), "a.ipynb")
    (tmp_path / "bellbo_LATE_12_99_00_figure-1.ipynb").write_text(notebook(RIGHT))
    (tmp_path / "bellbo_12_98_predictions.json").write_text(record(RIGHT, True))
    found, skipped = hand_ins(tmp_path)
    assert [(one.student, one.number, len(one.sources["00.hand"])) for one in found] == [
        ("Ada Lovelace", "4711", 1),
        ("bellbo", "12", 2),
    ]
    assert not skipped


def test_where_nothing_starts_nobody_is_marked(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    hand_in(tmp_path, "ada", notebook(RIGHT), "a.ipynb")
    monkeypatch.setattr("ikteach.publish.grading.judging.MODULE", "ikteach.gone")
    assert main(["grade", str(tmp_path), "--moodle", str(tmp_path / "m.csv")]) == 1
    assert "No process for answers can be started" in capsys.readouterr().err
    assert not (tmp_path / "m.csv").exists()


def test_a_folder_with_the_package_in_it_can_be_graded() -> None:
    with Judging(hidden=Path("/")) as judging:
        assert judging.verdict(
            "05.bound", f"{HEAD}{RIGHT['05.bound']}\nanswer = safe_damping"
        ).passed


def graded(tmp_path: Path, roster: str, *options: str) -> int:
    folder = tmp_path / "class"
    shutil.rmtree(folder, ignore_errors=True)
    hand_in(folder, "Ada Lovelace", notebook({"05.bound": RIGHT["05.bound"]}), "a.ipynb")
    (tmp_path / "roster.csv").write_text(roster)
    (tmp_path / "points.toml").write_text('title = "Week 5"\ndefault = 0\n[points]\n"05.bound" = 3')
    files = ["--points", str(tmp_path / "points.toml"), "--roster", str(tmp_path / "roster.csv")]
    return main(["grade", str(folder), *files, *options])


def test_a_roster_gives_the_columns_that_the_platform_wants(tmp_path: Path) -> None:
    canvas = 'Student,ID,SIS Login ID,Section,Old (3)\n"    Points Possible",,,,9\n'
    canvas += '"Lovelace, Ada",7,al,A,2\n"Bell, Bo",8,bb,A,1\n'
    assert graded(tmp_path, canvas, "--canvas", str(tmp_path / "c.csv")) == 0
    row = pd.read_csv(tmp_path / "c.csv").iloc[1]
    assert row.to_dict() == {
        "Student": "Lovelace, Ada",
        "ID": 7,
        "SIS Login ID": "al",
        "Section": "A",
        "Week 5": 3,
    }
    moodle = "First name,Last name,ID number,Email address\nAda,Lovelace,17,ada@example.org\n"
    assert graded(tmp_path, moodle, "--moodle", str(tmp_path / "m.csv")) == 0
    row = pd.read_csv(tmp_path / "m.csv").iloc[0]
    assert (row["Email address"], row["Week 5"], row["Maximum grade"]) == ("ada@example.org", 3, 3)


@pytest.mark.parametrize(
    ("points", "words"),
    [
        ('[points]\n"00.hnad" = 1', "did you mean '00.hand'"),
        ("defualt = 1", "did you mean 'default'"),
        ('[points]\n"00.hand" = -1', "00.hand must be a number from 0 on, not -1"),
        ("default = nan", "default must be a number"),
        ("default = ", "Invalid value"),
        ("points = 3", "must be a table"),
        ("title = 3", "title must be a text"),
    ],
)
def test_a_scheme_that_is_none_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], points: str, words: str
) -> None:
    (tmp_path / "p.toml").write_text(points)
    assert main(["grade", str(tmp_path), "--points", str(tmp_path / "p.toml")]) == 1
    assert words in capsys.readouterr().err
