"""Assignments of nbgrader and Otter: full marks to the solutions, none to what is empty or wrong.

What the tools do is done here by their rules: the lines between the marks go, and a test is passed
if its cell raises nothing. IKTEACH_FULL=1 does it with the tools themselves.
"""

import ast
import json
import os
import re
import subprocess
import sys
import venv
from pathlib import Path
from typing import Any

import nbformat
import pandas as pd
import pytest

from ikteach.__main__ import main
from ikteach.publish.assignments import solved
from ikteach.publish.grading.scheme import every_exercise

ROOT = Path(__file__).parents[2]
FULL = bool(os.environ.get("IKTEACH_FULL"))
STUB = {"nbgrader": "# YOUR CODE HERE\n{}raise NotImplementedError()", "otter": "..."}
CHAPTERS = sorted(path.stem for path in (ROOT / "notebooks").glob("[0-9]*.ipynb"))


@pytest.fixture(scope="module", params=["nbgrader", "otter"])
def built(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Any:
    """The tool, and {chapter: notebook} of its build."""
    folder = tmp_path_factory.mktemp(request.param)
    assert main(["build", request.param, str(folder)]) == 0
    found = sorted(folder.rglob("*.ipynb"))
    return request.param, {path.stem: nbformat.read(path, as_version=4) for path in found}, folder


def without(source: str, tool: str) -> str:
    """What the tool gives to students."""
    lines = re.compile(r"( *)#+ BEGIN SOLUTION\n.*?#+ END SOLUTION", re.DOTALL)
    return lines.sub(lambda match: match[1] + STUB[tool].format(match[1]), source)


def points(cells: list[str], monkeypatch: pytest.MonkeyPatch, folder: Path) -> int:
    """Run the cells as a kernel does that goes on after errors; count the tests that pass."""
    monkeypatch.chdir(folder)
    names: dict[str, Any] = {}
    passed = 0
    for source in cells:
        try:
            exec(compile(source, "<cell>", "exec"), names)
        except Exception:
            continue
        passed += "assert check(" in source
    return passed


@pytest.mark.parametrize("chapter", CHAPTERS if FULL else ["00_figure", "05_dls"])
def test_the_solutions_have_all_points_and_stubs_none(
    built: Any, chapter: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    tool, notebooks, _ = built
    cells = [cell.source for cell in notebooks[chapter].cells if cell.cell_type == "code"]
    most = sum("assert check(" in source for source in cells)
    assert most >= 2
    assert points(cells, monkeypatch, tmp_path) == most
    assert points([without(source, tool) for source in cells], monkeypatch, tmp_path) == 0
    wrong = [spoiled(source) if "SOLUTION" in source else source for source in cells]
    assert points(wrong, monkeypatch, tmp_path) == 0


def test_every_exercise_is_there_once_and_what_students_get_is_python(built: Any) -> None:
    tool, notebooks, folder = built
    code = [c.source for n in notebooks.values() for c in n.cells if c.cell_type == "code"]
    assert sorted(re.findall(r'assert check\("(\S+)"', "\n".join(code))) == every_exercise()
    for source in code:
        given = without(source, tool)
        ast.parse(given)
        assert "SOLUTION" not in given
        assert ("SOLUTION" in source) != ("check(" in source)
    pictures = {path.name for path in folder.rglob("*.svg")}
    assert pictures == {"nod.svg"}


def test_the_marks_are_those_that_the_tools_want(built: Any) -> None:
    tool, notebooks, folder = built
    for notebook in notebooks.values():
        nbformat.validate(notebook)
        if tool == "nbgrader":
            marks = [c.metadata.nbgrader for c in notebook.cells if "nbgrader" in c.metadata]
            ids = [mark.grade_id for mark in marks]
            assert len(ids) == len(set(ids)) > 0
            for mark in marks:
                assert mark.schema_version == 3
                assert mark.grade == mark.locked == (not mark.solution) == ("points" in mark)
        else:
            raw = [c.source.splitlines()[0] for c in notebook.cells if c.cell_type == "raw"]
            tasks = ["QUESTION", "SOLUTION", "TESTS"]
            each = [f"# BEGIN {tasks[0]}"]
            each += [f"# {word} {part}" for part in tasks[1:] for word in ("BEGIN", "END")]
            each += [f"# END {tasks[0]}"]
            assert raw == ["# ASSIGNMENT CONFIG", *each * ((len(raw) - 1) // len(each))]
    if tool == "nbgrader":
        compile((folder / "nbgrader_config.py").read_text(), "config", "exec")


def test_a_solution_goes_into_its_stub() -> None:
    stub = 'from x import check\n\n\ndef f(x):\n    """Says."""\n    ...\n\n\ncheck("00.a", f)'
    made = solved(
        stub,
        'K = 2\n\n\ndef f(x):\n    """Other."""\n    y = K * x\n    return y',
        "# ",
        ["import x"],
    )
    assert made.startswith("import numpy as np\nimport x\nK = 2\n")
    assert '"""Says."""\n    # BEGIN SOLUTION\n    y = K * x\n    return y\n    # END' in made
    assert "check" not in made


@pytest.fixture(scope="module")
def tools(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The programs of an environment with both tools and the package, as a grader has it."""
    folder = tmp_path_factory.mktemp("graders")
    venv.create(folder, with_pip=True)
    programs = folder / ("Scripts" if sys.platform == "win32" else "bin")
    wanted = [str(ROOT), "ipykernel", "nbgrader>=0.9.5", "otter-grader>=7"]
    subprocess.run([programs / "python", "-m", "pip", "install", "-q", *wanted], check=True)
    return programs


@pytest.mark.skipif(not FULL, reason="installs both tools: IKTEACH_FULL=1")
def test_the_tools_themselves_give_these_points(built: Any, tools: Path, tmp_path: Path) -> None:
    tool, notebooks, folder = built
    environment = os.environ | {"PATH": f"{tools}{os.pathsep}{os.environ['PATH']}"}

    def run(*command: object) -> None:
        line = [tools / str(command[0]), *map(str, command[1:])]
        done = subprocess.run(line, cwd=folder, env=environment, capture_output=True, text=True)
        assert done.returncode == 0, done.stdout + done.stderr

    found, wanted = {}, {}
    for name, notebook in notebooks.items():
        most = sum("assert check(" in cell.source for cell in notebook.cells)
        wanted |= {(name, who): most * (who == "good") for who in ("good", "wrong", "empty")}
        if tool == "otter":
            run("otter", "assign", f"{name}.ipynb", f"dist/{name}")
        else:
            run("nbgrader", "generate_assignment", name)
        given = f"dist/{name}/student" if tool == "otter" else f"release/{name}"
        places = handed_in(
            folder, nbformat.read(folder / given / f"{name}.ipynb", 4), name, notebook
        )
        if tool == "nbgrader":
            run("nbgrader", "autograde", name)
            continue
        (zipped,) = (folder / "dist" / name / "autograder").glob("*.zip")
        for who, place in places.items():
            run("otter", "run", place, "-a", zipped, "-o", place.parent)
            tests = json.loads((place.parent / "results.json").read_text())["tests"]
            found[name, who] = sum(test.get("score", 0) for test in tests)
    if tool == "nbgrader":
        run("nbgrader", "export", "--to", tmp_path / "grades.csv")
        grades = pd.read_csv(tmp_path / "grades.csv")
        found = grades.set_index(["assignment", "student_id"])["score"].to_dict()
    assert found == wanted


def handed_in(folder: Path, given: Any, name: str, solved: Any) -> dict[str, Path]:
    """Fill in what a student is given: right, wrong and not at all."""
    answers = [cell.source for cell in solved.cells if "BEGIN SOLUTION\n" in cell.source]
    blank = [i for i, c in enumerate(given.cells) if re.match("import numpy", c.source)]
    places = {}
    for who, change in {"good": str, "wrong": spoiled, "empty": None}.items():
        notebook = nbformat.from_dict(json.loads(json.dumps(given)))
        for i, answer in zip(blank, answers, strict=True):
            notebook.cells[i].source = change(answer) if change else notebook.cells[i].source
        places[who] = folder / "submitted" / who / name / f"{name}.ipynb"
        places[who].parent.mkdir(parents=True)
        nbformat.write(notebook, places[who])
    return places


def spoiled(answer: str) -> str:
    """A wrong answer of a form that may be right: another number."""
    tree = ast.parse(answer)
    given = [node for node in ast.walk(tree) if isinstance(node, ast.Return)]
    for node in given or [node for node in tree.body if isinstance(node, ast.Assign)]:
        node.value = ast.Constant(3.5)
    return ast.unparse(tree)
