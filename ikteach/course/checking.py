"""Checks of the exercises: by property, and always with a sentence.

A chapter's checkers are in `ikteach.course.exercises.chNN`. A checker is a function of the
student's answer that returns when all is right and raises `WrongError` with a sentence when not:

    @exercise("00.double", returns=(), hints=["Multiply by two."])
    def double(answer):
        for x in (0.0, 1.5, -2.0):
            expect(answer(x) == 2 * x, f"`{answer.call}` must be twice its argument.")

What every answer may do wrong (raise, return None, a NaN or a wrong shape, never end, change what
it was given or what others use) is dealt with here, for all of them.
"""

import copy
import dis
import importlib
import linecache
import re
import traceback
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from ikteach.course import record
from ikteach.course.deadline import TooLongError, deadline
from ikteach.course.notice import LOOK, Mood, box, paragraph
from ikteach.course.untouched import Unpatched, restoring
from ikteach.files import bounded
from ikteach.markup import Markup
from ikteach.names import unknown

NOT_YET = "Not yet"
SECONDS = 5.0  # what a check may take in all
LONGEST_SENTENCE = 500  # letters of a sentence

AnswerShape = tuple[int, ...]
Returns = AnswerShape | type | Callable[..., AnswerShape] | None


class WrongError(Exception):
    """A wrong answer; the message says how, in one sentence."""


class NotYetError(Exception):
    """No answer yet; the message may say more."""


@dataclass(frozen=True)
class Verdict:
    """The finding of a check, true if passed; perhaps a hint."""

    key: str
    passed: bool
    sentence: str
    hint: str = ""

    def __bool__(self) -> bool:
        return self.passed

    @property
    def mood(self) -> Mood:
        """Choose how to set it; not begun is no failure."""
        return "good" if self.passed else "plain" if self.sentence.startswith(NOT_YET) else "bad"

    def __str__(self) -> str:
        hint = f"\n  Hint: {self.hint}" if self.hint else ""
        return f"{LOOK[self.mood][0]} {self.sentence}{hint}"

    __repr__ = __str__

    def _repr_html_(self) -> str:
        hint = Markup("<br><b>Hint:</b> {}").format(paragraph(self.hint)) if self.hint else ""
        return box(self.mood, paragraph(self.sentence) + hint)


class Exercise(NamedTuple):
    """One exercise: its checker, and the kind of its answer."""

    key: str
    checker: Callable[[Any], None]
    hints: Sequence[str]
    returns: Returns
    value: bool
    seconds: float


EXERCISES: dict[str, Exercise] = {}
_failures: Counter[str] = Counter()  # in a row, per exercise


def exercise(
    key: str,
    *,
    hints: Sequence[str] = (),
    returns: Returns = None,
    value: bool = False,
    seconds: float = SECONDS,
) -> Callable[[Callable[[Any], None]], Callable[[Any], None]]:
    """Register a checker for the exercise `key`, such as "01.column".

    hints    given one after the other, one a failure
    returns  what the student's function must return: a shape, () for one number; a type; a
             function of the arguments that gives the shape; None leaves it to the checker. What
             has a shape comes to the checker as a finite float array
    value    True: the answer is a value and not a function; `returns` is then about the value
    seconds  what the check may take in all
    """

    def register(checker: Callable[[Any], None]) -> Callable[[Any], None]:
        EXERCISES[key] = Exercise(key, checker, hints, returns, value, seconds)
        return checker

    return register


def expect(holds: Any, sentence: str) -> None:
    """Raise WrongError with the sentence unless `holds`."""
    if not np.all(holds):
        raise WrongError(sentence)


def check(key: str, answer: Any, *, strict: bool = False) -> Verdict:
    """Check whether `answer` solves the exercise `key`, in a sentence.

    The answer is a function or a value. Each failure in a row gives the next hint. LookupError for
    an unknown key. The verdict is true only if it is solved; `strict` raises AssertionError with
    the sentence if not, for graders that go by what a cell raises.
    """
    verdict = judge(find(key), answer)
    if verdict.mood == "bad":
        hints = EXERCISES[key].hints
        hint = hints[min(_failures[key], len(hints) - 1)] if hints else ""
        _failures[key] += 1
        verdict = Verdict(key, False, verdict.sentence, hint)
    elif verdict.passed:
        _failures.pop(key, None)
    fields = {"passed": verdict.passed, "sentence": verdict.sentence}
    trouble = record.store("verdicts", key, again=True, **fields)
    verdict = Verdict(key, verdict.passed, f"{verdict.sentence} {trouble}".strip(), verdict.hint)
    if strict and not verdict:
        raise AssertionError(str(verdict))
    return verdict


