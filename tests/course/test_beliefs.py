"""Each wrong belief of TEACHING.md is committed to, and then fails in a cell that computes."""

import ast
import re
from pathlib import Path
from typing import Any

import nbformat
import pytest

ROOT = Path(__file__).parents[2]
TEACHING = (ROOT / "TEACHING.md").read_text("utf-8")
NOTEBOOKS = sorted((ROOT / "notebooks").glob("*.ipynb"))
ROW = re.compile(r"^\| (.+) \| `(\S+)` \| `(\S+)` \|$", re.MULTILINE)
BELIEFS = ROW.findall(TEACHING.partition("## Wrong beliefs")[2].partition("\n## ")[0])


def code_of(path: Path) -> list[Any]:
    return [c for c in nbformat.read(path, as_version=4).cells if c.cell_type == "code"]


def chapter(key: str) -> Path:
    (path,) = (p for p in NOTEBOOKS if p.stem.partition("_")[0] == key.partition(".")[0])
    return path


def calls(cell: Any, name: str) -> dict[str, ast.Call]:
    """The calls of `predict` or `reveal` in a cell, by key."""
    nodes = (node for node in ast.walk(ast.parse(cell.source)) if isinstance(node, ast.Call))
    named = (node for node in nodes if getattr(node.func, "id", "") == name)
    return {ast.literal_eval(node.args[0]): node for node in named}


def definitions(cells: list[Any]) -> dict[str, list[ast.AST]]:
    """What each name of these cells was made of."""
    found: dict[str, list[ast.AST]] = {}
    for node in (n for cell in cells for n in ast.walk(ast.parse(cell.source))):
        match node:
            case ast.Assign(targets=targets, value=value):
                made = targets
            case ast.AugAssign(target=target, value=value):
                made = [target]
            case ast.For(target=target, iter=value):
                made = [target]
            case ast.Call(func=ast.Attribute(value=target, attr="append"), args=[value]):
                made = [target]
            case _:
                continue
        for name in (n for each in made for n in ast.walk(each) if isinstance(n, ast.Name)):
            found.setdefault(name.id, []).append(value)
    return found


def computed(answer: ast.AST, cells: list[Any]) -> set[str]:
    """The package's and numpy's functions that an answer hangs on, through all its names."""
    made, waiting, seen = definitions(cells), [answer], set[str]()
    called = set[str]()
    while waiting:
        for node in ast.walk(waiting.pop()):
            if isinstance(node, ast.Call):
                called.add(ast.unparse(node.func))
            if isinstance(node, ast.Name) and node.id not in seen:
                seen.add(node.id)
                waiting += made.get(node.id, [])
    return called


def test_the_list_is_whole() -> None:
    assert len(BELIEFS) >= 18
    assert len({belief for belief, *_ in BELIEFS}) == len(BELIEFS)


@pytest.mark.parametrize(("belief", "key", "where"), BELIEFS, ids=[key for _, key, _ in BELIEFS])
def test_a_belief_is_committed_to_and_then_fails(belief: str, key: str, where: str) -> None:
    cells = code_of(chapter(key))
    asked = [i for i, cell in enumerate(cells) if key in calls(cell, "predict")]
    shown = [i for i, cell in enumerate(cells) if key in calls(cell, "reveal")]
    assert len(asked) == len(shown) == 1
    assert asked < shown
    cell = cells[shown[0]]
    assert cell.id == where
    answer = calls(cell, "reveal")[key].args[1]
    assert not isinstance(answer, ast.Constant)
    assert computed(answer, cells[: shown[0] + 1]) - {"zip", "dict", "int", "len", "list", "abs"}


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_what_computes_an_answer_is_folded(path: Path) -> None:
    for cell in code_of(path):
        if calls(cell, "reveal"):
            assert cell.metadata.get("jupyter", {}).get("source_hidden"), cell.id
            assert "hide-input" in cell.metadata.get("tags", []), cell.id


def test_a_literal_answer_would_be_found() -> None:
    cells = [nbformat.v4.new_code_cell('a = "yes"\nb = a\nc = np.dot(x, y)\nd = {k: c for k in b}')]
    assert computed(ast.parse("b").body[0], cells) == set()
    assert computed(ast.parse("d['k']").body[0], cells) == {"np.dot"}


def table(text: str) -> list[str]:
    return re.findall(r"^\| letter .*(?:\n\|.*)+", text, re.MULTILINE)


def test_there_is_one_table_of_letters() -> None:
    book = nbformat.read(ROOT / "notebooks" / "prerequisites.ipynb", as_version=4)
    (ours,) = table("\n".join(cell.source for cell in book.cells))
    assert table(TEACHING) == [ours]
    letters = [
        letter.strip()
        for row in ours.splitlines()[2:]
        for letter in re.split(r",(?![^()]*\))", row.split("|")[1])
    ]
    assert len(letters) == len(set(letters)) > 30


FORMULA = re.compile(r"\$\$(.+?)\$\$|\$(.+?)\$", re.DOTALL)
ELSEWHERE = {  # formulas whose letter means something else in another chapter
    r"\\varphi": {"06"},
    r"\\psi": {"01"},
    r"\\rho": {"10"},
    r"\\tau": {"07", "09"},
    r"\\mu": {"07"},
    r"\\alpha": {"03"},
    r"\\gamma": {"06"},
    r"\bw\b": {"10"},
    r"(?<![\^}A-Z])\bT\b": set[str](),
    r"\bs_j\b": set[str](),
}


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_letter_has_one_meaning_in_formulas(path: Path) -> None:
    number = path.stem.partition("_")[0]
    cells = nbformat.read(path, as_version=4).cells
    prose = "\n".join(
        cell.source
        for cell in cells
        if cell.cell_type == "markdown"
        and cell.id != "notation"
        and "Read critically" not in cell.source
    )
    formulas = " ".join(map("".join, FORMULA.findall(prose)))
    for letter, homes in ELSEWHERE.items():
        if number not in homes:
            assert not re.search(letter, formulas), f"{letter} in {path.stem}"
