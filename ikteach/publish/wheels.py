"""Wheels for the Python in the browser: our own, and those of packages that are installed here.

A wheel is made again of what is installed, so that no registry is asked. What was compiled for this
machine stays out; a package that cannot do without it is refused.
"""

import hashlib
import re
import zipfile
from collections.abc import Iterable, Mapping
from email.parser import HeaderParser
from importlib.metadata import Distribution, PackageNotFoundError, distribution
from pathlib import Path, PurePosixPath
from typing import Any, NamedTuple

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

COMPILED = (".so", ".pyd", ".dylib")
FOR_PAGES = {"labextension", "nbextension", "static"}  # the site has their scripts already
FACTS = {"METADATA", "entry_points.txt", "top_level.txt"}  # of the .dist-info that are kept
WHEEL = "Wheel-Version: 1.0\nGenerator: ikteach\nRoot-Is-Purelib: true\nTag: py3-none-any\n"
LONG_AGO = (1980, 1, 1, 0, 0, 0)  # the same wheel each time

LockEntry = dict[str, Any]  # of a package in Pyodide's lock file


class Metadata(NamedTuple):
    """The facts that a wheel states about itself."""

    name: str
    version: str
    requires: list[Requirement]
    imports: list[str]


def own(package: Path, folder: Path) -> Path:
    """Make the wheel of ikteach itself, of clone or installed."""
    clone = package.parent
    if not (clone / "pyproject.toml").is_file():
        return again("ikteach", folder)
    from hatchling.builders.wheel import WheelBuilder

    return Path(next(iter(WheelBuilder(str(clone)).build(directory=str(folder)))))


def again(name: str, folder: Path) -> Path:
    """Make an installed package's wheel again, or raise LookupError."""
    try:
        installed = distribution(name)
    except PackageNotFoundError:
        raise LookupError(f"{name} is not installed: pip install {name}") from None
    files = _pure(installed)
    stem = f"{canonicalize_name(name).replace('-', '_')}-{installed.version}"
    facts = f"{stem}.dist-info"
    contents = {facts + "/WHEEL": WHEEL.encode()}
    for path, place in files.items():
        said = path.parts[0].endswith(".dist-info")
        contents[f"{facts}/{path.name}" if said else path.as_posix()] = place.read_bytes()
    rows = [f"{path},," for path in (*contents, f"{facts}/RECORD")]
    contents[f"{facts}/RECORD"] = "\n".join(rows).encode()
    wheel = folder / f"{stem}-py3-none-any.whl"
    with zipfile.ZipFile(wheel, "w", zipfile.ZIP_DEFLATED) as archive:
        for inside, data in contents.items():
            archive.writestr(zipfile.ZipInfo(inside, LONG_AGO), data, zipfile.ZIP_DEFLATED)
    return wheel


def _pure(installed: Distribution) -> dict[PurePosixPath, Path]:
    """Path in the wheel -> file of what a browser can use; LookupError if that is not enough."""
    name = installed.metadata["Name"]
    paths = {path: Path(str(installed.locate_file(path))) for path in installed.files or []}
    outside = {"..", "__pycache__"}
    ours = {p: f for p, f in paths.items() if not outside & set(p.parts) and f.is_file()}
    compiled = {p.with_name(p.name.partition(".")[0]) for p in ours if p.suffix in COMPILED}
    sources = {p.with_suffix("") for p in ours if p.suffix == ".py"}
    # A module made by mypyc has its source beside it, and its helper has none and needs none.
    lost = sorted(str(p) for p in compiled - sources if not p.name.endswith("__mypyc"))
    if lost:
        raise LookupError(
            f"{name} has no pure Python for {lost[0]}, and Pyodide does not bring the package."
        )
    if not sources:
        raise LookupError(
            f"{name} is installed as a link to its source; install it as a wheel: pip install ."
        )
    return {
        path: place
        for path, place in ours.items()
        if path.suffix not in COMPILED
        and (path.suffix == ".py" or not FOR_PAGES & set(path.parts[:-1]))
        and (path.name in FACTS or not path.parts[0].endswith(".dist-info"))
    }


def metadata(wheel: Path) -> Metadata:
    """Read name, version, requirements and import names of a wheel."""
    with zipfile.ZipFile(wheel) as archive:
        names = archive.namelist()
        (place,) = (n for n in names if re.fullmatch(r"[^/]+\.dist-info/METADATA", n))
        said = HeaderParser().parsestr(archive.read(place).decode())
    tops = {PurePosixPath(n).parts[0] for n in names if n.endswith(".py")}
    return Metadata(
        canonicalize_name(said["Name"]),
        said["Version"],
        [Requirement(line) for line in said.get_all("Requires-Dist", [])],
        sorted(top.removesuffix(".py") for top in tops),
    )


def lock_entry(wheel: Path) -> LockEntry:
    """Describe the wheel for Pyodide's lock file, without dependencies."""
    name, version, _, imports = metadata(wheel)
    return {
        "name": name,
        "version": version,
        "file_name": wheel.name,
        "install_dir": "site",
        "sha256": digest(wheel.read_bytes()),
        "package_type": "package",
        "imports": imports,
        "depends": [],
        "unvendored_tests": False,
    }


def lock(
    pyodide: Mapping[str, LockEntry],
    wheels: Iterable[Path],
    roots: Iterable[str],
    folder: Path,
    python: str,
) -> dict[str, LockEntry]:
    """Choose all packages that the wheels and roots need.

    pyodide  the packages that Pyodide brings, by name
    folder   where the wheels are, and where those of further packages are made
    python   the version of Python in the browser
    """
    chosen: dict[str, LockEntry] = {}
    ours = {metadata(wheel).name: wheel for wheel in wheels}
    todo = [*ours, *roots]
    while todo:
        name = canonicalize_name(todo.pop())
        if name in chosen:
            continue
        if name not in ours and name in pyodide:
            chosen[name] = pyodide[name]
        else:
            wheel = ours[name] if name in ours else again(name, folder)
            chosen[name] = lock_entry(wheel)
            wanted = [one for one in metadata(wheel).requires if _applies(one, python)]
            chosen[name]["depends"] = [canonicalize_name(one.name) for one in wanted]
            for one in wanted:
                _fits(name, one, pyodide)
        todo += chosen[name]["depends"]
    return dict(sorted(chosen.items()))


def _applies(one: Requirement, python: str) -> bool:
    """Whether a requirement holds in the browser, without extras."""
    here = {
        "sys_platform": "emscripten",
        "platform_system": "Emscripten",
        "platform_machine": "wasm32",
        "os_name": "posix",
        "python_version": python.rpartition(".")[0],
        "python_full_version": python,
        "extra": "",
    }
    return one.marker is None or one.marker.evaluate(here)


def _fits(name: str, one: Requirement, pyodide: Mapping[str, LockEntry]) -> None:
    brought = pyodide.get(canonicalize_name(one.name))
    if brought is not None and not one.specifier.contains(brought["version"], prereleases=True):
        raise LookupError(f"{name} needs {one}, and this Pyodide brings {brought['version']}.")


def digest(data: bytes) -> str:
    """Compute the SHA-256, as lock files have it."""
    return hashlib.sha256(data).hexdigest()
