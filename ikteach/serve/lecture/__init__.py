"""Live figures as plain web pages for a lecture: `python -m ikteach lecture`.

The pages are the notebooks in `pages`, a figure and a few words each. Voilà shows them without
code; whoever opens one has a kernel of their own, which ends when the page is closed.
"""

import argparse
import os
import socket
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from ikteach.publish.delivery import deliver, find_course, report
from ikteach.publish.parser import Parser, RefusedError
from ikteach.serve import lab, ports

if TYPE_CHECKING:
    from ikteach.view.chapters.workbench import Workbench

Figure = TypeVar("Figure")
PAGES = Path(__file__).parent / "pages"
FIRST_PAGE = "workbench.ipynb"
FOLDER = Path("ikteach-lecture")
NO_STATE = {"token", "voila-template", "voila-theme"}  # what an address says to the server
OPEN_TO_ROOM = "IKTEACH_ROOM"  # set for the kernels when others than the lecturer may open pages


def main(argv: list[str]) -> int:
    """Show live figures as web pages; give the exit code."""
    options, extra = _options(argv)
    ports.check_server("Voilà", "voila", "lecture", options.port)
    os.environ.update(lab.environment(find_course()))
    return _show(options, extra)


def _options(argv: list[str]) -> tuple[argparse.Namespace, list[str]]:
    """Read our options, and those for Voilà: what follows `--`."""
    parser = Parser(
        prog="python -m ikteach lecture",
        usage="%(prog)s [FOLDER] [--room] [--no-browser] [--port N] [-- VOILÀ OPTIONS]",
        description="Show the workbench, the simulator, the walk and the race as web pages without "
        "code.",
        allow_abbrev=False,
    )
    parser.add_argument(
        "folder",
        metavar="FOLDER",
        nargs="?",
        type=Path,
        default=FOLDER,
        help="copy the pages there and show the copy; a page that you have changed is never "
        "overwritten, and movies and sessions go there too (default: ./%(default)s)",
    )
    parser.add_argument(
        "--room",
        action="store_true",
        help="others in this network may open the pages, with the address that is printed",
    )
    return ports.options(parser, argv)


def _show(options: argparse.Namespace, extra: list[str]) -> int:
    """Copy the pages, and serve them until Ctrl-C."""
    try:
        from ikteach.serve.lecture.server import Lecture
    except ImportError as error:
        why = f"Voilà is older than it must be, or a part of it is missing ({error})."
        mend = "pip install --upgrade 'ikteach[lecture]'"
        raise RefusedError(f"{why} Mend it with: {mend}") from None
    folder = options.folder.expanduser().resolve()
    print(*report(deliver(PAGES, folder), folder), sep="\n")
    os.environ.pop(OPEN_TO_ROOM, None)
    if options.room:
        os.environ[OPEN_TO_ROOM] = "1"
    browse = not options.no_browser
    try:
        lecture = Lecture.of(folder, FIRST_PAGE, options.port, room=options.room, browse=browse)
        lecture.initialize(extra)
        lecture.start()
    except KeyboardInterrupt:  # before it serves: then it hears of it itself
        return 130
    return 0


def addressed(figure: Figure) -> Figure:
    """Set a page's figure as the page's address says.

    `workbench.ipynb?method=sdls&speed=9`; the form is that of `ikteach.view.live.preset`.
    """
    from ikteach.view import preset

    query = os.environ.get("QUERY_STRING", "")  # Voilà tells the page's kernel
    state = [one for one in query.split("&") if one.partition("=")[0] not in NO_STATE]
    return preset(figure, "&".join(state))


def workbench() -> "Workbench":
    """Make a page's workbench; in a room it keeps no files."""
    from ikteach.view.chapters.workbench import Workbench

    bench = Workbench()
    bench.stay()
    if os.environ.get(OPEN_TO_ROOM):
        bench.keep_no_files()
    return addressed(bench)


def own_address() -> str:
    """Find this machine's address in its network, sending nothing."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            probe.connect(("192.0.2.1", 9))  # an address that is nobody's: a route is looked up
            return str(probe.getsockname()[0])
        except OSError:
            return socket.gethostname()
