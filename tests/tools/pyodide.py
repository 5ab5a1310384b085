"""A Pyodide distribution as far as the package registries have it.

Real: the core, from npm, and the pure-Python packages, from what is installed here. Not to be had:
the packages compiled to WebAssembly (numpy, pandas, matplotlib …). In place of each there is a
wheel of the right name with nothing in it, so that the site is whole and its lock file is tried;
to import one says that there is no such module.
"""

import json
import shutil
import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path
from typing import Any

from ikteach.publish import site, wheels

WANTED = [*site.PRELOADED, "typing-extensions", "numpy", "pandas", "matplotlib"]


def core(folder: Path) -> None:
    """Unpack the npm package `pyodide`."""
    npm = shutil.which("npm")
    assert npm, "npm is needed: it brings Pyodide's core (Debian: apt-get install npm)"
    command = [npm, "pack", "--silent", f"pyodide@{site.PYODIDE}"]
    subprocess.run(command, cwd=folder, check=True, capture_output=True, timeout=120)
    (package,) = folder.glob("pyodide-*.tgz")
    with tarfile.open(package) as archive:
        for name in (*site.CORE, site.LOCK):
            inside = archive.extractfile(f"package/{name}")
            assert inside is not None
            (folder / name).write_bytes(inside.read())
    package.unlink()


def distribution(folder: Path) -> Path:
    """The whole stand-in."""
    folder.mkdir()
    core(folder)
    whole = json.loads((folder / site.LOCK).read_text())
    todo, done = list(WANTED), set()
    while todo:
        name = todo.pop().replace("_", "-").lower()
        if name in done or name not in whole["packages"]:
            continue
        done.add(name)
        one = whole["packages"][name]
        try:
            wheel = fetched(one, folder) if name == "micropip" else wheels.again(name, folder)
            one.update(file_name=wheel.name, version=wheels.metadata(wheel).version)
        except LookupError:  # compiled, or pandas's pytz, which pandas no longer has here
            wheel = hollow(folder / one["file_name"], one)
        one["sha256"] = wheels.digest(wheel.read_bytes())
        todo += one["depends"]
    (folder / site.LOCK).write_text(json.dumps(whole))
    return folder


def fetched(one: dict[str, Any], folder: Path) -> Path:
    """The wheel of a pure package whose version of the browser is too new for this Python."""
    command = [sys.executable, "-m", "pip", "download", "--quiet", "--no-deps", "--dest", "."]
    command += ["--only-binary=:all:", "--python-version=3.14", f"{one['name']}=={one['version']}"]
    subprocess.run(command, cwd=folder, check=True, capture_output=True, timeout=120)
    return folder / str(one["file_name"])


def hollow(wheel: Path, one: dict[str, Any]) -> Path:
    """A wheel without contents."""
    facts = f"{'-'.join(wheel.name.split('-')[:2])}.dist-info"
    said = f"Metadata-Version: 2.1\nName: {one['name']}\nVersion: {one['version']}\n"
    with zipfile.ZipFile(wheel, "w") as archive:
        archive.writestr(f"{facts}/METADATA", said)
        archive.writestr(f"{facts}/WHEEL", wheels.WHEEL)
        archive.writestr(f"{facts}/RECORD", "")
    return wheel
