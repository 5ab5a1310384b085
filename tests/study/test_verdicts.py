"""Rules of verdicts, on made-up experiments whose answer is known."""

from itertools import product

import numpy as np
import pandas as pd
import pytest
from numpy.testing import assert_array_equal

from ikteach import SOLVERS
from ikteach.study import thesis
from ikteach.study.evidence import Evidence
from ikteach.study.thesis import CLAIMS, SLIPS, Claim
from ikteach.study.verdicts import MARGIN, against, against_bound, as_said, holding, turning, weigh

LEVELS = {
    "limits": ["hold", "clip"],
    "motion": ["walking", "running", "in reach"],
    "caps": ["equal", "own"],
    "damping": [0.1, 0.2, 0.4],
    "start": range(4),
}
RUNS = ["mean", "p95", "reach", "out_of_reach", "acceleration", "reversals"]


def made_up(ratio, measures=RUNS):
    """An experiment in which `ratio(method=…, limits=…, measure=…)` is what a method measures."""
    rows = []
    for values in product(SOLVERS, *LEVELS.values()):
        cell = dict(zip(["method", *LEVELS], values, strict=True))
        rows.append(cell | {name: 7.0 * ratio(**cell, measure=name) for name in measures})
    return pd.DataFrame(rows)


def dls_against_sdls(ratio):
    """The cells of "dls has less than sdls", if its share of sdls's measure is `ratio(…)`."""
    table = made_up(lambda method, **cell: ratio(**cell) if method == "dls" else 1.0, ["mean"])
    return against(table, ["dls"], ["sdls"], ["mean"])


@pytest.mark.parametrize(
    ("ratio", "word", "share"),
    [
        (0.5, "holds", 1),
        (2.0, "does not hold: the other way round", 0),
        (1.0, "does not hold: no difference", 0),
        (1 / 1.09, "does not hold: no difference", 0),  # within the margin, on either side
        (1.09, "does not hold: no difference", 0),
        (1 / 1.11, "holds", 1),
        (1.11, "does not hold: the other way round", 0),
    ],
)
def test_a_sentence_holds_or_does_not(ratio, word, share):
    found = weigh(dls_against_sdls(lambda **cell: ratio))
    assert (found.word, found.share, found.cells, found.turns) == (word, share, 144, ())
    assert found.ratios == pytest.approx([ratio] * 3, rel=1e-3)
    assert found.margin == MARGIN


@pytest.mark.parametrize("factor", LEVELS)
def test_a_sentence_depends_on_the_factor_that_turns_it(factor):
    first = next(iter(LEVELS[factor]))
    found = weigh(dls_against_sdls(lambda **cell: 0.5 if cell[factor] == first else 2.0))
    assert found.turns == (factor,)
    assert found.word.startswith("depends on ")
    assert found.share == pytest.approx(1 / len(LEVELS[factor]))
    if factor != "start":  # of which one is as good as another
        assert f"{first} 100%" in found.where
        assert found.where.count(" 0%") == len(LEVELS[factor]) - 1


def test_it_depends_on_two_factors_where_both_turn_it():
    found = weigh(
        dls_against_sdls(lambda limits, caps, **_: 0.5 if limits == "hold" and caps == "own" else 2)
    )
    assert set(found.turns) == {"limits", "caps"}
    assert found.share == 1 / 4


def test_it_depends_on_measure_and_opponent_too():
    table = made_up(
        lambda method, measure, **_: (
            0.5 if method == "sdls" and measure == "mean" else 2.0 if method == "sdls" else 1.0
        )
    )
    best = against(table, ["sdls"], ["dls", "transpose"], ["mean", "reversals"])
    assert weigh(best).turns == ("measure",)
    assert weigh(best).where == "mean 100%, reversals 0%"
    rank = dict(zip(SOLVERS, (1.0, 4.0, 3.0, 2.0), strict=True))
    table = made_up(lambda method, **_: rank[method])
    found = weigh(against(table, ["sdls"], ["transpose", "dls"], ["mean"]))
    assert found.turns == ("whom",)
    assert found.where == "dls 100%, transpose 0%"


def test_what_one_start_in_ten_says_does_not_count():
    cells = pd.DataFrame({"start": range(40), "ratio": [0.5] * 37 + [2.0] * 3})
    assert weigh(cells).word == "holds"
    assert (
        weigh(cells.assign(ratio=1 / cells["ratio"])).word == "does not hold: the other way round"
    )
    half = weigh(pd.DataFrame({"start": range(40), "ratio": [0.5, 2.0] * 20}))
    assert (half.word, half.where) == ("depends on the start pose", "")


def test_no_verdict_hangs_on_the_last_bits():
    """Where two are equal to the last bits, as where numbers lie at the edge of nothing."""
    rng = np.random.default_rng(0)
    tiny = 1 + 1e-12 * rng.standard_normal(1000)
    cells = pd.DataFrame({"start": range(1000), "ratio": tiny})
    assert weigh(cells).word == "does not hold: no difference"
    assert weigh(cells, "at most").word == "holds"
    still = pd.DataFrame(
        {"method": ["dls", "sdls"], "reversals": [0.0, 1e-9], "mean": [1e-15, 0.0]}
    )
    found = against(still, ["dls"], ["sdls"], ["reversals", "mean"])
    assert_array_equal(as_said(found["ratio"]), [0, 0])


