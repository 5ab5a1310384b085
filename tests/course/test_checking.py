"""The machinery of the checks: whatever an answer does, a sentence comes of it."""

import contextlib
import hashlib
import importlib
import itertools
import json
import linecache
import os
import re
import signal
import subprocess
import sys
import threading
import time
from decimal import Decimal
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from ikteach import solvers
from ikteach.course import check, checking
from ikteach.course.checking import EXERCISES, Answer, exercise, expect, find, judge
from ikteach.course.deadline import TooLongError, Tracer, deadline
from ikteach.course.forms import (
    NAME,
    NAMES,
    TRUTH,
    WrongError,
    agree,
    numbers_apart,
    of_form,
    parts,
)
from ikteach.course.kept import kept


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(checking, "EXERCISES", EXERCISES)
    return tmp_path


@pytest.fixture(scope="module", autouse=True)
def registered() -> Any:
    """Exercises of a chapter that is none."""

    @exercise("xx.double", returns=(2,), hints=["first", "second", "third"], seconds=0.3)
    def double(answer: Answer) -> None:
        for x in (np.array([0.0, 1.0]), np.array([-2.0, 3.5])):
            expect(np.allclose(answer(x), 2 * x), f"`{answer.call}` must be twice its argument.")

    @exercise("xx.same", returns=lambda x: x.shape)
    def same(answer: Answer) -> None:
        expect(answer(np.zeros((2, 3))) == 0, "It must be zero.")

    @exercise("xx.even", returns=TRUTH)
    def even(answer: Answer) -> None:
        expect(answer(2) and not answer(3), "2 is even and 3 is not.")

    @exercise("xx.refuse")
    def refuse(answer: Answer) -> None:
        expect(isinstance(answer.error(0), ValueError), "Zero must be refused by ValueError.")

    @exercise("xx.number", returns=(), value=True)
    def number(value: Any) -> None:
        expect(value == 7, "It is another number.")

    @exercise("xx.broken")
    def broken(answer: Answer) -> None:
        raise KeyError("ours")

    yield
    for key in [key for key in EXERCISES if key.startswith("xx")]:
        del EXERCISES[key]


def said(key: str, answer: Any) -> str:
    verdict = check(key, answer)
    assert not verdict.passed
    assert "\n" not in verdict.sentence
    assert "Traceback" not in str(verdict)
    return verdict.sentence


def test_right_answers_pass() -> None:
    assert check("xx.double", lambda x: 2 * x).passed
    assert check("xx.double", lambda x: [2 * one for one in x]).passed
    assert check("xx.same", np.zeros_like).passed
    assert check("xx.even", lambda x: np.bool_(x % 2 == 0)).passed
    assert check("xx.number", np.float64(7)).passed
    verdict = check("xx.number", 7)
    assert str(verdict) == "✓ `number` passes every check."
    assert "✓" in verdict._repr_html_()
    assert "<code>number</code>" in verdict._repr_html_()


def stub(x: Any) -> Any: ...


def unwritten(x: Any) -> Any:
    raise NotImplementedError


@pytest.mark.parametrize("answer", [stub, unwritten, lambda x: ..., None, ...])
def test_a_stub_is_not_yet_an_answer(answer: Any) -> None:
    for _ in range(3):
        verdict = check("xx.double", answer)
        assert not verdict.passed
        assert verdict.sentence.startswith("Not yet: ")
        assert verdict.sentence.endswith((".", "?", "`"))
        assert str(verdict).startswith("→")
        assert verdict.hint == ""


def wild(x: Any) -> Any:
    number = {}["nothing"]
    return number


def changes(x: Any) -> Any:
    x *= 2
    return x


def recursive(x: Any) -> Any:
    return recursive(x)


def leaves(x: Any) -> Any:
    sys.exit(3)


@pytest.mark.parametrize(
    ("answer", "words"),
    [
        (lambda x: x, "`double([0., 1.])` must be twice its argument."),
        (lambda x: x[:1], "array of shape (1,), where an array of shape (2,) is wanted"),
        (lambda x: 3, "returned one number, where an array of shape (2,)"),
        (lambda x: x * np.nan, "NaN"),
        (lambda x: 1 / np.zeros(2), "infinite"),
        (lambda x: "2, 4", "returned a str, where"),
        (lambda x: {1: 2}, "returned a dict, where"),
        (lambda x: [[1], [2, 3]], "returned a list, where"),
        (lambda x: x * 1j, "returned a"),
        (lambda x, y: x, "raised TypeError"),
        (wild, "raised KeyError: 'nothing', in the line `number = {}[\"nothing\"]`."),
        (changes, "changed its argument 1"),
        (recursive, "RecursionError"),
        (leaves, "exit()"),
        (7, "needs the function itself, `check('xx.double', double)`, not an int"),
    ],
)
def test_wrong_answers_have_their_sentence(answer: Any, words: str) -> None:
    assert words in said("xx.double", answer)


