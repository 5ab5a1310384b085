"""Points of a class as tables, for Moodle, Canvas and in detail, and a summary in words."""

import re
from collections import Counter
from pathlib import Path
from typing import Any, NamedTuple
from unicodedata import category, normalize

import pandas as pd

from ikteach.course.checking import Verdict
from ikteach.files import bounded
from ikteach.publish.grading.handed_in import HandIn
from ikteach.publish.grading.scheme import Scheme, added
from ikteach.publish.parser import RefusedError

# The columns with which the platforms' tables begin, in their order.
CANVAS = ["Student", "ID", "SIS User ID", "SIS Login ID", "Section"]
MOODLE = ["Identifier", "Full name", "Username", "Last modified (grade)"]
# Those that say who somebody is, in what the platforms export and in lists of one's own.
NAMES = ["First name", "Last name", "FirstName", "LastName", "Name", "name", "username"]
NUMBERS = ["ID number", "Email address", "Email", "email", "Integration ID", "Root Account"]
WHO = [*CANVAS[:-1], *MOODLE[:-1], *NAMES, *NUMBERS]
SAID = 3  # wrong answers that the summary tells of an exercise


class Graded(NamedTuple):
    """One student's verdicts, {key: verdict}, of what was handed in."""

    hand_in: HandIn
    verdicts: dict[str, Verdict]

    def points(self, scheme: Scheme) -> float:
        """Count the points."""
        passed = [key for key, verdict in self.verdicts.items() if verdict.passed]
        return added(scheme.points[key] for key in scheme.points if key in passed)


def details(
    graded: list[Graded], scheme: Scheme, roster: pd.DataFrame | None = None
) -> pd.DataFrame:
    """Tabulate every verdict, a row per student and exercise."""
    rows = []
    for one in graded:
        for key, worth in scheme.points.items():
            verdict = one.verdicts.get(key)
            passed = verdict is not None and verdict.passed
            rows.append(
                {
                    "student": one.hand_in.student,
                    "number": one.hand_in.number,
                    "exercise": key,
                    "passed": passed,
                    "points": worth if passed else 0,
                    "sentence": "Not handed in." if verdict is None else verdict.sentence,
                    "claimed": key in one.hand_in.claims,
                }
            )
    return pd.DataFrame(rows)


def moodle(graded: list[Graded], scheme: Scheme, roster: pd.DataFrame | None) -> pd.DataFrame:
    """Tabulate points as Moodle takes them.

    As the worksheet of an assignment, which must have the columns `MOODLE`; with the roster of a
    course as a table for its gradebook.
    """
    table = _who(graded, roster, MOODLE)
    worksheet = "Identifier" in table
    for row, one in enumerate(graded):
        hand_in = one.hand_in
        if roster is None:
            number = f"Participant {hand_in.number}" if hand_in.number else ""
            table.loc[row, MOODLE] = [number, hand_in.student, hand_in.student, ""]
        table.loc[row, "Grade" if worksheet else scheme.title] = one.points(scheme)
        table.loc[row, "Maximum grade"] = scheme.total
        table.loc[row, "Feedback comments"] = feedback(one, scheme)
    return table


def canvas(graded: list[Graded], scheme: Scheme, roster: pd.DataFrame | None) -> pd.DataFrame:
    """Tabulate points as Canvas takes them, below those possible."""
    table = _who(graded, roster, CANVAS)
    for row, one in enumerate(graded):
        if roster is None:
            table.loc[row, CANVAS[:2]] = [one.hand_in.student, one.hand_in.number]
        table.loc[row, scheme.title] = one.points(scheme)
    possible = dict.fromkeys(table.columns, "") | {table.columns[0]: "    Points Possible"}
    first = pd.DataFrame([possible | {scheme.title: scheme.total}])
    return pd.concat([first, table], ignore_index=True)


def _who(graded: list[Graded], roster: pd.DataFrame | None, columns: list[str]) -> pd.DataFrame:
    """Name the students, by the roster where there is one."""
    if roster is None:
        return pd.DataFrame("", index=range(len(graded)), columns=columns, dtype=object)
    table = roster.loc[rows_of([one.hand_in for one in graded], roster)].reset_index(drop=True)
    whole = "Identifier" in roster  # a worksheet comes back as it is, with what else it has
    return table[[name for name in table if whole or name in {*columns, *WHO}]].astype(object)


