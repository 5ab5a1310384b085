"""Checks of the exercises: by property, and always with a sentence.

A chapter's checkers are in `ikteach.course.exercises.chNN`. A checker is a function of the
student's answer that returns when all is right and raises `WrongError` with a sentence when not:

    @exercise("00.double", returns=(), hints=["Which number?", "2x", "`return 2 * x`"])
    def double(answer):
        for x in (0.0, 1.5, -2.0):
            agree(answer(x), 2 * x, f"`{answer.call}` is {{found}}, and it must be {{wanted}}.")

What every answer may do wrong (raise, return None, a NaN or a wrong shape, never end, change what
it was given or what others use) is dealt with here, and every right form that it may have in
`ikteach.course.forms`.
"""

import copy
import dis
import importlib
import linecache
import re
import traceback
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np

from ikteach.course import record
from ikteach.course.deadline import TooLongError, deadline
from ikteach.course.forms import (
    AnswerShape,
    Form,
    NotYetError,
    WrongError,
    in_brief,
    kind,
    listed,
    of_form,
    same,
    type_name,
)
from ikteach.course.kept import Kept, kept
from ikteach.course.notice import LOOK, Mood, box, paragraph
from ikteach.course.untouched import Unpatched, ipython, restoring
from ikteach.files import bounded
from ikteach.markup import Markup
from ikteach.names import unknown

NOT_YET = "Not yet"
SECONDS = 5.0  # what a check may take in all
DRAWING = 20.0  # [s] what a picture may take: matplotlib is loaded for the first one
LONGEST_SENTENCE = 500  # letters of a sentence
OURS = {__file__}  # files whose lines are told to nobody: they only call the answer

Returns = AnswerShape | Form | Callable[..., AnswerShape] | None


@dataclass
class Verdict:
    """The finding of a check, true if passed; perhaps a hint.

    A cell that ends with a verdict shows it. One that only asks whether it is true, as
    `assert check(...)` does, would show nothing: a verdict that is false then says why by itself.
    """

    key: str
    passed: bool
    sentence: str
    hint: str = ""
    picture: Any = field(default=None, repr=False, compare=False)
    told: bool = field(default=False, repr=False, compare=False)

    def __bool__(self) -> bool:
        if not self.passed:
            self.tell()
        return self.passed

    @property
    def mood(self) -> Mood:
        """Choose how to set it; not begun is no failure."""
        return "good" if self.passed else "plain" if self.sentence.startswith(NOT_YET) else "bad"

    def tell(self) -> None:
        """Print it, unless it has been told already."""
        if not self.told:
            self.told = True
            print(self)

    def __str__(self) -> str:
        hint = f"\n  {self.hint}" if self.hint else ""
        return f"{LOOK[self.mood][0]} {self.sentence}{hint}"

    __repr__ = __str__

    def _repr_html_(self) -> str:
        self.told = True
        name, _, words = self.hint.partition(": ")
        hint = Markup("<br><b>{}:</b> {}").format(name, paragraph(words)) if self.hint else ""
        said = box(self.mood, paragraph(self.sentence) + hint)
        drawn = self.picture._repr_html_() if self.picture is not None else ""
        return Markup("{}{}").format(said, drawn)


class Exercise(NamedTuple):
    """One exercise: its checker, and the kind of its answer."""

    key: str
    checker: Callable[[Any], None]
    hints: Sequence[str]
    returns: Returns
    value: bool
    seconds: float
    drawn: Callable[[Any], Any] | None


EXERCISES: dict[str, Exercise] = {}


def exercise(
    key: str,
    *,
    hints: Sequence[str] = (),
    returns: Returns = None,
    value: bool = False,
    seconds: float = SECONDS,
    drawn: Callable[[Any], Any] | None = None,
) -> Callable[[Callable[[Any], None]], Callable[[Any], None]]:
    """Register a checker for the exercise `key`, such as "01.column".

    hints    a question, a formula and a line of code; the next one comes when an answer fails
             that is another than those before
    returns  what the student's function must return: a shape, () for one number; a form of
             `ikteach.course.forms`; a function of the arguments that gives the shape; None leaves
             it to the checker. What has a shape comes to the checker as a finite float array
    value    True: the answer is a value and not a function; `returns` is then about the value
    seconds  what the check may take in all
    drawn    gives a picture of an answer, shown under the verdict, or None
    """

    def register(checker: Callable[[Any], None]) -> Callable[[Any], None]:
        EXERCISES[key] = Exercise(key, checker, hints, returns, value, seconds, drawn)
        return checker

    return register


def expect(holds: Any, sentence: str) -> None:
    """Raise WrongError with the sentence unless `holds`."""
    if not np.all(holds):
        raise WrongError(sentence)


