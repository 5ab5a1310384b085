"""The answers of a class as they come in, before the class: `python -m ikteach class FOLDER`.

A server of its own, not a page of the lecture's: whoever the lecture lets in, with `--room` a whole
class, never has this page's token, and it listens to its own machine alone. It needs no notebook
and no kernel, writes nothing, and knows what a folder of answers holds, on a disk of the class or
in the homes of a hub.
"""

import argparse
import asyncio
import signal
import threading
import time
import webbrowser
from pathlib import Path
from typing import Any

from ikteach.publish.delivery import find_course
from ikteach.publish.parser import Parser, RefusedError
from ikteach.serve import ports

FRESH = 1.0  # [s] for which counts are given again: more pages do not read more


def main(argv: list[str]) -> int:
    """Show the answers of a class; give the exit code."""
    options = _options(argv)
    ports.check_server("Tornado", "tornado", "lecture", options.port)
    from ikteach.serve.classroom.server import ClassServer

    try:
        counts = Counts(options.folder.expanduser(), options.notebooks)
    except NotADirectoryError as error:
        raise RefusedError(f"{error}.") from None
    server = ClassServer(counts, options.port)
    print(f"the class is at {server.address}", "Ctrl-C here ends it", sep="\n", flush=True)
    if not options.no_browser:
        threading.Thread(target=webbrowser.open, args=[server.address], daemon=True).start()
    signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's background ignores it
    try:
        asyncio.run(server.serve())
    except KeyboardInterrupt:
        print()
    return 0


def _options(argv: list[str]) -> argparse.Namespace:
    parser = Parser(
        prog="python -m ikteach class",
        description="Show before a class what it predicts and where it is stuck, as the answers "
        "come in. FOLDER holds a folder or a file per student, as the homes of a hub do.",
        allow_abbrev=False,
    )
    parser.add_argument("folder", metavar="FOLDER", type=Path)
    parser.add_argument(
        "--notebooks",
        metavar="FOLDER",
        type=Path,
        help="where the questions are read (default: the course's own notebooks)",
    )
    options, extra = ports.options(parser, argv)
    if extra:
        raise RefusedError("The class has no other program: leave out what is after --.")
    return options


class Counts:
    """The counts of a folder, whenever they are asked for.

    notebooks  whose predictions are told with their words; the course's if None
    """

    def __init__(self, folder: Path, notebooks: Path | None = None) -> None:
        from ikteach.serve.classroom.asked import asked_in
        from ikteach.serve.classroom.folder import ClassFolder

        if notebooks is not None and not notebooks.is_dir():
            raise NotADirectoryError(f"{notebooks} is not a folder")
        self.folder = ClassFolder(folder)
        self._asked = asked_in(notebooks or find_course().notebooks)
        self._students, self._at = self.folder.look(), time.monotonic()

    def __call__(self, names: bool) -> dict[str, Any]:
        """Count what is in the folder now."""
        from ikteach.serve.classroom.tally import tally

        if time.monotonic() - self._at > FRESH:
            self._students, self._at = self.folder.look(), time.monotonic()
        return tally(self._students, self._asked, troubles=self.folder.troubles, names=names)
