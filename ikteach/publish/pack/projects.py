"""Projects: a text and a notebook to begin with, for students, and the rubric."""

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

from ikteach.publish.pack.teaching import TEXTS, data

START = re.compile(r"## Starting cell\n\n```python\n(.*?)```\n", re.DOTALL)
EVERY = "## Levels of every project"


class Project(NamedTuple):
    """A project: what students are told, and how they begin."""

    number: int
    stem: str
    title: str
    text: str
    start: str


def projects() -> list[Project]:
    """Read the projects, in order."""
    return [_read(path) for path in sorted((TEXTS / "projects").glob("*.md"))]


def _read(path: Path) -> Project:
    text = path.read_text("utf-8")
    found = START.search(text)
    if found is None:
        raise LookupError(f"{path.name} has no starting cell.")
    told = START.sub("", text).rstrip()
    title = text.splitlines()[0].removeprefix("# ")
    return Project(int(path.stem[0]), path.stem, title, told, found[1])


def rubric() -> str:
    """Write the levels of every project as a table of Markdown."""
    table = data("rubric")
    heads: Sequence[str] = ["", *table["levels"]]
    rows = [[f"**{row['of']}**", *row["seen"]] for row in table["row"]]
    lines = [heads, ["---"] * len(heads), *rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def notebook(project: Project) -> Any:
    """Make the notebook that students begin with."""
    import nbformat

    told = f"{project.text}\n\n{EVERY}\n\n{rubric()}"
    kernel = {"display_name": "Python 3 (ipykernel)", "language": "python", "name": "python3"}
    cells = [
        nbformat.v4.new_markdown_cell(told, id="told"),
        nbformat.v4.new_code_cell(project.start.rstrip(), id="start"),
    ]
    return nbformat.v4.new_notebook(cells=cells, metadata={"kernelspec": kernel})
