"""The answers of a class in one table: everything that is an answer, and a word on what is not."""

import json
from pathlib import Path

import pandas as pd
import pytest

from ikteach.__main__ import main
from ikteach.course import export, predict, quiz, reveal
from ikteach.course.collect import FIRST, collect, summary
from ikteach.course.record import store
from ikteach.course.widget import Question

OPTIONS = ["fewer", "more"]


def answered(question: Question, answer: object) -> None:
    question.answer = answer
    question.asked += 1


@pytest.fixture
def handed_in(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """What two students handed in, through the doors of the course: one exported, one did not."""
    for name, answer, far in (("ada", "more", 96), ("bo", "fewer", 40)):
        folder = tmp_path / "class" / name
        folder.mkdir(parents=True)
        monkeypatch.chdir(folder)
        answered(predict("03.half", "?", OPTIONS), answer)
        answered(predict("01.zeros", "?", numbers=(0, 240, "entries")), far)
        reveal("03.half", "more")
        reveal("01.zeros", 96)
        answered(quiz("03.stuck", "?", OPTIONS, "more", ""), answer)
        store("verdicts", "03.alpha", passed=name == "ada", sentence="So.", tries=2)
    log = pd.DataFrame({"method": ["dls", "sdls"], "error": [0.1, 0.2]})
    monkeypatch.chdir(tmp_path / "class" / "ada")
    assert export("ada.json", log).mood == "good"
    Path("predictions.json").unlink()
    monkeypatch.chdir(tmp_path)
    return tmp_path / "class"


def test_every_answer_is_a_row(handed_in: Path) -> None:
    table, logs, skipped = collect(handed_in)
    assert skipped == {}
    assert list(table.columns[: len(FIRST)]) == FIRST
    assert len(table) == 8
    answers = table.pivot(index="key", columns="student", values="answer")
    assert answers.loc["03.half"].to_dict() == {"ada": "more", "bo": "fewer"}
    assert answers.loc["01.zeros"].to_dict() == {"ada": 96, "bo": 40}
    right = table.pivot(index="key", columns="student", values="right")
    assert right.loc["03.half"].to_dict() == {"ada": True, "bo": False}
    assert right.loc["03.stuck"].to_dict() == {"ada": True, "bo": False}
    assert right.loc["03.alpha"].to_dict() == {"ada": True, "bo": False}
    assert right.loc["01.zeros"].isna().all()
    assert set(table["kind"]) == {"prediction", "exercise", "quiz"}
    assert logs["error"].tolist() == [0.1, 0.2]
    assert set(logs["student"]) == {"ada"}


def test_the_summary_says_how_many_and_what(handed_in: Path) -> None:
    said = summary(collect(handed_in).table)
    assert said.loc[("03.half", "prediction")].tolist() == [2, "50%", "fewer 1, more 1"]
    assert said.loc[("01.zeros", "prediction")].tolist() == [2, "–", "median 68"]
    assert said.loc[("03.alpha", "exercise"), "right"] == "50%"


def test_of_two_files_both_are_rows_and_the_newest_counts(handed_in: Path) -> None:
    old = json.loads((handed_in / "bo" / "predictions.json").read_text())
    old["predictions"]["03.half"] |= {"answer": "more", "at": "2020-01-01T00:00:00+00:00"}
    (handed_in / "bo" / "old").mkdir()
    (handed_in / "bo" / "old" / "predictions.json").write_text(json.dumps(old))
    table = collect(handed_in).table
    assert len(table) == 12
    assert summary(table).loc[("03.half", "prediction")].tolist()[2] == "fewer 1, more 1"


@pytest.mark.parametrize(
    ("name", "content", "word"),
    [
        ("half.json", b'{"predictions": {', "damaged"),
        ("list.json", b"[1, 2]", "no answers"),
        ("settings.json", b'{"gait": {}}', "no answers"),
        ("latin.json", '{"quiz": "\u00e9"}'.encode("latin-1"), "damaged"),
        ("form.json", b'{"predictions": {"03.half": "more"}}', "form"),
        ("deep.json", b"[" * 100_000, "damaged"),
        ("all.zip", b"PK", "unpack"),
    ],
)
def test_what_is_no_answer_is_named_and_the_rest_is_read(
    handed_in: Path, name: str, content: bytes, word: str
) -> None:
    (handed_in / "bo" / name).write_bytes(content)
    table, _, skipped = collect(handed_in)
    assert len(table) == 8
    assert list(skipped) == [str(Path("bo", name))]
    assert word in skipped[str(Path("bo", name))]


def test_a_bad_log_costs_no_answer_and_a_forged_name_is_not_believed(tmp_path: Path) -> None:
    entry = {"answer": ["sdls", "dls"], "student": "eve", "more": {"a": 1}}
    content = {"predictions": {"08.time": entry}, "log": {"columns": ["a"], "data": [[1, 2]]}}
    (tmp_path / "cy.json").write_text(json.dumps(content), encoding="utf-8-sig")
    table, logs, skipped = collect(tmp_path)
    assert table.loc[0, ["student", "answer"]].tolist() == ["cy", "sdls, then dls"]
    assert table.loc[0, "more"] == "{'a': 1}"
    assert logs.empty
    assert "log" in skipped["cy.json"]


def test_the_command_writes_tables_and_never_over_a_file(
    handed_in: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (handed_in / "bo" / "x.json").write_text("no")
    assert main(["collect", str(handed_in), "--table", "a.csv", "--logs", "l.csv"]) == 0
    said = capsys.readouterr()
    assert "8 answers of 2 students in 2 files" in said.out
    assert "x.json: skipped" in said.err
    assert len(pd.read_csv("a.csv")) == 8
    assert len(pd.read_csv("l.csv")) == 2
    before = Path("a.csv").read_bytes()
    assert main(["collect", str(handed_in), "--table", "a.csv"]) == 1
    assert "a.csv exists" in capsys.readouterr().err
    assert Path("a.csv").read_bytes() == before


def test_nothing_to_collect_is_said(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["collect", str(tmp_path)]) == 1
    assert "no answers" in capsys.readouterr().err
    assert main(["collect", str(tmp_path / "gone")]) == 1
    assert "is not a folder" in capsys.readouterr().err
