"""Every notebook, in both builds, runs in a fresh kernel, forwards and then backwards, cleanly."""

import ast
import copy
import json
import os
from collections.abc import Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from typing import Any

import nbformat
import pytest
from nbclient import NotebookClient

from ikteach.course import builds

NOTEBOOKS = sorted((Path(__file__).parents[1] / "notebooks").glob("*.ipynb"))
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")


def test_there_are_notebooks() -> None:
    assert NOTEBOOKS


def run(path: Path, build: str, folder: Path) -> Any:
    """The notebook of that build, run; a student's is run once more from its end to its start."""
    notebook = builds.clean(nbformat.read(path, as_version=4))
    if build == "instructor":
        notebook = builds.with_solutions(notebook)
    else:
        again = copy.deepcopy([c for c in notebook.cells if c.cell_type == "code"])
        for cell in again:
            cell.id += "-again"
        notebook.cells += again[::-1]
    resources = {"metadata": {"path": str(folder)}}
    NotebookClient(notebook, timeout=60, resources=resources).execute()
    return notebook


@pytest.fixture(scope="module")
def runs(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[dict[tuple[Path, str], Future[Any]]]:
    """What is asked for of each notebook and build, run two at a time."""
    wanted = [item.callspec.params for item in request.session.items if hasattr(item, "callspec")]
    pairs = dict.fromkeys((p["path"], p["build"]) for p in wanted if {"path", "build"} <= set(p))
    with ThreadPoolExecutor(2) as pool:
        yield {pair: pool.submit(run, *pair, tmp_path_factory.mktemp("run")) for pair in pairs}


@pytest.mark.filterwarnings("ignore:Proactor event loop:RuntimeWarning")
@pytest.mark.parametrize("build", ["student", "instructor"])
@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_runs_without_errors_or_warnings(path: Path, build: str, runs: Any) -> None:
    notebook = runs[path, build].result()
    for cell in notebook.cells:
        said = json.dumps(cell.get("outputs", []), ensure_ascii=False)
        for output in cell.get("outputs", []):
            assert output.get("name") != "stderr", f"{cell.id} warns: {output.text}"
        assert "check itself failed" not in said
        if cell.cell_type == "code" and list(builds.checks(cell)):
            solved = "solution" in cell.metadata.get("tags", [])
            assert ("passes every check" if solved else "Not yet") in said, f"{cell.id}: {said}"


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
    assert all(key.startswith(path.name[:2] + ".") for key in asked)
