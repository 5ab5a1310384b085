"""The documentation as a site of static files, by Sphinx, without any network.

Its sources are what is read elsewhere too: the notebooks, run; TEACHING, CONTRIBUTING, CHANGELOG
and the tables of the benches; the docstrings. Only what stands in none of them is in `pages/`.
"""

import asyncio
import io
import os
import re
import shutil
import tempfile
from pathlib import Path

from ikteach.publish.builds import student
from ikteach.publish.delivery import chapters, deliver, find_course, report
from ikteach.publish.docs.links import broken
from ikteach.publish.parser import Parser, RefusedError

OWN = Path(__file__).parent / "pages"
DOCUMENTS = {  # of the clone -> page of the site
    "TEACHING.md": "teaching.md",
    "CONTRIBUTING.md": "contributing.md",
    "CHANGELOG.md": "changelog.md",
    "tests/bench/README.md": "benches.md",
    "ikteach/data/README.md": "data.md",
}
COLOUR = re.compile(r"\x1b\[[\d;]*m")  # of a terminal
STILL = "The notebooks were not run for this copy: figures and numbers are left out."


def main(argv: list[str]) -> int:
    """Build the documentation; give the exit code."""
    parser = Parser(
        prog="python -m ikteach docs",
        description="Build the documentation in FOLDER, from a clone. A file there that has been "
        "changed since it was made is never overwritten.",
        allow_abbrev=False,
    )
    parser.add_argument("folder", metavar="FOLDER", type=Path)
    parser.add_argument(
        "--fast", action="store_true", help="do not run the notebooks: a course without pictures"
    )
    options = parser.parse_args(argv)
    course = find_course()
    if not course.clone:
        raise RefusedError("The documentation is built from a clone; its texts are not in a wheel.")
    folder = options.folder.expanduser().resolve()
    with tempfile.TemporaryDirectory() as made:
        pages = Path(made, "pages")
        try:
            assemble(course.notebooks, Path(made, "sources"), run=not options.fast)
            compose(Path(made, "sources"), pages)
        except ModuleNotFoundError as error:
            install = "pip install 'ikteach[docs]'"
            raise RefusedError(f"{error.name} is not installed: {install}") from None
        if links := broken(pages):
            raise RefusedError("\n".join(["Links that lead nowhere:", *links]))
        print(*report(deliver(pages, folder), folder), sep="\n")
    return 0


def assemble(notebooks: Path, sources: Path, *, run: bool) -> None:
    """Put all that the site is made of into `sources`."""
    from ikteach.publish.docs.reference import reference

    clone = notebooks.parent
    shutil.copytree(OWN, sources)
    for document, page in DOCUMENTS.items():
        shutil.copyfile(clone / document, sources / page)
    student(notebooks, sources / "course")
    titles = chapters(notebooks)
    if run:
        asyncio.run(_run([sources / "course" / name for name in titles]))
    said = "" if run else f"\n```{{note}}\n{STILL}\n```\n"
    toctree = "\n".join(f"course/{Path(name).stem}" for name in titles)
    course = (sources / "course.md").read_text("utf-8")
    course = course.replace("{said}", said).replace("{chapters}", toctree)
    (sources / "course.md").write_text(course, "utf-8")
    for name, page in reference().items():
        place = sources / "api" / f"{name}.rst"
        place.parent.mkdir(exist_ok=True)
        place.write_text(page, "utf-8")


async def _run(notebooks: list[Path]) -> None:
    """Run the notebooks, as many at a time as there are processors, with stills as outputs."""
    import nbformat

    from ikteach.publish.pages import executed

    places = asyncio.Semaphore(os.cpu_count() or 1)

    async def one(path: Path) -> None:
        async with places:
            nbformat.write(await executed(path), path)

    await asyncio.gather(*map(one, notebooks))


def compose(sources: Path, pages: Path) -> None:
    """Have Sphinx make the pages; RefusedError lists its warnings."""
    from sphinx.application import Sphinx
    from sphinx.errors import SphinxError

    from ikteach.publish.docs.settings import SETTINGS

    said = io.StringIO()
    with tempfile.TemporaryDirectory() as doctrees:
        try:
            app = Sphinx(
                sources, None, pages, doctrees, "html", SETTINGS, status=None, warning=said
            )
            app.build(force_all=True)
        except SphinxError as error:
            said.write(str(error))
    if faults := COLOUR.sub("", said.getvalue()).replace(f"{sources}{os.sep}", "").strip():
        raise RefusedError(f"The documentation has faults:\n{faults}")
