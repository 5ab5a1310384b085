"""The documentation is built without a warning, leads nowhere wrong, and shows what is public."""

import os
import re
import subprocess
import sys
from importlib import import_module
from inspect import ismodule
from pathlib import Path

import pytest

from ikteach import __main__ as cli
from ikteach.publish import docs
from ikteach.publish.delivery import chapters
from ikteach.publish.docs.docstrings import restructured
from ikteach.publish.docs.links import Links, broken
from ikteach.publish.docs.reference import FORMATS, ROOMS
from ikteach.publish.parser import RefusedError

ROOT = Path(__file__).parents[2]
CODE = re.compile("<(pre|script|style)\\b.*?</\\1>", re.DOTALL)
FULL = bool(os.environ.get("IKTEACH_FULL"))  # else the notebooks are not run


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The site as its command builds it, which takes warnings and broken links for faults."""
    folder = tmp_path_factory.mktemp("docs")
    command = [sys.executable, "-m", "ikteach", "docs", str(folder), *([] if FULL else ["--fast"])]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return folder


def text(page: Path) -> str:
    return re.sub(r"<[^>]*>", "", page.read_text("utf-8"))


def test_every_chapter_is_there_to_read(site: Path) -> None:
    for name, title in chapters(ROOT / "notebooks").items():
        page = site / "course" / Path(name).with_suffix(".html")
        assert title.partition(" ")[0] in text(page)
        assert "$" not in re.sub(
            r"<pre>.*?</pre>|<script.*?</script>", "", page.read_text("utf-8"), flags=re.DOTALL
        )
    assert "<math" in (site / "course" / "05_dls.html").read_text("utf-8")
    assert (docs.STILL in text(site / "course.html")) is not FULL
    stills = len(re.findall("<img alt=", (site / "course" / "07_gait.html").read_text("utf-8")))
    assert (stills > 0) is FULL


def test_every_public_name_is_in_the_reference(site: Path) -> None:
    anchors = set().union(
        *(Links(page.read_text("utf-8")).anchors for page in (site / "api").glob("*.html"))
    )
    package = import_module("ikteach")
    for module in [package, *(import_module(f"ikteach.{room}") for room in ROOMS)]:
        for name in getattr(module, "__all__", []):
            here = module if module is package or name not in package.__all__ else package
            it = getattr(module, name)
            place = f"module-{it.__name__}" if ismodule(it) else f"{here.__name__}.{name}"
            assert place in anchors
    assert {f"ikteach.formats.{name}" for name in FORMATS} < anchors


def test_the_documents_of_the_clone_are_in_it(site: Path) -> None:
    for document, page in docs.DOCUMENTS.items():
        heading = (ROOT / document).read_text("utf-8").partition("\n")[0].removeprefix("# ")
        assert heading in text((site / page).with_suffix(".html"))
    assert "mink" in text(site / "benches.html")


def test_what_a_page_lacks_is_told(tmp_path: Path) -> None:
    (tmp_path / "a.html").write_text(
        '<h1 id="top">A</h1><a href="b.html#here"></a><a href="#top"></a><a href="a.html"></a>'
        '<a href="https://example.org"></a><img src="data:,x">'
    )
    (tmp_path / "b.html").write_text('<p id="here">B</p>')
    assert broken(tmp_path) == []
    (tmp_path / "c.html").write_text(
        '<a href="b.html#there"></a><a href="../x.html"></a><img src="gone.png">'
        '<script src="https://example.org/a.js"></script><link href="//example.org/a.css">'
    )
    assert broken(tmp_path) == [
        "c.html: ../x.html is not there",
        "c.html: //example.org/a.css is of a network",
        "c.html: b.html#there has no such place",
        "c.html: gone.png is not there",
        "c.html: https://example.org/a.js is of a network",
    ]


FAULTS = {
    "link.md": ("[nowhere](nowhere.md)", r"link\.md:3: .*'nowhere\.md'"),
    "anchor.md": ("[nowhere](#nowhere)", r"anchor\.md:3: .*'nowhere'"),
    "tree.md": ("```{toctree}\ngone\n```", r"tree\.md:3: .*'gone'"),
    "picture.md": ("![none](gone.png)", r"picture\.md:3: .*gone\.png"),
    "word.md": ("```{nothing}\n```", r"word\.md:3: .*'nothing'"),
    "lost.md": ("In no table of contents.", r"lost\.md: .*toctree"),
    "api.rst": (".. autofunction:: ikteach.nothing", "autodoc: failed to import 'nothing'"),
}


def test_every_warning_is_told_with_its_place(tmp_path: Path) -> None:
    pages = tmp_path / "pages"
    pages.mkdir()
    names = [Path(name).stem for name in FAULTS if name != "lost.md"]
    tree = "\n".join(["```{toctree}", *names, "```"])
    (pages / "index.md").write_text(f"# Title\n\n{tree}\n")
    for name, (fault, _) in FAULTS.items():
        heading = "# Title" if name.endswith("md") else "Title\n====="
        (pages / name).write_text(f"{heading}\n\n{fault}\n")
    program = (
        "import sys; from pathlib import Path; from ikteach.publish import docs;"
        "docs.compose(Path(sys.argv[1]), Path(sys.argv[2]))"
    )
    command = [sys.executable, "-c", program, pages, tmp_path / "out"]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 1
    said = done.stderr.partition("The documentation has faults:\n")[2]
    for _, words in FAULTS.values():
        assert re.search(words, said), said


def test_a_docstring_is_read_as_it_is_meant() -> None:
    made = restructured(
        [
            "Solve J* e, `x_1`s and y_.", "",
            "rate   frames a second", "       or *more*", "size   (w, h)", "",
            "    >>> no example", "",
            ">>> 1 * 1", "1",
        ]
    )  # fmt: skip
    assert made == [
        r"Solve J\* e, \ ``x_1``\ s and y\_.", "",
        "``rate``", "    frames a second", r"    or \*more\*", "``size``", "    (w, h)", "",
        "::", "", "        >>> no example", "",
        ">>> 1 * 1", "1", "",
    ]  # fmt: skip


def test_what_cannot_be_built_is_said(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(docs, "assemble", lambda *_, **__: None)

    def missing(*_: object) -> None:
        raise ModuleNotFoundError(name="furo")

    monkeypatch.setattr(docs, "compose", missing)
    assert cli.main(["docs", str(tmp_path)]) == 1
    assert "furo is not installed: pip install 'ikteach[docs]'" in capsys.readouterr().err

    def loose(sources: Path, pages: Path) -> None:
        pages.mkdir()
        (pages / "index.html").write_text('<a href="gone.html"></a>')

    monkeypatch.setattr(docs, "compose", loose)
    assert cli.main(["docs", str(tmp_path / "out")]) == 1
    assert "lead nowhere:\nindex.html: gone.html is not there" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()
    course = docs.find_course()._replace(clone=False)
    monkeypatch.setattr(docs, "find_course", lambda: course)
    with pytest.raises(RefusedError, match="built from a clone"):
        docs.main([str(tmp_path)])
