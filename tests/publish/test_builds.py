"""The builds: students get no solutions, instructors get them folded, pages need no network."""

import json
import re
from pathlib import Path
from typing import Any

import nbformat
import pytest

from ikteach import __main__ as cli
from ikteach.publish import builds
from ikteach.publish.delivery import MANIFEST
from tests.browser.conftest import open_browser

ROOT = Path(__file__).parents[2]


def code(source: str, **metadata: Any) -> Any:
    return nbformat.v4.new_code_cell(source, metadata=metadata)


@pytest.fixture
def clone(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A clone with one small chapter and the solution of its exercise."""
    notebooks = tmp_path / "clone" / "notebooks"
    (notebooks / "pictures").mkdir(parents=True)
    (notebooks / "pictures" / "a.png").write_bytes(b"png")
    (notebooks / "predictions.json").write_text("{}")
    (tmp_path / "clone" / "pyproject.toml").touch()
    cells = [
        nbformat.v4.new_markdown_cell(
            "# 0 · Figure\n\nWith $e = t - s$:\n\n$$\\Delta\\theta = J^\\top e_i$$\n\n> a *box*"
        ),
        code(
            "from ikteach.course import check, predict\n\n"
            "predict('00.x', 'Which?', ['this & that', 'other'])"
        ),
        code("def hand(t, a): ...\n\n\ncheck('00.hand', hand)"),
        code("secret = 1", tags=["solution"]),
        code(
            "from ikteach.view.widgets.picture import Still\n\n"
            "Still(bytes.fromhex('89504e470d0a1a0a'), 'a <picture>')"
        ),
        code(
            "class Live:\n    def _repr_mimebundle_(self, **_):\n"
            "        return {'application/vnd.jupyter.widget-view+json': {'model_id': 'x'},\n"
            "                'image/png': 'iVBORw0KGgo=', 'text/plain': 'A \"live\" figure.'}\n\n"
            "Live()"
        ),
    ]
    notebook = nbformat.v4.new_notebook(cells=cells)
    notebook.cells[1].outputs = [nbformat.v4.new_output("stream", text="old")]
    nbformat.write(notebook, notebooks / "00_figure.ipynb")

    monkeypatch.setattr(builds, "find_course", lambda: builds_course(notebooks))
    monkeypatch.setattr(builds, "solution", lambda key: SOLUTIONS[key])
    monkeypatch.chdir(tmp_path)
    return notebooks


def builds_course(notebooks: Path) -> Any:
    from ikteach.publish.delivery import CourseFolder

    return CourseFolder(notebooks, clone=True)


SOLUTIONS = {"00.hand": "def hand(t, a):\n    return a"}


def cells(path: Path) -> list[Any]:
    return nbformat.read(path, as_version=4).cells


def test_student_build(clone: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["build", "student", "out"]) == 0
    assert "copied 1 notebook" in capsys.readouterr().out
    made = sorted(p.relative_to("out").as_posix() for p in Path("out").rglob("*") if p.is_file())
    assert made == [MANIFEST, "00_figure.ipynb", "pictures/a.png"]  # nobody's answers
    built = cells(Path("out/00_figure.ipynb"))
    assert [c.source for c in built if c.source == "secret = 1"] == []
    assert not any(c.get("outputs") for c in built)
    assert not any("solution" in c.metadata.get("tags", []) for c in built)


def test_instructor_build_folds_the_solution_after_its_exercise(clone: Path) -> None:
    assert cli.main(["build", "instructor", "out"]) == 0
    built = cells(Path("out/00_figure.ipynb"))
    [at] = [i for i, c in enumerate(built) if "solution" in c.metadata.get("tags", [])]
    assert "def hand(t, a): ..." in built[at - 1].source
    assert built[at].source == 'def hand(t, a):\n    return a\n\n\ncheck("00.hand", hand)'
    assert built[at].metadata["jupyter"]["source_hidden"] is True
    assert "hide-input" in built[at].metadata["tags"]


def test_builds_never_overwrite_what_was_changed(
    clone: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    cli.main(["build", "student", "out"])
    Path("out/00_figure.ipynb").write_text("mine")
    assert cli.main(["build", "instructor", "out"]) == 0
    assert Path("out/00_figure.ipynb").read_text() == "mine"
    assert "kept yours: 00_figure.ipynb" in capsys.readouterr().out


def test_what_cannot_be_built_is_said(
    clone: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    assert cli.main(["build", "student", str(clone / "out")]) == 1
    assert "is among the notebooks themselves" in capsys.readouterr().err
    monkeypatch.undo()
    monkeypatch.chdir(clone.parent)
    with pytest.raises(LookupError, match=r"ch99\.py is missing.*clone only"):
        builds.solution("99.x")

    def missing(*_: Any) -> None:
        raise ModuleNotFoundError(name="latex2mathml")

    monkeypatch.setitem(builds.BUILDS, "html", missing)
    assert cli.main(["build", "html", "out"]) == 1
    assert "latex2mathml is not installed: pip install 'ikteach[html]'" in capsys.readouterr().err
    with pytest.raises(SystemExit):
        cli.main(["build", "pdf", "out"])
    assert "invalid choice: 'pdf'" in capsys.readouterr().err


LOADS = re.compile(
    r"""<(?:script|link|iframe|img|source|object|embed)[^>]*?(?:src|href|data)\s*=\s*["']?"""
    r"""(?!data:|[\w./-]+\.(?:png|html)["'])([^"'\s>]+)|@import|url\(\s*["']?http|"""
    r"mathjax(?!_ignore)",
    re.IGNORECASE,
)


def test_pages_ask_nothing_of_a_network(clone: Path, browser_alone: Any) -> None:
    assert cli.main(["build", "html", "out"]) == 0
    made = sorted(p.name for p in Path("out").rglob("*") if p.is_file())
    assert made == [MANIFEST, "00_figure.html", "a.png", "index.html"]
    page = Path("out/00_figure.html").read_text("utf-8")
    assert not LOADS.search(page), LOADS.search(page)
    assert LOADS.search('<script src="https://x.org/a.js">')
    assert "$" not in re.sub(r"<style>.*?</style>", "", page, flags=re.DOTALL)
    for wanted in ('alt="a &lt;picture&gt;"', "alt='A \"live\" figure.'", "Not yet"):
        assert wanted in page
    assert not re.search("<script[^>]*widget-view", page)

    view = browser_alone.new_page()
    asked: list[str] = []
    view.on("request", lambda request: asked.append(request.url))
    view.route(re.compile("^https?:"), lambda route: route.abort())
    view.goto(Path("out/index.html").absolute().as_uri())
    view.get_by_role("link", name="0 · Figure").click()
    view.wait_for_selector("math msup")
    assert view.locator("math").count() == 2
    formula = view.locator("math[display=block]").bounding_box()
    assert formula["width"] > 60
    assert view.get_by_text("this & that", exact=True).is_visible()
    assert all(url.startswith(("file:", "data:")) for url in asked)
    view.close()


@pytest.fixture
def browser_alone() -> Any:
    from playwright.sync_api import sync_playwright

    with sync_playwright() as play:
        browser = open_browser(play)
        yield browser
        browser.close()


def test_every_exercise_of_the_course_is_in_the_instructor_build(tmp_path: Path) -> None:
    builds.instructor(ROOT / "notebooks", tmp_path)
    for path in tmp_path.glob("*.ipynb"):
        built = cells(path)
        asked = [key for c in built if c.cell_type == "code" for key, _ in builds.checks(c)]
        assert all(asked.count(key) == 2 for key in asked)
        nbformat.validate(json.loads(path.read_text("utf-8")))


OPEN = [  # the cells of the chapters that ask in words, and no widget takes the answer
    (path.stem[:2], cell.id)
    for path in sorted((ROOT / "notebooks").glob("[0-9]*.ipynb"))
    for cell in nbformat.read(path, as_version=4).cells
    if cell.cell_type == "markdown"
    and re.search(r"\?", re.split(r"## Exit questions|\*\*On paper:\*\*", cell.source)[-1])
    and re.search(r"## Exit questions|\*\*On paper:\*\*|^1\. .*\?", cell.source, re.MULTILINE)
]


def test_every_open_question_has_an_answer_for_the_instructor_alone() -> None:
    assert len(OPEN) >= 9
    for path in sorted((ROOT / "notebooks").glob("*.ipynb")):
        chapter = path.stem.partition("_")[0]
        asked = [cell for number, cell in OPEN if number == chapter]
        assert sorted(builds.open_answers(chapter)) == sorted(asked), chapter
        notebook = nbformat.read(path, as_version=4)
        theirs = builds.with_solutions(builds.clean(notebook), chapter)
        ids = [cell.id for cell in theirs.cells]
        for cell in asked:
            answer = theirs.cells[ids.index(cell) + 1]
            assert answer.cell_type == "markdown"
            assert len(answer.source) > 80
        assert builds.clean(theirs).cells == builds.clean(notebook).cells
        nbformat.validate(theirs)
