"""Syllabi: weeks with their chapters, minutes, hand-ins, quizzes and projects."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from ikteach.publish.pack.bank import families
from ikteach.publish.pack.parts import Chapter, Stub
from ikteach.publish.pack.plan import at_home, in_class, plan
from ikteach.publish.pack.teaching import data


class Week(NamedTuple):
    """One week.

    Minutes are sums over its chapters and its work on the project.
    """

    number: int
    chapters: Sequence[Chapter]
    in_class: int
    at_home: int
    hand_in: Sequence[str]
    quizzes: Sequence[str]
    project: str


class Syllabus(NamedTuple):
    """Some weeks."""

    title: str
    about: str
    weeks: Sequence[Week]


def syllabi(chapters: Sequence[Chapter]) -> list[Syllabus]:
    """Make the syllabi; LookupError for a chapter that is not there."""
    known = {chapter.number: chapter for chapter in chapters}
    found = []
    for one in data("syllabi").values():
        weeks = [_week(i, week, known) for i, week in enumerate(one["week"], 1)]
        found.append(Syllabus(one["title"], one["about"], weeks))
    return found


def _week(number: int, week: Mapping[str, object], known: Mapping[str, Chapter]) -> Week:
    names = week["chapters"]
    assert isinstance(names, list)
    if missing := [name for name in names if name not in known]:
        raise LookupError(f"There is no chapter {missing[0]} for week {number}.")
    chapters = [known[name] for name in names]
    plans = [plan(chapter) for chapter in chapters]
    hand_in = [task.key for chapter in chapters for task in chapter.of(Stub)]
    quizzes = [name for name in families() if name.partition(".")[0] in names]
    return Week(
        number,
        chapters,
        sum(map(in_class, plans)) + int(str(week.get("class_minutes", 0))),
        sum(map(at_home, plans)) + int(str(week.get("home_minutes", 0))),
        hand_in,
        quizzes,
        str(week.get("project", "")),
    )
