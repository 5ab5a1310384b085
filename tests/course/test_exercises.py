"""Every exercise of the course: the solution passes, typical wrong answers and stubs do not."""

import ast
import importlib
import re
from pathlib import Path
from typing import Any

import nbformat
import pytest

from ikteach.course.checking import EXERCISES, check, find, judge
from ikteach.publish import builds
from tests.course.answers.right import RIGHT
from tests.course.answers.unseen import UNSEEN

ROOT = Path(__file__).parents[2]
PACKAGE = ROOT / "ikteach" / "course"
CHAPTERS = sorted(path.stem for path in (PACKAGE / "exercises").glob("ch*.py"))
for chapter in CHAPTERS:
    importlib.import_module(f"ikteach.course.exercises.{chapter}")
OURS = sorted(EXERCISES)


def wrong(key: str) -> list[tuple[Any, str]]:
    chapter = f"ch{key.partition('.')[0]}"
    return importlib.import_module(f"tests.course.answers.{chapter}").WRONG[key]


WRONG = [(key, i) for key in OURS for i in range(len(wrong(key)))]


def in_notebooks() -> dict[str, tuple[str, str]]:
    """Key -> the source of the cell that checks it, and the answer's name there."""
    found = {}
    for path in sorted((ROOT / "notebooks").glob("*.ipynb")):
        for cell in nbformat.read(path, as_version=4).cells:
            if cell.cell_type == "code":
                for key, name in builds.checks(cell):
                    assert path.name.startswith(key.partition(".")[0]), f"{key} in {path.name}"
                    found[key] = (cell.source, name)
    return found


def answer(key: str) -> Any:
    """What the last statement of the solution binds, in a namespace of its own."""
    chapter = PACKAGE / "solutions" / f"ch{key.partition('.')[0]}.py"
    preamble, source = chapter.read_text("utf-8").partition("# %%")[0], builds.solution(key)
    names: dict[str, Any] = {}
    exec(compile(f"{preamble}\n{source}", str(chapter), "exec"), names)
    match ast.parse(source).body[-1]:
        case ast.FunctionDef(name=name) | ast.Assign(targets=[ast.Name(id=name)]):
            return names[name]
    raise LookupError(f"the last statement of the solution of {key!r} binds no answer")


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def test_exercises_are_those_of_the_notebooks() -> None:
    assert sorted(in_notebooks()) == OURS


@pytest.mark.parametrize("key", OURS)
def test_the_solution_passes(key: str) -> None:
    verdict = check(key, answer(key))
    assert verdict.passed, verdict


@pytest.mark.parametrize(
    "i", range(len(RIGHT)), ids=[f"{key}-{i}" for i, (key, _) in enumerate(RIGHT)]
)
def test_a_right_answer_in_another_form_passes(i: int) -> None:
    key, answer = RIGHT[i]
    assert judge(find(key), answer).passed, judge(find(key), answer)


@pytest.mark.parametrize(
    "i", range(len(UNSEEN)), ids=[f"{k}-{i}" for i, (k, _) in enumerate(UNSEEN)]
)
def test_a_wrong_answer_of_another_kind_is_refused(i: int) -> None:
    key, answer = UNSEEN[i]
    sentence = judge(find(key), answer).sentence
    assert "passes every check" not in sentence
    assert "check itself failed" not in sentence, sentence
    assert re.search(r"\d|is wanted|is no|must|not an? ", sentence), sentence


def test_hints_are_a_question_a_formula_and_code() -> None:
    for key in OURS:
        question, formula, code = EXERCISES[key].hints
        assert question.rstrip(".").endswith("?") or "?" in question, key
        assert "`" in code, key
        assert len({question, formula, code}) == 3


@pytest.mark.parametrize(("key", "i"), WRONG)
def test_a_wrong_answer_is_told_apart(key: str, i: int) -> None:
    answer, words = wrong(key)[i]
    verdict = judge(find(key), answer)
    assert not verdict.passed
    assert words
    assert words in verdict.sentence, verdict.sentence
    assert "check itself failed" not in verdict.sentence


@pytest.mark.parametrize("key", OURS)
def test_there_are_hints_and_enough_wrong_answers(key: str) -> None:
    assert EXERCISES[key].hints
    assert len(wrong(key)) >= 3


@pytest.mark.parametrize("key", OURS)
def test_the_stub_does_not_pass(key: str) -> None:
    source, name = in_notebooks()[key]
    names: dict[str, Any] = {"check": lambda *_: None}
    exec(source.replace("from ikteach.course", "# "), names)
    verdict = check(key, names[name])
    assert not verdict.passed
    assert verdict.sentence.startswith("Not yet")
    assert not verdict.hint


ODD = {
    "raises": lambda *_: 1 / 0,
    "None": lambda *_: None,
    "text": lambda *_: "seven",
    "NaN": lambda *_: float("nan"),
    "NaNs": lambda *_: [float("nan")] * 3,
    "shape": lambda *_: [[[0.0]]],
    "set": lambda *_: {1, 2},
    "arguments": lambda: 0.0,
}


@pytest.mark.parametrize("odd", ODD)
@pytest.mark.parametrize("key", OURS)
def test_what_answers_can_do_wrong_is_a_sentence(key: str, odd: str) -> None:
    answer = ODD[odd]() if find(key).value and odd not in ("raises", "arguments") else ODD[odd]
    verdict = judge(find(key), answer)
    assert not verdict.passed
    assert "check itself failed" not in verdict.sentence, verdict.sentence
    assert "Traceback" not in verdict.sentence
