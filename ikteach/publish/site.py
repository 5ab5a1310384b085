"""The course as a site: static files, with Python in the reader's browser (JupyterLite, Pyodide).

Everything is put into the site when it is built: the notebooks, JupyterLab, the widgets' scripts,
Pyodide, and the wheels that the course needs. While it is read it asks nothing of any other place.
What the wheels are is in Pyodide's lock file, so that `import ikteach` finds them and a notebook
needs no other line there than elsewhere.
"""

import json
import os
import shutil
import subprocess
import sys
import tempfile
import urllib.error
import urllib.request
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

from ikteach.markup import Markup
from ikteach.publish import builds, delivery
from ikteach.publish.delivery import MANIFEST, Manifest, chapters, find_course, read_manifest
from ikteach.publish.parser import Parser, RefusedError

PYODIDE = "314.0.6"
PYODIDE_ADDRESS = f"https://cdn.jsdelivr.net/pyodide/v{PYODIDE}/full"
# It runs on this Pyodide. It is fetched by each build and not installed, for JupyterLab would take
# its scripts, which are for a site, for its own, and say on every page that they do not load.
KERNEL_WHEEL = "jupyterlite-pyodide-kernel==0.8.6"
CORE = ("pyodide.mjs", "pyodide.asm.mjs", "pyodide.asm.wasm", "python_stdlib.zip")
LOCK = "pyodide-lock.json"
KERNEL = "@jupyterlite/pyodide-kernel-extension"
EXTENSIONS = (  # what a page needs to show the course's widgets, and the kernel
    "@jupyter-widgets/jupyterlab-manager",
    "anywidget",
    "jupyter-threejs",
    "jupyterlab-datawidgets",
    KERNEL,
)
# The kernel's own packages; those named here are loaded while it starts, the rest when imported.
PRELOADED = ("micropip", "piplite", "ipykernel", "comm", "pyodide-kernel", "jedi", "ipython")
STANDINS = ("ipykernel-6", "piplite", "pyodide_kernel", "widgetsnbextension-4")
TIMEOUT = 60  # [s] without a byte


class Size(NamedTuple):
    """The counts and bytes of a build."""

    chapters: int
    files: int
    bytes: int
    packages: int


def main(argv: list[str]) -> int:
    """Build the site; give the exit code."""
    parser = Parser(
        prog="python -m ikteach site",
        description="Build the course as static files in FOLDER: any web server can hand them out, "
        "and Python runs in the reader's browser. A site that was built there before and not "
        "changed since is replaced; nothing else is.",
        allow_abbrev=False,
    )
    parser.add_argument("folder", metavar="FOLDER", type=Path)
    parser.add_argument(
        "--pyodide",
        metavar="FOLDER|ADDRESS",
        help="where Pyodide's files are: an unpacked distribution, or its web address (default: "
        "its release on a content network, from which this command then fetches about 45 MB)",
    )
    options = parser.parse_args(argv)
    try:
        folder = options.folder.expanduser().resolve()
        size = build(folder, options.pyodide)
    except ModuleNotFoundError as error:
        install = "pip install 'ikteach[site]'"
        raise RefusedError(f"{error.name} is not installed: {install}") from None
    except (LookupError, ValueError) as error:
        raise RefusedError(str(error.args[0])) from None
    print(
        f"built {folder}: {size.chapters} chapters, {size.packages} Python packages, "
        f"{size.files} files, {size.bytes / 1e6:.0f} MB; it asks nothing of any other place\n"
        f"to look at it: {sys.executable} -m http.server --bind 127.0.0.1 "
        f"--directory {folder}"
    )
    return 0


