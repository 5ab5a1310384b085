"""The course in JupyterLab: `python -m ikteach`."""

import argparse
import errno
import os
import signal
import subprocess
import sys
from pathlib import Path
from urllib.parse import quote

from ikteach import __version__
from ikteach.publish import delivery
from ikteach.publish.delivery import CourseFolder, chapters, deliver, find_course, report
from ikteach.publish.parser import Parser, RefusedError
from ikteach.serve import ports

QUIET = Path(__file__).parent  # where JupyterLab does not ask a beginner whether they want news


def main(argv: list[str]) -> int:
    """Open or list the course; give the exit code."""
    options, extra = _options(argv)
    course = find_course()
    titles = chapters(course.notebooks)
    if not titles:
        raise RefusedError(f"There are no notebooks in {course.notebooks}.")
    if options.list:
        width = max(map(len, titles))
        print(*(f"{name:{width}}  {title}" for name, title in titles.items()), sep="\n")
        return 0
    ports.check_server("JupyterLab", "jupyterlab", "lab", options.port)
    folder = prepare(course, options.folder)
    first = min(titles, key=lambda name: (not name[0].isdigit(), name))  # chapter 0
    print(f"opening {folder / first} in JupyterLab; Ctrl-C here ends it", flush=True)
    code = run(_command(folder, first, options.port, extra), environment(course))
    as_root = hasattr(os, "geteuid") and os.geteuid() == 0  # Windows has no user numbers
    if code == 1 and as_root and "--allow-root" not in extra:
        hint = "python -m ikteach -- --allow-root"
        raise RefusedError(f"JupyterLab refuses to run as root, unless: {hint}")
    return code


def _options(argv: list[str]) -> tuple[argparse.Namespace, list[str]]:
    """Read our options, and those for JupyterLab: what follows `--`."""
    parser = Parser(
        prog="python -m ikteach",
        usage="%(prog)s [FOLDER] [--no-browser] [--port N] [--list] [--version]"
        " [-- JUPYTERLAB OPTIONS]\n"
        "       %(prog)s build student|instructor|html FOLDER\n"
        "       %(prog)s site FOLDER [--pyodide FOLDER|ADDRESS]\n"
        "       %(prog)s lecture [FOLDER]\n"
        "       %(prog)s class FOLDER\n"
        "       %(prog)s collect FOLDER",
        description="Open the course on inverse kinematics in JupyterLab.",
        allow_abbrev=False,
    )
    parser.add_argument(
        "folder",
        metavar="FOLDER",
        nargs="?",
        type=Path,
        help="copy the notebooks there and open the copy; a file that you have changed is never "
        "overwritten (default: ./ikteach-course, or in a clone its own notebooks, uncopied)",
    )
    parser.add_argument("--version", action="version", version=f"ikteach {__version__}")
    parser.add_argument("--list", action="store_true", help="print the chapters and end")
    options, extra = ports.options(parser, argv)
    return options, ["--no-browser"] * options.no_browser + extra


def prepare(course: CourseFolder, wanted: Path | None) -> Path:
    """Give the folder to open, a clone's or a copy."""
    notebooks = course.notebooks.resolve()
    default = notebooks if course.clone else Path("ikteach-course")
    folder = Path(os.path.realpath(os.path.expanduser(wanted or default)))
    if course.clone and folder == notebooks:
        return folder
    if folder.is_relative_to(notebooks):
        raise OSError(errno.EINVAL, "A copy cannot go among the originals", str(folder))
    print(*report(deliver(notebooks, folder), folder), sep="\n")
    return folder


def _command(folder: Path, first: str, port: int | None, extra: list[str]) -> list[str]:
    """Give the command that starts JupyterLab in `folder` with the notebook `first` open."""
    command = [sys.executable, "-m", "jupyterlab", f"--ServerApp.root_dir={folder}"]
    command += [f"--LabApp.default_url=/lab/tree/{quote(first)}"]
    command += ["--ServerApp.jpserver_extensions={'ikteach.serve.extension': True}"]
    # Ask nothing of the network: no news, no look for a newer JupyterLab.
    command += ["--LabApp.news_url=None"]
    command += ["--LabApp.check_for_updates_class=jupyterlab.NeverCheckForUpdate"]
    if port is not None:
        command += [f"--ServerApp.port={port}", "--ServerApp.port_retries=0"]
    return command + extra


def environment(course: CourseFolder) -> dict[str, str]:
    """Give a server's environment; kernels find a clone's package."""
    clone = str(delivery.PACKAGE.parent) if course.clone else ""
    ours = {"JUPYTER_CONFIG_PATH": str(QUIET), "PYTHONPATH": clone}
    paths = {name: [path, os.environ.get(name, "")] for name, path in ours.items()}
    joined = {name: os.pathsep.join(filter(None, both)) for name, both in paths.items()}
    return os.environ | {name: path for name, path in joined.items() if path}


def run(command: list[str], environment: dict[str, str]) -> int:
    """Run JupyterLab until it ends, and give its exit code."""
    # In a process group of its own it does not hear the terminal's Ctrl-C. It hears of it from us
    # as a plain request to end, which it obeys at any moment, with no question and no traceback.
    # Windows has no such groups: there Ctrl-C reaches JupyterLab too, and it ends by itself.
    child = subprocess.Popen(command, env=environment, process_group=0)
    for name in ("SIGINT", "SIGTERM", "SIGHUP"):
        if hasattr(signal, name):
            signal.signal(getattr(signal, name), lambda *_: child.terminate())
    code = child.wait()
    return code if code >= 0 else 128 - code  # ended by a signal: the shell's way to say so
