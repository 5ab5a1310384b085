"""A prediction before the code runs, what came of it, and the exit questions.

The widgets are made in `ikteach.course.widget`, imported when the first one is asked for.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import inf
from numbers import Real
from typing import TYPE_CHECKING, Any

from ikteach.checks import shown
from ikteach.course import record
from ikteach.course.notice import box
from ikteach.course.quizzes import asked
from ikteach.files import bounded, jsonable
from ikteach.markup import Markup

if TYPE_CHECKING:
    from ikteach.course.widget import Question

NOBODY = "You made no prediction."


def predict(
    key: str,
    question: str,
    options: Sequence[str] = (),
    *,
    numbers: tuple[float, float, str] | None = None,
    ranking: bool = False,
    explain: str | None = None,
) -> "Question":
    """Ask before the code runs.

    Make it the last line of its cell.

    key      chapter and name, such as "03.half-alpha"
    options  to choose from, or to put in order if `ranking`
    numbers  (low, high, unit) for a number in place of options
    explain  a sentence under the question
    The answer is stored when it is locked in, and may be changed until `reveal` shows the result.
    """
    from ikteach.course.widget import Question

    kind = "number" if numbers is not None else "ranking" if ranking else "choice"
    if numbers is None:
        options = _choices(key, options)
    else:
        numbers = _range(key, numbers)
    known = record.entry("predictions", key)

    def answered(answer: Any) -> str:
        return _store(key, answer) if fits(answer, kind, options, numbers) else NO_ANSWER

    shown = Question(
        key,
        answered,
        kind=kind,
        question=question,
        note=explain or "",
        options=list(options),
        numbers=list(numbers or ()),
    )
    if fits(known.get("answer"), kind, options, numbers):
        shown.answer = known["answer"]
        shown.status = f"Your prediction: {written(known['answer'])}."
        shown.locked = "result" in known
        shown.status += LOCKED if shown.locked else CHANGE
    return shown


NO_ANSWER = "That is no answer to this question."


def _choices(key: str, options: Sequence[str]) -> list[str]:
    """Check the options, as a list; TypeError or ValueError says what is wrong."""
    from ikteach.view.widgets import doors

    choices = doors.texts(f"the options of {key!r}", options)
    if len(set(choices)) < max(2, len(choices)):
        raise ValueError(
            f"{key!r} needs options to choose from, two or more that differ, or "
            "numbers=(low, high, unit)"
        )
    return choices


def _range(key: str, numbers: Any) -> tuple[float, float, str]:
    """Check low, high and unit; TypeError or ValueError says what is wrong."""
    from ikteach.view.widgets import doors

    if not (isinstance(numbers, tuple | list) and len(numbers) == 3):
        raise TypeError(f"the numbers of {key!r} must be (low, high, unit), not {shown(numbers)}")
    low, high, unit = numbers
    doors.within(f"the low end of {key!r}", low, -inf, inf)
    doors.within(f"the high end of {key!r}", high, low, inf)
    doors.text(f"the unit of {key!r}", unit)
    return low, high, unit


CHANGE = " You can change it until the result is shown."
LOCKED = " It is locked: the result has been shown."


def fits(
    answer: Any, kind: str, options: Sequence[str], numbers: tuple[float, float, str] | None
) -> bool:
    """Tell whether this question can have a stored answer."""
    if kind == "number":
        assert numbers is not None
        real = isinstance(answer, Real) and not isinstance(answer, bool)
        return real and bool(numbers[0] <= answer <= numbers[1])
    if kind == "ranking":
        return isinstance(answer, list) and sorted(map(str, answer)) == sorted(options)
    return answer in options


def _store(key: str, answer: Any) -> str:
    known = record.entry("predictions", key)
    if "result" in known and known.get("answer") is not None:
        return f"Your prediction: {written(known['answer'])}.{LOCKED}"
    late = "result" in known
    trouble = record.store("predictions", key, answer=answer, **({"late": True} if late else {}))
    after = " The result was shown before." if late else CHANGE
    return f"Your prediction: {written(answer)}.{after} {trouble}".strip()


@dataclass(frozen=True)
class Revealed:
    """A prediction beside the result."""

    prediction: Any
    result: Any
    because: str = ""
    late: bool = False
    trouble: str = ""

    @property
    def right(self) -> bool | None:
        """Whether prediction and result agree.

        None without a prediction, and for numbers, where it is a matter of how near.
        """
        if self.prediction is None or isinstance(self.result, int | float):
            return None
        return bool(self.prediction == self.result)

    def _lines(self) -> list[str]:
        said = NOBODY if self.prediction is None else f"You predicted: {written(self.prediction)}."
        lines = [said + (" (after the result was shown)" if self.late else "")]
        lines.append(f"Computed: {written(self.result)}.")
        if self.right is None and isinstance(self.prediction, int | float):
            lines.append(f"That is {written(abs(self.prediction - self.result))} away.")
        elif self.right is not None:
            lines.append("They agree." if self.right else "They differ.")
        return [*lines, *filter(None, [self.because, self.trouble])]

    def __str__(self) -> str:
        return "\n".join(self._lines())

    __repr__ = __str__

    def _repr_html_(self) -> str:
        mood = {True: "good", False: "bad", None: "plain"}[self.right]
        return box(mood, Markup("<br>").join(self._lines()))  # type: ignore[arg-type]


def reveal(key: str, answer: Any, because: str | None = None) -> Revealed:
    """Show the prediction `key` beside the computed `answer`, and lock it.

    answer   the result that the notebook has computed: an option, a number, or an order
    because  a sentence on why
    A prediction that was not made stays open: the result is shown all the same.
    """
    result = jsonable(answer)
    known = record.entry("predictions", key)
    trouble = record.store("predictions", key, result=result)
    _lock(key)
    return Revealed(known.get("answer"), result, because or "", bool(known.get("late")), trouble)


def _lock(key: str) -> None:
    import sys

    module = sys.modules.get("ikteach.course.widget")
    shown = module.Question.living(key) if module else None
    if shown is not None and record.entry("predictions", key).get("answer") is not None:
        shown.locked = True
        shown.status = f"Your prediction: {written(shown.answer)}.{LOCKED}"


def quiz(
    key: str,
    question: str = "",
    options: Sequence[str] = (),
    right: str = "",
    why: str | Mapping[str, str] = "",
) -> "Question":
    """Ask an exit question.

    Make it the last line of its cell.

    key    alone, it asks one of the course's own, from `ikteach.course.quizzes`
    right  for a question of yours: the right one of the options
    why    {option: a sentence} for the options, said when one is chosen; or one sentence for all
    LookupError for an unknown key, or if `right` or a key of `why` is not among the options.
    """
    from ikteach.course.widget import Question
    from ikteach.names import unknown

    if not question:
        ours = asked(key)
        question, options, right, why = ours.question, ours.choices, ours.right, ours.why
    options = _choices(key, options)
    if not isinstance(why, str | Mapping):
        raise TypeError(
            f"why of {key!r} must be a sentence or {{option: sentence}}, not {shown(why)}"
        )
    reasons = dict.fromkeys(options, why) if isinstance(why, str) else dict(why)
    for name in (right, *reasons):
        if name not in options:
            raise LookupError(unknown(f"option of {key!r}", name, options))

    def judge(answer: Any) -> str:
        if answer not in options:
            return NO_ANSWER
        good = answer == right
        trouble = record.store("quiz", key, again=True, answer=answer, right=good)
        verdict = "✓ Right." if good else "✗ Not so."
        return f"{verdict} {reasons.get(answer, '')} {trouble}".strip()

    return Question(f"quiz {key}", judge, question=question, options=list(options), button="Check")


def written(value: Any) -> str:
    """Write an answer as a person does."""
    if isinstance(value, list):
        return bounded(", then ".join(map(written, value)), 1000)
    return f"{value:.4g}" if isinstance(value, float) else bounded(str(value), 1000)
