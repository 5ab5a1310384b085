"""The exit questions with their answers, a module a chapter, so that no cell gives them away.

A notebook asks `quiz("03.stuck")`; the question, its options, the right one and the reasons are in
`QUIZZES` of `ikteach.course.quizzes.ch03`.
"""

import importlib
from collections.abc import Mapping, Sequence
from typing import NamedTuple

from ikteach.names import unknown


class Quiz(NamedTuple):
    """One exit question.

    question  what is asked
    right     the right one of its options
    why       {option: a sentence}, said when it is chosen; or one sentence for all
    options   what there is to choose from; those of `why` if left out
    """

    question: str
    right: str
    why: str | Mapping[str, str]
    options: Sequence[str] = ()

    @property
    def choices(self) -> list[str]:
        """List what there is to choose from."""
        return list(self.options or self.why)


def asked(key: str) -> Quiz:
    """Return the exit question `key`, or raise LookupError."""
    module = f"{__name__}.ch{str(key).partition('.')[0]}"
    known: Mapping[str, Quiz] = {}
    try:
        known = importlib.import_module(module).QUIZZES
    except ModuleNotFoundError as error:
        if error.name != module:
            raise
    if key not in known:
        raise LookupError(unknown("exit question", key, known))
    return known[key]