def build(folder: Path, pyodide: str | None = None) -> Size:
    """Build the site in `folder`.

    It appears only once it is complete. LookupError or ValueError say in a sentence what is missing
    or in the way.
    """
    notebooks = find_course().notebooks
    if folder.is_relative_to(notebooks.resolve()):
        raise ValueError(f"{folder} is among the notebooks themselves; name another folder.")
    if reason := hindrance(folder):
        raise ValueError(reason)
    folder.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix=f".{folder.name}-", dir=folder.parent) as room:
        project, made = Path(room, "project"), Path(room, "site")
        builds.student(notebooks, project / "files")
        kernel = fetch_kernel(Path(room, "kernel"))
        packages = distribution(pyodide or PYODIDE_ADDRESS, project / "static" / "pyodide", kernel)
        extensions(project / "widgets", kernel)
        lay_out(project, made, kernel)
        titles = chapters(notebooks)
        (made / "index.html").write_text(start_page(titles), encoding="utf-8")
        manifest = contents(made)
        (made / MANIFEST).write_text(json.dumps(manifest, indent=1), encoding="utf-8")
        size = sum((made / name).stat().st_size for name in manifest)
        made.chmod(0o755)
        if folder.exists():
            folder.rename(Path(room, "before"))
        made.rename(folder)
    return Size(len(titles), len(manifest), size, len(packages))


def hindrance(folder: Path) -> str:
    """Say why nothing may be built there, or nothing."""
    if not folder.exists():
        return ""
    if not folder.is_dir():
        return f"{folder} is a file; name a folder."
    there = contents(folder)
    if not there:
        return ""
    known = read_manifest(folder)
    if not known or not (folder / "jupyter-lite.json").exists():
        return f"{folder} has files that are no site of ours, and is left alone; name a new folder."
    changed = sorted(name for name in {*there, *known} if there.get(name) != known.get(name))
    if changed:
        return (
            f"{changed[0]} in {folder} was changed since the site was built, so the folder is left "
            "alone; name a new one, or move this one away."
        )
    return ""


def contents(folder: Path) -> Manifest:
    """List the files in the folder: name -> SHA-256."""
    from ikteach.publish.wheels import digest

    files = {p.relative_to(folder).as_posix(): p for p in folder.rglob("*") if p.is_file()}
    return {name: digest(files[name].read_bytes()) for name in sorted(files) if name != MANIFEST}