def find(key: str) -> Exercise:
    """Return the exercise of that key, or raise LookupError."""
    module = f"ikteach.course.exercises.ch{str(key).partition('.')[0]}"
    try:
        importlib.import_module(module)
    except ModuleNotFoundError as error:
        if error.name != module:
            raise
    if key not in EXERCISES:
        raise LookupError(unknown("exercise", key, EXERCISES))
    return EXERCISES[key]


def judge(task: Exercise, answer: Any) -> Verdict:
    """Judge an answer, without hints and without recording it."""
    name = _name(answer, task.key.partition(".")[2])

    def verdict(passed: bool, sentence: str) -> Verdict:
        return Verdict(task.key, passed, bounded(" ".join(sentence.split()), LONGEST_SENTENCE))

    try:
        with restoring(), deadline(task.seconds):
            if answer is None or answer is ...:
                raise NotYetError
            task.checker(_value(task, answer) if task.value else _function(task, answer, name))
    except NotYetError as error:
        return verdict(False, f"{NOT_YET}: {str(error) or 'write your answer first.'}")
    except WrongError as wrong:
        return verdict(False, str(wrong))
    except TooLongError:
        stopped = f"`{name}` was stopped after {task.seconds:g} seconds: does a loop in it end?"
        return verdict(False, stopped)
    except Exception as error:  # ours, and not the student's: they are not to be left without word
        broken = f"The check itself failed ({_said(error)}); this is a mistake of the course, "
        return verdict(False, broken + "unless your answer is of an odd kind.")
    return verdict(True, f"`{name}` passes every check.")


def _name(answer: Any, other: str) -> str:
    """Find what a function calls itself, if that is a name."""
    try:
        name = answer.__name__
    except Exception:
        return other
    proper = isinstance(name, str) and re.fullmatch(r"\w{1,60}", name)
    return str(name) if proper else other


class Answer:
    """A student's function as a checker sees it.

    It returns a value of the form it must have, or raises WrongError.

    call   the last call, as text for sentences
    """

    def __init__(self, function: Callable[..., Any], name: str, returns: Returns) -> None:
        self._function, self.name, self._returns = function, name, returns
        self.call = f"{name}()"

    def __call__(self, *arguments: Any) -> Any:
        """Answer these arguments, which stay as they are."""
        self.call = f"{self.name}({', '.join(map(_brief, arguments))})"
        given = copy.deepcopy(arguments)
        try:
            result = self._run(given)
        except (NotYetError, WrongError):
            raise
        except Exception as error:
            raise WrongError(f"`{self.call}` {_told(error)}") from None
        for i, (before, after) in enumerate(zip(arguments, given, strict=True), start=1):
            if not _same(before, after):
                changed = f"`{self.name}` changed its argument {i}: work on a copy of it."
                raise WrongError(changed)
        if result is None:
            raise NotYetError(f"`{self.name}` returned None. Does it end with `return`?")
        if result is ...:
            raise NotYetError(f"`{self.name}` still returns `...`")
        wanted = self._returns
        if not (wanted is None or isinstance(wanted, tuple | type)):
            wanted = wanted(*arguments)
        return of_form(result, wanted, f"`{self.call}` returned")

    def error(self, *arguments: Any) -> Exception | None:
        """Return the error that the function raises, or None."""
        self.call = f"{self.name}({', '.join(map(_brief, arguments))})"
        try:
            result = self._run(copy.deepcopy(arguments))
        except (NotYetError, WrongError):
            raise
        except Exception as error:
            return error
        if result is ...:
            raise NotYetError(f"`{self.name}` still returns `...`")
        return None

    def _run(self, given: Sequence[Any]) -> Any:
        """Call the function; raise of its exceptions errors and ours."""
        try:
            with Unpatched():
                return self._function(*given)
        except NotImplementedError:
            raise NotYetError(f"`{self.name}` still says that it is not implemented.") from None
        except (Exception, TooLongError):
            raise
        except SystemExit:
            raise WrongError(f"`{self.name}` ended with exit(); use return.") from None
        except BaseException as error:
            if isinstance(error, KeyboardInterrupt) and not _by_raise(error):
                raise  # the student's own wish
            raise WrongError(f"`{self.call}` {_told(error)}") from None


