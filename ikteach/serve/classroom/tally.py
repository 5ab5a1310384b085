"""Counts for the page before a class: predictions, who is stuck, what is got wrong.

What students wrote themselves is for nobody's wall: an answer that is not among those asked for,
and a finding or a key that only one student has, are counted without their words or not at all,
unless names are asked for.
"""

import re
from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping
from datetime import UTC, datetime
from itertools import pairwise
from statistics import median
from typing import Any

from ikteach.course.checking import NOT_YET
from ikteach.course.questions import fits, written
from ikteach.files import bounded
from ikteach.markup import brief, visible
from ikteach.serve.classroom.asked import Asked, Prediction
from ikteach.serve.classroom.folder import Answers

STUCK_TRIES, STUCK_MINUTES = 3, 10  # wrong tries, or minutes since the first one
BARS, KINDS, PARTS = 8, 8, 5  # rows of a chart: answers, findings, parts of a range
MOST_TRIES = 999  # that anybody is believed to have made
OTHER, ALONE = "another answer", "findings of one student each"
CODE, NUMBER = re.compile(r"`[^`]*`?"), re.compile(r"[-−+]?\d[\d.]*(?:e[-+−]?\d+)?")
RAISED = re.compile(r"(raised \w+):.*")  # the rest of which is the student's

Class = Mapping[str, Answers]  # student -> answers


def tally(
    students: Class,
    asked: Asked,
    *,
    troubles: Mapping[str, str],
    names: bool = False,
    now: datetime | None = None,
) -> dict[str, Any]:
    """Count the answers of a class, as data for the page.

    asked  what the notebooks ask
    names  whether students and their own words may be named
    """
    now = now or datetime.now(UTC)
    predicted, tried = _by_key(students, "predictions"), _by_key(students, "verdicts")
    open_ = {
        key: {who: entry for who, entry in entries.items() if entry["answer"] is not None}
        for key, entries in predicted.items()
    }
    known = asked.predictions
    others = sorted(key for key in open_ if key not in known and (names or len(open_[key]) > 1))
    keys = [*filter(open_.get, known), *others]
    tasks = [key for key in tried if names or key in asked.exercises or len(tried[key]) > 1]
    found: dict[str, Any] = {
        "students": len(students),
        "troubles": len(troubles),
        "predictions": [_prediction(key, known.get(key), open_[key], predicted[key], now)
                        for key in keys],
        "exercises": [_exercise(key, tried[key], now, names) for key in sorted(tasks)],
    }  # fmt: skip
    if names:
        for one in found["predictions"]:
            one["who"] = _named(open_[one["key"]])
            one["missing"] = _named(students.keys() - open_[one["key"]].keys())
        found["named"] = [f"{brief(name)}: {visible(why)}" for name, why in troubles.items()]
    return found


def _by_key(students: Class, kind: str) -> dict[str, dict[str, Any]]:
    """Turn {student: answers} into {key: {student: entry}}."""
    found: dict[str, dict[str, Any]] = defaultdict(dict)
    for who, answers in students.items():
        for key, entry in answers[kind].items():
            found[key][who] = entry
    return found


def _prediction(
    key: str,
    asked: Prediction | None,
    given: Mapping[str, Any],
    all_: Mapping[str, Any],
    now: datetime,
) -> dict[str, Any]:
    answers = [one["answer"] for one in given.values()]
    results = [one["result"] for one in all_.values() if one["result"] is not None]
    result = Counter(map(_words, results)).most_common(1)[0][0] if results else None
    rows, note = _unknown(answers), ""
    if asked is not None:
        kind = "number" if asked.numbers else "ranking" if asked.ranking else "choice"
        proper = [one for one in answers if fits(one, kind, asked.options, asked.numbers)]
        if asked.numbers:
            rows, note = _binned(proper, asked.numbers), _median(proper, asked.numbers[2])
        else:
            counts = Counter(map(_words, proper))
            some = [] if asked.ranking else [(one, counts.pop(one, 0)) for one in asked.options]
            rows = [*some, *counts.most_common(BARS)]
        rows += [(OTHER, more)] if (more := len(answers) - sum(n for _, n in rows)) else []
    times = filter(None, (_time(one["at"]) for one in given.values()))
    newest = max((time.timestamp() for time in times if time <= now), default=0.0)
    return {
        "key": key, "question": asked.question if asked else "", "answered": len(given),
        "rows": [{"label": label, "count": n} for label, n in rows], "note": note,
        "result": result, "newest": newest,
    }  # fmt: skip


