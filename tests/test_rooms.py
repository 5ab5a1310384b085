"""A room imports only from rooms below it, and the ground needs numpy alone."""

import ast
import subprocess
import sys
from pathlib import Path

import pytest

import ikteach

PACKAGE = Path(ikteach.__file__).parent
MODULES = sorted(path.relative_to(PACKAGE) for path in PACKAGE.rglob("*.py"))

TOOLS = {"arrays", "checks", "files", "markup", "names"}  # what every room may use
BELOW = {  # what each room may import of the package
    "arrays": set(),
    "checks": TOOLS,
    "files": TOOLS,
    "names": TOOLS,
    "markup": TOOLS,
    "server": set(),
    "body": TOOLS,
    "solvers": TOOLS,
    "motion": TOOLS | {"body", "solvers"},
    "study": TOOLS | {"body", "solvers", "motion"},
    "trials": TOOLS | {"body", "solvers", "motion", "study"},
    "formats": TOOLS | {"body", "solvers", "motion"},
}
EVERYTHING = BELOW.keys() | {"", "view", "course"}
TOP = {"view", "course", "__main__"}
SCREEN = {"matplotlib", "ipywidgets", "pythreejs", "anywidget", "traitlets", "IPython"}
PAGES = {"nbformat", "nbclient", "nbconvert", "latex2mathml", "pygments"}
SERVER = {"voila", "tornado", "jupyter_client", "jupyter_server", "jupyterlab_server", "ipykernel"}
SITE = {"hatchling", "jupyter_core", "packaging"}
HEAVY = ["pandas", "matplotlib", "ipywidgets", "pythreejs", "anywidget", "traitlets"]


def imports(module, at_top_only=False):
    """The dotted names that a module imports."""
    tree = ast.parse((PACKAGE / module).read_text())
    for node in tree.body if at_top_only else ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{module} has a relative import"
            # `from ikteach import study` imports a room, `from ikteach import dls` does not.
            yield node.module
            if node.module == "ikteach":
                yield from (f"ikteach.{a.name}" for a in node.names if a.name in EVERYTHING)


def room(module):
    return module.parts[0].removesuffix(".py")


@pytest.mark.parametrize("module", MODULES, ids=str)
def test_a_room_imports_only_from_below(module):
    here = room(module)
    ours = {name.split(".")[1] if "." in name else "" for name in imports(module)
            if name.split(".")[0] == "ikteach"}  # fmt: skip
    if here == "__init__":
        allowed = {"body", "solvers", "motion"}
    else:
        allowed = EVERYTHING if here in TOP else BELOW[here] | {here}
    assert ours <= allowed, f"{module} imports {ours - allowed}"


@pytest.mark.parametrize("module", MODULES, ids=str)
def test_only_numpy_on_the_ground_pandas_in_study_and_screens_on_top(module):
    here = room(module)
    others = {name.split(".")[0] for name in imports(module)}
    others -= {"ikteach", "numpy"} | sys.stdlib_module_names
    if here in ("view", "formats"):
        return
    rooms = {
        "study": {"pandas"},
        "trials": {"pandas"},
        "course": SCREEN | PAGES | SERVER | SITE | {"pandas"},
        "server": {"jupyter_server"},
    }
    allowed = rooms.get(here, set())
    if here == "__main__":
        others = {name.split(".")[0] for name in imports(module, at_top_only=True)}
        others -= {"ikteach"} | sys.stdlib_module_names
    assert others <= allowed, f"{module} imports {others - allowed}"


def test_the_package_is_imported_without_tables_and_screens():
    program = f"import sys, ikteach; print([m for m in {HEAVY} if m in sys.modules])"
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    )
    assert done.stdout.strip() == "[]"


def test_what_the_package_offers_is_there():
    assert len(set(ikteach.__all__)) == len(ikteach.__all__)
    for name in ikteach.__all__:
        assert hasattr(ikteach, name)