def test_never_against_never_is_no_difference():
    never = pd.DataFrame({"method": ["dls", "sdls", "transpose"], "steps": [np.inf, np.inf, 5.0]})
    assert weigh(against(never, ["dls"], ["sdls"], ["steps"])).word.endswith("no difference")
    assert weigh(against(never, ["transpose"], ["sdls"], ["steps"])).word == "holds"
    assert weigh(against(never, ["sdls"], ["transpose"], ["steps"])).word.endswith(
        "other way round"
    )


def test_relations():
    ratio = pd.Series([0.5, 0.95, 1.0, 1.05, 2.0])
    assert list(as_said(ratio, "less")) == [1, 0, 0, 0, -1]
    assert list(as_said(ratio, "more")) == [-1, 0, 0, 0, 1]
    assert list(as_said(ratio, "at most")) == [1, 1, 1, 1, -1]
    assert list(as_said(ratio, "less", margin=0.03)) == [1, 1, 0, -1, -1]


def test_turning_counts_the_pairs_that_differ_in_one_factor():
    cells = pd.DataFrame(product("ab", "xyz"), columns=["limits", "caps"])
    yes = cells["limits"] == "a"
    assert dict(turning(cells, yes)) == {"limits": 1.0, "caps": 0.0}
    yes &= cells["caps"] == "x"
    assert dict(turning(cells, yes)) == pytest.approx({"limits": 1 / 3, "caps": 2 / 6})


def test_within_a_bound():
    table = pd.DataFrame({"motion": ["walking", "running"], "leap": [0.05, 0.3], "other": 1.0})
    cells = against_bound(table, "leap", 0.1)
    assert list(cells.columns) == ["motion", "ratio"]
    assert weigh(cells).where == "running 0%, walking 100%"
    assert len(against_bound(table.assign(leap=[np.nan, 1.0]), "leap", 0.1)) == 1


def test_orders_that_hold():
    rank = dict(zip(SOLVERS, (1.0, 4.0, 1.05, 2.0), strict=True))
    table = made_up(lambda method, **_: rank[method])
    asked = ["transpose < sdls", "transpose < dls", "sdls < transpose", "sdls<pseudoinverse"]
    assert holding(table, asked, "mean") == ["transpose < sdls", "sdls<pseudoinverse"]


# The sentences.


def words(claims):
    return [(claim.section, claim.says, claim.measured) for claim in claims]


def test_every_sentence_is_a_comparison_of_its_own():
    every = [*CLAIMS, *SLIPS]
    assert len(set(words(every))) == len(every)
    for claim in every:
        assert claim.table in Evidence._fields
        assert all(name in thesis.MEASURES for name in claim.measures)
        assert bool(claim.whom) != bool(claim.bound[0])
        assert claim.bound[0] == 0 or len(claim.measures) == 1
        assert len(claim.says) < 60  # a few words, no more
        assert not set(claim.who) & set(claim.whom)


@pytest.mark.parametrize("claim", [c for c in CLAIMS if c.whom and c.factor == "method"], ids=repr)
def test_a_sentence_of_methods_follows_the_numbers(claim: Claim):
    """It holds where its methods have less, and does not where they have more."""
    table = made_up(lambda method, **_: 1.0 if method in claim.who else 3.0, claim.measures)
    assert claim.verdict(table).word == "holds"
    table = made_up(lambda method, **_: 3.0 if method in claim.who else 1.0, claim.measures)
    assert claim.verdict(table).word.startswith("does not hold")


@pytest.mark.parametrize("claim", [c for c in (*CLAIMS, *SLIPS) if not c.whom], ids=repr)
def test_a_sentence_with_a_bound_follows_the_numbers(claim: Claim):
    cell = {name: next(iter(values)) for name, values in claim.where.items()}
    words = []
    for size in 1e-3, 1e3:
        table = pd.DataFrame([cell | {claim.measures[0]: size * claim.bound[0]}])
        words.append(claim.verdict(table).word)
    holds, fails = words if claim.relation != "more" else words[::-1]
    assert holds == "holds"
    assert fails.startswith("does not hold")


def one(section, says):
    (claim,) = (c for c in CLAIMS if section in c.section and says in c.says)
    return claim


def test_whom_the_thesis_compares_with_whom():
    slow, best = one("5.3", "slower than the other"), one("5.3", "best performance of all four")
    assert set(slow.who) == set(best.whom) == set(SOLVERS) - {"sdls"}  # against all three
    assert (slow.whom, best.who) == (("sdls",), ("sdls",))
    for says in "not slower", "much better animation":
        claim = one("7.1", says)
        assert (claim.who, claim.whom) == (("dls", "sdls"), ("transpose", "pseudoinverse"))
    assert one("5.3", "substantially better").whom == ("transpose", "pseudoinverse")
    for says in "both leg targets reachable", "the hands' targets never", "four targets":
        assert one("5.3", says).table == "reach"


def test_the_distance_of_all_motions_is_not_asked_of_the_thesiss():
    """Walking with hands in reach is ours; the sentences on walking and running leave it out."""
    for claim in CLAIMS:
        if claim.table == "runs" and claim.measures != ("reach",) and claim.factor == "method":
            motions = set(claim.where.get("motion", ()))
            assert motions in ({"walking", "running"}, {"in reach"}) or "reach" in claim.measures