def _unknown(answers: Iterable[Any]) -> list[tuple[str, int]]:
    """Count answers to what no notebook asks: those that two students or more gave."""
    counts = Counter(map(_words, answers))
    shared = [(label, n) for label, n in counts.most_common(BARS) if n > 1]
    rest = counts.total() - sum(n for _, n in shared)
    return [*shared, *([(OTHER, rest)] if rest else [])]


def _binned(answers: list[float], numbers: tuple[float, float, str]) -> list[tuple[str, int]]:
    """Count numbers, each whole one or in parts of their range."""
    low, high, unit = numbers
    single = high - low < BARS and all(x % 1 == 0 for x in [low, high, *answers])
    parts = int(high - low) + 1 if single else PARTS
    width = 1.0 if single else (high - low) / PARTS
    counts = Counter(min(int((x - low) / width), parts - 1) for x in answers)
    edges = pairwise(low + i * width for i in range(parts + 1))
    labels = [f"{a:g}" if single else f"{a:g} to {b:g}" for a, b in edges]
    return [(f"{label} {unit}".strip(), counts[i]) for i, label in enumerate(labels)]


def _median(answers: list[float], unit: str) -> str:
    return f"Median: {median(answers):.4g} {unit}".strip() if answers else ""


def _words(value: Any) -> str:
    return visible(bounded(written(value), 80))


def _exercise(key: str, tried: Mapping[str, Any], now: datetime, names: bool) -> dict[str, Any]:
    """Count who passed, who is at work and who is stuck, and the kinds of wrong answers."""
    wrong = {who: one for who, one in tried.items() if one["passed"] is not True}
    stuck = {who: one for who, one in wrong.items() if _is_stuck(one, now)}
    since = [_minutes(one, now) for one in stuck.values()]
    kinds: dict[str, list[str]] = defaultdict(list)
    for who, one in wrong.items():
        if not _not_yet(one):
            kinds[finding_kind(_finding(one))].append(who)
    rows: list[dict[str, Any]] = []
    for whose in sorted(kinds.values(), key=len, reverse=True):
        said = Counter(_finding(wrong[who]) for who in whose).most_common(1)[0][0]
        more = {"who": _named(whose), "example": _sentence(wrong[whose[0]])} if names else {}
        rows.append({"label": said, "count": len(whose)} | more)
    if not names:
        alone = sum(row["count"] == 1 for row in rows)
        rows = [row for row in rows if row["count"] > 1]
        rows += [{"label": ALONE, "count": alone}] if alone else []
    found = {
        "key": key, "passed": len(tried) - len(wrong), "working": len(wrong) - len(stuck),
        "stuck": len(stuck), "longest": max(since, default=0),
        "tries": max((_tries(one) for one in stuck.values()), default=0), "kinds": rows[:KINDS],
    }  # fmt: skip
    if names:
        longest_first = sorted(stuck, key=lambda who: -_minutes(stuck[who], now))
        found["who"] = [
            {"name": brief(who), "minutes": _minutes(stuck[who], now), "tries": _tries(stuck[who])}
            for who in longest_first
        ]
    return found


def finding_kind(finding: str) -> str:
    """Tell the kind of a finding: its words, without its numbers."""
    return NUMBER.sub("#", finding)


def _finding(entry: Mapping[str, Any]) -> str:
    """Return what the check says, without what the student wrote."""
    text = CODE.sub("…", RAISED.sub(r"\1", _sentence(entry)))
    return bounded(" ".join(text.split()), 160)


def _is_stuck(entry: Mapping[str, Any], now: datetime) -> bool:
    many = _tries(entry) >= STUCK_TRIES and not _not_yet(entry)
    return many or _minutes(entry, now) >= STUCK_MINUTES


def _not_yet(entry: Mapping[str, Any]) -> bool:
    return _sentence(entry).startswith(NOT_YET)


def _sentence(entry: Mapping[str, Any]) -> str:
    return visible(str(entry["sentence"] or ""))


def _named(students: Iterable[str]) -> list[str]:
    return [brief(name) for name in sorted(students)]


def _tries(entry: Mapping[str, Any]) -> int:
    return min(entry["tries"], MOST_TRIES) if type(entry["tries"]) is int else 0


def _minutes(entry: Mapping[str, Any], now: datetime) -> int:
    """Return the minutes since the first try; 0 where nobody knows."""
    first = _time(entry["since"] or entry["at"])
    return 0 if first is None else max(0, int((now - first).total_seconds() // 60))


def _time(text: Any) -> datetime | None:
    try:
        time = datetime.fromisoformat(str(text))
        return time if time.tzinfo else time.replace(tzinfo=UTC)
    except (ValueError, OverflowError):
        return None
