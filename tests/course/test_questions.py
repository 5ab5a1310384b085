"""Predictions, quiz and the file of answers: nothing is lost, and the course goes on."""

import importlib
import io
import json
import os
import re
import threading
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from ikteach.course import export, predict, quiz, quizzes, record, reveal
from ikteach.course.notice import Notice
from ikteach.course.widget import Question

KEY, OPTIONS = "03.half-alpha", ["slower", "divergent", "the same"]


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def denied(*_: Any, **__: Any) -> None:
    raise PermissionError(13, "Permission denied")


@pytest.fixture
def readonly(folder: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder that cannot be written to, for root too."""
    monkeypatch.setattr(os, "open", denied)
    monkeypatch.setattr(os, "rename", denied)
    return folder


def ask(key: str = KEY, **options: Any) -> Question:
    return predict(key, "Half of α: what happens?", OPTIONS, **options)


def answer(question: Question, value: Any) -> str:
    """What the page does when the button is pressed."""
    question.answer = value
    question.asked += 1
    return str(question.status)


def stored(folder: Path, kind: str = "predictions") -> Any:
    return json.loads((folder / "predictions.json").read_text("utf-8"))[kind]


def test_a_prediction_is_stored_at_once_and_shown_again(folder: Path) -> None:
    question = ask(explain="α is the step length.")
    assert (question.kind, question.note, question.locked) == ("choice", "α is the step length.", 0)
    assert not (folder / "predictions.json").exists()
    assert answer(question, "slower").startswith("Your prediction: slower. You can change it")
    assert stored(folder)[KEY]["answer"] == "slower"
    again = ask()
    assert again.answer == "slower"
    assert "Your prediction: slower" in again.status
    assert not again.locked
    answer(again, "divergent")
    assert stored(folder)[KEY]["answer"] == "divergent"


def test_reveal_shows_both_and_locks(folder: Path) -> None:
    question = ask()
    answer(question, "slower")
    shown = reveal(KEY, "the same", because="α is of the line, not of the method.")
    for text in (str(shown), shown._repr_html_()):
        assert "You predicted: slower." in text
        assert "Computed: the same." in text
        assert "They differ." in text
        assert "α is of the line" in text
    assert question.locked
    assert "locked" in question.status
    answer(question, "the same")  # a page that does not know yet
    assert stored(folder)[KEY]["answer"] == "slower"
    again = ask()
    assert again.locked
    assert again.answer == "slower"
    assert "locked" in again.status
    assert reveal(KEY, "slower").right is True


def test_another_kernel_finds_it_locked(folder: Path) -> None:
    answer(ask(), "slower")
    reveal(KEY, "slower")
    late = Question("x", lambda given: __import__("ikteach").course.questions._store(KEY, given))
    assert "locked" in answer(late, "divergent")
    assert stored(folder)[KEY]["answer"] == "slower"


def test_a_skipped_prediction_harms_nothing_and_may_come_late(folder: Path) -> None:
    shown = reveal(KEY, "slower")
    assert str(shown) == "You made no prediction.\nComputed: slower."
    question = ask()
    assert not question.locked
    assert "The result was shown before" in answer(question, "slower")
    assert stored(folder)[KEY]["late"] is True
    assert "after the result was shown" in str(reveal(KEY, "slower"))


def test_numbers(folder: Path) -> None:
    question = predict("00.poses", "How many?", numbers=(0, 10, "poses"))
    assert (question.kind, question.numbers) == ("number", [0, 10, "poses"])
    assert "Your prediction: 4." in answer(question, 4)
    assert "That is 2 away." in str(reveal("00.poses", np.int64(2)))
    assert predict("00.poses", "How many?", numbers=(0, 10, "poses")).locked
    # The question was changed since: an answer that it cannot have is not shown.
    assert predict("00.poses", "How many?", numbers=(6, 10, "poses")).answer is None
    assert "Computed: 0.3333." in str(reveal("00.share", np.float64(1 / 3)))


def test_ranking(folder: Path) -> None:
    question = predict("08.rank", "Rank.", ["sdls", "dls", "transpose"], ranking=True)
    assert question.kind == "ranking"
    order = ["dls", "sdls", "transpose"]
    assert "dls, then sdls, then transpose" in answer(question, order)
    shown = reveal("08.rank", np.array(order))
    assert shown.right is True
    assert stored(folder)["08.rank"] | {"at": ""} == {"answer": order, "result": order, "at": ""}
    assert predict("08.rank", "Rank.", ["a", "b"], ranking=True).answer is None


def test_a_result_that_was_no_option_is_shown_all_the_same() -> None:
    answer(ask(), "slower")
    assert "They differ." in str(reveal(KEY, "none of these"))
    reveal(KEY, object())  # whatever it is, it is shown as text


def test_questions_without_options_are_refused() -> None:
    with pytest.raises(ValueError, match=r"'03\.x' needs options"):
        predict("03.x", "What?")
    with pytest.raises(LookupError, match=r"no option of '03\.q' 'c'"):
        quiz("03.q", "What?", ["a", "b"], "c", "why")
    with pytest.raises(LookupError, match="'d'"):
        quiz("03.q", "What?", ["a", "b"], "a", {"d": "why"})


def test_exit_questions_are_those_of_the_notebooks_and_give_nothing_away() -> None:
    """A notebook names the key; the answer and the reasons are in the package alone."""
    ours = {}
    for path in sorted(Path(quizzes.__file__).parent.glob("ch*.py")):
        ours |= importlib.import_module(f"{quizzes.__name__}.{path.stem}").QUIZZES
    there = set()
    for path in sorted((Path(__file__).parents[2] / "notebooks").glob("*.ipynb")):
        text = json.loads(path.read_text(encoding="utf-8"))
        source = "\n".join("".join(cell["source"]) for cell in text["cells"])
        there |= set(re.findall(r'^quiz\("([^"]+)"\)$', source, re.MULTILINE))
        for key, one in ours.items():
            reasons = [one.why] if isinstance(one.why, str) else one.why.values()
            assert not any(reason in source for reason in reasons), f"{key} in {path.name}"
    assert there == set(ours)
    for key, one in ours.items():
        question = quiz(key)
        assert question.options == one.choices
        assert answer(question, one.right).startswith("✓ Right. ")
        wrong = [answer(question, other) for other in one.choices if other != one.right]
        assert all(said.startswith("✗ Not so. ") and len(said) > 12 for said in wrong)
    with pytest.raises(LookupError, match=r"no exit question '03.stick'; did you mean '03.stuck'"):
        quiz("03.stick")


def test_quiz_explains_each_answer(folder: Path) -> None:
    why = {"a": "It lags.", "b": "So it is."}
    question = quiz("03.q", "Which?", ["a", "b", "c"], "b", why)
    assert answer(question, "a") == "✗ Not so. It lags."
    assert answer(question, "b") == "✓ Right. So it is."
    assert answer(question, "c") == "✗ Not so."
    entry = stored(folder, "quiz")["03.q"]
    assert (entry["answer"], entry["right"], entry["tries"]) == ("c", False, 3)
    assert answer(quiz("03.q", "Which?", ["a", "b"], "b", "Why."), "a") == "✗ Not so. Why."


@pytest.mark.parametrize("value", [None, "other", 3, [], {"a": 1}, ["slower"] * 10**5, "x" * 10**6])
def test_what_is_no_answer_is_not_stored(folder: Path, value: Any) -> None:
    for question in (ask(), quiz("03.q", "Which?", OPTIONS, "slower", "")):
        assert answer(question, value) == "That is no answer to this question."
    number = predict("00.poses", "How many?", numbers=(0, 10, "poses"))
    for wrong in (11, -1, float("nan"), float("inf"), 10**400, True, "4", [4]):
        assert answer(number, wrong) == "That is no answer to this question."
    assert not (folder / "predictions.json").exists()


def test_a_long_answer_of_a_file_is_shown_short(folder: Path) -> None:
    for long in ("x" * 10**6, ["y"] * 10**6):
        entry = {"predictions": {KEY: {"answer": long}}}
        (folder / "predictions.json").write_text(json.dumps(entry))
        assert len(str(reveal(KEY, "slower"))) < 3000
        assert ask().answer is None


def test_a_notice_is_false_if_it_is_bad(folder: Path) -> None:
    assert export("mine.json")
    assert not export("mine.json")


def test_running_a_cell_again_frees_the_widget_before() -> None:
    first = ask()
    second = ask()
    assert first.comm is None
    assert second.comm is not None


def test_questions_can_be_read_without_a_kernel() -> None:
    data, _ = ask(explain="Think <first>.")._repr_mimebundle_()
    assert "<li>divergent</li>" in data["text/html"]
    assert "Think &lt;first&gt;." in data["text/html"]
    data, _ = predict("03.n", "How many?", numbers=(0, 5, "m"))._repr_mimebundle_()
    assert "from 0 to 5 m" in data["text/html"]


def test_answers_from_another_thread_are_kept(folder: Path) -> None:
    workers = [
        threading.Thread(target=record.store, args=("quiz", f"k{i}"), kwargs={"n": i})
        for i in range(12)
    ]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    assert {key: one["n"] for key, one in stored(folder, "quiz").items()} == {
        f"k{i}": i for i in range(12)
    }


# ---- files that are not as they should be


@pytest.mark.parametrize(
    "damage", [b"", b"{", b"\xff\xfe\x00", b"[1, 2]", b'{"predictions": 3}', b'{"quiz": {"a": 1}}']
)
def test_a_damaged_file_is_set_aside(folder: Path, damage: bytes) -> None:
    (folder / "predictions.json").write_bytes(damage)
    (folder / "predictions.damaged-1.json").write_text("an older one")
    question = ask()  # to look does nothing to the file
    assert (folder / "predictions.json").read_bytes() == damage
    said = answer(question, "slower")
    assert "predictions.json was damaged; it is now predictions.damaged-2.json" in said
    assert (folder / "predictions.damaged-2.json").read_bytes() == damage
    assert (folder / "predictions.damaged-1.json").read_text() == "an older one"
    assert stored(folder)[KEY]["answer"] == "slower"
    assert "damaged" not in str(reveal(KEY, "slower"))


def test_where_nothing_can_be_written_answers_live_in_memory(
    readonly: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    said = answer(ask(), "slower")
    assert "predictions.json cannot be written (Permission denied): your answers are kept" in said
    shown = str(reveal(KEY, "slower"))
    assert "You predicted: slower." in shown
    assert "cannot be written" in shown
    assert list(readonly.iterdir()) == []
    monkeypatch.undo()
    monkeypatch.chdir(readonly)
    assert record.store("quiz", "later", answer="a") == ""
    assert stored(readonly)[KEY]["answer"] == "slower"  # what was in memory is in the file now


def test_a_damaged_file_that_cannot_be_set_aside_is_left_alone(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(os, "rename", denied)
    (folder / "predictions.json").write_bytes(b"{")
    said = answer(ask(), "slower")
    assert "is damaged and cannot be set aside (Permission denied)" in said
    assert (folder / "predictions.json").read_bytes() == b"{"
    assert ask().answer == "slower"


def test_a_folder_in_place_of_the_file(folder: Path) -> None:
    (folder / "predictions.json").mkdir()
    assert "cannot be read" in answer(ask(), "slower")
    assert "You predicted: slower." in str(reveal(KEY, "slower"))


# ---- one file for an assignment


def test_export(folder: Path) -> None:
    answer(ask(), "slower")
    answer(quiz("03.q", "Which?", ["a", "b"], "b", ""), "b")
    log = pd.DataFrame({"method": ["dls", "sdls"], "error": [0.25, np.nan]})
    done = export("mine.json", log)
    assert done == Notice(
        "Written to mine.json: 1 predictions, 0 verdicts, 1 quiz, a log of 2 rows.", "good"
    )
    file = json.loads((folder / "mine.json").read_text())
    assert file["predictions"][KEY]["answer"] == "slower"
    assert file["quiz"]["03.q"]["right"] is True
    back = pd.read_json(io.StringIO(json.dumps(file["log"])), orient="split")
    pd.testing.assert_frame_equal(back, log)


def test_export_never_overwrites_unless_asked(folder: Path) -> None:
    (folder / "mine.json").write_text("precious")
    refused = export("mine.json")
    assert refused.mood == "bad"
    assert "exists already and was left alone" in refused.sentence
    assert (folder / "mine.json").read_text() == "precious"
    assert export("mine.json", overwrite=True).mood == "good"
    assert json.loads((folder / "mine.json").read_text())["log"] is None


def test_export_says_what_is_wrong(folder: Path) -> None:
    assert "must be a DataFrame, not [1]" in export("a.json", [1]).sentence
    assert "where your answers live" in export("predictions.json", overwrite=True).sentence
    assert "could not be written" in export("no/such/folder.json").sentence
    (folder / "predictions.json").write_text("{")
    assert "is damaged and was left out" in export("b.json").sentence
    assert (folder / "predictions.json").read_text() == "{"
    assert "✗" in str(export("b.json"))
    assert "border-left" in export("b.json")._repr_html_()


def test_what_goes_wrong_in_an_answer_is_told_under_it() -> None:
    def breaks(answer: Any) -> str:
        raise ValueError("no room")

    question = Question("00.breaks", breaks, question="Which?", options=["a", "b"])
    assert answer(question, "a") == "That did not work: no room"
    question.close()