def rows_of(hand_ins: list[HandIn], roster: pd.DataFrame) -> list[Any]:
    """Find each student's row of a roster.

    RefusedError names all who have none of their own.
    """
    called = {row: _called(cells) for row, cells in roster.iterrows()}
    rows: list[Any] = []
    amiss = []
    for one in hand_ins:
        name = bounded(one.student, 60)
        by_number, by_name = (
            [row for row, names in called.items() if wanted and wanted in names]
            for wanted in map(_plain, (one.number, one.student))
        )
        found = by_number or by_name
        if len(found) == 1 and found[0] in rows:
            other = bounded(hand_ins[rows.index(found[0])].student, 60)
            amiss.append(f"{name} and {other} are the same row of the roster.")
        elif len(found) != 1:
            why = f"is {len(found)} rows of the roster" if found else "is not in the roster"
            amiss.append(f"{name} {why}.")
        rows.append(found[0] if found else None)
    if amiss:
        raise RefusedError("\n".join(amiss))
    return rows


def _called(row: "pd.Series[Any]") -> set[str]:
    """All that a row's student may be called."""
    cells = [str(row[name]) for name in WHO if name in row]
    pairs = [("First name", "Last name"), ("FirstName", "LastName")]
    names = [tuple(str(row.get(one, "")) for one in pair) for pair in pairs]
    names += [tuple(cell.split(",")[::-1]) for cell in cells if cell.count(",") == 1]
    whole = ["".join(pair) for first, last in names for pair in ((first, last), (last, first))]
    numbers = [cell.removeprefix("Participant ") for cell in cells]
    return set(map(_plain, (*cells, *whole, *numbers)))


def _plain(text: str) -> str:
    """Drop blanks, marks of direction and punctuation, in which platforms differ."""
    letters = normalize("NFKC", text).casefold()
    return "".join(one for one in letters if category(one)[0] in "LMN")


def feedback(one: Graded, scheme: Scheme) -> str:
    """Say in a line what was passed and what not."""
    told = []
    for key in scheme.points:
        verdict = one.verdicts.get(key)
        word = "not handed in" if verdict is None else verdict.sentence
        told.append(f"{key}: {'passed' if verdict is not None and verdict.passed else word}")
    return " | ".join(told)


def class_summary(graded: list[Graded], scheme: Scheme) -> str:
    """Tell how a class did, and what most got wrong."""
    points = pd.Series([one.points(scheme) for one in graded])
    lines = [
        f"{len(graded)} students, {len(scheme.points)} exercises, {scheme.total:g} points in all.",
        f"Mean {points.mean():.4g}, median {points.median():.4g}, "
        f"from {points.min():g} to {points.max():g}.",
    ]
    table = details(graded, scheme)
    for key, group in sorted(table.groupby("exercise"), key=lambda pair: pair[1]["passed"].mean()):
        lines.append(f"{key}: {group['passed'].sum()} of {len(group)} passed.")
        wrong = group.loc[~group["passed"], "sentence"]
        alike = Counter(map(_alike, wrong))
        first = {_alike(sentence): sentence for sentence in reversed(wrong.tolist())}
        lines += [f"  {n} ×: {bounded(first[kind], 160)}" for kind, n in alike.most_common(SAID)]
    claims = table[table["claimed"] & ~table["passed"]]
    if len(claims):
        lines.append("Said to be passed in the file, and not passed when judged again:")
        lines += [f"  {row.student}: {row.exercise}" for row in claims.itertuples()]
    return "\n".join(lines)


def _alike(sentence: str) -> str:
    """Drop what differs between sentences of one kind: numbers and names."""
    return re.sub(r"`[^`]*`|[-+]?\d[\d.e+-]*", "#", sentence)[:80]


def read_roster(path: Path) -> pd.DataFrame:
    """Read the list of students that a platform exports, as texts."""
    try:
        table = pd.read_csv(path, dtype=str, keep_default_na=False, encoding="utf-8-sig")
    except (ValueError, OSError) as error:
        raise RefusedError(f"{path} cannot be read as a table: {bounded(str(error))}.") from None
    if not set(table) & set(WHO):
        raise RefusedError(f"{path} has no column that says who somebody is: {', '.join(WHO)}.")
    first = table.iloc[:, 0].str.strip()
    return table[first != "Points Possible"]