def check(key: str, answer: Any, *, strict: bool = False) -> Verdict:
    """Check whether `answer` solves the exercise `key`, in a sentence.

    The answer is a function or a value. LookupError for an unknown key. The verdict is true only
    if it is solved: `assert check("01.column", column)` is a test, also where there is no page to
    show it. `strict` raises AssertionError with the sentence. Each new wrong answer gets the next
    hint. What was answered is recorded with its source, beside the notebook.
    """
    task = find(key)
    verdict, written = judge(task, answer), kept(answer)
    known = record.entry("verdicts", key)
    verdict.picture = None if verdict.mood == "plain" else _picture(task, answer)
    verdict.hint, seen = _hint(task, verdict, written, known)
    trouble = record.store(
        "verdicts",
        key,
        again=True,
        passed=verdict.passed,
        sentence=verdict.sentence,
        source=written.source,
        sha256=written.sha256,
        seen=seen,
    )
    verdict.sentence = f"{verdict.sentence} {trouble}".strip()
    if strict and not verdict.passed:
        raise AssertionError(str(verdict))
    if ipython() is None:  # no cell shows it
        verdict.tell()
    return verdict


def _hint(
    task: Exercise, verdict: Verdict, written: Kept, known: record.Entry
) -> tuple[str, list[str]]:
    """Choose the hint, and the marks of the answers that were given one."""
    before = known.get("seen")
    seen = [str(one) for one in before] if isinstance(before, list) else []
    if verdict.mood != "bad" or not task.hints:
        return "", [] if verdict.passed else seen
    if written.mark not in seen and len(seen) < len(task.hints):
        seen.append(written.mark)
    level = min(len(seen), len(task.hints))
    return f"Hint {level} of {len(task.hints)}: {task.hints[level - 1]}", seen


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
    passed = False
    try:
        with restoring(), deadline(task.seconds):
            if answer is None or answer is ...:
                raise NotYetError
            task.checker(_value(task, answer) if task.value else _function(task, answer, name))
        passed, sentence = True, f"`{name}` passes every check."
    except NotYetError as error:
        sentence = f"{NOT_YET}: {str(error) or 'write your answer first.'}"
    except WrongError as wrong:
        sentence = str(wrong)
    except TooLongError:
        sentence = f"`{name}` was stopped after {task.seconds:g} seconds: does a loop in it end?"
    except BaseException as error:  # ours, or of an object that the answer gave
        if isinstance(error, KeyboardInterrupt) and not _by_raise(error):
            raise  # the student's own wish
        sentence = f"The check itself failed ({_said(error)}); this is a mistake of the course, "
        sentence += "unless your answer is of an odd kind."
    short = bounded(" ".join(sentence.split()), LONGEST_SENTENCE)
    return Verdict(task.key, passed, short)


def _picture(task: Exercise, answer: Any) -> Any:
    """Draw an answer, if it can be drawn."""
    if task.drawn is None:
        return None
    try:
        with restoring(), deadline(DRAWING):
            return task.drawn(_function(task, answer, "answer"))
    except (Exception, TooLongError):  # the verdict has said what is wrong with it
        return None


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
        self.call = f"{self.name}({', '.join(map(in_brief, arguments))})"
        given = copy.deepcopy(arguments)
        try:
            result = self._run(given)
        except (NotYetError, WrongError):
            raise
        except Exception as error:
            raise WrongError(f"`{self.call}` {_told(error)}") from None
        for i, (before, after) in enumerate(zip(arguments, given, strict=True), start=1):
            if not same(before, after):
                changed = f"`{self.name}` changed its argument {i}: work on a copy of it."
                raise WrongError(changed)
        if result is None:
            raise NotYetError(f"`{self.name}` returned None. Does it end with `return`?")
        if result is ...:
            raise NotYetError(f"`{self.name}` still returns `...`")
        wanted = self._returns
        if callable(wanted):
            wanted = wanted(*arguments)
        return of_form(result, wanted, f"`{self.call}` returned")

    def error(self, *arguments: Any) -> Exception | None:
        """Return the error that the function raises, or None."""
        self.call = f"{self.name}({', '.join(map(in_brief, arguments))})"
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
                return listed(self._function(*given))
        except NotImplementedError:
            raise NotYetError(f"`{self.name}` still says that it is not implemented.") from None
        except (Exception, TooLongError):  # also our own
            raise
        except SystemExit:
            leaves = f"`{self.call}` ended with exit(), which may end the whole notebook"
            raise WrongError(f"{leaves}: use `return`, or `raise` an error.") from None
        except BaseException as error:
            if isinstance(error, KeyboardInterrupt) and not _by_raise(error):
                raise  # the student's own wish
            raise WrongError(f"`{self.call}` {_told(error)}") from None


def _function(task: Exercise, answer: Any, name: str) -> Answer:
    if not callable(answer):
        hint = f"check({task.key!r}, {name})"
        raise WrongError(f"The check needs the function itself, `{hint}`, not {kind(answer)}.")
    return Answer(answer, name, task.returns)


def _value(task: Exercise, answer: Any) -> Any:
    if callable(answer):
        raise WrongError("The check needs a value, not a function: call it first.")
    wanted = None if callable(task.returns) else task.returns
    return of_form(answer, wanted, "Your answer is")


def _said(error: BaseException) -> str:
    """Say what was raised and its first line, bounded."""
    try:
        text = str(error).strip()
    except Exception:
        text = ""
    return f"{type_name(error)}: {bounded((text or 'without a word').splitlines()[0], 200)}"


def _told(error: BaseException) -> str:
    """Say what was raised, and in which line of the student's."""
    every = traceback.extract_tb(error.__traceback__)
    frames = [frame for frame in every if frame.filename not in OURS]
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
