"""The map of the course: each goal, and what measures it."""

from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

from ikteach.publish.pack.bank import families
from ikteach.publish.pack.parts import Chapter, Exit, Posed, Stub
from ikteach.publish.pack.projects import Project
from ikteach.publish.pack.teaching import Belief, data


class Goal(NamedTuple):
    """A goal of a chapter, and the keys of its measures."""

    chapter: str
    goal: str
    predictions: Sequence[str]
    exercises: Sequence[str]
    quizzes: Sequence[str]
    open: Sequence[str]
    bank: Sequence[str]
    projects: Sequence[str]
    beliefs: Sequence[str]

    @property
    def measured(self) -> bool:
        """Whether anything measures it."""
        return any(self[2:8])


class Map(NamedTuple):
    """All goals, and what fits nowhere.

    strange  measures that `objectives.toml` names and nobody has
    unused   measures of the course that no goal names
    reworded goals that stand otherwise in the notebook, or not at all
    """

    goals: Sequence[Goal]
    strange: Sequence[str]
    unused: Sequence[str]
    reworded: Sequence[str]


def mapped(
    chapters: Sequence[Chapter], beliefs: Mapping[str, Belief], projects: Sequence[Project]
) -> Map:
    """Draw the map from the course's own data."""
    table = data("objectives")
    known = set(all_measures(chapters, projects))
    named = {key for goals in table.values() for keys in goals.values() for key in keys}
    told = {(number, goal) for number, goals in table.items() for goal in goals}
    true = {(chapter.number, goal) for chapter in chapters for goal in chapter.goals}
    goals = [
        _goal(chapter, goal, table[chapter.number][goal], beliefs)
        for chapter in chapters
        for goal in chapter.goals
        if (chapter.number, goal) in told
    ]
    reworded = sorted(f"{number}: {goal}" for number, goal in told ^ true)
    return Map(goals, sorted(named - known), sorted(known - named), reworded)


def all_measures(chapters: Sequence[Chapter], projects: Sequence[Project]) -> Iterator[str]:
    """List all that can measure a goal."""
    for chapter in chapters:
        yield from chapter.keys
    yield from (f"bank {name}" for name in [*families(), LETTERS])
    yield from (f"project {project.number}" for project in projects)


LETTERS = "prerequisites.letters"  # of the bank, made of the table of letters


def _goal(chapter: Chapter, goal: str, keys: Sequence[str], beliefs: Mapping[str, Belief]) -> Goal:
    def of(kind: type) -> list[str]:
        return [part.key for part in chapter.of(kind) if part.key in keys]

    predictions = of(Posed)
    opened = [key for key in keys if key in chapter.keys and " " in key]
    bank, projects = (
        [key.removeprefix(f"{word} ") for key in keys if key.startswith(f"{word} ")]
        for word in ("bank", "project")
    )
    wrong = [beliefs[key].belief for key in predictions if key in beliefs]
    number = chapter.number
    return Goal(number, goal, predictions, of(Stub), of(Exit), opened, bank, projects, wrong)
