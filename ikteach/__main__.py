"""The commands of `python -m ikteach`; without one, the course opens in JupyterLab."""

import importlib
import os
import sys
from pathlib import Path

from ikteach.checks import shown
from ikteach.publish.parser import RefusedError, meant

OPEN = "ikteach.serve.lab"
COMMANDS = {  # each a module with main(argv), which gives the exit code
    "build": "ikteach.publish.builds",
    "class": "ikteach.serve.classroom",
    "collect": "ikteach.publish.collect",
    "docs": "ikteach.publish.docs",
    "film": "ikteach.publish.race",
    "grade": "ikteach.publish.grading.grade",
    "lecture": "ikteach.serve.lecture",
    "site": "ikteach.publish.site",
}


def main(argv: list[str] | None = None) -> int:
    """Run a command; give its exit code."""
    if hasattr(sys.stdout, "reconfigure"):  # a title may hold a σ that the console cannot show
        sys.stdout.reconfigure(errors="replace")
    argv = sys.argv[1:] if argv is None else argv
    try:
        command = COMMANDS.get(argv[0]) if argv else None
        if not command and (reason := misspelt(argv)):
            raise RefusedError(reason)
        code = importlib.import_module(command or OPEN).main(argv[1:] if command else argv)
        return int(code)
    except RefusedError as refused:
        print(refused, file=sys.stderr)
    except OSError as error:
        where = f"{error.filename}: " if error.filename else ""
        why = f"{where}{error.strerror or error}"
        print(f"The course cannot be opened: {why}.", file=sys.stderr)
    return 1


def misspelt(argv: list[str]) -> str:
    """Explain a misspelt command; empty where none is meant."""
    word = argv[0] if argv else ""
    late = [command for command in COMMANDS if command in argv and "--" not in argv]
    if late and word.startswith("-"):
        return f"The command comes first: python -m ikteach {late[0]} …"
    hint = meant(word, [*COMMANDS, "--list", "--help", "--version"])
    if not hint or word.startswith("-") or os.sep in word or Path(word).exists():
        return ""
    folder = os.path.join(".", word)
    return f"There is no command {shown(word)}{hint} For a folder of that name: {folder}"


if __name__ == "__main__":
    sys.exit(main())
