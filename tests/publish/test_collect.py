"""The answers of a class in one table: everything that is an answer, and a word on what is not."""

import csv
import json
import os
import re
from pathlib import Path

import pandas as pd
import pytest

from ikteach.__main__ import main
from ikteach.course import export, predict, quiz, record, reveal
from ikteach.course.record import store
from ikteach.course.widget import Question
from ikteach.publish.collect import LEADING, SKIPPED, collect, harmless, summarise

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
        monkeypatch.setattr(record, "_folder", None)  # another kernel
        answered(predict("03.half", "?", OPTIONS), answer)
        answered(predict("01.zeros", "?", numbers=(0, 240, "entries")), far)
        reveal("03.half", "more")
        reveal("01.zeros", 96)
        answered(quiz("03.stuck", "?", OPTIONS, "more", ""), answer)
        store("verdicts", "03.alpha", passed=name == "ada", sentence="So.", tries=2)
    log = pd.DataFrame({"method": ["dls", "sdls"], "error": [0.1, 0.2]})
    monkeypatch.chdir(tmp_path / "class" / "ada")
    monkeypatch.setattr(record, "_folder", None)
    assert export("ada.json", log).mood == "good"
    Path("predictions.json").unlink()
    monkeypatch.chdir(tmp_path)
    return tmp_path / "class"


def test_every_answer_is_a_row(handed_in: Path) -> None:
    table, logs, skipped = collect(handed_in)
    assert skipped == {}
    assert list(table.columns[: len(LEADING)]) == LEADING
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
    said = summarise(collect(handed_in).table)
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
    assert summarise(table).loc[("03.half", "prediction")].tolist()[2] == "fewer 1, more 1"