def test_other_kinds_of_answer() -> None:
    assert "returned 3, where True or False is wanted" in said("xx.even", lambda x: 3)
    assert "2 is even" in said("xx.even", lambda x: True)
    assert "must be refused" in said("xx.refuse", lambda x: x)
    assert check("xx.refuse", lambda x: int("no")).passed
    assert said("xx.refuse", unwritten).startswith("Not yet")
    assert "another number" in said("xx.number", 8)
    assert "Your answer is NaN" in said("xx.number", float("nan"))
    assert "not a function" in said("xx.number", lambda: 7)
    assert "The check itself failed (KeyError: 'ours')" in said("xx.broken", lambda: 7)
    with pytest.raises(LookupError, match=r"no exercise 'xx.doubel'; did you mean 'xx.double'"):
        check("xx.doubel", stub)


def cell(source: str) -> Any:
    """The function `f` of a cell, with its lines where `inspect` looks for them."""
    name = f"<cell {len(linecache.cache)}>"
    linecache.cache[name] = (len(source), None, source.splitlines(True), name)
    names: dict[str, Any] = {"__name__": "__main__", "np": np}
    exec(compile(source, name, "exec"), names)
    return names["f"]


def test_the_next_hint_comes_with_another_answer() -> None:
    one = "def f(x):\n    return x"
    same = [
        one,
        "def f(x):\n    # as before\n    return  (x)\n",
        'def f(x):\n    """So."""\n    return x',
    ]
    hints = [check("xx.double", cell(source)).hint for source in same]
    assert hints == ["Hint 1 of 3: first"] * 3
    others = [f"def f(x):\n    return x + {n}" for n in (1, 1, 2, 3)]
    hints = [check("xx.double", cell(source)).hint[:6] for source in others]
    assert hints == ["Hint 2", "Hint 2", "Hint 3", "Hint 3"]
    assert check("xx.double", cell(one)).hint == "Hint 3 of 3: third"
    assert "\n  Hint 3 of 3: third" in str(check("xx.double", cell(one)))
    assert "<b>Hint 3 of 3:</b> third" in check("xx.double", cell(one))._repr_html_()
    assert check("xx.double", stub).hint == ""  # not begun is no failure
    assert check("xx.double", lambda x: 2 * x).hint == ""
    assert check("xx.double", cell(one)).hint == "Hint 1 of 3: first"  # begins again


def test_hints_need_no_memory_of_this_session(folder: Path) -> None:
    """A kernel that starts again goes on from the file."""
    code = "from ikteach.course import check; check('04.projector', {})"
    said = []
    for n in (1, 1, 2):
        done = [sys.executable, "-c", code.format(n)]
        said.append(subprocess.run(done, capture_output=True, text=True, check=True).stdout)
    assert [text.partition("Hint ")[2][:1] for text in said] == ["1", "1", "2"]


# ---- what is kept of an answer


def test_the_source_is_kept_and_answers_alike(folder: Path) -> None:
    source = "K = 2\nA = np.eye(2)\ndef twice(x):\n    return K * A @ x\n"
    source += "def f(x):\n    return twice(x)\n"
    assert check("xx.double", cell(source))
    entry = json.loads((folder / "predictions.json").read_text())["verdicts"]["xx.double"]
    names: dict[str, Any] = {}
    exec(entry["source"], names)  # as a grader would, in a process of its own
    assert judge(find("xx.double"), names["answer"]).passed
    assert entry["sha256"] == hashlib.sha256(entry["source"].encode()).hexdigest()


