"""Open the course in JupyterLab: `python -m ikteach`; or make a build or a site of it."""

import argparse
import errno
import os
import signal
import subprocess
import sys
from pathlib import Path
from urllib.parse import quote

from ikteach import __version__
from ikteach.publish.delivery import Course, chapters, deliver, find_course, told
from ikteach.publish.parser import Parser, meant, shown
from ikteach.serve import ports

PACKAGE = Path(__file__).resolve().parent
COMMANDS = ("build", "collect", "lecture", "site")


def main(argv: list[str] | None = None) -> int:
    """Open, list or build the course; the exit code says whether that went well."""
    if hasattr(sys.stdout, "reconfigure"):  # a title may hold a σ that the console cannot show
        sys.stdout.reconfigure(errors="replace")
    argv = sys.argv[1:] if argv is None else argv
    try:
        if argv[:1] == ["build"]:
            from ikteach.publish import builds

            return builds.main(PACKAGE, argv[1:])
        if argv[:1] == ["collect"]:
            from ikteach.publish import collect

            return collect.main(argv[1:])
        if argv[:1] == ["lecture"]:
            return open_lecture(argv[1:])
        if argv[:1] == ["site"]:
            from ikteach.publish import site

            return site.main(PACKAGE, argv[1:])
        if reason := misspelt(argv):
            return refuse(reason)
        options, extra = parse(argv)
        return open_course(find_course(PACKAGE), options, extra)
    except OSError as error:
        where = f"{error.filename}: " if error.filename else ""
        return refuse(f"The course cannot be opened: {where}{error.strerror or error}.")


def misspelt(argv: list[str]) -> str:
    """Why a command is not where it is looked for, or not one; empty where none is meant."""
    word = argv[0] if argv else ""
    late = [command for command in COMMANDS if command in argv and "--" not in argv]
    if late and word.startswith("-"):
        return f"The command comes first: python -m ikteach {late[0]} …"
    hint = meant(word, [*COMMANDS, "--list", "--help", "--version"])
    if not hint or word.startswith("-") or os.sep in word or Path(word).exists():
        return ""
    folder = os.path.join(".", word)
    return f"There is no command {shown(word)}{hint} For a folder of that name: {folder}"


def parse(argv: list[str]) -> tuple[argparse.Namespace, list[str]]:
    """Our options, and those for JupyterLab: what follows `--`."""
    parser = Parser(
        prog="python -m ikteach",
        usage="%(prog)s [FOLDER] [--no-browser] [--port N] [--list] [--version]"
        " [-- JUPYTERLAB OPTIONS]\n"
        "       %(prog)s build student|instructor|html FOLDER\n"
        "       %(prog)s site FOLDER [--pyodide FOLDER|ADDRESS]\n"
        "       %(prog)s lecture [FOLDER]\n"
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
    options, extra = ports.parse(parser, argv)
    return options, ["--no-browser"] * options.no_browser + extra


def open_course(course: Course, options: argparse.Namespace, extra: list[str]) -> int:
    """List the chapters or run JupyterLab on them; give the exit code."""
    titles = chapters(course.notebooks)
    if not titles:
        return refuse(f"There are no notebooks in {course.notebooks}.")
    if options.list:
        width = max(map(len, titles))
        print(*(f"{name:{width}}  {title}" for name, title in titles.items()), sep="\n")
        return 0
    if reason := ports.hindrance("JupyterLab", "jupyterlab", "lab", options.port):
        return refuse(reason)
    folder = prepare(course, options.folder)
    first = next(iter(titles))
    print(f"opening {folder / first} in JupyterLab; Ctrl-C here ends it", flush=True)
    code = run(lab_command(folder, first, options.port, extra), lab_environment(course))
    as_root = hasattr(os, "geteuid") and os.geteuid() == 0  # Windows has no user numbers
    if code == 1 and as_root and "--allow-root" not in extra:
        refuse("JupyterLab refuses to run as root, unless: python -m ikteach -- --allow-root")
    return code


def open_lecture(argv: list[str]) -> int:
    """Show the live figures as web pages, until Ctrl-C; give the exit code."""
    from ikteach.serve import lecture

    options, extra = lecture.parse(argv)
    if reason := ports.hindrance("Voilà", "voila", "lecture", options.port):
        return refuse(reason)
    os.environ.update(lab_environment(find_course(PACKAGE)))
    return lecture.show(options, extra)


def prepare(course: Course, wanted: Path | None) -> Path:
    """The folder to open: the clone's own notebooks, or a copy of the course, told in sentences."""
    notebooks = course.notebooks.resolve()
    default = notebooks if course.clone else Path("ikteach-course")
    folder = Path(os.path.realpath(os.path.expanduser(wanted or default)))
    if course.clone and folder == notebooks:
        return folder
    if folder.is_relative_to(notebooks):
        raise OSError(errno.EINVAL, "A copy cannot go among the originals", str(folder))
    print(*told(deliver(notebooks, folder), folder), sep="\n")
    return folder


def lab_command(folder: Path, first: str, port: int | None, extra: list[str]) -> list[str]:
    """The command that starts JupyterLab in `folder` with the notebook `first` open."""
    command = [sys.executable, "-m", "jupyterlab", f"--ServerApp.root_dir={folder}"]
    command += [f"--LabApp.default_url=/lab/tree/{quote(first)}"]
    command += ["--ServerApp.jpserver_extensions={'ikteach.serve.extension': True}"]
    # Ask nothing of the network: no news, no look for a newer JupyterLab.
    command += ["--LabApp.news_url=None"]
    command += ["--LabApp.check_for_updates_class=jupyterlab.NeverCheckForUpdate"]
    if port is not None:
        command += [f"--ServerApp.port={port}", "--ServerApp.port_retries=0"]
    return command + extra


def lab_environment(course: Course) -> dict[str, str]:
    """The environment of JupyterLab; from a clone, its kernels find this very package."""
    quiet = str(PACKAGE / "serve" / "lab")  # does not ask a beginner whether they want news
    ours = {"JUPYTER_CONFIG_PATH": quiet, "PYTHONPATH": str(PACKAGE.parent) if course.clone else ""}
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


def refuse(sentence: str) -> int:
    """Say on stderr what went wrong; give the exit code for it."""
    print(sentence, file=sys.stderr)
    return 1


if __name__ == "__main__":
    sys.exit(main())
