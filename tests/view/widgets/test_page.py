"""Scripts and styles of widgets: how the modules of the package become one text."""

import ast
import re
from importlib import import_module
from pathlib import Path

import anywidget
import pytest

import ikteach
from ikteach.view.widgets import page

PACKAGE = Path(ikteach.__file__).parent
for path in PACKAGE.rglob("*.py"):
    if "_esm" in path.read_text("utf-8"):
        import_module(".".join(["ikteach", *path.relative_to(PACKAGE).with_suffix("").parts]))
OURS = [one for one in anywidget.AnyWidget.__subclasses__() if one.__module__[:7] == "ikteach"]


@pytest.fixture
def write(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """Write modules {name: source} into a package of their own."""
    monkeypatch.setattr(page, "PACKAGE", tmp_path)

    def write(**modules: str) -> None:
        page.script.cache_clear()
        for name, source in modules.items():
            (tmp_path / f"{name}.js").write_text(source)

    yield write
    page.script.cache_clear()


def test_each_module_stands_once_and_before_those_that_import_it(write) -> None:
    write(
        a="export const one = 1;\nconst own = 2;\n",
        b='import { one } from "./a.js";\nexport function two() {\n  return 2 * one;\n}\n',
        c='import { one } from "./a.js";\nimport {\n  two,\n} from "./b.js";\nconst own = one;\n'
        "export default { two, own };\n",
    )
    text = page.script("c.js")
    assert re.findall(r"const (\w+) = \(\(\) =>", text) == ["a_js", "b_js", "c_js"]
    assert text.count("export") == 1
    assert text.endswith("export default c_js.main;\n")
    assert "const { one } = a_js;" in text


@pytest.mark.parametrize(
    "source",
    [
        'import * as b from "./b.js";', 'import b from "./b.js";', 'import { b } from "b";',
        'import { b as c } from "./b.js";', 'import "./b.js";', "const b = await import('./b.js');",
        'export { b } from "./b.js";', "export * from './b.js';", "export let b = 1;",
        "const url = import.meta.url;",
    ],
)  # fmt: skip
def test_what_cannot_be_joined_is_refused_by_name(write, source: str) -> None:
    write(a=f"{source}\nexport default 1;\n", b="export const b = 1;\n")
    with pytest.raises(ValueError, match=r"a\.js cannot be joined: (import|export|const)"):
        page.script("a.js")


def test_modules_in_a_circle_and_modules_that_are_not_there_are_refused(write) -> None:
    write(
        a='import { b } from "./b.js";\nexport const a = b;\n',
        b='import { a } from "./a.js";\nexport const b = a;\n',
        c='import { d } from "./d.js";\n',
    )
    with pytest.raises(ValueError, match=r"circle: a\.js > b\.js > a\.js"):
        page.script("a.js")
    with pytest.raises(FileNotFoundError, match=r"d\.js"):
        page.script("c.js")


@pytest.mark.parametrize("kind", OURS, ids=lambda kind: kind.__name__)
def test_every_widget_has_its_script_and_the_style_that_all_share(kind: type) -> None:
    assert "render: guarded(render)" in kind._esm
    assert ".ikteach-failed" in kind._css


def test_every_module_comes_into_some_page() -> None:
    joined = "".join(kind._esm for kind in OURS) + page.script("serve/classroom/page.js")
    alone = PACKAGE / "publish" / "pack" / "slides.js"  # in pages that are read without us
    for path in {*PACKAGE.rglob("*.js")} - {alone}:
        name = path.relative_to(PACKAGE).as_posix().replace("/", "_").replace(".", "_")
        assert f"const {name} = (() => {{" in joined


def test_no_script_or_style_stands_in_a_string_of_python() -> None:
    foreign = re.compile(r"<style>\s*\w|<script>|addEventListener|document\.|\{\s*[a-z-]+:[^{}]*;")
    for path in (PACKAGE / "view").rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if isinstance(node, ast.Constant) and isinstance(node.value, str):
                assert not foreign.search(node.value), f"{path.name}:{node.lineno}"