@pytest.mark.parametrize(
    ("name", "content", "word"),
    [
        ("half.json", b'{"predictions": {', "not JSON (line 1"),
        ("list.json", b"[1, 2]", "no answers"),
        ("settings.json", b'{"gait": {}}', "no answers"),
        ("latin.json", '{"quiz": "\u00e9"}'.encode("latin-1"), "not text in UTF-8"),
        ("form.json", b'{"predictions": {"03.half": "more"}}', "form"),
        ("deep.json", b"[" * 100_000, "nested too deep"),
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
    assert main(["collect", str(handed_in), "--table", "a.csv", "--logs", "l.csv"]) == SKIPPED
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


# ---- whatever somebody hands in


def entry(**fields: object) -> dict[str, object]:
    return {"predictions": {"01.x": {"answer": "a", "result": "a", "at": "2026-01-01"} | fields}}


def nested(levels: int) -> object:
    value: object = "x"
    for _ in range(levels):
        value = [value]
    return value


HOSTILE: dict[str, object] = {
    "nested 600 deep": entry(answer=nested(600)),
    "nested 100 deep": entry(answer=nested(100)),
    "400 digits": entry(answer=10**400),
    "infinite": '{"quiz": {"k": {"answer": 1e999}}}',
    "at a number": entry(at=3),
    "at nothing": entry(at=None),
    "tries a text": {"verdicts": {"01.x": {"tries": "3"}}},
    "half a character": entry(answer="\ud800"),
    "half in a key": {"quiz": {"\ud800": {}}},
    "a list": [],
    "no object": {"quiz": []},
    "no entry": {"quiz": {"k": 3}},
    "many fields": {"quiz": {"k": {f"f{i}": 1 for i in range(1000)}}},
    "many keys": {"quiz": {f"k{i}": {} for i in range(10_000)}},
    "binary": b"\0" * 1000,
    "gzip": b"\x1f\x8b\x08",
    "a number": "3",
    "nothing": "",
}


@pytest.mark.parametrize("content", HOSTILE.values(), ids=HOSTILE.keys())
def test_one_bad_file_costs_no_other(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    content: object,
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("class").mkdir()
    Path("class/ada.json").write_text(json.dumps(entry()))
    data = content if isinstance(content, str | bytes) else json.dumps(content)
    Path("class/eve.json").write_bytes(data if isinstance(data, bytes) else data.encode())
    assert main(["collect", "class", "--table", "t.csv"]) == SKIPPED
    said = capsys.readouterr()
    assert said.err.startswith("eve.json: skipped: ")
    assert len(said.err) < 500
    assert pd.read_csv("t.csv")["student"].tolist() == ["ada"]


LOGS: dict[str, object] = {
    "two of a name": {"columns": ["a", "a"], "data": [[1, 2]]},
    "our names": {"columns": ["student"], "data": [["eve"]]},
    "rows of other lengths": {"columns": ["a"], "data": [[1], [1, 2]]},
    "no rows": {"columns": ["a"], "data": {"a": 1}},
    "many columns": {"columns": [f"c{i}" for i in range(5000)], "data": []},
    "a text": "log",
    "lists as names": {"columns": [["a"], ["b"]], "data": [[[1], {"a": 1}]]},
}


@pytest.mark.parametrize("log", LOGS.values(), ids=LOGS.keys())
def test_one_bad_log_costs_no_other(tmp_path: Path, log: object) -> None:
    good = {"columns": ["a"], "data": [[1], [2]]}
    (tmp_path / "ada.json").write_text(json.dumps(entry() | {"log": good}))
    (tmp_path / "eve.json").write_text(json.dumps(entry() | {"log": log}))
    table, logs, skipped = collect(tmp_path)
    assert set(table["student"]) == {"ada", "eve"}
    assert logs[logs["student"] == "ada"]["a"].tolist() == [1, 2]
    assert "its log is not" in skipped.get("eve.json", "its log is not") or logs.shape[0] == 3


def test_what_is_no_file_or_leads_elsewhere_is_named(tmp_path: Path) -> None:
    home = tmp_path / "class"
    (home / "bo").mkdir(parents=True)
    (home / "ada.json").write_text(json.dumps(entry()))
    (tmp_path / "secret.json").write_text(json.dumps(entry(answer="secret")))
    (home / "eve.json").symlink_to(tmp_path / "secret.json")
    (home / "bo" / "up").symlink_to(home)
    (home / "loop.json").symlink_to(home / "loop.json")
    os.mkfifo(home / "pipe.json")
    (home / "folder.json").mkdir()
    with (home / "giant.json").open("wb") as file:
        file.truncate(120 * 2**20)
    (home / ".hidden.json").write_text("{")
    table, _, skipped = collect(home)
    assert table["student"].tolist() == ["ada"]
    words = {"eve.json": "link", str(Path("bo", "up")): "link", "loop.json": "link",
             "pipe.json": "not an ordinary file", "giant.json": "120 MB, more than 50"}  # fmt: skip
    assert skipped.keys() == words.keys()
    for name, word in words.items():
        assert word in skipped[name]


def test_a_file_name_that_is_no_text(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    name = os.fsencode(tmp_path) + b"/\xff.json"
    with open(name, "w") as file:
        json.dump(entry(), file)
    (tmp_path / "\x1b[2J.json").write_text("no")
    assert main(["collect", str(tmp_path), "--table", str(tmp_path / "t.csv")]) == SKIPPED
    assert pd.read_csv(tmp_path / "t.csv")["student"].tolist() == ["?"]
    assert "\x1b" not in "".join(capsys.readouterr())


@pytest.mark.parametrize(
    ("cell", "safe"),
    [
        ("=1+1", "'=1+1"), ("+cmd|' /C calc'!A0", "'+cmd|' /C calc'!A0"), ("@SUM(A1)", "'@SUM(A1)"),
        ("-1+1", "'-1+1"), (" =1", "' =1"), ("a;=1", "a;'=1"), ("＝1", "'＝1"), ("-inf", "'-inf"),
        ("a\t=1", "a\t'=1"), ("a, -b", "a, -b"), ("a = b", "a = b"), ("a; b", "a; b"),
        ("more, then less", "more, then less"), ("-0.5", "-0.5"), ("+1e-3", "+1e-3"),
        (-0.5, -0.5), (True, True), (None, None),
    ],
)  # fmt: skip
def test_no_cell_is_a_formula_and_numbers_stay_numbers(cell: object, safe: object) -> None:
    table = harmless(pd.DataFrame({"key": ["x"], "answer": pd.Series([cell], dtype=object)}))
    assert table["answer"].tolist() == [safe]


@pytest.mark.parametrize("cell", ["\t=1", "\r=1", "\n-1+1", "\tx", "\r\n@x"])
def test_no_cell_begins_with_what_a_spreadsheet_leaves_out(cell: str) -> None:
    safe = harmless(pd.DataFrame({"answer": [cell]})).loc[0, "answer"]
    assert safe.startswith("'")
    assert not re.search(r"(^|\s)[=+@-]", safe)


def test_names_and_columns_are_no_formulas_either(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("class").mkdir()
    hostile = {"quiz": {"=1+1": {"answer": '=HYPERLINK("x")', "=2+2": 1, "note": -0.5}}}
    hostile["log"] = {"columns": ["=3+3"], "data": [["@x"]]}  # type: ignore[dict-item]
    Path("class/=4+4.json").write_text(json.dumps(hostile))
    assert main(["collect", "class", "--table", "t.csv", "--logs", "l.csv"]) == 0
    for name in ("t.csv", "l.csv"):
        with open(name, newline="") as file:
            cells = [cell for row in csv.reader(file) for cell in row]
        assert not [cell for cell in cells if cell.startswith(("=", "@", "+"))]
    assert pd.read_csv("t.csv").loc[0, "note"] == -0.5


def test_a_table_is_whole_or_not_there(
    handed_in: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def full(_: object) -> None:
        raise OSError(28, "No space left on device")

    before = sorted(os.listdir())
    with monkeypatch.context() as patch:
        patch.setattr(os, "fsync", full)
        assert main(["collect", str(handed_in), "--table", "a.csv"]) == 1
    assert "a.csv cannot be written (No space left on device)." in capsys.readouterr().err
    assert sorted(os.listdir()) == before
    assert main(["collect", str(handed_in), "--table", "a.csv", "--logs", "./a.csv"]) == 1
    assert "need two files" in capsys.readouterr().err
    assert main(["collect", str(handed_in), "--table", "no/a.csv"]) == 1
    assert "there is no folder" in capsys.readouterr().err


def test_a_screen_is_not_flooded(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for i in range(50):
        answer = f"\x1b[31m{i}" + "long " * 100
        (tmp_path / f"s{i}.json").write_text(json.dumps(entry(answer=answer)))
    assert main(["collect", str(tmp_path)]) == 0
    said = capsys.readouterr().out
    assert "and 42 other answers" in said
    assert "\x1b" not in said
    assert len(said) < 2000


def test_answers_of_any_age_are_counted(tmp_path: Path) -> None:
    """A result that was no number stands in old files as NaN, which JSON does not know."""
    old = '{"predictions": {"01.x": {"answer": 3, "result": NaN, "at": "2026-01-01"}}}'
    (tmp_path / "ada.json").write_text(old)
    (tmp_path / "bo.json").write_text(json.dumps({"predictions": {"01.x": {"answer": 5}}}))
    table, _, skipped = collect(tmp_path)
    assert skipped == {}
    assert summarise(table).loc[("01.x", "prediction"), "said"] == "median 4"
