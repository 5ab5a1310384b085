"""What a class has handed in: for each student the source of each answer, and none of it run.

It is read from notebooks, each cell that calls `check("NN.name", answer)` with what it uses of the
cells before it, and from the sources kept in `predictions.json` or in what `export` has written.
What a file says of itself (`passed: true`) is a claim and no mark.
"""

import ast
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

from ikteach.course.record import LARGEST_ANSWERS, valid
from ikteach.files import bounded, read_json, whole_characters
from ikteach.publish.collect import files_of
from ikteach.publish.delivery import LARGEST_NOTEBOOK

KEY = re.compile(r"""\bcheck\(\s*["'](\d\d\.\w+)["']""")
MAGIC = re.compile(r"^\s*[%!].*$", re.MULTILINE)
LONGEST = 100_000  # letters of an answer
MOST_CELLS = 1000
# How learning platforms name what they hand out: Moodle's folders and Canvas's files.
MOODLE_FOLDER = re.compile(r"(?P<name>.+?)_(?P<id>\d+)_assignsubmission_\w+_?")
CANVAS_FILE = re.compile(r"(?P<name>[^_]+)(_LATE)?_(?P<id>\d+)_\d+_.+")


class HandIn(NamedTuple):
    """One student's answers.

    student  a name, and `number` that of the platform, or ""
    sources  {key: sources, each a module that binds `answer`, the newest last}
    claims   keys that a file says were passed
    """

    student: str
    number: str
    sources: dict[str, list[str]]
    claims: set[str]


def hand_ins(folder: Path) -> tuple[list[HandIn], dict[str, str]]:
    """Read what is in a folder, and why not."""
    if not folder.is_dir():
        raise NotADirectoryError(f"{folder} is not a folder")
    found: dict[str, HandIn] = {}
    skipped: dict[str, str] = {}
    for path in sorted(folder.iterdir()):
        if path.is_dir() and not path.is_symlink() and not path.name.startswith("."):
            _of(found, path.name)  # also who has handed in nothing
    for path, hindrance in files_of(folder, (".json", ".zip", ".ipynb")):
        name = path.relative_to(folder)
        one = _of(found, name.parts[0] if len(name.parts) > 1 else name.stem)
        try:
            if hindrance:
                raise ValueError(hindrance)
            if path.suffix.lower() == ".ipynb":
                for key, source in answers(_cells(read_json(path, LARGEST_NOTEBOOK))).items():
                    one.sources.setdefault(key, []).append(source)
            else:
                _kept(one, valid(read_json(path, LARGEST_ANSWERS)))
        except (OSError, ValueError, RecursionError) as error:
            skipped[str(name)] = bounded(str(error))
    return sorted(found.values()), skipped


def _of(found: dict[str, HandIn], place: str) -> HandIn:
    """Find the student to whom a folder or a file belongs."""
    match = MOODLE_FOLDER.fullmatch(place) or CANVAS_FILE.fullmatch(place)
    name, number = (match["name"], match["id"]) if match else (place, "")
    name = whole_characters(name)
    return found.setdefault(f"{name} {number}", HandIn(name, number, {}, set()))


def _kept(one: HandIn, content: dict[str, Any]) -> None:
    for key, entry in content.get("verdicts", {}).items():
        if entry.get("passed") is True:
            one.claims.add(key)
        source = entry.get("source")
        if isinstance(source, str) and 0 < len(source) <= LONGEST:
            one.sources.setdefault(key, []).insert(0, source)


def _cells(notebook: Any) -> list[str]:
    """Return the code cells of a notebook, without solutions that we put in."""
    cells = notebook.get("cells") if isinstance(notebook, dict) else None
    if not isinstance(cells, list) or len(cells) > MOST_CELLS:
        raise ValueError("it is no notebook of Jupyter's version 4")
    texts = []
    for cell in cells:
        match cell:
            case {"cell_type": "code", "metadata": {"tags": [*tags]}} if "solution" in tags:
                continue
            case {"cell_type": "code", "source": str(text)}:
                texts.append(text)
            case {"cell_type": "code", "source": [*lines]}:
                texts.append("".join(map(str, lines)))
    return texts


def answers(cells: list[str]) -> dict[str, str]:
    """Find the source of each answer in code cells.

    A later check of a key replaces an earlier one.
    """
    found: dict[str, str] = {}
    before: list[ast.stmt] = []
    for text in cells:
        text = MAGIC.sub("", text)[:LONGEST]
        try:
            statements = ast.parse(text).body
        except (SyntaxError, ValueError, MemoryError, RecursionError):
            found |= dict.fromkeys(KEY.findall(text), text)  # to say what is wrong with it
            continue
        for statement in statements:
            for key, answer in _checks(statement):
                kept = _needed(before, answer)
                found[key] = "\n".join([*map(ast.unparse, kept), f"answer = {ast.unparse(answer)}"])
            before.append(statement)
    return found


def _checks(statement: ast.stmt) -> Iterator[tuple[str, ast.expr]]:
    """List (key, answer) of each check in a statement."""
    for node in ast.walk(statement):
        match node:
            case ast.Call(
                func=ast.Name(id="check") | ast.Attribute(attr="check"),
                args=[ast.Constant(value=str(key)), answer, *_],
            ):
                yield key, answer


def _needed(before: list[ast.stmt], answer: ast.expr) -> list[ast.stmt]:
    """List the statements that bind what an answer uses, in order."""
    wanted, kept = _names(answer, ast.Load), set[int]()
    while more := {i for i, one in enumerate(before) if _bound(one) & wanted} - kept:
        kept |= more
        for i in more:
            wanted |= _names(before[i], ast.Load)
    return [before[i] for i in sorted(kept)]


def _bound(statement: ast.stmt) -> set[str]:
    """List the names that a statement binds, or changes a part of."""
    if isinstance(statement, ast.Expr):
        return set()
    if isinstance(statement, ast.Import | ast.ImportFrom):
        return {(one.asname or one.name).partition(".")[0] for one in statement.names}
    if isinstance(statement, ast.FunctionDef | ast.ClassDef):
        return {statement.name}
    parts = [n for n in ast.walk(statement) if isinstance(n, ast.Subscript | ast.Attribute)]
    changed = [n.value for n in parts if isinstance(n.ctx, ast.Store)]
    return _names(statement, ast.Store) | {n.id for n in changed if isinstance(n, ast.Name)}


def _names(node: ast.AST, context: type) -> set[str]:
    return {n.id for n in ast.walk(node) if isinstance(n, ast.Name) and isinstance(n.ctx, context)}
