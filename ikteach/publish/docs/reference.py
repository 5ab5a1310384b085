"""The reference: a page for each room with public names, made of what the rooms offer."""

import inspect
from collections.abc import Collection
from importlib import import_module

ROOMS = [  # after the package itself, whose names are not told again
    "body",
    "solvers",
    "motion",
    "study",
    "formats",
    "course",
    "view",
]
FORMATS = [  # which is used by its modules
    "bvh.Recording",
    "bvh.read_bvh",
    "bvh.recorded_walk",
    "bvh.write_bvh",
    "gltf.write_glb",
    "movie.facts",
    "movie.read",
    "movie.write",
    "movie.writing",
    "session.load",
    "session.save",
    "urdf.Robot",
    "urdf.read_urdf",
]


def reference() -> dict[str, str]:
    """Write the pages of the reference: {file name: text}."""
    package = import_module("ikteach")
    told = set(package.__all__)
    pages = {"ikteach": of_room("ikteach", package.__all__)}
    for room in ROOMS:
        names = FORMATS if room == "formats" else import_module(f"ikteach.{room}").__all__
        pages[room] = of_room(f"ikteach.{room}", names, told)
    return pages


def of_room(module: str, names: list[str], told: Collection[str] = ()) -> str:
    """Write the page of one module: a table, then each name.

    told  names that have their places on the page of the package, to which the table leads
    """
    lines = [module, "=" * len(module), "", f".. automodule:: {module}", ""]
    lines += [f".. currentmodule:: {module}", "", ".. autosummary::", "   :nosignatures:", ""]
    lines += [f"   ~ikteach.{name}" if name in told else f"   {name}" for name in names]
    for name in (name for name in names if name not in told):
        lines += ["", *of_name(module, name)]
    return "\n".join([*lines, ""])


def of_name(module: str, name: str) -> list[str]:
    """Write the entry of one public name."""
    *inner, last = name.split(".")
    it = getattr(import_module(".".join([module, *inner])), last)
    if inspect.ismodule(it):
        title = it.__name__
        return [title, "-" * len(title), "", f".. automodule:: {title}", "   :members:", ""]
    kind = "class" if inspect.isclass(it) else "function" if callable(it) else "data"
    options = {"class": ["   :members:"], "data": ["   :no-value:"], "function": []}[kind]
    return [f".. auto{kind}:: {module}.{name}", *options]
