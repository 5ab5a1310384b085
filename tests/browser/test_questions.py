"""Predictions and quiz in a real browser, by keyboard; each answer is in the file at once."""

import json
from pathlib import Path
from typing import Any

import nbformat
import pytest

from tests.browser.conftest import READY, Lab, Notebook

CELLS = {
    "choice": "predict('99.choice', 'Slower or divergent?', ['slower', 'divergent'])",
    "number": "predict('99.number', 'How many poses?', numbers=(0, 10, 'poses'))",
    "ranking": "predict('99.rank', 'Rank them.', ['sdls', 'dls', 'transpose'], ranking=True)",
    "quiz": "quiz('99.quiz', 'Which one?', ['a', 'b'], 'b', {'a': 'It lags.', 'b': 'So it is.'})",
    "ours": "quiz('03.stuck')",
    "path": "check('07.path', lambda p: np.stack([0 * p, 0.2 * np.sin(6.2831853 * p)], -1))",
}
IMPORTS = "import numpy as np\nfrom ikteach.course import check, predict, quiz, reveal"


@pytest.fixture(scope="module")
def asked(open_notebook: Any, lab: Lab) -> Notebook:
    cells = [nbformat.v4.new_code_cell(IMPORTS)]
    cells += [nbformat.v4.new_code_cell(source) for source in CELLS.values()]
    kernel = {"kernelspec": {"name": "python3", "display_name": "Python 3 (ipykernel)"}}
    notebook = nbformat.v4.new_notebook(cells=cells, metadata=kernel)
    nbformat.write(notebook, lab.folder / "questions.ipynb")
    notebook = open_notebook("questions.ipynb")
    notebook.run_all()
    return notebook


def form(notebook: Notebook, question: str) -> Any:
    found = notebook.page.locator(".ikteach-question", has_text=question)
    found.wait_for(timeout=READY)
    found.scroll_into_view_if_needed()
    return found


def stored(lab: Lab, kind: str, key: str) -> Any:
    return json.loads(Path(lab.folder / "predictions.json").read_text("utf-8"))[kind][key]


def status(found: Any, words: str) -> None:
    found.locator("[role=status]", has_text=words).wait_for(timeout=READY)


def test_a_choice_by_keys_then_locked(asked: Notebook, lab: Lab) -> None:
    found = form(asked, "Slower or divergent?")
    assert found.get_by_role("group", name="Slower or divergent?").count() == 1
    button = found.get_by_role("button", name="Lock in")
    button.click()
    status(found, "Choose an answer first.")
    found.get_by_label("slower").focus()
    asked.page.keyboard.press("Space")
    asked.page.keyboard.press("ArrowDown")
    asked.page.keyboard.press("Enter")
    status(found, "Your prediction: divergent.")
    assert stored(lab, "predictions", "99.choice")["answer"] == "divergent"
    assert "They agree." in asked.kernel("str(reveal('99.choice', 'divergent'))")
    status(found, "It is locked")
    assert found.get_by_label("slower").is_disabled()
    assert not button.is_visible()
    asked.shot("questions")


def test_a_number(asked: Notebook, lab: Lab) -> None:
    found = form(asked, "How many poses?")
    box = found.get_by_role("spinbutton")
    box.focus()
    asked.page.keyboard.type("11")
    asked.page.keyboard.press("Enter")
    status(found, "Write a number in the range first.")
    asked.page.keyboard.press("Backspace")
    asked.page.keyboard.press("Enter")
    status(found, "Your prediction: 1.")
    assert stored(lab, "predictions", "99.number")["answer"] == 1


def test_a_ranking(asked: Notebook, lab: Lab) -> None:
    found = form(asked, "Rank them.")
    found.get_by_role("button", name="move transpose up").focus()
    asked.page.keyboard.press("Enter")
    asked.page.keyboard.press("Enter")  # the button went along with its row
    assert found.locator("li").first.inner_text().endswith("transpose")
    found.get_by_role("button", name="Lock in").press("Enter")
    status(found, "transpose, then sdls, then dls")
    assert stored(lab, "predictions", "99.rank")["answer"] == ["transpose", "sdls", "dls"]


def test_a_quiz(asked: Notebook, lab: Lab) -> None:
    found = form(asked, "Which one?")
    for option, words in ("a", "✗ Not so. It lags."), ("b", "✓ Right. So it is."):
        found.get_by_label(option, exact=True).check()
        found.get_by_role("button", name="Check").click()
        status(found, words)
    assert stored(lab, "quiz", "99.quiz")["right"] is True
    asked.shot("questions_answered")
    assert asked.errors == []


def test_a_question_of_the_course_by_its_key(asked: Notebook, lab: Lab) -> None:
    found = form(asked, "A straight arm, its target straight inward.")
    found.get_by_label("It stands still").check()
    found.get_by_role("button", name="Check").click()
    status(found, "✓ Right. Jᵀe is exactly zero")
    assert stored(lab, "quiz", "03.stuck")["right"] is True


def test_a_verdict_with_its_hint_and_picture(asked: Notebook, lab: Lab) -> None:
    said = asked.page.get_by_role("status").filter(has_text="The foot lifts by 0 cm")
    said.wait_for(timeout=READY)
    assert "Hint 1 of 3: For which part of the cycle" in said.inner_text()
    picture = asked.page.get_by_alt_text("Your foot, from the side: z from -0.2 to 0.2 m")
    picture.scroll_into_view_if_needed()
    assert picture.evaluate("image => image.naturalWidth") > 300
    asked.shot("07_path_verdict")
    verdict = stored(lab, "verdicts", "07.path")
    assert not verdict["passed"]
    assert "np.sin(6.2831853 * p)" in verdict["source"]
