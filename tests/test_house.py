"""The house's laws that can be counted: how large a thing may be, and one name for each."""

import ast
import re
from collections import defaultdict
from pathlib import Path

import pytest

import ikteach

PACKAGE = Path(ikteach.__file__).parent
MODULES = sorted(path.relative_to(PACKAGE) for path in PACKAGE.rglob("*.py"))
TASKS = {"exercises", "solutions", "quizzes"}  # whose names and words are those of the notebooks
OURS = [module for module in MODULES if TASKS.isdisjoint(module.parts)]

LONGEST = {ast.ClassDef: 250, ast.FunctionDef: 50, ast.AsyncFunctionDef: 50}  # lines
DOCUMENTED = ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef
WORDS = 10  # of the first line of a docstring
SKIPS = 10  # `# fmt: skip` in the package
SHARED = {  # names that several modules may have, with one meaning
    "main",  # of each command
    "by_differences",  # J in two ways to check it by: of any body, and of a package of chapter 10;
    "by_hand",  # the notebooks import them from both modules
}


def parsed(module):
    return ast.parse((PACKAGE / module).read_text(encoding="utf-8"))


def length(node):
    """Lines of a class; of a function without its docstring, as shapes and sources are wanted."""
    lines = node.end_lineno - node.lineno + 1
    if isinstance(node, ast.ClassDef) or ast.get_docstring(node) is None:
        return lines
    docstring = node.body[0]
    return lines - (docstring.end_lineno - docstring.lineno + 1)


@pytest.mark.parametrize("module", MODULES, ids=str)
def test_no_class_and_no_function_is_too_long(module):
    for node in ast.walk(parsed(module)):
        if (most := LONGEST.get(type(node))) is not None:
            assert (lines := length(node)) <= most, f"{node.name} in {module} has {lines} lines"


@pytest.mark.parametrize("module", MODULES, ids=str)
def test_no_half_of_a_sentence_is_left_on_a_line_of_its_own(module):
    for node in ast.walk(parsed(module)):
        lost = isinstance(node, ast.Expr) and isinstance(node.value, ast.JoinedStr)
        assert not lost, f"{module}:{node.lineno} makes a text that nobody gets"


@pytest.mark.parametrize("module", OURS, ids=str)
def test_a_docstring_begins_with_few_words(module):
    for node in ast.walk(parsed(module)):
        if not isinstance(node, DOCUMENTED) or node.name.startswith("_"):
            continue
        first = (ast.get_docstring(node) or "").partition("\n")[0]
        prose = re.sub(r"\([^()]*\)|\[[^\[\]]*\]|`[^`]*`", "", first)  # without shapes, units, code
        words = re.findall(r"[^\W\d_]{2,}", prose)
        assert len(words) <= WORDS, f"{module}: {first}"


def test_a_class_or_function_has_a_name_of_its_own():
    known = defaultdict(list)
    for module in OURS:
        for node in parsed(module).body:
            if isinstance(node, DOCUMENTED) and not node.name.startswith("_"):
                known[node.name].append(str(module))
    twice = {name: modules for name, modules in known.items() if len(modules) > 1}
    assert {name: modules for name, modules in twice.items() if name not in SHARED} == {}


def test_a_constant_is_defined_once():
    """One value under one name in two modules is one constant, defined twice."""
    known = defaultdict(list)
    for module in OURS:
        for node in parsed(module).body:
            if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]).isupper():
                known[ast.unparse(node)].append(str(module))
    assert {one: modules for one, modules in known.items() if len(modules) > 1} == {}


def test_no_merge_is_left_half_done():
    """In no text of ours, whatever its kind: a mark of git stands at the beginning of a line."""
    kinds = {".css", ".html", ".ipynb", ".js", ".json", ".md", ".py", ".toml", ".txt", ".yml"}
    ours = [PACKAGE, PACKAGE.parent / "notebooks", PACKAGE.parent / "tests"]
    texts = [path for folder in ours for path in folder.rglob("*") if path.suffix in kinds]
    texts += PACKAGE.parent.glob("*.*")
    marked = re.compile(r"^ *\"?(?:<{7}|>{7}) ", re.MULTILINE)
    written = [p for p in texts if p.is_file() and "node_modules" not in p.parts]
    assert [str(p) for p in written if marked.search(p.read_text("utf-8", "replace"))] == []


def test_the_formatter_is_followed():
    counts = {
        str(module): len(
            re.findall(r"# fmt: (?:skip|off)\n", (PACKAGE / module).read_text("utf-8"))
        )
        for module in MODULES
    }
    assert sum(counts.values()) <= SKIPS, {name: count for name, count in counts.items() if count}
