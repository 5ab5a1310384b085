"""Questions as GIFT, the text that Moodle imports."""

import html
import re
from collections.abc import Iterable, Mapping

import numpy as np

from ikteach.course.quizzes import Quiz
from ikteach.publish.pack.bank import Numeric

SPECIAL = re.compile(r"([\\~=#{}:])")


def escaped_gift(text: str) -> str:
    """Write text as HTML, and that as GIFT."""
    return guarded(html.escape(" ".join(text.split()), quote=False))


def guarded(text: str) -> str:
    """Put a backslash before what means something in GIFT."""
    return SPECIAL.sub(r"\\\1", text)


def in_category(*path: str) -> str:
    """Name the category of what follows."""
    return f"$CATEGORY: {'/'.join(one.replace('/', '//') for one in path)}"


def numeric_question(name: str, question: Numeric) -> str:
    """Write a question whose answer is a number.

    A wrong belief's value gives no points and its own feedback, any other number the way.
    """
    unit = f" Answer in {question.unit}." if question.unit else " Answer with the number."
    why = escaped_gift(question.why)
    rows = [f"={_number(question.answer, question)}#Right. {why}"]
    rows += [
        f"=%0%{_number(value, question)}#Not so. {escaped_gift(said)}"
        for said, value in question.wrong.items()
    ]
    return _question(name, question.text + unit, ["#", *rows, f"~#Not so. {why}"])


def choice_question(name: str, quiz: Quiz) -> str:
    """Write a question with one right answer of several."""
    why = quiz.why if isinstance(quiz.why, Mapping) else dict.fromkeys(quiz.choices, quiz.why)
    rows = [
        f"{'=' if one == quiz.right else '~'}{escaped_gift(one)}#{escaped_gift(why.get(one, ''))}"
        for one in quiz.choices
    ]
    return _question(name, quiz.question, rows)


def matching_question(name: str, text: str, pairs: Iterable[tuple[str, str]]) -> str:
    """Write a question in which each of several has its own."""
    # The one is HTML to Moodle, the other plain text.
    rows = [f"={escaped_gift(one)} -> {guarded(other)}" for one, other in pairs]
    return _question(name, text, rows)


def _question(name: str, text: str, rows: Iterable[str]) -> str:
    body = "\n".join(f"\t{row}" for row in rows)
    return f"::{escaped_gift(name)}::[html]{escaped_gift(text)}{{\n{body}\n}}"


def _number(value: float, question: Numeric) -> str:
    """Write a value with its margin, without an exponent: `0.3927:0.0039`."""
    answer = np.format_float_positional(value, 5, fractional=False, trim="-")
    margin = np.format_float_positional(question.margin(value), 2, fractional=False, trim="-")
    return f"{answer}:{margin}"
