"""The question bank: it can be read, and every number is found again another way."""

import math
import re
from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest

from ikteach.course.quizzes import asked
from ikteach.publish.delivery import chapters, find_course
from ikteach.publish.pack.bank import VARIANTS, draw_variants, families, gift
from ikteach.publish.pack.parts import Chapter
from ikteach.publish.pack.write import bank
from tests.publish.gift import Asked, Number, read

NOTEBOOKS = find_course().notebooks
UNITS = {"centimetres": 100, "millimetres": 1000, "feet": 1 / 0.3048, "degrees": 180 / math.pi}


def sin(degrees: float) -> float:
    return math.sin(math.radians(degrees))


def per(text: str) -> float:
    """Units of length per metre over units of angle per radian, as a question names them."""
    length, angle = re.findall(r"lengths are in (\w+) and angles in (\w+)", text)[0]
    return UNITS[length] / UNITS.get(angle, 1)


def best(a: float, _: float, b: float, c: float, *e: float) -> float:
    slope = [a * e[0] + b * e[1], c * e[1]]
    ahead = [a * slope[0], b * slope[0] + c * slope[1]]
    return (e[0] * ahead[0] + e[1] * ahead[1]) / (ahead[0] ** 2 + ahead[1] ** 2)


def largest(a: float, _: float, b: float, c: float) -> float:
    trace = a**2 + b**2 + c**2
    return math.sqrt((trace + math.sqrt(trace**2 - 4 * (a * c) ** 2)) / 2)


def tangent(length: float, degrees: float) -> float:
    turn = math.radians(degrees)
    return length * math.hypot(1 - math.cos(turn), turn - math.sin(turn))


def shaken(*degrees: float) -> float:
    turns = [b - a for a, b in pairwise(degrees)]
    return float(np.mean([abs(b - a) for a, b in pairwise(turns)]))


def nodding(y: float, z: float, eyes: float) -> float:
    return math.degrees(math.atan2(z, y) - math.acos(eyes / math.hypot(y, z)))


# From the numbers that a question prints, in their order, to its answer: by formulas alone.
AGAIN: dict[str, Callable[..., float]] = {
    "prerequisites.arc": lambda r, turn: r * math.radians(turn),
    "00.hand": lambda a, b, one, two: a * sin(one) + b * sin(one + two),
    "00.nearest": lambda a, b: abs(a - b),
    "00.poses": lambda n, k: n - 3 * k,
    "01.arrow": lambda x, y, z: math.hypot(x, y),
    "01.cramer": lambda *n: np.linalg.solve(np.reshape(n[:9], (3, 3)), n[9:])[0],
    "01.once": tangent,
    "01.zeros": lambda trunk, limbs, each, _: 3 * limbs * (limbs - 1) * each,
    "02.sigma": largest,
    "02.volume": lambda a, b, bend: a * b * sin(bend),
    "03.alpha": best,
    "03.left": lambda least, gain: 1 - (1 - least) * gain * (2 - gain),
    "04.cap": lambda arm, leg, most: leg * most / arm,
    "04.length": lambda s, w, a, b: math.hypot(a / s, b / w),
    "04.shortest": lambda a, b, e: a * e / (a * a + b * b),
    "05.answer": lambda s, damping: s / (s * s + damping * damping),
    "05.bound": lambda damping, e: e / (2 * damping),
    "06.clamp": lambda peak, other, most: other * most / abs(peak),
    "06.gamma": lambda a, b, c, s, sigma, most: most * min(1, sigma / (c * a + s * b)),
    "07.pace": lambda A, speed, z: speed * math.sqrt(A * A - z * z),
    "07.period": lambda speed: 2 * math.pi / speed,
    "08.jitter": shaken,
    "09.iteration": lambda start, upper, wish, most: min(start + min(wish, most), upper),
    "10.det": lambda a, b, elbow, rho: rho * a * b * sin(elbow),
    "10.nod": nodding,
    "11.score": lambda left, right: math.sqrt((left**2 + right**2) / 2),
    "11.support": lambda share: 2 * share - 100,
    "12.error": lambda length, turn: 2 * length * sin(turn / 2),
    "12.lock": lambda middle: math.sqrt(1 - sin(middle)),
}
BY_WORDS: dict[str, Callable[[str, float], float]] = {  # where units are words
    "02.unit": lambda text, found: found * UNITS[re.findall(r"lengths in (\w+)\?", text)[0]] ** 2,
    "05.unit": lambda text, found: found * per(text),
}


@pytest.fixture(scope="module")
def course() -> list[Chapter]:
    return [Chapter(NOTEBOOKS / name) for name in chapters(NOTEBOOKS)]


@pytest.fixture(scope="module")
def text(course: list[Chapter]) -> str:
    return bank(course)


@pytest.fixture(scope="module")
def questions(text: str) -> list[Asked]:
    return read(text)


