"""Marks of a class: every answer is judged again, and nobody can mark or harm another."""

import json
import os
import re
import shutil
import sys
import zipfile
from pathlib import Path
from typing import Any

import nbformat
import pandas as pd
import psutil
import pytest

from ikteach.__main__ import main
from ikteach.course.checking import Verdict
from ikteach.publish import builds
from ikteach.publish.collect import SKIPPED
from ikteach.publish.grading import gradebook
from ikteach.publish.grading.gradebook import Graded
from ikteach.publish.grading.handed_in import HandIn, answers, hand_ins
from ikteach.publish.grading.judging import Judging
from ikteach.publish.grading.scheme import Scheme, every_exercise, read_scheme
from ikteach.publish.parser import RefusedError

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


SLOW = {
    "never ends": "while True:\n    try:\n        while True: pass\n    except BaseException: pass",
    "takes all memory": "a = []\nwhile True: a.append(np.ones(10**7))",
    "prints": "for i in range(10**5): print('x' * 1000)",
    "calls itself": "import sys; sys.setrecursionlimit(10**9)\ndef f(n): return f(n + 1)\nf(0)",
    "sleeps out of reach": "import os, time; os.setsid(); time.sleep(1000)",
}
HOSTILE = {
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
    "starts a program by the back door": "import os, sys, subprocess\n"
    "sys.modules.pop('_posixsubprocess', 0)\nimport _posixsubprocess as p\n"
    "p.fork_exec([b'/bin/rm', PLACE.encode()], [b'/bin/rm'], True, (), *[None] * 2, *[-1] * 6,"
    " *os.pipe(), False, False, -1, None, None, None, -1, None, False)",
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
    "reads what is the grader's": "raise ValueError(open('/etc/passwd').read())",
    "reads a folder by number": "import os, ikteach.course as c\n"
    "f = os.open('solutions/ch00.py', os.O_RDONLY, dir_fd=os.open(c.__path__[0], os.O_RDONLY))\n"
    "n = {}; exec(os.read(f, 10**6), n); return n['hand'](theta, lengths)",
    "writes in a folder by number": "import os\n"
    "f = os.open(os.path.dirname(PLACE), os.O_RDONLY)\n"
    "os.write(os.open(os.path.basename(PLACE), os.O_WRONLY | os.O_TRUNC, dir_fd=f), b'gone')",
    "changes what looks at paths": "import posixpath, os\nhere = os.getcwd()\n"
    "posixpath._joinrealpath = lambda *a: (here, True)\nopen(PLACE, 'w').write('gone')",
    "looks for the hook": "import gc\n"
    "for f in gc.get_objects():\n    if getattr(f, '__name__', '') == 'look':"
    " f.__code__ = (lambda *a: None).__code__\nopen(PLACE, 'w').write('gone')",
    "fills the disk": "import os\n"
    "for i in range(10**4): open(f'{os.getcwd()}/{i}', 'w').write('x' * 10**6)",
    "leaves the next a reply": "import sys, os\nout = sys.modules['__main__']\n"
    "for n in range(3, 64):\n    try:\n"
    "        for said in (b'is [9, 9]', b'ended', b'is 3', b'is 3'):\n"
    "            os.write(n, out.SIZE.pack(len(said)) + said)\n    except OSError: pass\n"
    "os._exit(0)",
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
    """A class, and its points counted by hand.

    One student has handed in all that is hostile; in the full mode many a piece of it each.
    """
    folder = tmp_path_factory.mktemp("class")
    victim = folder / "victim" / "predictions.json"
    counted: dict[str, float] = {"good": ALL, "victim": ALL, "half": 2.0, "two files": 3.5}
    hand_in(folder, "good", notebook(RIGHT), "all.ipynb")
    hand_in(folder, "victim", record(RIGHT, False), "predictions.json")
    hand_in(folder, "half", notebook(RIGHT | {k: WRONG[k] for k in KEYS[:2]}), "a.ipynb")
    hand_in(folder, "two files", notebook({"00.hand": RIGHT["00.hand"]}), "a.ipynb")
    (folder / "two files" / "predictions.json").write_text(
        record({"05.bound": RIGHT["05.bound"]}, True)
    )
    hand_in(folder, "wrong", notebook(WRONG), "a.ipynb")
    hand_in(folder, "empty", notebook(EMPTY), "a.ipynb")
    hand_in(folder, "forger", record(WRONG, True), "predictions.json")
    (folder / "nothing").mkdir()
    (folder / "broken.ipynb").write_text("{")
    (folder / "no python.ipynb").write_text(notebook({"00.hand": "def hand(theta:"}))
    (folder / "=cmd \u202eeve.ipynb").write_text(notebook({}))
    counted |= dict.fromkeys(("wrong", "empty", "forger", "nothing", "broken", "no python"), 0)
    counted["'=cmd \u202eeve"] = 0
    kinds = {name: [lines] for name, lines in (SLOW | HOSTILE).items()} if FULL else {}
    for name, several in (kinds or {"hostile": list(HOSTILE.values())}).items():
        (folder / name).mkdir()
        for i, lines in enumerate(several):
            source = hostile(lines.replace("PLACE", repr(str(victim))))
            parts = {"00.hand": source, "01.column": RIGHT["01.column"]}
            (folder / name / f"{i}.ipynb").write_text(notebook(parts))
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
    assert "\u202e" not in said.out
    assert re.search(r"\d+ ×: With ", said.out)
    assert "broken.ipynb: left out" in said.err
    assert "not passed when judged again:\n  forger: 00.hand" in said.out
    assert f"{len(counted)} students, 4 exercises, 5 points in all." in said.out
    assert {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()} == before


REFUSED = [
    "asks",
    "changes",
    "fills",
    "forks",
    "imports",
    "kills",
    "reads",
    "removes",
    "runs",
    "writes",
]


def wrong(judging: Judging, lines: str) -> str:
    """What is said of a hostile answer to 00.hand, which must not pass."""
    verdict = judging.verdict("00.hand", f"{HEAD}{hostile(lines)}\nanswer = hand")
    assert not verdict.passed
    return verdict.sentence


def right(judging: Judging, key: str = "00.hand") -> bool:
    """Whether a right answer passes after all that was judged before."""
    return judging.verdict(key, f"{HEAD}{RIGHT[key]}\nanswer = {NAMES[key]}").passed


@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere a sleeper out of reach sleeps on")
def test_what_does_not_end_is_ended(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("ikteach.publish.grading.judging.bubblewrap", lambda: "")
    monkeypatch.setattr("ikteach.publish.grading.judging.PATIENCE", 0.1)
    with Judging() as judging:
        for name in ("never ends", "sleeps out of reach"):
            assert "was stopped after" in wrong(judging, SLOW[name])
        home = judging._folder
    places = [home_of(pid) for pid in psutil.pids()]
    assert home_of(os.getpid()) in places
    assert home not in places


def home_of(pid: int) -> str | None:
    """The HOME of a process, if it has not ended since and one may look."""
    try:
        return psutil.Process(pid).environ().get("HOME")
    except psutil.Error:
        return None


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
    refused = {name for name in HOSTILE if name.split()[0] in REFUSED} | {"looks for the hook"}
    with Judging() as judging:
        assert "no bubblewrap" in judging.walls
        for name in HOSTILE:
            sentence = wrong(judging, HOSTILE[name].replace("PLACE", repr(str(victim))))
            assert ("PermissionError" in sentence) or name not in refused, (name, sentence)
            assert "root" not in sentence
        assert right(judging)
    assert victim.read_text() == "here"
    assert len(refused) > 12


def test_nothing_is_left_for_the_next_answer(judging: Judging) -> None:
    for name in ("leaves the next a reply", "forges a reply", "leaves"):
        wrong(judging, HOSTILE[name])
        assert right(judging, "05.bound")
        assert not judging.verdict("00.hand", f"{HEAD}{WRONG['00.hand']}\nanswer = hand").passed


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
        "import numpy as np\nfrom math import *\nK = 2\nrest = 1 / 0\nJ = figure.jacobian()",
        "%%time\n!ls\nx = %timeit 1\ndef twice(x):\n    J = K * x\n    return J",
        "def f(x):\n    ...\ncheck('00.a', f)",
        "K = 3\nf = lambda x: twice(np.abs(x))\nassert course.check('00.a', f, strict=True)",
        "check('00.b', {'a': K})\ncheck('00.c', )",
        "mix = {}\nmix.update(a=1)\nmix.update(1 / 0)\nnp.testing.assert_equal(1, 2)",
        "if K:\n    def g(x):\n        return sqrt(x) + (K\n     % 2)\n%matplotlib inline",
        "with out:\n    check(answer=mix, key='00.d')\nfor _ in range(1): check('00.e', g)",
    ]
    found = answers(cells)
    assert sorted(found) == ["00.a", "00.b", "00.d", "00.e"]
    assert "1 / 0" not in found["00.a"]
    made = {}
    for key, source in found.items():
        names: dict[str, Any] = {}
        exec(source, names)
        made[key] = names["answer"]
    assert made["00.a"](-2) == 6
    assert (made["00.b"], made["00.d"]) == ({"a": 3}, {"a": 1})
    assert made["00.e"](4) == 3


PLACES = {  # of a file -> student and number
    "Ada Lovelace_4711_assignsubmission_file_/a.ipynb": ("Ada Lovelace", "4711"),
    "Bo O'Bell_4712_assignsubmission_file/deep/down/01 column-2.ipynb": ("Bo O'Bell", "4712"),
    "Chi-Wen_4713_assignsubmission_file_my answer-2 (1).ipynb": ("Chi-Wen", "4713"),
    "Dee_assignsubmission_file/a.ipynb": ("Dee", ""),
    "Course-Week 5-99/Eve_4715_assignsubmission_file_/a.ipynb": ("Eve", "4715"),
    "Course-Week 5-99/Flo_4716_assignsubmission_file_/a.ipynb": ("Flo", "4716"),
    "gaugauss_LATE_17_98_figure-1.ipynb": ("gaugauss", "17"),
    "submissions/hopper_18_97_a.ipynb": ("hopper", "18"),
    "submissions/iverson_LATE_19_96_a-1.ipynb": ("iverson", "19"),
    "Jose\u0301/hw_1_2_final.ipynb": ("Jos\u00e9", ""),
    "kay.ipynb": ("kay", ""),
    "packed.zip:Lee_4720_assignsubmission_file_/a.ipynb": ("Lee", "4720"),
    "Max_4721_assignsubmission_file_/hw.zip:work/a.ipynb": ("Max", "4721"),
    "noether_21_95_hw.zip:/hw/a.ipynb": ("noether", "21"),
    "ola/one.zip:Lee_4720_assignsubmission_file_/x/a.ipynb": ("ola", ""),
    "__MACOSX/._a.ipynb": None,
    ".git/a.ipynb": None,
}


def test_platforms_name_their_students(tmp_path: Path) -> None:
    for place in PLACES:
        path, _, inside = str(tmp_path / place).partition(":")
        Path(path).parent.mkdir(parents=True, exist_ok=True)
        if inside:
            with zipfile.ZipFile(path, "w") as archive:
                archive.writestr(inside, notebook(RIGHT))
                archive.writestr("__MACOSX/._a.ipynb", "")
        else:
            Path(path).write_text(notebook(RIGHT))
    (tmp_path / "gaugauss_17_99_predictions.json").write_text(record(RIGHT, True))
    found, skipped = hand_ins(tmp_path)
    assert not skipped
    wanted = sorted(who for who in PLACES.values() if who)
    assert [(one.student, one.number) for one in found] == wanted
    assert {one.student: len(one.sources["00.hand"]) for one in found} == {
        name: 1 + (name == "gaugauss") for name, _ in wanted
    }


SAVED = [  # as Jupyter, VS Code and others write a cell
    {"cell_type": "code", "source": ["def hand(t, a):\n", "    return 1\n"], "outputs": []},
    {"cell_type": "code", "source": "check('00.hand', hand)", "metadata": {"vscode": {"x": 1}}},
    {"cell_type": "markdown", "source": "check('01.column', x)"},
    {"cell_type": "code", "source": "", "outputs": [{"text": "check('05.bound', y)"}]},
    {"cell_type": "code", "source": "check('09.mix', 1)", "metadata": {"tags": ["solution"]}},
]


def test_what_is_read_of_a_notebook(tmp_path: Path) -> None:
    (tmp_path / "ada.ipynb").write_text(json.dumps({"cells": SAVED}), encoding="utf-8-sig")
    (tmp_path / "old.ipynb").write_text(json.dumps({"worksheets": [{"cells": SAVED}]}))
    (tmp_path / "zip.zip").write_bytes(b"PK")
    with zipfile.ZipFile(tmp_path / "none.zip", "w") as archive:
        archive.writestr("a.txt", "")
    (tmp_path / "deep.ipynb").write_text(notebook({"00.hand": f"hand = {'-' * 9000}1"}))
    found, skipped = hand_ins(tmp_path)
    assert {one.student: sorted(one.sources) for one in found} == {
        "ada": ["00.hand"],
        "deep": ["00.hand"],
        "none": [],
        "old": [],
        "zip": [],
    }
    assert skipped == {
        "old.ipynb": "it is no notebook of Jupyter's version 4",
        "none.zip": "it cannot be unpacked (it holds nothing to grade)",
        "zip.zip": "it cannot be unpacked (File is not a zip file)",
    }


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
    sheet = (
        "Identifier,Full name,Status,Grade,Maximum grade,Last modified (grade),Feedback comments"
    )
    sheet += (
        "\nParticipant 9,\u200fAda  Lovelace,No submission,,3.00,-,\nParticipant 8,Bo,-,,3.00,-,\n"
    )
    assert graded(tmp_path, sheet, "--moodle", str(tmp_path / "s.csv")) == 0
    table = pd.read_csv(tmp_path / "s.csv")
    assert list(table) == sheet.splitlines()[0].split(",")  # all that Moodle's import asks for
    assert table[["Identifier", "Grade"]].values.tolist() == [["Participant 9", 3]]
    assert table.loc[0, "Feedback comments"] == "05.bound: passed"


def test_a_table_without_roster_has_the_columns_that_are_asked_for(tmp_path: Path) -> None:
    one = HandIn("Ada", "17", {}, set())
    scheme = Scheme({"00.hand": 0.1, "00.reach": 0.1, "01.column": 0.1}, "Week")
    passed = {key: Verdict(key, True, "") for key in scheme.points}
    table = gradebook.moodle([Graded(one, passed)], scheme, None)
    assert {"Identifier", "Grade", "Last modified (grade)", "Feedback comments"} <= set(table)
    assert (table["Identifier"][0], table["Grade"][0]) == ("Participant 17", 0.3)
    table = gradebook.canvas([Graded(one, passed)], scheme, None)
    assert list(table) == ["Student", "ID", "SIS User ID", "SIS Login ID", "Section", "Week"]
    assert table.loc[1].tolist() == ["Ada", "17", "", "", "", 0.3]


def test_a_roster_that_does_not_fit_is_told_at_once(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    table = pd.DataFrame(
        {
            "Student": ["Bell, Bo", "Chi", "chi"],
            "ID": ["12", "13", "14"],
            "Old (3)": ["9", "9", "7"],
        }
    )
    who = [("bo bell", ""), ("Nobody", "7"), ("Chi", ""), ("Chi", "14"), ("B", "12")]
    with pytest.raises(RefusedError) as refused:
        gradebook.rows_of([HandIn(*one, {}, set()) for one in who], table)
    assert str(refused.value).splitlines() == [
        "Nobody is not in the roster.",
        "Chi is 2 rows of the roster.",
        "B and bo bell are the same row of the roster.",
    ]
    assert graded(tmp_path, "Vorname,Nachname\nAda,Lovelace\n") == 1
    assert "no column that says who somebody is" in capsys.readouterr().err


def test_a_scheme_names_chapters_and_exercises(tmp_path: Path) -> None:
    (tmp_path / "p.toml").write_text('default = 0\n[points]\n"05" = 2\n"05.svd" = 0.5')
    scheme = read_scheme(tmp_path / "p.toml")
    assert scheme.points == {"05.bound": 2, "05.svd": 0.5, "05.unit": 2}


@pytest.mark.parametrize(
    ("points", "words"),
    [
        ('[points]\n"00.hnad" = 1', "did you mean '00.hand'"),
        ("defualt = 1", "did you mean 'default'"),
        ('[points]\n"00.hand" = -1', "00.hand must be a number from 0 on, not -1"),
        ("default = nan", "default must be a number"),
        ("default = ", "Invalid value"),
        ("points = 3", "must be a table"),
        ("default = 0", "no exercise is worth anything"),
        ("title = 3", "title must be a text"),
    ],
)
def test_a_scheme_that_is_none_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], points: str, words: str
) -> None:
    (tmp_path / "p.toml").write_text(points)
    assert main(["grade", str(tmp_path), "--points", str(tmp_path / "p.toml")]) == 1
    assert words in capsys.readouterr().err
