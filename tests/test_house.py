"""The house's laws that can be counted: how large a thing may be, and one name for each."""

import ast
import re
from collections import defaultdict
from pathlib import Path

import pytest

import ikteach

PACKAGE = Path(ikteach.__file__).parent
ROOT = PACKAGE.parent
MODULES = sorted(path.relative_to(PACKAGE) for path in PACKAGE.rglob("*.py"))
TASKS = {"exercises", "solutions"}  # whose names are those of the notebooks
LONGEST = {ast.ClassDef: 250, ast.FunctionDef: 50, ast.AsyncFunctionDef: 50}  # lines
SKIPS = 10  # `# fmt: skip` in all
SUMMARY = 10  # words of a docstring's first line
SHARED = {"main"}  # of each command


def definitions(module):
    return ast.walk(ast.parse((PACKAGE / module).read_text(encoding="utf-8")))


@pytest.mark.parametrize("module", MODULES, ids=str)
def test_no_class_and_no_function_is_too_long(module):
    for node in definitions(module):
        if (most := LONGEST.get(type(node))) is not None:
            lines = node.end_lineno - node.lineno + 1
            assert lines <= most, f"{node.name} in {module} has {lines} lines"


@pytest.mark.parametrize("module", MODULES, ids=str)
def test_a_docstring_begins_with_few_words(module):
    documented = ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef
    for node in definitions(module):
        if isinstance(node, documented) and (text := ast.get_docstring(node)):
            first = text.splitlines()[0]
            words = len(re.sub(r"\([^()]*\)|\[[^\[\]]*\]", "", first).split())  # shapes, units
            assert words <= SUMMARY, f"{module}: {first}"


def test_a_class_or_function_has_a_name_of_its_own():
    named = defaultdict(list)
    for module in MODULES:
        if TASKS.isdisjoint(module.parts):
            for node in ast.parse((PACKAGE / module).read_text(encoding="utf-8")).body:
                if isinstance(node, ast.ClassDef | ast.FunctionDef) and node.name[0] != "_":
                    named[node.name].append(str(module))
    twice = {name: where for name, where in named.items() if len(where) > 1}
    assert {name: where for name, where in twice.items() if name not in SHARED} == {}


def test_a_constant_is_defined_once():
    """One value under one name in two modules is one constant, defined twice."""
    known = defaultdict(list)
    for module in MODULES:
        for node in ast.parse((PACKAGE / module).read_text(encoding="utf-8")).body:
            if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name):
                if (name := node.targets[0].id).isupper():
                    known[name, ast.unparse(node.value)].append(str(module))
    assert {one: where for one, where in known.items() if len(where) > 1} == {}


def test_the_formatter_is_followed():
    sources = [
        path for room in ("ikteach", "tests", "binder") for path in (ROOT / room).rglob("*.py")
    ]
    marks = [
        path.name
        for path in sources
        for _ in re.findall(r"# fmt: (?:skip|off)\n", path.read_text("utf-8"))
    ]
    assert len(marks) <= SKIPS, f"{len(marks)} in {sorted(set(marks))}"
