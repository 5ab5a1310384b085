"""The marks of a class: `python -m ikteach grade FOLDER` judges every answer again.

Nothing that a file says of itself counts. Each answer is judged from its source in a process of its
own (`judging`), which has neither the solutions nor the network nor anybody's files.
"""

import os
import sys
from collections.abc import Callable
from pathlib import Path

import pandas as pd

from ikteach.course.checking import Verdict
from ikteach.files import write_whole
from ikteach.publish.collect import SKIPPED, harmless, shown_text
from ikteach.publish.grading import gradebook
from ikteach.publish.grading.gradebook import Graded
from ikteach.publish.grading.handed_in import HandIn, hand_ins
from ikteach.publish.grading.judging import Judging
from ikteach.publish.grading.scheme import Scheme, read_scheme
from ikteach.publish.parser import Parser, RefusedError

Table = Callable[[list[Graded], Scheme, pd.DataFrame | None], pd.DataFrame]
TABLES: dict[str, Table] = {
    "moodle": gradebook.moodle,
    "canvas": gradebook.canvas,
    "table": gradebook.details,
}


def grade(
    folder: Path, scheme: Scheme, roster: pd.DataFrame | None = None
) -> tuple[list[Graded], dict[str, str], str]:
    """Judge a folder; give marks, what was left out, walls."""
    found, skipped = hand_ins(folder)
    if roster is not None:
        gradebook.rows_of(found, roster)  # what is wrong with it is said before, not after
    known: dict[tuple[str, str], Verdict] = {}  # many answers are alike
    graded = []
    for count, one in enumerate(found):
        if sys.stderr.isatty():
            print(f"judging {count + 1} of {len(found)}", end="\r", file=sys.stderr)
        with Judging(hidden=folder) as judging:
            graded.append(Graded(one, _verdicts(one, scheme, judging, known)))
            walls = judging.walls
    return graded, skipped, walls if found else ""


def _verdicts(
    one: HandIn, scheme: Scheme, judging: Judging, known: dict[tuple[str, str], Verdict]
) -> dict[str, Verdict]:
    """Judge the answers of a student; of several to one exercise the best counts."""
    verdicts: dict[str, Verdict] = {}
    for key in scheme.points:
        for source in one.sources.get(key, []):
            if (key, source) not in known:
                known[key, source] = judging.verdict(key, source)
            verdict = known[key, source]
            if verdict.passed or key not in verdicts or not verdicts[key].passed:
                verdicts[key] = verdict
    return verdicts


def main(argv: list[str]) -> int:
    """Grade what was handed in; give the exit code."""
    parser = Parser(
        prog="python -m ikteach grade",
        description="Judge the answers in FOLDER again, from notebooks or from what "
        "predictions.json keeps, each in a process of its own, and give points.",
        epilog="Exit code: 0 if all was read, 3 if files were left out, which are named, 1 if "
        "there was nothing to grade or a table could not be written.",
        allow_abbrev=False,
    )
    parser.add_argument("folder", metavar="FOLDER", type=Path, help="NAME/… or NAME.ipynb, .json")
    parser.add_argument("--points", metavar="TOML", type=Path, help="the scheme of points")
    parser.add_argument(
        "--roster", metavar="CSV", type=Path, help="the platform's list of students"
    )
    parser.add_argument("--moodle", metavar="CSV", type=Path, help="write grades for Moodle there")
    parser.add_argument("--canvas", metavar="CSV", type=Path, help="write grades for Canvas there")
    parser.add_argument("--table", metavar="CSV", type=Path, help="write every verdict there")
    options = parser.parse_args(argv)
    outputs = {name: path for name in TABLES if (path := getattr(options, name))}
    for path in outputs.values():
        if os.path.lexists(path):
            raise RefusedError(f"{path} exists already and was left alone; name another file.")
    if len(set(map(os.path.realpath, outputs.values()))) < len(outputs):
        raise RefusedError("Each table needs a file of its own.")
    scheme = read_scheme(options.points)
    roster = gradebook.read_roster(options.roster) if options.roster else None
    try:
        graded, skipped, walls = grade(options.folder.expanduser(), scheme, roster)
    except NotADirectoryError as error:
        raise RefusedError(f"{error}.") from None
    for name, why in skipped.items():
        print(shown_text(f"{name}: left out: {why}"), file=sys.stderr)
    if not graded:
        raise RefusedError(f"Nobody has handed in anything in {options.folder}.")
    print(shown_text(gradebook.class_summary(graded, scheme)))
    print(f"Judged behind: {walls}.")
    tables = {name: TABLES[name](graded, scheme, roster) for name in outputs}
    for name, path in outputs.items():
        try:
            write_whole(path, harmless(tables[name]).to_csv(index=False))
        except OSError as error:
            raise RefusedError(f"{error}.") from None
        print(f"written: {path}")
    return SKIPPED if skipped else 0