def fetch_kernel(folder: Path) -> Path:
    """Unpack JupyterLite's Python kernel, or raise LookupError."""
    command = [sys.executable, "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
    command += ["--no-deps", "--target", str(folder), KERNEL_WHEEL]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        said = done.stderr.strip().splitlines()
        raise LookupError(f"{KERNEL_WHEEL} cannot be fetched by pip: {said[-1] if said else '?'}")
    return folder


def distribution(where: str, folder: Path, kernel: Path) -> list[str]:
    """Put the Python packages of the course into `folder`.

    Returns the names of its packages.
    """
    from ikteach.publish import wheels

    folder.mkdir(parents=True)
    whole = json.loads(take(where, LOCK))
    if not all((Path(where) / name).is_file() or is_address(where) for name in CORE):
        missing = [name for name in CORE if not (Path(where) / name).is_file()]
        raise LookupError(f"{where} is no Pyodide distribution: {missing[0]} is missing.")
    for name in CORE:
        (folder / name).write_bytes(take(where, name))
    _agree_on_version(folder / "pyodide.mjs", where)
    ours = [wheels.own(delivery.PACKAGE, folder)]
    for wheel in (_extension(KERNEL, kernel) / "static" / "pypi").glob("*.whl"):
        if wheel.name.startswith(STANDINS):
            ours.append(Path(shutil.copy(wheel, folder)))
    python = whole["info"]["python"]
    chosen = wheels.lock(whole["packages"], ours, PRELOADED, folder, python)
    wanted = {one["file_name"]: one["sha256"] for one in chosen.values()}
    wanted = {name: sha256 for name, sha256 in wanted.items() if not (folder / name).exists()}
    if not is_address(where):
        missing = sorted(name for name in wanted if not (Path(where) / name).is_file())
        if missing:
            raise LookupError(
                f"{where} lacks {len(missing)} wheels of the {len(wanted)} that the course needs, "
                f"{missing[0]} the first; take Pyodide's full distribution."
            )
    else:
        print(f"fetching Pyodide and {len(wanted)} of its packages from {where}", flush=True)
    for name, sha256 in wanted.items():
        data = take(where, name)
        if wheels.digest(data) != sha256:
            raise ValueError(f"{name} from {where} is not the file that {LOCK} there describes.")
        (folder / name).write_bytes(data)
    (folder / LOCK).write_text(json.dumps({**whole, "packages": chosen}, indent=1))
    return list(chosen)


def is_address(where: str) -> bool:
    """Tell whether it is on the web, and no folder."""
    return where.startswith(("https://", "http://"))


def take(where: str, name: str) -> bytes:
    """Read a file of Pyodide's, or raise LookupError."""
    try:
        if not is_address(where):
            return Path(where, name).read_bytes()
        with urllib.request.urlopen(f"{where.rstrip('/')}/{name}", timeout=TIMEOUT) as answer:
            return bytes(answer.read())
    except OSError as error:  # of files and of the network
        reason = getattr(error, "reason", None) or error.strerror or error
        raise LookupError(
            f"{name} of Pyodide cannot be had from {where} ({reason}); "
            "--pyodide FOLDER takes it from an unpacked distribution."
        ) from None


def _agree_on_version(script: Path, where: str) -> None:
    if f'"{PYODIDE}"' not in script.read_text(encoding="utf-8"):
        raise ValueError(f"{where} is not Pyodide {PYODIDE}, which the kernel here needs.")


def extensions(folder: Path, kernel: Path) -> None:
    """Copy the JupyterLab extensions, installed or the kernel's."""
    for name in EXTENSIONS:
        shutil.copytree(_extension(name, kernel), folder / name)
        facts = folder / name / "package.json"
        # Two of them were packed on Windows, and a browser wants its own kind of slash.
        facts.write_text(facts.read_text(encoding="utf-8").replace("static\\\\", "static/"))


def _extension(name: str, kernel: Path) -> Path:
    from jupyter_core.paths import jupyter_path

    roots = [str(kernel / "share" / "jupyter" / "labextensions"), *jupyter_path("labextensions")]
    places = [Path(root, name) for root in roots]
    found = next((place for place in places if (place / "package.json").is_file()), None)
    if found is None:
        raise LookupError(
            f"the JupyterLab extension {name} is not installed: pip install 'ikteach[site]'"
        )
    return found


def lay_out(project: Path, made: Path, kernel: Path) -> None:
    """Have JupyterLite lay out the site `made` from the project."""
    settings = {
        "loadPyodideOptions": {"packages": list(PRELOADED)},
        "disablePyPIFallback": True,  # what is not in the site is asked of nobody
    }
    page = {
        "appName": "ikteach",
        "litePluginSettings": {f"{KERNEL}:kernel": settings},
        "disabledExtensions": ["@jupyterlab/extensionmanager-extension"],
    }
    config = {
        "LiteBuildConfig": {
            "apps": ["lab"],
            "contents": ["files"],
            "federated_extensions": [f"widgets/{name}" for name in EXTENSIONS],
            "ignore_sys_prefix": ["federated_extensions"],
            "no_sourcemaps": True,
            "no_unused_shared_packages": True,
            "output_dir": str(made),
        }
    }
    texts = {
        "jupyter-lite.json": {"jupyter-lite-schema-version": 0, "jupyter-config-data": page},
        "jupyter_lite_config.json": config,
    }
    for name, text in texts.items():
        (project / name).write_text(json.dumps(text, indent=1))
    command = [sys.executable, "-m", "jupyterlite_core", "build", "--lite-dir", str(project)]
    paths = filter(None, [str(kernel), os.environ.get("PYTHONPATH")])  # where its plugins are found
    ours = os.environ | {"PYTHONPATH": os.pathsep.join(paths)}
    done = subprocess.run(command, cwd=project, env=ours, capture_output=True, text=True)
    if done.returncode:
        said = (done.stderr or done.stdout).strip().splitlines()
        raise LookupError(f"JupyterLite could not build the site: {said[-1] if said else '?'}")


def start_page(titles: Mapping[str, str]) -> str:
    """Make the first page: a link per chapter, and advice."""
    row = Markup('<li><a href="lab/index.html?path={}">{}</a></li>\n')
    rows = Markup().join(row.format(name, title) for name, title in titles.items())
    page = (Path(__file__).parent / "start.html").read_text("utf-8")
    return page.replace("ROWS", rows)
