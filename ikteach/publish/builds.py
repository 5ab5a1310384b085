"""The builds of the course: for students, for instructors, and as pages to read offline.

The notebooks in the clone are the student build: they hold no solutions. The instructor build puts
after each exercise its solution, folded, from `ikteach.course.solutions`. The pages are the student
build, run, with still pictures in place of live ones and formulas as MathML: they ask nothing of
any network.
"""

import ast
import copy
import re
import shutil
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from ikteach.publish.delivery import chapters, course_files, deliver, find_course, report
from ikteach.publish.parser import Parser, RefusedError

ANSWER = re.compile(r"^## (\S+) (\S+)\n", re.MULTILINE)  # chapter, id of the cell that asks
MARK = re.compile(r"^# %% (\S+)\n", re.MULTILINE)

Notebook = Any  # of nbformat, which is typed as Any


def main(argv: list[str]) -> int:
    """Make a build of the course; give the exit code."""
    parser = Parser(
        prog="python -m ikteach build",
        description="Make a build of the course in FOLDER. A file there that has been changed "
        "since it was made is never overwritten.",
        allow_abbrev=False,
    )
    parser.add_argument(
        "build",
        choices=BUILDS,
        help="notebooks without or with solutions; pages; assignments; pack",
    )
    parser.add_argument("folder", metavar="FOLDER", type=Path)
    options = parser.parse_args(argv)
    notebooks = find_course().notebooks
    folder = options.folder.expanduser().resolve()
    if folder.is_relative_to(notebooks.resolve()):
        raise RefusedError(f"{folder} is among the notebooks themselves; name another folder.")
    with tempfile.TemporaryDirectory() as made:
        try:
            BUILDS[options.build](notebooks, Path(made))
        except ModuleNotFoundError as error:
            install = "pip install 'ikteach[html]'"
            raise RefusedError(f"{error.name} is not installed: {install}") from None
        except LookupError as error:
            raise RefusedError(str(error)) from None
        print(*report(deliver(Path(made), folder), folder), sep="\n")
    return 0


def student(notebooks: Path, folder: Path) -> None:
    """Copy the notebooks without outputs, and their files."""
    _make(notebooks, folder, _as_it_is)


def instructor(notebooks: Path, folder: Path) -> None:
    """Copy the notebooks with solutions, or raise LookupError."""
    _make(notebooks, folder, with_solutions)


def pages(notebooks: Path, folder: Path) -> None:
    """Write the course to read: a page per chapter."""
    from ikteach.publish import pages

    titles = chapters(notebooks)
    _make(notebooks, folder, _as_it_is)
    for name in titles:
        place = folder / name
        place.with_suffix(".html").write_text(pages.page(place, titles), encoding="utf-8")
    (folder / "index.html").write_text(pages.index(titles), encoding="utf-8")
    for path in folder.rglob("*.ipynb"):
        path.unlink()


def nbgrader(notebooks: Path, folder: Path) -> None:
    """Write the exercises as assignments of nbgrader."""
    from ikteach.publish import assignments

    assignments.for_nbgrader(notebooks, folder)


def otter(notebooks: Path, folder: Path) -> None:
    """Write the exercises as sources of `otter assign`."""
    from ikteach.publish import assignments

    assignments.for_otter(notebooks, folder)


def pack(notebooks: Path, folder: Path) -> None:
    """Write the instructor's pack, or raise LookupError."""
    from ikteach.publish.pack.write import write_pack

    write_pack(notebooks, folder)


BUILDS = {
    "student": student,
    "instructor": instructor,
    "html": pages,
    "nbgrader": nbgrader,
    "otter": otter,
    "pack": pack,
}


def _as_it_is(notebook: Notebook, chapter: str) -> Notebook:
    return notebook


def _make(notebooks: Path, folder: Path, change: Callable[[Notebook, str], Notebook]) -> None:
    import nbformat

    for name in course_files(notebooks):
        place = folder / name
        place.parent.mkdir(parents=True, exist_ok=True)
        if place.suffix != ".ipynb":
            shutil.copyfile(notebooks / name, place)
            continue
        chapter = place.stem.partition("_")[0]
        notebook = change(clean(nbformat.read(notebooks / name, as_version=4)), chapter)
        nbformat.write(notebook, place)


def clean(notebook: Notebook) -> Notebook:
    """Copy a notebook without outputs and `solution` cells."""
    notebook = copy.deepcopy(notebook)
    notebook.cells = [c for c in notebook.cells if "solution" not in c.metadata.get("tags", [])]
    for cell in notebook.cells:
        if cell.cell_type == "code":
            cell.outputs, cell.execution_count = [], None
    return notebook


def with_solutions(notebook: Notebook, chapter: str = "") -> Notebook:
    """Copy a notebook with solutions and answers after the questions.

    Solutions are folded. Both have the tag `solution`.
    """
    import nbformat

    notebook = copy.deepcopy(notebook)
    folded = {"tags": ["solution", "hide-input"], "jupyter": {"source_hidden": True}}
    cells, answered = [], open_answers(chapter)
    for cell in notebook.cells:
        cells.append(cell)
        if cell.id in answered:
            text = f"**Answers.** {answered[cell.id]}"
            tags = {"tags": ["solution"]}
            cells.append(
                nbformat.v4.new_markdown_cell(text, id=f"answers-{cell.id}", metadata=tags)
            )
        for key, name in checks(cell) if cell.cell_type == "code" else []:
            source = f'{solution(key)}\n\n\ncheck("{key}", {name})'
            name = re.sub(r"\W", "-", f"solution-{key}")
            cells.append(nbformat.v4.new_code_cell(source, id=name, metadata=folded))
    notebook.cells = cells
    return notebook


def checks(cell: Notebook) -> Iterator[tuple[str, str]]:
    """List (key, name of the answer) of each `check("key", name)` in a cell."""
    for node in ast.walk(ast.parse(cell.source)):
        if not (isinstance(node, ast.Call) and getattr(node.func, "id", "") == "check"):
            continue
        match node.args:
            case [ast.Constant(value=str(key)), answer]:
                yield key, ast.unparse(answer)


def solution(key: str) -> str:
    """Return the source of a solution, or raise LookupError."""
    chapter = Path(__file__).parents[1] / "course" / "solutions" / f"ch{key.partition('.')[0]}.py"
    if not chapter.exists():
        raise LookupError(
            f"There are no solutions for {key!r} here: {chapter.name} is missing. They are in the "
            "clone only, and not in the installed package."
        )
    found = solutions(chapter.read_text(encoding="utf-8"))
    if key not in found:
        raise LookupError(f"{chapter.name} has no solution for {key!r}.")
    return found[key]


def open_answers(chapter: str) -> dict[str, str]:
    """Return a chapter's answers, {id of the cell that asks: text}.

    None where they are not, as in the installed package.
    """
    path = Path(__file__).parents[1] / "course" / "solutions" / "answers.md"
    if not path.exists():
        return {}
    _, *found = ANSWER.split(path.read_text(encoding="utf-8"))
    rows = zip(found[::3], found[1::3], found[2::3], strict=True)
    return {cell: text.strip() for number, cell, text in rows if number == chapter}


def solutions(text: str) -> dict[str, str]:
    """Return {key: source} of the solutions in a module's text."""
    _, *parts = MARK.split(text)
    return {key: source.strip() for key, source in zip(parts[::2], parts[1::2], strict=True)}
