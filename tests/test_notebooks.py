"""Every notebook runs cleanly in a fresh kernel: forwards, backwards, and with its solutions.

Backwards and with its solutions it runs as on another processor, whose last bits differ; what a
prediction is held against must not hang on those.
"""

import ast
import asyncio
import builtins
import copy
import json
import os
import re
from pathlib import Path
from typing import Any

import nbformat
import pytest
import rounding

from ikteach.publish import builds
from ikteach.publish.pages import runner

NOTEBOOKS = sorted((Path(__file__).parents[1] / "notebooks").glob("*.ipynb"))
OTHER_PROCESSOR = f"""{Path(rounding.__file__).read_text(encoding="utf-8")}
for name, other in move_all().items():
    setattr(np.linalg, name, other)
"""
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")


def test_there_are_notebooks() -> None:
    assert NOTEBOOKS


def story(path: Path) -> Any:
    """The student's notebook, then once more from its end to its start, then the instructor's."""
    notebook = builds.clean(nbformat.read(path, as_version=4))
    solved = builds.with_solutions(copy.deepcopy(notebook))
    later = {"again": notebook.cells[::-1], "solved": solved.cells}
    notebook.cells.append(nbformat.v4.new_code_cell(OTHER_PROCESSOR, id="other-processor"))
    for name, cells in later.items():
        for cell in copy.deepcopy([cell for cell in cells if cell.cell_type == "code"]):
            cell.id += f"-{name}"
            notebook.cells.append(cell)
    return notebook


@pytest.fixture(scope="module")
def runs(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> dict[Path, Any]:
    """Each notebook that is asked for as it was run, or what went wrong. Two run at a time."""
    asked = [item for item in request.session.items if "runs" in getattr(item, "fixturenames", ())]
    paths = dict.fromkeys(item.callspec.params["path"] for item in asked)
    places = asyncio.Semaphore(2)

    async def run(path: Path) -> Any:
        folder = tmp_path_factory.mktemp("run")
        async with places:
            try:
                return await runner(story(path), folder, timeout=60).async_execute()
            except RuntimeError:  # the kernel did not come up: another one took its port
                return await runner(story(path), folder, timeout=60).async_execute()

    async def run_all() -> list[Any]:
        return await asyncio.gather(*map(run, paths), return_exceptions=True)

    return dict(zip(paths, asyncio.run(run_all()), strict=True))


@pytest.mark.filterwarnings("ignore:Proactor event loop:RuntimeWarning")
@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_runs_without_errors_or_warnings(path: Path, runs: Any) -> None:
    notebook = runs[path]
    if isinstance(notebook, BaseException):
        raise notebook
    for cell in notebook.cells:
        said = json.dumps(cell.get("outputs", []), ensure_ascii=False)
        for output in cell.get("outputs", []):
            assert output.get("name") != "stderr", f"{cell.id} warns: {output.text}"
        assert "check itself failed" not in said
        if cell.cell_type == "code" and list(builds.checks(cell)):
            solved = "solution" in cell.metadata.get("tags", [])
            assert ("passes every check" if solved else "Not yet") in said, f"{cell.id}: {said}"


def revealed(cell: Any) -> dict[str, str]:
    """{key: what was computed} of the predictions that a cell reveals, but for the time it took."""
    keys = re.findall(r'reveal\(\s*"([^"]+)"', cell.source)
    said = "".join(output.get("data", {}).get("text/plain", "") for output in cell.outputs)
    found = dict(zip(keys, re.findall(r"Computed: (.*)\.\n", said), strict=True))
    return {key: answer for key, answer in found.items() if not key.endswith(".time")}


@pytest.mark.filterwarnings("ignore:Proactor event loop:RuntimeWarning")
@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_what_is_revealed_does_not_hang_on_the_last_bit(path: Path, runs: Any) -> None:
    notebook = runs[path]
    if isinstance(notebook, BaseException):
        raise notebook
    cells = {cell.id: cell for cell in notebook.cells if "reveal(" in cell.source}
    here = [id for id in cells if f"{id}-solved" in cells]
    assert here
    for id in here:
        assert revealed(cells[id]) == revealed(cells[f"{id}-solved"])


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_is_committed_clean_and_short(path: Path) -> None:
    notebook = nbformat.read(path, as_version=4)
    code = [cell for cell in notebook.cells if cell.cell_type == "code"]
    prose = " ".join(cell.source for cell in notebook.cells if cell.cell_type == "markdown")
    assert not any(cell.outputs or cell.execution_count for cell in code)
    assert len(code) <= 15
    assert max(len(cell.source.splitlines()) for cell in code) <= 10
    assert len(prose.split()) <= 1200
    assert not any("solution" in cell.metadata.get("tags", []) for cell in notebook.cells)


def names(source: str, context: type[ast.expr_context]) -> set[str]:
    """The names that a cell reads (ast.Load), or that it makes (ast.Store)."""
    nodes = [*ast.walk(ast.parse(source))]
    found = {n.id for n in nodes if isinstance(n, ast.Name) and isinstance(n.ctx, context)}
    if context is ast.Store:
        found |= {n.name for n in nodes if isinstance(n, ast.FunctionDef | ast.ClassDef)}
        found |= {n.arg for n in nodes if isinstance(n, ast.arg)}
        found |= {
            (alias.asname or alias.name).partition(".")[0]
            for n in nodes
            if isinstance(n, ast.Import | ast.ImportFrom)
            for alias in n.names
        }
    return found


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_cell_and_a_solution_use_only_what_was_made_before(path: Path) -> None:
    made = {*dir(builtins), "display"}
    for cell in builds.with_solutions(nbformat.read(path, as_version=4)).cells:
        if cell.cell_type == "code":
            made |= names(cell.source, ast.Store)
            missing = names(cell.source, ast.Load) - made
            assert not missing, f"{cell.id} uses {missing}"


def calls(path: Path, name: str) -> list[ast.Call]:
    """The calls of that function in a notebook."""
    cells = nbformat.read(path, as_version=4).cells
    trees = [ast.parse(cell.source) for cell in cells if cell.cell_type == "code"]
    return [
        node
        for tree in trees
        for node in ast.walk(tree)
        if isinstance(node, ast.Call) and getattr(node.func, "id", "") == name
    ]


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_every_prediction_is_revealed(path: Path) -> None:
    asked, shown = (
        [ast.literal_eval(call.args[0]) for call in calls(path, name)]
        for name in ("predict", "reveal")
    )
    assert set(asked) == set(shown)
    assert len(asked) == len(set(asked))
    assert all(key.startswith(path.stem.partition("_")[0] + ".") for key in asked)
