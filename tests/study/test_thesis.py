"""The sentences of the thesis, held against a small experiment: what is said of it, and how firmly.

The experiment is that of chapter 8 with fewer starts and λ.
"""

import json
import re
from pathlib import Path

import numpy as np
import pytest
import rounding

from ikteach import SOLVERS, figures, solvers
from ikteach.study import evidence, thesis
from ikteach.study.experiment import starts
from ikteach.study.trials import trials
from ikteach.study.verdicts import against, holding, weigh

HUMAN = figures.human()
REACH = [[True, True, False, False], [False] * 4, [True] * 4]
CAPS = {"equal": dict.fromkeys(SOLVERS, np.radians(30)), **evidence.OWN["caps"]}
TIMED = {"times", "arrivals"}  # which hang on the machine


def gathered():
    same = {"starts": starts(HUMAN.tree, 2), "dampings": (0.05, 0.1, 0.4, 0.8), "can_reach": REACH}
    ours = trials(*HUMAN, evidence.MOTIONS, caps=CAPS, limits=evidence.LIMITS, **same)
    own = trials(*HUMAN, evidence.MOTIONS, **evidence.OWN, **same)
    return evidence.gather(ours, own)


@pytest.fixture(scope="module")
def facts():
    return gathered()


@pytest.fixture(scope="module")
def table(facts):
    both = [thesis.verdicts(facts), thesis.verdicts(facts, thesis.SLIPS)]
    return {says: row for part in both for (_, says), row in part.iterrows()}


def test_every_sentence_has_a_verdict_a_number_and_a_margin(table):
    assert len(table) == len(thesis.CLAIMS) + len(thesis.SLIPS)
    for says, row in table.items():
        assert row["verdict"].startswith(("holds", "does not hold", "depends on ")), says
        assert any(digit.isdigit() for digit in row["number"]), says
        assert row["measured by"].endswith(("by 10%", "by 25%", "by 50%"))
        assert row["verdict"].startswith("depends") >= bool(row["turned by"])


def test_what_is_known_of_the_sentences(table):
    """Those that have a wide margin, or are mathematics."""
    words = {says: row["verdict"] for says, row in table.items()}
    for says in (
        "walking: both leg targets reachable",
        "walking: the hands' targets never",
        "running: four targets unreachable",
        "capped, it is “unable to effectively track”",
        "pseudoinverse: “instability near singularities”",
        "DLS “avoids many” of its problems near singular",
        "the same, a step near a singular pose",
        "the transpose uses “fewer computations”",
        "λ “must be chosen very carefully”",
    ):
        assert words[says] == "holds"
    for says in (
        "pseudoinverse: “slightly better results”",
        "the transpose needs “the least iteration”",
        "human motion without capture: feet that stand",
        "“d ≤ 0” is reachable",
        "a row of zeroes: “almost singular”, not wholly",
        "an m × n matrix U that is orthogonal",
        "its α leaves least of e (our reading: Δt = JJᵀe)",
    ):
        assert words[says].startswith("does not hold")
    assert words["increments “small enough” to look smooth"] == "depends on the motion"
    assert words["“defined for all matrices”: Jᵀ(JJᵀ)⁻¹"] == "depends on the pose"
    complexity = table["DLS, SDLS have “greater complexity” than the others"]
    assert complexity["turned by"] == "pseudoinverse 0%, transpose 100%"
    near = table["transpose and pseudoinverse: problems near singular"]
    assert near["turned by"] == "pseudoinverse 100%, transpose 0%"


def test_one_order_by_jitter_survives_all_that_is_varied(facts):
    """The thesis's worst method is calmer than its best."""
    orders = ["transpose < sdls", "sdls < transpose", "dls < transpose", "dls < sdls", "sdls < dls"]
    assert holding(facts.runs, orders, "acceleration") == ["transpose < sdls"]
    cells = against(facts.runs, ["transpose"], ["sdls"], ["acceleration"])
    assert weigh(cells).share == 1
    dls = weigh(against(facts.runs, ["dls"], ["transpose"], ["acceleration"]))
    assert dls.turns[0] == "damping"


def test_no_verdict_hangs_on_the_last_bits_of_a_processor(facts, monkeypatch):
    for name, other in rounding.move_all().items():
        monkeypatch.setattr(np.linalg, name, other)
    again = gathered()
    for claim in (*thesis.CLAIMS, *thesis.SLIPS):
        if claim.table not in TIMED:
            before, after = (claim.verdict(getattr(of, claim.table)) for of in (facts, again))
            assert before.word == after.word, claim.says


def test_the_names_that_optimisers_have_are_those_of_the_solvers():
    """The table of chapter 8 and the docstring of `ikteach.solvers` say the same."""
    path = Path(__file__).parents[2] / "notebooks" / "08_comparison.ipynb"
    first = "".join(json.loads(path.read_text(encoding="utf-8"))["cells"][0]["source"])
    rows = dict(re.findall(r"^\| (\w+)[^|]* \| ([^|]+?) \|$", first, re.MULTILINE))
    del rows["here"]
    assert set(rows) == {*SOLVERS, "ccd"}
    for method, name in rows.items():
        (line,) = re.findall(rf"^ +{method} +(.+)$", solvers.__doc__, re.MULTILINE)
        known = re.match(r"[^ ,]+( descent)?", name)
        assert line.startswith(known[0])
