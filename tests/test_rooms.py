"""The floors of the house: a room imports only from floors below its own."""

import ast
import subprocess
import sys
from pathlib import Path

import pytest

import ikteach

PACKAGE = Path(ikteach.__file__).parent
MODULES = sorted(
    path.relative_to(PACKAGE)
    for path in PACKAGE.rglob("*.py")
    if path.relative_to(PACKAGE).parts[0] != "notebooks"
)

TOOLS = {"arrays", "checks", "files", "markup", "names"}  # what every room may use, and each other
FLOORS = [  # from the ground up; rooms of one floor do not know each other
    TOOLS,
    {"body", "solvers"},
    {"motion"},
    {"motion.paths"},
    {"motion.live", "motion.reach"},
    {"formats", "study"},
    {"view.stage", "view.widgets"},
    {"view.raster", "view.charts"},
    {"view.webgl"},
    {"view.live"},
    {"view.tools"},
    {"view.chapters"},
    {"course"},
    {"publish"},
    {"serve"},
    {"__main__"},
]
FLOOR = {room: level for level, rooms in enumerate(FLOORS) for room in rooms}
DOORS = {  # what stands in front of several rooms, and the highest floor that it opens
    "__init__": FLOOR["motion"],
    "motion.__init__": FLOOR["motion.live"],
    "view.__init__": FLOOR["view.chapters"],
}
MOST = 15  # modules in one folder

SCREEN = {"matplotlib", "ipywidgets", "pythreejs", "anywidget", "traitlets", "IPython"}
HEAVY = ["pandas", "matplotlib", "ipywidgets", "pythreejs", "anywidget", "traitlets"]
OTHERS = {  # what a room may import from elsewhere, beside numpy and the standard library
    "formats": {"av", "pygltflib"},
    "study": {"pandas"},
    "view": SCREEN | {"pandas", "PIL"},
    "course": SCREEN | {"pandas"},
    "publish": {"nbformat", "nbclient", "nbconvert", "latex2mathml", "pygments", "pandas"}
    | {"IPython", "docutils", "hatchling", "jupyter_core", "packaging", "sphinx"},
    "serve": {"voila", "tornado", "traitlets", "jupyter_client", "jupyter_core"}
    | {"jupyter_server", "jupyterlab_server", "ipykernel"},
}


def imports(module, at_top_only=False):
    """The dotted names that a module imports; a name of a package that is a module counts as it."""
    tree = ast.parse((PACKAGE / module).read_text(encoding="utf-8"))
    for node in tree.body if at_top_only else ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{module} has a relative import"
            for alias in node.names:
                inner = f"{node.module}.{alias.name}"
                yield inner if is_ours(inner) else node.module


def is_ours(dotted):
    """Whether this is a module or a folder of the package."""
    path = PACKAGE.joinpath(*dotted.split(".")[1:])
    return dotted.startswith("ikteach.") and (path.with_suffix(".py").is_file() or path.is_dir())


def room(dotted):
    """The room of a module of the package: `view.stage`, `course`, `arrays`."""
    first, *rest = dotted.split(".")
    # A folder of `motion` is a room of its own, and so is all that stands in `view`.
    inner = first == "view" or (
        first == "motion" and (PACKAGE / first / "".join(rest[:1])).is_dir()
    )
    return f"{first}.{rest[0]}" if rest and inner else first


@pytest.mark.parametrize("module", MODULES, ids=str)
def test_a_room_imports_only_from_below(module):
    here = ".".join(module.with_suffix("").parts)
    level = DOORS.get(here, FLOOR.get(room(here)))
    assert level is not None, f"{module} is in no room: give it one in FLOORS"
    for name in imports(module):
        if name.split(".")[0] != "ikteach":
            continue
        there = room(name.removeprefix("ikteach").removeprefix(".") or "__init__")
        below = there == room(here) or {there, here} <= TOOLS
        below |= FLOOR.get(there, DOORS.get(there, 0)) < level
        assert below or here in DOORS, f"{module} imports {name}, which is not below {room(here)}"
        assert FLOOR.get(there, 0) <= level, f"{module} imports {name}, which is above it"


@pytest.mark.parametrize("module", MODULES, ids=str)
def test_only_numpy_on_the_ground_pandas_in_study_and_screens_on_top(module):
    here = module.parts[0].removesuffix(".py")
    others = {name.split(".")[0] for name in imports(module, at_top_only=here == "__main__")}
    others -= {"ikteach", "numpy"} | sys.stdlib_module_names
    assert others <= OTHERS.get(here, set()), f"{module} imports {others}"


def test_no_folder_is_crowded():
    folders = [path for path in PACKAGE.rglob("*") if path.is_dir() and path.name != "__pycache__"]
    sizes = {str(folder.relative_to(PACKAGE)): len(list(folder.glob("*.py"))) for folder in folders}
    assert {folder for folder, size in sizes.items() if size > MOST + 1} == set()


def test_the_figure_of_a_chapter_is_found_by_the_name_of_the_chapter():
    notebooks = PACKAGE.parent / "notebooks"
    for notebook in notebooks.glob("[0-9]*.ipynb"):
        chapter = notebook.stem.split("_", 1)[1]
        assert is_ours(f"ikteach.view.chapters.{chapter}"), f"{chapter} has no figure of its name"


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