def numeric(questions: list[Asked]) -> list[Asked]:
    return [question for question in questions if question.kind == "numeric"]


def test_every_number_is_found_another_way(questions: list[Asked]) -> None:
    counted = dict.fromkeys(families(), 0)
    for question in numeric(questions):
        family = question.name.partition(" ")[0]
        told = question.text.partition(" Answer ")[0].replace("−", "-")
        printed = [float(n) for n in re.findall(r"-?\d+(?:\.\d+)?", told)]
        known = BY_WORDS.get(family)
        again = known(told, *printed) if known else AGAIN[family](*printed)
        right, *wrong = question.answers
        assert isinstance(right, Number)
        assert right.share == 1
        assert right.value == pytest.approx(again, rel=2e-3), question
        assert right.margin == pytest.approx(0.01 * abs(right.value), rel=0.06)
        for other in wrong:
            assert isinstance(other, Number)
            assert other.share == 0
            assert abs(other.value - right.value) > other.margin + right.margin, question
        counted[family] += 1
    assert set(counted.values()) == {VARIANTS}


def test_a_wrong_formula_would_be_found(questions: list[Asked]) -> None:
    (one, *_) = [q for q in numeric(questions) if q.name.startswith("05.bound")]
    right = one.answers[0]
    assert isinstance(right, Number)
    damping, far = (float(n) for n in re.findall(r"\d+\.\d+", one.text))
    assert right.value != pytest.approx(far / damping, rel=2e-3)


def test_no_two_questions_are_alike(questions: list[Asked]) -> None:
    assert len({question.name for question in questions}) == len(questions)
    texts = [question.text for question in numeric(questions)]
    assert len(set(texts)) == len(texts)


def test_exit_questions_are_those_of_the_course(
    questions: list[Asked], course: list[Chapter]
) -> None:
    from ikteach.publish.pack.parts import Exit

    choices = {question.name.removeprefix("quiz "): question for question in questions}
    keys = [part.key for chapter in course for part in chapter.of(Exit)]
    assert len(keys) > 12
    for key in keys:
        quiz, question = asked(key), choices[key]
        assert question.text == quiz.question
        assert [(one[0], one[1]) for one in question.answers] == [
            (option, option == quiz.right) for option in quiz.choices
        ]


def test_letters_mean_what_the_table_says(questions: list[Asked]) -> None:
    table = next(c for c in Chapter(NOTEBOOKS / "prerequisites.ipynb").cells if c.id == "notation")
    found = [question for question in questions if question.kind == "matching"]
    assert len(found) == VARIANTS
    for question in found:
        assert all(f"| {one} | {other} |" in table.source for one, other, *_ in question.answers)


def test_the_same_seed_makes_the_same_bytes(text: str, course: list[Chapter]) -> None:
    assert bank(course) == text
    name = "05.bound"
    assert draw_variants(name, 3) == draw_variants(name, 5)[:3]
    assert draw_variants(name, 3, seed=1) != draw_variants(name, 3)


@pytest.mark.parametrize("family", families())
def test_other_seeds_make_questions_too(family: str) -> None:
    for question in draw_variants(family, 5, seed=7):
        assert question.clear
        (back,) = read(gift.numeric_question("a: b", question))
        assert back.name == "a: b"


def test_whatever_means_something_in_gift_or_html_is_shown_as_it_is() -> None:
    from ikteach.course.quizzes import Quiz

    nasty = r"a ~ b = {c} # d: <b>e</b> & \n f\\g // h -> i"
    quiz = Quiz(nasty, right=nasty, why={nasty: nasty, "other": "[html] %50% 1..2"})
    (back,) = read(gift.choice_question(nasty, quiz))
    assert back.text == nasty
    assert back.answers == [(nasty, True, nasty), ("other", False, "[html] %50% 1..2")]
    (pairs,) = read(gift.matching_question("m", "?", [(nasty, "x = y"), ("b", "c"), ("d", "e")]))
    assert pairs.answers[0] == (nasty, "x = y")


@pytest.mark.parametrize(
    ("broken", "why"),
    [
        ("::a::[html]b{\n\t=c#\n\t=d#\n}", "no choice of one"),
        ("::a::[html]b = c{\n\t=c#\n\t~d#\n}", "no question"),
        ("::a::[html]b{\n\t#\n\t=1,5:0.1#x\n\t~#y\n}", "has no numbers"),
        ("::a::[html]b{\n\t#\n\t=1.5:0.1#x\n}", "says nothing of other numbers"),
        ("::a::[html]b\\q{\n\t=c#\n\t~d#\n}", "escapes nothing"),
        ("no name{\n\t=c#\n\t~d#\n}", "no question"),
        ("::a::[html]b{\n\t=c -> d\n\t=e -> d\n\t=f -> g\n}", "two that are alike"),
    ],
)
def test_the_reader_is_strict(broken: str, why: str) -> None:
    with pytest.raises(ValueError, match=why):
        read(broken)