def _same(before: Any, after: Any) -> bool:
    """Whether an argument is as it was; of arrays and lists of numbers this can be told."""
    if isinstance(before, np.ndarray | list):
        try:
            return np.array_equal(np.asarray(before), np.asarray(after), equal_nan=True)
        except Exception:  # it is no longer made of numbers
            return False
    return True


def _function(task: Exercise, answer: Any, name: str) -> Answer:
    if not callable(answer):
        hint = f"check({task.key!r}, {name})"
        raise WrongError(f"The check needs the function itself, `{hint}`, not {_kind(answer)}.")
    return Answer(answer, name, task.returns)


def _value(task: Exercise, answer: Any) -> Any:
    if callable(answer):
        raise WrongError("The check needs a value, not a function: call it first.")
    return of_form(answer, task.returns, "Your answer is")


def of_form(result: Any, wanted: Any, said: str) -> Any:
    """Give `result` back if it is of the wanted form.

    As a finite array where that is a shape; WrongError if it is not. `said` begins the sentence:
    "`f(x)` returned".
    """
    if wanted is None:
        return result
    if isinstance(wanted, type):
        kinds = {bool: (bool, np.bool_), str: (str,), int: (int, np.integer)}
        if not isinstance(result, kinds.get(wanted, (wanted,))):
            raise WrongError(f"{said} {_kind(result)}, where {_a(wanted.__name__)} is wanted.")
        return result
    form = f"an array of shape {wanted}" if wanted else "one number"
    try:
        array = np.asarray(None if isinstance(result, str) else result)  # a text may be long
        if array.dtype.kind not in "biuf":  # text, complex numbers, objects
            raise TypeError
    except Exception:  # whatever an object of the student's raises when it is to be an array
        raise WrongError(f"{said} {_kind(result)}, where {form} is wanted.") from None
    if array.shape != wanted:
        shape = f"an array of shape {array.shape}" if array.shape else "one number"
        raise WrongError(f"{said} {shape}, where {form} is wanted.")
    array = array.astype(float)
    if np.isnan(array).any():
        raise WrongError(f"{said} NaN, which is no number: what was divided by zero?")
    if np.isinf(array).any():
        raise WrongError(f"{said} an infinite number: what was divided by zero?")
    return array


def _brief(value: Any) -> str:
    """Tell a value in few words, for a sentence."""
    if isinstance(value, np.ndarray) and value.size > 4:
        return f"array {value.shape}"
    if isinstance(value, np.ndarray | float):
        return np.array2string(np.asarray(value), precision=3, separator=", ", threshold=6)
    text = repr(value)
    return text if len(text) <= 40 else _kind(value)


def _kind(value: Any) -> str:
    return _a(_type(value))


def _type(value: Any) -> str:
    """Name its type, the true one, whatever its class says."""
    return bounded(type.__dict__["__name__"].__get__(type(value)) or "nameless type", 60)


def _a(name: str) -> str:
    return f"{'an' if name[0] in 'aeiouAEIOU' else 'a'} {name}"


def _said(error: BaseException) -> str:
    """Say what was raised and its first line, bounded."""
    try:
        text = str(error).strip()
    except Exception:
        text = ""
    return f"{_type(error)}: {bounded((text or 'without a word').splitlines()[0], 200)}"


def _told(error: BaseException) -> str:
    """Say what was raised, and in which line of the student's."""
    every = traceback.extract_tb(error.__traceback__)
    frames = [frame for frame in every if frame.filename != __file__]  # but our own calls
    theirs = [frame for frame in frames if frame.filename == frames[0].filename]
    line = linecache.getline(theirs[-1].filename, theirs[-1].lineno or 0).strip() if theirs else ""
    end = f", in the line `{bounded(line, 120)}`" if line else ""
    return f"raised {_said(error).rstrip('.')}{end}."


def _by_raise(error: BaseException) -> bool:
    """Whether a `raise` has raised it, and not a signal."""
    trace = error.__traceback__
    while trace is not None and trace.tb_next is not None:
        trace = trace.tb_next
    if trace is None:
        return True
    return trace.tb_frame.f_code.co_code[trace.tb_lasti] == dis.opmap["RAISE_VARARGS"]
