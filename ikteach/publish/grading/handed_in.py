"""What a class has handed in: for each student the source of each answer, and none of it run.

It is read from notebooks, each cell that calls `check("NN.name", answer)` with what it uses of the
cells before it, and from the sources kept in `predictions.json` or in what `export` has written.
What a file says of itself (`passed: true`) is a claim and no mark.
"""

import ast
import re
import symtable
import zipfile
from collections.abc import Iterable, Iterator
from pathlib import Path, PurePosixPath
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple
from unicodedata import normalize

from IPython.core.inputtransformer2 import TransformerManager

from ikteach.course.record import LARGEST_ANSWERS, valid
from ikteach.files import bounded, read_json, whole_characters
from ikteach.publish.collect import files_of
from ikteach.publish.delivery import LARGEST_NOTEBOOK

KEY = re.compile(r"""\bcheck\(\s*["'](\d\d\.\w+)["']""")
READ = (".json", ".ipynb")
MOST_PACKED = 2000  # files of an archive
LARGEST_PACKED = 500 * 2**20  # bytes of them
LONGEST = 100_000  # letters of an answer
MOST_CELLS = 1000
LEFT_BY_MACOS = "__MACOSX"  # a folder that it puts into archives
# How learning platforms name the folders and files that they hand out.
MOODLE = re.compile(r"(?P<name>.+?)(_(?P<id>\d+))?_assignsubmission_.*")
CANVAS = re.compile(r"(?P<name>[^_]+)(_LATE)?_(?P<id>\d+)_\d+_.+")


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


class HandedFile(NamedTuple):
    """A file that was handed in.

    path       where it can be read
    name       what it is called within the folder
    hindrance  why it cannot be read, or ""
    """

    path: Path
    name: Path
    hindrance: str = ""


def hand_ins(folder: Path) -> tuple[list[HandIn], dict[str, str]]:
    """Read what is in a folder, and why not."""
    if not folder.is_dir():
        packed = ": unpack it first" if folder.suffix.lower() == ".zip" else ""
        raise NotADirectoryError(f"{folder} is not a folder{packed}")
    found: dict[str, HandIn] = {}
    skipped: dict[str, str] = {}
    with TemporaryDirectory() as room:
        files = list(_files(folder, Path(room)))
        canvas = _of_canvas(file.name for file in files)
        for place in _folders(folder):  # also who has handed in nothing
            if place.relative_to(folder) not in canvas:
                inner = [one.name for one in _folders(place) if MOODLE.fullmatch(one.name)]
                for student in inner or [place.name]:
                    _of(found, student)
        for path, name, hindrance in files:
            parts = (*name.parts[:-1], name.stem)
            moodle = (part for part in parts[:2] if MOODLE.fullmatch(part))
            one = _of(found, name.stem if name.parent in canvas else next(moodle, parts[0]))
            try:
                if hindrance:
                    raise ValueError(hindrance)
                _read(one, path)
            except (OSError, ValueError, RecursionError) as error:
                skipped[str(name)] = bounded(str(error))
    return sorted(found.values()), skipped


def _read(one: HandIn, path: Path) -> None:
    if path.suffix.lower() == ".ipynb":
        for key, source in answers(_cells(read_json(path, LARGEST_NOTEBOOK))).items():
            one.sources.setdefault(key, []).append(source)
    else:
        _kept(one, valid(read_json(path, LARGEST_ANSWERS)))


def _files(folder: Path, room: Path) -> Iterator[HandedFile]:
    """List what was handed in, also in archives, which are unpacked into `room`."""
    for path, hindrance in files_of(folder, (*READ, ".zip")):
        file = HandedFile(path, path.relative_to(folder), hindrance)
        if LEFT_BY_MACOS in path.parts:
            continue
        if path.suffix.lower() != ".zip" or path.is_symlink():
            yield file
            continue
        try:
            yield from _unpacked(file, room)
        except (OSError, ValueError, RuntimeError, zipfile.BadZipFile) as error:
            yield file._replace(hindrance=f"it cannot be unpacked ({error})")


def _unpacked(file: HandedFile, room: Path) -> list[HandedFile]:
    """Unpack what is to be read of an archive; ValueError if that is too much."""
    with zipfile.ZipFile(file.path) as archive:
        names = {one: PurePosixPath(one.filename) for one in archive.infolist()}
        wanted = [
            one
            for one, name in names.items()
            if name.suffix.lower() in READ
            and not any(part.startswith((".", LEFT_BY_MACOS)) for part in name.parts)
        ]
        if not wanted:
            raise ValueError("it holds nothing to grade")
        if len(wanted) > MOST_PACKED or sum(one.file_size for one in wanted) > LARGEST_PACKED:
            raise ValueError("it holds too much")
        files = []
        for one in wanted:
            place = room / f"{len(list(room.iterdir()))}{names[one].suffix.lower()}"
            place.write_bytes(archive.read(one))
            inside = Path(*names[one].relative_to(names[one].anchor).parts)
            files.append(HandedFile(place, file.name.with_suffix("") / inside))
    return files


def _folders(place: Path) -> list[Path]:
    """List folders in a folder; what cannot be read is told by `files_of`."""
    try:
        inner = sorted(place.iterdir())
    except OSError:
        return []
    ours = (one for one in inner if one.is_dir() and not one.is_symlink())
    return [one for one in ours if not one.name.startswith(".") and one.name != LEFT_BY_MACOS]


