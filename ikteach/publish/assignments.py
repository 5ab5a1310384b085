"""The exercises as assignments of nbgrader and of Otter-Grader.

One notebook a chapter, with its exercises alone: the text, a cell that the student fills in, and a
cell that tests it with `check`, which is worth a point. Both tools make of it a version for
students without the solutions, which stand between the tools' own marks.
"""

import ast
import re
import shutil
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from ikteach.publish.builds import checks, solution
from ikteach.publish.delivery import course_files

SETTINGS = """# Settings of nbgrader for this folder: `nbgrader generate_assignment NAME` ...
c = get_config()
c.CourseDirectory.course_id = "ikteach"
c.ExecutePreprocessor.timeout = 300  # [s] of a cell: the longest checks run a race
"""
OTTER = """# ASSIGNMENT CONFIG
init_cell: true
export_cell: false
generate:
  points_possible: {points}
tests:
  files: true
"""
PICTURE = re.compile(r"\]\((pictures/[\w.-]+)\)")
NOTE = "A test cell shows what is wrong in a sentence. It is worth its point when it says ✓."


class Task(NamedTuple):
    """One exercise, with the solution marked in its code."""

    key: str
    name: str
    text: str
    code: str


def for_nbgrader(notebooks: Path, folder: Path) -> None:
    """Write `source/CHAPTER/CHAPTER.ipynb`, and the settings."""
    import nbformat

    for title, stem, tasks in _chapters(notebooks, "### "):
        cells = [nbformat.v4.new_markdown_cell(f"{title}\n\n{NOTE}", id="title")]
        for task in tasks:
            place = re.sub(r"\W", "-", task.key)
            cells.append(nbformat.v4.new_markdown_cell(task.text, id=f"text-{place}"))
            for kind, source in (("answer", task.code), ("test", _test(task))):
                cell = nbformat.v4.new_code_cell(source, id=f"{kind}-{place}")
                cell.metadata["nbgrader"] = _marks(f"{kind}-{place}", graded=kind == "test")
                cells.append(cell)
        _write(notebooks, folder / "source" / stem / f"{stem}.ipynb", cells)
    (folder / "nbgrader_config.py").write_text(SETTINGS, encoding="utf-8")


def for_otter(notebooks: Path, folder: Path) -> None:
    """Write `CHAPTER.ipynb` for `otter assign`."""
    import nbformat

    raw: Any = nbformat.v4.new_raw_cell
    code: Any = nbformat.v4.new_code_cell
    for title, stem, tasks in _chapters(notebooks, "# "):
        cells = [raw(OTTER.format(points=len(tasks)))]
        cells.append(nbformat.v4.new_markdown_cell(f"{title}\n\n{NOTE}"))
        for task in tasks:
            name = re.sub(r"\W", "_", f"q{task.key}")
            cells += [
                raw(f"# BEGIN QUESTION\nname: {name}\npoints: 1"),
                nbformat.v4.new_markdown_cell(task.text),
                raw("# BEGIN SOLUTION"),
                code(task.code),
                raw("# END SOLUTION"),
                raw("# BEGIN TESTS"),
                code(_test(task)),
                raw("# END TESTS"),
                raw("# END QUESTION"),
            ]
        for i, cell in enumerate(cells):
            cell.id = f"cell-{i}"
        _write(notebooks, folder / f"{stem}.ipynb", cells)


def _test(task: Task) -> str:
    return f'from ikteach.course import check\n\nassert check("{task.key}", {task.name})'


def _marks(name: str, *, graded: bool) -> dict[str, Any]:
    """Return what nbgrader wants to know of a cell."""
    marks: dict[str, Any] = {"schema_version": 3, "grade_id": name, "task": False}
    marks |= {"grade": graded, "locked": graded, "solution": not graded}
    return marks | ({"points": 1} if graded else {})


def _write(notebooks: Path, path: Path, cells: list[Any]) -> None:
    """Write a notebook, and beside it the pictures that it shows."""
    import nbformat

    kernel = {"display_name": "Python 3 (ipykernel)", "language": "python", "name": "python3"}
    notebook = nbformat.v4.new_notebook(cells=cells, metadata={"kernelspec": kernel})
    path.parent.mkdir(parents=True, exist_ok=True)
    nbformat.write(notebook, path)
    for name in PICTURE.findall("".join(cell.source for cell in cells)):
        place = path.parent / name
        place.parent.mkdir(exist_ok=True)
        shutil.copyfile(notebooks / name, place)


def _chapters(notebooks: Path, mark: str) -> Iterator[tuple[str, str, list[Task]]]:
    """List title, file stem and exercises of each chapter that has some."""
    import nbformat

    for name in course_files(notebooks):
        if not name.endswith(".ipynb"):
            continue
        cells = nbformat.read(notebooks / name, as_version=4).cells
        tasks = list(_tasks(cells, mark))
        if tasks:
            title = next(c.source for c in cells if c.cell_type == "markdown").splitlines()[0]
            yield title, Path(name).stem, tasks


def _tasks(cells: list[Any], mark: str) -> Iterator[Task]:
    text = ""
    for cell in cells:
        if cell.cell_type == "markdown":
            text = cell.source
            continue
        for key, name in checks(cell):
            answer = solution(key)
            yield Task(key, name, text, solved(cell.source, answer, mark, _imports(cells, answer)))


def _imports(cells: list[Any], answer: str) -> list[str]:
    """List the imports of a notebook that an answer needs."""
    used = {node.id for node in ast.walk(ast.parse(answer)) if isinstance(node, ast.Name)}
    found: dict[str, None] = {}
    for cell in cells:
        for one in ast.parse(cell.source).body if cell.cell_type == "code" else []:
            if isinstance(one, ast.Import | ast.ImportFrom):
                one.names = [name for name in one.names if (name.asname or name.name) in used]
                found |= {ast.unparse(one): None} if one.names else {}
    return list(found)


def solved(stub: str, answer: str, mark: str, imports: Sequence[str] = ()) -> str:
    """Write the solution into a stub, between marks.

    Without the lines between them, the student finds the head of the function and its docstring.
    """
    *before, last = ast.parse(answer).body
    lines = answer.splitlines()
    ours = next(one for one in ast.parse(stub).body if _name(one) == _name(last))
    given = stub.splitlines()
    head = [*dict.fromkeys(["import numpy as np", *imports])]
    head += [ast.unparse(one) for one in before]
    begin, end = f"{mark}BEGIN SOLUTION", f"{mark}END SOLUTION"
    if not (isinstance(last, ast.FunctionDef) and isinstance(ours, ast.FunctionDef)):
        start = given[ours.lineno - 1 : ours.end_lineno]
        return "\n".join([*head, "", *start, begin, *lines[last.lineno - 1 :], end])
    told = bool(ast.get_docstring(ours))
    start = given[ours.lineno - 1 : ours.body[told].lineno - 1]
    first = last.body[bool(ast.get_docstring(last))]
    body = lines[first.lineno - 1 : last.end_lineno]
    return "\n".join([*head, "\n", *start, f"    {begin}", *body, f"    {end}"])


def _name(statement: ast.stmt) -> str:
    match statement:
        case ast.FunctionDef(name=name) | ast.Assign(targets=[ast.Name(id=name)]):
            return name
    return ""