@pytest.mark.parametrize(
    "source",
    [
        "f = lambda x: 2 * x",
        "g = (lambda x: x, lambda x: 2 * x)\nf = g[1]",
        "def make(k):\n    def inner(x):\n        return k * x\n    return inner\nf = make(2)",
        "def double(x, k=2):\n    return k * x\nf = double",
        "times = {'k': [2.0, (1, None)]}\ndef f(x):\n    return times['k'][0] * x",
        "from numpy import multiply\ndef f(x):\n    return multiply(x, 2)",
        "def f(x):\n    return x + x if len(x) else f(x)",
    ],
)
def test_a_kept_source_stands_alone(source: str) -> None:
    names: dict[str, Any] = {}
    exec(kept(cell(source)).source, names)
    np.testing.assert_array_equal(names["answer"](np.array([1.0, 2.5])), [2, 5])


@pytest.mark.parametrize(
    "value", [3, 2.5, float("inf"), "sdls", {"foot.l": "sdls"}, [1, (2, None)]]
)
def test_a_value_is_kept(value: Any) -> None:
    names: dict[str, Any] = {}
    exec(kept(value).source, names)
    assert names["answer"] == value


def test_what_cannot_be_kept_is_told_apart_all_the_same(folder: Path) -> None:
    long = cell("def f(x):\n" + "    x = x + 1\n" * 5000 + "    return x")
    for odd in (long, NoArray(), Odd(3), int, np.zeros(10**6), type("C", (), {})()):
        assert len(kept(odd).source) < 100
        assert kept(odd).mark
    assert not check("xx.double", long)
    assert (folder / "predictions.json").stat().st_size < 5000


def test_to_keep_or_to_read_runs_nothing(folder: Path) -> None:
    ran: list[int] = []
    source = "def f(x, y=[]):\n    ran.append(1)\n    return 2 * x\n"
    function = cell(source)
    function.__globals__["ran"] = ran
    assert "ran.append" in kept(function).source
    hostile = {"verdicts": {"xx.double": {"source": "raise SystemExit", "seen": "x", "tries": 1}}}
    (folder / "predictions.json").write_text(json.dumps(hostile))
    assert check("xx.double", lambda x: 2 * x)
    assert ran == []


# ---- the one door of answers


ONE = [
    7,
    7.0,
    np.float32(7),
    np.int8(7),
    [7],
    (7,),
    np.array([[7]]),
    Fraction(7),
    Decimal(7),
    pd.Series([7]),
    (x for x in [7]),
    7 + 0j,
    np.array(7),
    range(7, 8),
]


@pytest.mark.parametrize("value", ONE, ids=lambda value: type(value).__name__)
def test_one_number_in_any_form(value: Any) -> None:
    found = of_form(value, (), "It is")
    assert (found.shape, float(found)) == ((), 7.0)


TWO = [
    [1, 2],
    (1.0, 2),
    np.array([1, 2], np.float32),
    np.array([[1], [2]]),
    np.array([[1, 2]]),
    pd.Series([1, 2]),
    pd.Index([1, 2]),
    iter([1, 2]),
    map(float, "12"),
    range(1, 3),
    [np.array([1.0]), 2],
    [Fraction(1), Decimal(2)],
    np.array([1, 2], object),
    np.ma.array([1, 2]),
]


@pytest.mark.parametrize("value", TWO, ids=lambda value: type(value).__name__)
def test_two_numbers_in_any_form(value: Any) -> None:
    found = of_form(value, (2,), "It is")
    assert found.tolist() == [1, 2]
    assert found.dtype == float


@pytest.mark.parametrize(
    ("value", "words"),
    [
        ([1, 2, 3], "an array of shape (3,), where an array of shape (2,)"),
        ("12", "a str"),
        ({1: 2, 2: 3}, "a dict"),
        ({1, 2}, "a set"),
        (["1", "2"], "a list"),
        ([1j, 2], "a list"),
        ([None, 1], "a list"),
        (itertools.count(), "has no end"),
        (b"12", "a bytes"),
    ],
    ids=lambda value: type(value).__name__,
)
def test_what_is_no_two_numbers(value: Any, words: str) -> None:
    with pytest.raises(WrongError, match=re.escape(words)):
        of_form(value, (2,), "It is")


