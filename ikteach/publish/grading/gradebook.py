"""Points of a class as tables, for Moodle, Canvas and in detail, and a summary in words."""

import re
from collections import Counter
from pathlib import Path
from typing import Any, NamedTuple

import pandas as pd

from ikteach.course.checking import Verdict
from ikteach.files import bounded
from ikteach.publish.grading.handed_in import HandIn
from ikteach.publish.grading.scheme import Scheme
from ikteach.publish.parser import RefusedError

CANVAS = ["Student", "ID", "SIS User ID", "SIS Login ID", "Section"]
MOODLE = ["Identifier", "Full name", "Username"]
SAID = 3  # wrong answers that the summary tells of an exercise


class Graded(NamedTuple):
    """One student's verdicts, {key: verdict}, of what was handed in."""

    hand_in: HandIn
    verdicts: dict[str, Verdict]

    def points(self, scheme: Scheme) -> float:
        """Count the points."""
        passed = [key for key, verdict in self.verdicts.items() if verdict.passed]
        return sum(scheme.points[key] for key in scheme.points if key in passed)


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
    """Tabulate points as Moodle's import of grades takes them."""
    table = _who(graded, roster, MOODLE)
    for row, one in enumerate(graded):
        hand_in = one.hand_in
        if roster is None:
            number = f"Participant {hand_in.number}" if hand_in.number else ""
            table.loc[row, MOODLE] = [number, hand_in.student, hand_in.student]
        table.loc[row, "Grade"] = one.points(scheme)
        table.loc[row, "Maximum grade"] = scheme.total
        table.loc[row, "Feedback comments"] = feedback(one, scheme)
    return table.rename(columns={"Grade": scheme.title if roster is not None else "Grade"})


def canvas(graded: list[Graded], scheme: Scheme, roster: pd.DataFrame | None) -> pd.DataFrame:
    """Tabulate points as Canvas takes them, below those possible."""
    table = _who(graded, roster, CANVAS)
    for row, one in enumerate(graded):
        hand_in = one.hand_in
        if roster is None:
            table.loc[row, CANVAS] = [hand_in.student, hand_in.number, "", hand_in.student, ""]
        table.loc[row, scheme.title] = one.points(scheme)
    possible = dict.fromkeys(table.columns, "") | {"Student": "    Points Possible"}
    first = pd.DataFrame([possible | {scheme.title: scheme.total}])
    return pd.concat([first, table], ignore_index=True)


def _who(graded: list[Graded], roster: pd.DataFrame | None, columns: list[str]) -> pd.DataFrame:
    """Name the students, by the roster where there is one."""
    if roster is None:
        return pd.DataFrame("", index=range(len(graded)), columns=columns, dtype=object)
    rows = [roster.loc[found(one.hand_in, roster)] for one in graded]
    kept = [name for name in roster.columns if name in {*columns, *IDENTITY}]
    return pd.DataFrame(rows).reset_index(drop=True)[kept].astype(object)


IDENTITY = {"Email address", "ID number", "First name", "Last name", "Email", "username", "email"}


def found(hand_in: HandIn, roster: pd.DataFrame) -> Any:
    """Find a student's row of a roster, or raise RefusedError."""
    wanted = {_plain(hand_in.student), _plain(hand_in.number)} - {""}
    rows = [i for i, row in roster.iterrows() if wanted & set(_called(row))]
    if len(rows) != 1:
        why = "is not in the roster" if not rows else f"is {len(rows)} rows of the roster"
        raise RefusedError(f"{bounded(hand_in.student, 60)} {why}.")
    return rows[0]


def _called(row: "pd.Series[Any]") -> list[str]:
    """All that a row's student may be called."""
    cells = [str(cell) for cell in row]
    first, last = (str(row.get(name, "")) for name in ("First name", "Last name"))
    turned = [" ".join(cell.split(",")[::-1]) for cell in cells if cell.count(",") == 1]
    whole = [f"{first} {last}", f"{last}{first}"]
    numbers = [cell.removeprefix("Participant ") for cell in cells]
    return [_plain(text) for text in (*cells, *turned, *whole, *numbers)]


def _plain(text: str) -> str:
    return re.sub(r"[\W_]", "", text.casefold())


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
    first = table.columns[:1]
    possible = table[first].apply(lambda row: row.str.strip() == "Points Possible").any(axis=1)
    return table[~possible]
