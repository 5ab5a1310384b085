"""Questions on the course's table of letters: which letter means what."""

import re
from collections.abc import Iterator

import numpy as np

from ikteach.publish.pack.bank import VARIANTS, gift
from ikteach.publish.pack.parts import Chapter

ROW = re.compile(r"^\| ([^|$]+) \| ([^|$]+) \| ([^|$]*)\|$", re.MULTILINE)
PAIRS = 5


def letters(chapter: Chapter, name: str) -> Iterator[str]:
    """Write matching questions on the table in this chapter.

    Rows with formulas are left out: Moodle's short answers show none.
    """
    (table,) = (cell.source for cell in chapter.cells if cell.id == "notation")
    rows = [(row[0].strip(), row[1].strip()) for row in ROW.findall(table)[1:]]
    rng = np.random.default_rng(0)
    for i in range(1, VARIANTS + 1):
        chosen = sorted(rng.choice(len(rows), PAIRS, replace=False))
        yield gift.matching_question(
            f"{name} {i:02}", "What does each letter mean?", [rows[j] for j in chosen]
        )