def test_truths_names_and_parts() -> None:
    for value in (True, np.bool_(True), 1, 1.0, np.array([True]), np.array(1), pd.Series([True])):
        assert of_form(value, TRUTH, "It is") is True
    for value in (2, "yes", None, [True, False], 0.5, object()):
        with pytest.raises(WrongError, match="where True or False is wanted"):
            of_form(value, TRUTH, "It is")
    for value in ("dls", np.str_("dls"), " dls ", solvers.dls, np.array(["dls"])):
        assert of_form(value, NAME, "It is") == "dls"
    both = [
        ["dls", "sdls"],
        ("dls", "sdls"),
        pd.Index(["dls", "sdls"]),
        np.array(["dls", "sdls"]),
        (solvers.dls, solvers.sdls),
        iter(["dls", "sdls"]),
        {"dls": 1, "sdls": 2}.keys(),
        pd.Categorical(["dls", "sdls"]),
    ]
    for names in both:
        assert of_form(names, NAMES, "It is") == ["dls", "sdls"]
    for odd in ("dls", {"dls": 1}, 3, [3], pd.Series([0.1, 0.2]), pd.DataFrame({"dls": [1]})):
        with pytest.raises(WrongError, match="where a list of names is wanted"):
            of_form(odd, NAMES, "It is")
    pair = parts("a log", "a winner")
    for two in ([1, 2], (1, 2), iter([1, 2])):
        assert of_form(two, pair, "It is") == [1, 2]
    with pytest.raises(WrongError, match=r"a log and a winner \(in one list or tuple\) is wanted"):
        of_form((1, 2, 3), pair, "It is")


@pytest.mark.parametrize(
    ("a", "b"),
    [(1.0, 1.0001), (1e-9, 2e-9), (0.123456789, 0.123456788), (3.0, -3.0), (1e9, 1e9 + 1)],
)
def test_numbers_that_differ_differ_as_printed(a: float, b: float) -> None:
    one, other = numbers_apart(a, b)
    assert one != other
    assert len(set(numbers_apart([0.0, a], [0.0, b]))) == 2
    with pytest.raises(WrongError, match=f"^{re.escape(one)} not {re.escape(other)}$"):
        agree(a, b, "{found} not {wanted}", near=1e-12)
    agree(a, a, "")


# ---- where there is no page