def _of_canvas(names: Iterable[Path]) -> set[Path]:
    """Find the outer folders that hold nothing but files as Canvas names them."""
    numbers: dict[Path, set[str]] = {}
    for name in names:
        match = CANVAS.fullmatch(name.stem)
        numbers.setdefault(name.parent, set()).add(match["id"] if match else "")
    outer = {place: found for place, found in numbers.items() if len(place.parts) == 1}
    return {place for place, found in outer.items() if "" not in found and len(found) > 1}


def _of(found: dict[str, HandIn], place: str) -> HandIn:
    """Find the student to whom a folder or a file belongs."""
    match = MOODLE.fullmatch(place) or CANVAS.fullmatch(place)
    name, number = (match["name"], match["id"] or "") if match else (place, "")
    name = normalize("NFC", whole_characters(name))  # macOS writes é as two characters
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
    before: list[tuple[ast.stmt, Uses]] = []
    for text in cells:
        try:
            statements = ast.parse(plain_python(text[:LONGEST])).body
        except (SyntaxError, ValueError, MemoryError, RecursionError):
            found |= dict.fromkeys(KEY.findall(text), text)  # to say what is wrong with it
            continue
        for statement in statements:
            for key, answer in _checks(statement):
                lines = map(ast.unparse, _needed(before, answer))
                found[key] = "\n".join([*lines, f"answer = {ast.unparse(answer)}"])
            before.append((statement, Uses.of(statement)))
    return found


def plain_python(text: str) -> str:
    """Drop the magic of a cell, as Jupyter understands it."""
    try:
        ast.parse(text)  # a line that begins with % may also be Python
    except SyntaxError:
        body = re.sub(r"\A\s*%%.*", "", text)  # of `%%time` and the like
        transformer: Any = TransformerManager
        return str(transformer().transform_cell(body))
    return text


def _checks(statement: ast.stmt) -> Iterator[tuple[str, ast.expr]]:
    """List (key, answer) of each check in a statement."""
    for node in ast.walk(statement):
        if isinstance(node, ast.Call) and _called(node.func) == "check":
            given = dict(zip(("key", "answer"), node.args, strict=False))
            match given | {one.arg: one.value for one in node.keywords}:
                case {"key": ast.Constant(value=str(key)), "answer": answer}:
                    yield key, answer


def _called(function: ast.expr) -> str:
    return getattr(function, "id", "") or getattr(function, "attr", "")


def _needed(before: list[tuple[ast.stmt, "Uses"]], answer: ast.expr) -> list[ast.stmt]:
    """List the statements that bind or change what an answer uses, in order."""
    statements, names = [one for one, _ in before], [names for _, names in before]
    wanted = set(Uses.of(ast.Expr(answer)).used)
    kept = {i for i, one in enumerate(names) if "*" in one.bound}  # from … import *
    while more := {i for i, one in enumerate(names) if one.bound & wanted} - kept:
        kept |= more
        wanted |= {name for i in more for name in names[i].used}
    wanted -= {name for one in names for name in one.imported}
    changes = {i for i, one in enumerate(statements) if _changed(one) & wanted}
    return [
        _attempt(statements[i]) if i in changes else statements[i] for i in sorted(kept | changes)
    ]


class Uses(NamedTuple):
    """The names of a notebook that a statement binds, imports and uses."""

    bound: set[str]
    imported: set[str]
    used: set[str]

    @classmethod
    def of(cls, statement: ast.stmt) -> "Uses":
        """Look them up as Python does."""
        try:
            top = symtable.symtable(ast.unparse(statement), "<answer>", "exec")
        except (SyntaxError, ValueError):  # such as `return` outside of a function
            return cls(set(), set(), set())
        here = top.get_symbols()
        inner = [one for table in _below(top) for one in table.get_symbols() if one.is_global()]
        parts = [n for n in ast.walk(statement) if isinstance(n, ast.Subscript | ast.Attribute)]
        changed = [n.value for n in parts if isinstance(n.ctx, ast.Store)]
        bound = {one.get_name() for one in here if one.is_assigned() or one.is_imported()}
        bound |= {one.get_name() for one in inner if one.is_assigned()}
        bound |= {n.id for n in changed if isinstance(n, ast.Name)}
        if isinstance(statement, ast.ImportFrom) and statement.names[0].name == "*":
            bound.add("*")
        used = {one.get_name() for one in [*here, *inner] if one.is_referenced()}
        return cls(bound, {one.get_name() for one in here if one.is_imported()}, used)


def _below(table: symtable.SymbolTable) -> Iterator[symtable.SymbolTable]:
    for child in table.get_children():
        yield child
        yield from _below(child)


def _changed(statement: ast.stmt) -> set[str]:
    """Name what a statement such as `mix.update(…)` may change."""
    match statement:
        case ast.Expr(value=ast.Call(func=ast.Attribute(value=ast.Name(id=name)))):
            return {name}
    return set()


def _attempt(statement: ast.stmt) -> ast.stmt:
    """Let the answer go on where what may be without meaning for it fails."""
    (tried,) = ast.parse("try:\n    ...\nexcept Exception:\n    ...").body
    assert isinstance(tried, ast.Try)
    tried.body = [statement]
    return tried
