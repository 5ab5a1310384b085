"""A made-up class that answers chapters 0 and 2 over a minute, for the page before a class.

    python tests/tools/pupils.py FOLDER --seconds 60 & python -m ikteach class FOLDER

They predict by the widgets and check real answers, wrong ones first. One wants not to be shown, and
one hands in what would be markup on a careless page.
"""

import argparse
import contextlib
import io
import json
import random
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parents[2]))

from ikteach.course import check, predict, record, reveal, show_in_class
from ikteach.course.solutions import ch00
from ikteach.publish.delivery import find_course
from ikteach.serve.classroom.asked import asked_in
from tests.course.answers.ch00 import WRONG

PUPILS = 30
HOSTILE, SHY = "<b>mallory", "shy"
MARKUP = "<img src=x onerror=\"document.title='taken'\">"
FORECASTS = ("02.inward", "02.near", "00.two")


def steps(folder: Path, seed: int, pupils: int = PUPILS) -> list[Callable[[], object]]:
    """What the class does, one after the other, as each pupil comes to it."""
    draw = random.Random(seed)
    names = [*(f"pupil{i:02}" for i in range(pupils - 2)), HOSTILE, SHY]
    todo = [list(_of(folder / name, draw)) for name in names]
    order = []
    while waiting := [one for one in todo if one]:
        order.append(draw.choice(waiting).pop(0))
    return order


def _of(home: Path, draw: random.Random) -> Iterator[Callable[[], object]]:
    """What one pupil does; most do not come to the end of it."""
    asked = asked_in(find_course().notebooks).predictions
    home.mkdir(parents=True, exist_ok=True)
    if home.name == HOSTILE:
        yield lambda: _hostile(home)
        return
    if home.name == SHY:
        yield lambda: _as(home, lambda: show_in_class(False))
    for key in FORECASTS[: draw.choice([1, 2, 3, 3])]:
        one = asked[key]
        at = draw.randrange(len(one.options) or 5)
        yield lambda one=one, key=key, at=at: _as(home, lambda: _predict(key, one, at))
    if draw.random() < 0.4:
        yield lambda: _as(home, lambda: reveal("02.inward", "none"))
    for i in range(draw.choice([0, 1, 3, 4])):
        wrong = WRONG["00.hand"][draw.choice([0, 0, 0, 1, 5]) if i else 0][0]
        yield lambda wrong=wrong: _as(home, lambda: check("00.hand", wrong))
    if draw.random() < 0.4:
        yield lambda: _as(home, lambda: check("00.hand", ch00.hand))


def _predict(key: str, one: Any, at: int) -> None:
    numbers = {"numbers": one.numbers} if one.numbers else {}
    shown = predict(key, one.question, one.options, **numbers)
    shown.answer = float(at) if one.numbers else one.options[at]
    shown.asked += 1
    shown.close()


def _as(home: Path, act: Callable[[], object]) -> None:
    """Act as the kernel of a notebook in this folder."""
    record._folder = home
    with contextlib.redirect_stdout(io.StringIO()):  # the findings
        act()


def _hostile(home: Path) -> None:
    verdict = {"passed": False, "sentence": MARKUP, "tries": 10**9, "since": MARKUP}
    content = {
        "predictions": {"02.inward": {"answer": MARKUP, "result": MARKUP, "at": "9"}},
        "verdicts": {"00.hand": verdict, MARKUP: verdict},
    }
    (home / record.FILE).write_text(json.dumps(content))


def main() -> None:
    """Have them answer."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--seconds", type=float, default=60.0)
    options = parser.parse_args()
    todo = steps(options.folder, 1)
    for act in todo:
        time.sleep(options.seconds / len(todo))
        act()


if __name__ == "__main__":
    main()