def test_a_script_is_told_in_plain_words(folder: Path) -> None:
    code = (
        "from ikteach.course import check\nimport numpy as np\n"
        "check('01.column', lambda v, p, s: np.cross(s - p, v))\n"
        "assert check('01.column', lambda v, p, s: np.cross(v, s - p))\n"
        "assert check('01.column', lambda v, p, s: np.cross(v, s)), 'told'\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.stdout.count("✗ ") == 2
    assert done.stdout.count("✓ `column` passes every check.") == 1
    assert "Hint 1 of 3: " in done.stdout
    assert "AssertionError: told" in done.stderr


def test_an_assertion_in_a_cell_says_why(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(checking, "ipython", object)
    verdict = check("xx.double", lambda x: x)
    assert capsys.readouterr().out == ""  # the cell shows it
    with pytest.raises(AssertionError):
        assert verdict
    assert "must be twice its argument" in capsys.readouterr().out
    assert not verdict
    assert capsys.readouterr().out == ""  # once is enough
    assert check("xx.double", lambda x: 2 * x)
    assert capsys.readouterr().out == ""


CELLS = """
from IPython.core.interactiveshell import InteractiveShell
shell = InteractiveShell.instance()
for cell in [
    "from ikteach.course import check; import numpy as np",
    "def column(v, p, s):\\n    exit()\\nverdict = check('01.column', column)",
    "assert verdict",
    "assert check('01.column', lambda v, p, s: np.cross(v, s - p))",
    "check('01.column', lambda v, p, s: np.cross(v, s - p))",
    "print('alive')",
]:
    shell.run_cell(cell)
assert "ask_exit" not in vars(shell)
"""


def test_in_the_cells_of_a_grader(folder: Path) -> None:
    """As nbgrader and Otter run them: an assertion is a test, and exit() ends nothing."""
    done = subprocess.run([sys.executable, "-c", CELLS], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert "ended with exit()" in done.stdout
    assert "AssertionError" in done.stdout
    assert done.stdout.count("✓ `column` passes every check.") == 1  # the cell that ends with it
    assert done.stdout.rstrip().endswith("alive")


def test_where_nothing_can_be_written_a_check_is_a_test_all_the_same(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def denied(*_: Any, **__: Any) -> None:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(os, "open", denied)
    assert check("xx.double", lambda x: 2 * x)
    assert not check("xx.double", lambda x: x)


def test_verdicts_are_recorded(folder: Path) -> None:
    check("xx.double", lambda x: x)
    check("xx.double", lambda x: 2 * x)
    entry = json.loads((folder / "predictions.json").read_text())["verdicts"]["xx.double"]
    assert (entry["passed"], entry["tries"]) == (True, 2)


def test_arguments_come_to_no_harm() -> None:
    seen = np.array([1.0, 2.0])
    with pytest.raises(WrongError, match="changed its argument 1"):
        Answer(changes, "changes", (2,))(seen)
    assert (seen == [1, 2]).all()


# ---- what never ends


def endless(x: Any) -> Any:
    while True:
        pass


def stubborn(x: Any) -> Any:
    while True:
        with contextlib.suppress(Exception):
            x = x + 1


def sleeper(x: Any) -> Any:
    time.sleep(60)


def swallower(x: Any) -> Any:
    for _ in range(20):
        try:
            while True:
                pass
        except:  # noqa: E722
            pass


@pytest.mark.parametrize("answer", [endless, stubborn, sleeper])
def test_what_never_ends_is_stopped(answer: Any) -> None:
    began = time.monotonic()
    assert "was stopped after 0.3 seconds" in said("xx.double", answer)
    assert time.monotonic() - began < 10
    time.sleep(0.25)  # no alarm comes after


def test_a_bare_except_does_not_keep_it_running() -> None:
    began = time.monotonic()
    assert not check("xx.double", swallower).passed
    assert time.monotonic() - began < 20


@pytest.mark.parametrize("answer", [endless, stubborn])
def test_it_is_stopped_in_a_thread_too(answer: Any) -> None:
    verdicts: list[Any] = []
    worker = threading.Thread(target=lambda: verdicts.append(check("xx.double", answer)))
    worker.start()
    worker.join(20)
    assert not worker.is_alive()
    assert "was stopped after 0.3 seconds" in verdicts[0].sentence


def test_a_tracer_leaves_what_was_traced_before() -> None:
    before = sys.gettrace()
    with pytest.raises(TooLongError), Tracer(0.05):
        endless(0)
    assert sys.gettrace() is before
    with Tracer(60):
        assert sum(range(10)) == 45


def test_a_deadline_that_is_met_leaves_nothing_behind() -> None:
    import signal

    before = signal.getsignal(signal.SIGALRM)
    with deadline(0.05):
        pass
    time.sleep(0.15)
    assert signal.getsignal(signal.SIGALRM) is before
    assert signal.getitimer(signal.ITIMER_REAL) == (0, 0)


def test_the_course_is_imported_without_screens() -> None:
    heavy = ["ipywidgets", "anywidget", "pandas", "matplotlib"]
    code = f"import sys, ikteach.course as c; print([m for m in {heavy} if m in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


# ---- a verdict counts only if it passed


def test_a_verdict_is_true_only_if_passed() -> None:
    assert check("xx.double", lambda x: 2 * x)
    for wrong in (lambda x: x, stub, None, endless):
        assert not check("xx.double", wrong)
    assert check("xx.double", lambda x: 2 * x, strict=True).passed
    with pytest.raises(AssertionError, match="must be twice its argument") as raised:
        check("xx.double", lambda x: x, strict=True)
    assert "Hint 1 of 3: first" in str(raised.value)
    with pytest.raises(AssertionError, match="Not yet"):
        check("xx.double", stub, strict=True)


def test_a_strict_check_is_recorded_too(folder: Path) -> None:
    with pytest.raises(AssertionError):
        check("xx.double", lambda x: x, strict=True)
    entry = json.loads((folder / "predictions.json").read_text())["verdicts"]["xx.double"]
    assert (entry["passed"], entry["tries"]) == (False, 1)


# ---- odd answers, odd results, odd errors


class Odd:
    """A callable of many oddities."""

    def __init__(self, name: Any, gives: Any = 1) -> None:
        self.name, self.gives = name, gives

    @property
    def __name__(self) -> Any:
        if isinstance(self.name, Exception):
            raise self.name
        return self.name

    def __call__(self, *_: Any) -> Any:
        return self.gives


class Silent(Exception):
    def __str__(self) -> str:
        raise RuntimeError


class Base(BaseException):
    pass


class NoArray:
    def __array__(self, *_: Any, **__: Any) -> Any:
        raise KeyError("no")

    def __repr__(self) -> str:
        raise RuntimeError


class Meta(type):
    @property
    def __name__(cls) -> Any:  # type: ignore[override]
        return 5


@pytest.mark.parametrize("name", [5, None, "", "two words", "x" * 10**6, "\ud800", "a\nb", b"x",
                                  RuntimeError("no")])  # fmt: skip
def test_whatever_an_answer_calls_itself(name: Any) -> None:
    assert said("xx.double", Odd(name)).startswith("`double([0., 1.])` returned")


def raising(error: BaseException) -> Any:
    def raises(x: Any) -> Any:
        raise error

    return raises


@pytest.mark.parametrize(
    ("error", "words"),
    [
        (ValueError("x" * 10**7), "raised ValueError: xxx"),
        (ValueError("two\nlines"), "raised ValueError: two, in the line"),
        (ValueError("\ud800"), "raised ValueError: ?"),
        (ValueError(), "raised ValueError: without a word"),
        (Silent(), "raised Silent: without a word"),
        (MemoryError(), "raised MemoryError"),
        (RecursionError("deep"), "raised RecursionError: deep"),
        (KeyboardInterrupt(), "raised KeyboardInterrupt"),
        (GeneratorExit(), "raised GeneratorExit"),
        (StopIteration(3), "raised StopIteration: 3"),
        (Base("own"), "raised Base: own"),
        (ExceptionGroup("both", [ValueError("a")]), "raised ExceptionGroup: both"),
        (SystemExit(3), "exit()"),
        (type("", (Exception,), {})("x"), "raised nameless type: x"),
    ],
    ids=lambda value: type(value).__name__ if isinstance(value, BaseException) else "",
)
def test_whatever_is_raised_is_one_short_sentence(
    folder: Path, error: BaseException, words: str
) -> None:
    sentence = said("xx.double", raising(error))
    assert words in sentence
    assert len(sentence) <= checking.LONGEST_SENTENCE
    if not isinstance(error, Exception):  # nor is one taken for an error that was asked for
        assert words in said("xx.refuse", raising(error))
    assert (folder / "predictions.json").stat().st_size < 5000


def test_an_interrupt_by_the_student_goes_through() -> None:
    import _thread

    def interrupted(x: Any) -> Any:
        _thread.interrupt_main()
        for _ in range(10**6):
            pass
        return 2 * x

    before = signal.signal(signal.SIGINT, signal.default_int_handler)  # whoever started the tests
    try:
        with pytest.raises(KeyboardInterrupt):
            check("xx.double", interrupted)
    finally:
        signal.signal(signal.SIGINT, before)


@pytest.mark.parametrize(
    ("result", "words"),
    [
        (NoArray(), "returned a NoArray, where an array of shape (2,) is wanted"),
        (Meta("Strange", (), {})(), "returned a Strange, where"),
        (type("", (), {})(), "returned a nameless type, where"),
        (np.broadcast_to(0.0, (10**6, 10**6)), "an array of shape (1000000, 1000000)"),
        ("x" * 10**7, "returned a str"),
        (Odd(3), "returned an Odd"),
        ((x for x in ()), "returned an array of shape (0,)"),
    ],
    ids=["no-array", "meta", "nameless", "giant", "long", "callable", "generator"],
)  # fmt: skip
def test_whatever_is_returned(result: Any, words: str) -> None:
    assert words in said("xx.double", lambda x: result)
    assert "check itself failed" not in said("xx.number", result)


def test_a_giant_array_is_an_answer_like_another() -> None:
    sentence = said("xx.double", lambda x: np.zeros((10**8, 10**8)))
    assert "raised" in sentence
    assert "MemoryError" in sentence


def test_an_argument_made_into_something_else() -> None:
    def spoils(x: Any) -> Any:
        x.append([1, 2])
        return 0

    with pytest.raises(WrongError, match="changed its argument 1"):
        Answer(spoils, "spoils", ())([1, 2])


@pytest.mark.parametrize("way", [deadline, Tracer], ids=["timer", "tracer"])
def test_a_loop_in_one_line_is_stopped(way: Any) -> None:
    # The body stands in the line of the loop: with Python 3.11 that is a line only once.
    code = "def one():\n    while True: pass\ndef two():\n    while 1: 1\n"
    names: dict[str, Any] = {}
    exec(compile(code, "<cell>", "exec"), names)
    before = sys.gettrace()
    for name in ("one", "two"):
        with pytest.raises(TooLongError), way(0.1):
            names[name]()
        assert sys.gettrace() is before


def test_a_bare_except_that_never_ends_is_stopped() -> None:
    def deaf(x: Any) -> Any:
        while True:
            try:
                while True:
                    pass
            except:  # noqa: E722
                pass

    assert "was stopped after 0.3 seconds" in said("xx.double", deaf)


# ---- the session is as it was


def meddle(x: Any) -> Any:
    """Change what others use, in every way."""
    import math
    import os
    import random
    import warnings

    os.makedirs("elsewhere", exist_ok=True)
    os.chdir("elsewhere")
    os.environ["IKTEACH_TEST"] = "1"
    sys.path.insert(0, "elsewhere")
    sys.stdout = sys.stderr = None  # type: ignore[assignment]
    np.random.seed(1)  # noqa: NPY002
    random.seed(1)
    np.seterr(all="raise")
    np.set_printoptions(precision=1)
    warnings.simplefilter("error")
    sys.setrecursionlimit(5000)
    time.monotonic = lambda: 0.0
    math.sqrt = lambda _: 0.0  # type: ignore[assignment]
    np.linalg.svd = np.allclose = np.array_equal = np.all = lambda *a, **k: True  # type: ignore
    __builtins__["len" if isinstance(__builtins__, dict) else "__name__"] = lambda _: 0
    return x + 1


def state() -> Any:
    import os
    import random
    import warnings

    chance = np.random.get_state()  # noqa: NPY002
    return {
        "folder": os.getcwd(), "environment": dict(os.environ), "path": list(sys.path),
        "streams": (sys.stdin, sys.stdout, sys.stderr), "random": random.getstate(),
        "numpy's": (chance[1].tolist(), chance[2]), "errors": np.geterr(),
        "printing": np.get_printoptions(), "warnings": list(warnings.filters),
        "limit": sys.getrecursionlimit(), "trace": sys.gettrace(),
        "names": [np.linalg.svd, np.allclose, np.all, time.monotonic, len],
    }  # fmt: skip


@pytest.mark.parametrize("thread", [False, True])
def test_a_check_leaves_the_session_as_it_was(folder: Path, thread: bool) -> None:
    before, verdicts = state(), []

    def work() -> None:
        verdicts.append(check("xx.double", meddle))

    if thread:
        worker = threading.Thread(target=work)
        worker.start()
        worker.join()
    else:
        work()
    after = state()
    for what in before:
        assert after[what] == before[what], what
    # What the answer has put in the place of numpy's functions does not judge it.
    assert verdicts[0].sentence == "`meddle([0., 1.])` must be twice its argument."
    assert json.loads((folder / "predictions.json").read_text())["verdicts"]["xx.double"]
    assert not (folder / "elsewhere" / "predictions.json").exists()


def test_answers_stay_in_the_folder_of_the_notebook(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    check("xx.double", stub)
    (folder / "data").mkdir()
    monkeypatch.chdir(folder / "data")
    check("xx.double", lambda x: 2 * x)
    assert json.loads((folder / "predictions.json").read_text())["verdicts"]["xx.double"]["passed"]
    assert list((folder / "data").iterdir()) == []


def test_megabytes_that_an_answer_prints_are_left_out(capsys: pytest.CaptureFixture[str]) -> None:
    def prints(x: Any) -> Any:
        print("y" * 10**6)
        print("z" * 10**6, file=sys.stderr)
        return 2 * x

    assert check("xx.double", prints)
    out, err = capsys.readouterr()
    assert out.startswith("y" * 100)
    assert "✓ `prints` passes every check." in out
    for text in (out.partition("✓")[0], err):
        assert 10_000 <= len(text) < 10_100
        assert text.endswith("left out)\n")


@pytest.mark.parametrize(
    ("module", "name", "other"),
    [
        ("ikteach.course.forms", "agree", lambda *_, **__: None),
        ("ikteach.course.checking", "of_form", lambda *_: np.array([2.0, 4.0])),
        ("ikteach.body", "forward", lambda *_: None),
    ],
)
def test_what_an_answer_changes_of_ours_is_put_back(module: str, name: str, other: Any) -> None:
    ours = importlib.import_module(module)
    before = getattr(ours, name)

    def patches(x: Any) -> Any:
        setattr(ours, name, other)
        return [9.0] * len(x)

    assert "must be twice" in said("xx.double", patches)
    assert getattr(ours, name) is before


def test_a_text_of_another_class_is_a_text() -> None:
    class Like(str):
        __slots__ = ()

        def __eq__(self, other: object) -> bool:
            return True

        __hash__ = str.__hash__

        def strip(self, *_: Any) -> "Like":
            return self

    assert type(of_form(Like(" dls "), NAME, "It is")) is str
