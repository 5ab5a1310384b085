"""A chapter taken apart: what its notebook tells, asks, shows and sets, in the notebook's order.

All that the pack says of a chapter comes from here, so that a changed notebook changes the pack.
"""

import ast
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cached_property, partial
from pathlib import Path
from typing import Any, NamedTuple

from ikteach.course.quizzes import Quiz, asked
from ikteach.publish.builds import checks, open_answers

Notebook = Any  # of nbformat, which is typed as Any

MINUTES = re.compile(r"About (\d+) minutes")
NEEDS = re.compile(r"About \d+ minutes\.\s*([^*\n]+)")
BULLET = re.compile(r"^- (.+(?:\n  .+)*)", re.MULTILINE)
HEADING = re.compile(r"^#+ (.+)$", re.MULTILINE)


class Told(NamedTuple):
    """A markdown cell."""

    cell: str
    text: str

    @property
    def heading(self) -> str:
        """Its last heading, or nothing."""
        found = HEADING.findall(self.text)
        return str(found[-1]) if found else ""


class Posed(NamedTuple):
    """A prediction, and the cell in which it is revealed."""

    cell: str
    key: str
    question: str
    choices: Sequence[str]
    numbers: tuple[float, float, str] | None
    ranking: bool
    revealed: str


class Computed(NamedTuple):
    """A cell that computes what was predicted."""

    cell: str
    keys: Sequence[str]


Tries = Mapping[str, Mapping[str, Any]]  # sentence -> name of a control -> its value


class ToTry(NamedTuple):
    """A live figure, and what to try with it.

    make  makes it: the figure, and its tries
    """

    cell: str
    make: Callable[[], tuple[Any, Tries]]


class Stub(NamedTuple):
    """An exercise, and the text that sets it."""

    cell: str
    key: str
    name: str
    text: str


class Exit(NamedTuple):
    """An exit question that a widget asks."""

    cell: str
    key: str
    quiz: Quiz


class Open(NamedTuple):
    """Open questions, and their answers."""

    cell: str
    text: str
    answer: str


Part = Told | Posed | Computed | ToTry | Stub | Exit | Open


class Chapter:
    """A chapter's notebook, read.

    Predictions are made by running their cells, and the imports before them; so are live figures,
    when they are asked for.
    """

    def __init__(self, path: Path) -> None:
        import nbformat

        self.path, self.file = path, path.name
        self.number = path.stem.partition("_")[0]
        self.cells = nbformat.read(path, as_version=4).cells
        self.first = next(c.source for c in self.cells if c.cell_type == "markdown")

    @property
    def title(self) -> str:
        """Its title, without a mark."""
        return self.first.splitlines()[0].removeprefix("# ")

    @property
    def minutes(self) -> int:
        """How long it takes, as it says itself."""
        found = MINUTES.search(self.first)
        if found is None:
            raise LookupError(f"{self.file} does not say in its first cell how long it takes.")
        return int(found[1])

    @property
    def needs(self) -> str:
        """What is needed from before."""
        found = NEEDS.search(self.first)
        return found[1].strip() if found else ""

    @property
    def goals(self) -> list[str]:
        """What one can do when through."""
        return [re.sub(r"\s+", " ", goal).rstrip(".;") for goal in BULLET.findall(self.first)]

    @cached_property
    def parts(self) -> list[Part]:
        """All that it tells, asks, shows and sets, in order."""
        return list(self._parts())

    def of(self, kind: type[Any]) -> list[Any]:
        """Return its parts of one kind."""
        return [part for part in self.parts if isinstance(part, kind)]

    @cached_property
    def keys(self) -> list[str]:
        """Keys of all by which a goal can be measured.

        Predictions, exercises and exit questions, and open questions as `NN cell`.
        """
        keyed = [part.key for part in self.parts if isinstance(part, Posed | Stub | Exit)]
        return keyed + [f"{self.number} {part.cell}" for part in self.of(Open)]

    def _parts(self) -> Iterator[Part]:
        answers, revealed = open_answers(self.number), self._revealed()
        names: dict[str, Any] = {"display": lambda *_: None}
        told = ""
        for cell in self.cells[1:]:
            if cell.cell_type == "markdown":
                told = cell.source
                open_too = cell.id in answers
                yield Open(cell.id, told, answers[cell.id]) if open_too else Told(cell.id, told)
                continue
            called = set(calls(cell.source))
            if "predict" in called:
                for part in _predictions(cell, names):
                    yield part._replace(revealed=revealed[part.key])
            elif "show_me" in called:
                _import(cell.source, names)
                yield ToTry(cell.id, partial(_figure, cell, dict(names)))
            else:
                _import(cell.source, names)
            if found := list(keys(cell.source, "reveal")):
                yield Computed(cell.id, found)
            for key, name in checks(cell):
                yield Stub(cell.id, key, name, told)
            for key in keys(cell.source, "quiz"):
                yield Exit(cell.id, key, asked(key))

    def _revealed(self) -> dict[str, str]:
        """Find the cell in which each prediction is revealed."""
        code = [cell for cell in self.cells if cell.cell_type == "code"]
        return {key: cell.id for cell in code for key in keys(cell.source, "reveal")}


def calls(source: str) -> Iterator[str]:
    """List the names that a cell calls."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
            yield node.func.id


def keys(source: str, name: str) -> Iterator[str]:
    """List the first arguments of a function's calls, if texts."""
    for node in ast.walk(ast.parse(source)):
        match node:
            case ast.Call(func=ast.Name(id=called), args=[ast.Constant(value=str(key)), *_]):
                if called == name:
                    yield key


def _import(source: str, names: dict[str, Any]) -> None:
    found = [one for one in ast.parse(source).body if isinstance(one, ast.Import | ast.ImportFrom)]
    _run(found, names)


def _run(statements: Sequence[ast.stmt], names: dict[str, Any]) -> None:
    exec(compile(ast.Module([*statements], []), "a cell", "exec"), names)


def _predictions(cell: Notebook, names: dict[str, Any]) -> list[Posed]:
    """Run a cell with a `predict` that only notes what it asks."""
    found: list[Posed] = []

    def note(
        key: str,
        question: str,
        options: Sequence[str] = (),
        *,
        numbers: tuple[float, float, str] | None = None,
        ranking: bool = False,
        explain: str = "",
    ) -> None:
        words = f"{question} {explain}".strip()
        found.append(Posed(cell.id, key, words, list(options), numbers, ranking, ""))

    _import(cell.source, names)
    body = [
        one
        for one in ast.parse(cell.source).body
        if not isinstance(one, ast.Import | ast.ImportFrom)
    ]
    _run(body, names | {"predict": note})
    _run([one for one in body if isinstance(one, ast.Assign)], names)
    return found


def _figure(cell: Notebook, names: dict[str, Any]) -> tuple[Any, Tries]:
    """Run a cell without its last line, `show_me(figure, tries)`, for these two."""
    *body, last = ast.parse(cell.source).body
    _run(body, names)
    match last:
        case ast.Expr(value=ast.Call(func=ast.Name(id="show_me"), args=[figure, tries])):
            return eval(ast.unparse(figure), names), eval(ast.unparse(tries), names)
    raise LookupError(f"The cell {cell.id} does not end with show_me(figure, tries).")
