"""No mutant of a solution that answers otherwise passes its check."""

import os
from pathlib import Path

import numpy as np
import pytest

from ikteach.course import checking
from ikteach.course.checking import Answer, exercise, expect
from tests.course import draws
from tests.course.mutation import alike, mutants, tried
from tests.course.test_exercises import OURS

SAMPLE = None if os.environ.get("IKTEACH_FULL") else 16  # mutants of a solution


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


@pytest.mark.filterwarnings("ignore::SyntaxWarning")
@pytest.mark.parametrize("key", OURS)
def test_no_mutant_that_answers_otherwise_passes(key: str) -> None:
    report = tried(key, SAMPLE)
    print(report)
    assert report.passed == []
    assert report.mute == []
    assert report.counts["refused"] >= 10


SOURCE = """
def share(x, y):
    if abs(x) < 2:
        return 0.5 * x
    return np.sqrt(x * x + y)
"""


def test_a_solution_is_taken_apart_everywhere() -> None:
    done, sources = zip(*mutants(SOURCE), strict=True)
    for what in (
        "its first argument: abs(x)",  # an abs dropped
        "Gt: abs(x) < 2",  # a comparison turned
        "LtE: abs(x) < 2",
        "doubled: 2",
        "halved: 0.5",
        "zeroed: 0.5",
        "ignored: x",
        "read y: x",  # a test on another argument
        "Sub: x * x + y",
        "negated: return 0.5 * x",
        "its first argument: np.sqrt(x * x + y)",
        "never: if abs(x) < 2:",
    ):
        assert what in done
    assert len(set(sources)) == len(sources)
    assert "if abs(y) < 2" in "".join(sources)


def test_a_check_with_a_hole_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two cases of the same kind: neither asks for a negative number."""

    @exercise("00.hole", returns=(), hints=["?"])
    def hole(answer: Answer) -> None:
        for x in (1.0, 2.5):
            expect(np.isclose(answer(x), 2 * abs(x)), f"{answer.call} is wrong")

    monkeypatch.setitem(draws.DRAWS, "00.hole", lambda rng: (float(rng.normal()),))
    try:
        report = tried("00.hole", source="def double(x):\n    return 2 * abs(x)\n")
    finally:
        del checking.EXERCISES["00.hole"]
    assert any(one.startswith("its first argument: abs(x)") for one in report.passed)
    assert report.counts["refused"] > 5


def test_what_is_alike() -> None:
    assert alike(np.ones(3), np.ones(3) * (1 + 1e-12))
    assert not alike(np.ones(3), np.ones(3) * (1 + 1e-4))
    assert not alike(np.ones(3), np.ones(2))
    assert not alike("lost", "free")
    assert not alike(ValueError, np.ones(3))
    assert alike(np.zeros(3), np.full(3, 1e-15), (np.ones(3),))
