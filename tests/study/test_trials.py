"""The fair experiment and its verdict."""

import numpy as np
import pandas as pd
import pytest
from numpy.testing import assert_allclose
from pandas.testing import assert_frame_equal

from ikteach import SOLVERS, figures, gait, study, track
from ikteach.motion import BUSS_CAPS
from ikteach.study import trials
from ikteach.study.experiment import reversals, starts
from ikteach.study.measures import measures

HUMAN = figures.human()
CAPS = {"equal": dict.fromkeys(SOLVERS, np.radians(30)), "own": BUSS_CAPS}
POSES = starts(HUMAN.tree, 2)
REACH = np.array([[True, True, False, False], [False] * 4])
OPTIONS = {
    "caps": CAPS, "starts": POSES, "rates": (10, 20), "seconds": 1.5, "settle": 0.5,
    "can_reach": REACH,
}  # fmt: skip


@pytest.fixture(scope="module")
def table():
    return trials.trials(*HUMAN, gait.MOTIONS, **OPTIONS)


def test_a_row_for_each_trial(table):
    assert len(table) == 2 * 2 * 2 * 2 * 4
    keys = ["motion", "caps", "rate", "start", "method"]
    assert not table.duplicated(keys).any()
    assert_frame_equal(table, trials.trials(*HUMAN, gait.MOTIONS, **OPTIONS))


def test_a_trial_is_the_run_that_it_stands_for(table):
    times = np.arange(1, 31) / 20
    for method in SOLVERS:
        run = track(
            *HUMAN, gait.walking(times), method, theta=POSES[1], times=times,
            max_step=BUSS_CAPS[method],
        )  # fmt: skip
        late = study.after(run, 0.5)
        [row] = table.query(
            f"motion == 'walking' and caps == 'own' and rate == 20 and start == 1"
            f" and method == '{method}'"
        ).itertuples()
        assert row.mean == pytest.approx(late.error.mean(), rel=1e-6)
        assert row.reach == pytest.approx(late.error[:, :2].mean(), rel=1e-6)
        assert row.out_of_reach == pytest.approx(late.error[:, 2:].mean(), rel=1e-6)
        assert row.capped == pytest.approx(late.capped.mean())
        assert row.reversals == pytest.approx(reversals(late))
        assert row.jitter == pytest.approx(late.jitter.mean(), rel=1e-6)


def test_what_cannot_be_reached_has_no_mean_of_what_can(table):
    assert table.loc[table["motion"] == "running", "reach"].isna().all()
    assert table.loc[table["motion"] == "walking", "reach"].notna().all()


def test_reach_is_the_thesiss():
    assert (trials.reachable_throughout(*HUMAN, gait.MOTIONS, phases=4) == REACH).all()


def made_up(order, wins=3):
    """Trials in which the methods have 1, 2, 3, 4 but the first two change places at times."""
    rows = []
    for start in range(4):
        values = dict(zip(order, (1.0, 2.0, 30.0, 40.0), strict=True))
        if start >= wins:
            values[order[0]] = 2.5
        rows += [
            {"motion": "walking", "caps": "equal", "rate": 30, "start": start, "method": m,
             "mean": v, "jitter": v, "reversals": v}
            for m, v in values.items()
        ]  # fmt: skip
    return pd.DataFrame(rows)


def test_the_ranking_follows_the_numbers():
    for order in (["sdls", "dls", "transpose", "pseudoinverse"], list(SOLVERS)):
        ranked = trials.ranking(made_up(order), "mean").loc[("equal", "walking")]
        assert ranked["order"] == " < ".join(order)
        assert ranked["first"] == order[0]
        assert ranked["wins"] == 3 / 4


def test_the_spread_is_over_starts():
    table = trials.spread(made_up(list(SOLVERS)))
    row = table.loc[("equal", "walking", "transpose")]
    assert row[("mean", "mean")] == np.mean([1, 1, 1, 2.5])
    assert row[("mean", "std")] == pytest.approx(np.std([1, 1, 1, 2.5], ddof=1))


REACHES = {"walking": REACH[0], "running": REACH[1]}
TIMES = {"transpose": 1.0, "pseudoinverse": 2.0, "dls": 1.5, "sdls": 2.4}
STEPS = {"transpose": 90.0, "pseudoinverse": 6.0, "dls": 10.0, "sdls": 5.0}


def test_claims_follow_the_numbers():
    order = ["sdls", "dls", "pseudoinverse", "transpose"]
    table = trials.claims(made_up(order), REACHES, TIMES, STEPS)
    assert table["holds"].tolist() == [True, True, True, False, False, True, True, True]
    other = trials.claims(
        made_up(list(SOLVERS)), {"walking": REACH[1], "running": REACH[0]},
        {**TIMES, "sdls": 1.0}, {**STEPS, "sdls": 99.0},
    )  # fmt: skip
    assert other["holds"].tolist() == [False, False, False, True, True, False, False, False]
    assert "1.6 × dls" in table["numbers"][2]
    assert "0.8 × dls" in table["numbers"][3]


def test_variants_are_what_single_runs_come_to():
    times = np.arange(1, 11) / 30
    walk = gait.walking(times)
    batch = track(*HUMAN, walk[:, None], "sdls", theta=POSES, times=times)
    table = study.variants(batch, ["rest", "other"], "start")
    assert table.index.name == "start"
    runs = {
        name: track(*HUMAN, walk, "sdls", theta=pose, times=times)
        for name, pose in zip(table.index, POSES, strict=True)
    }
    single = [measures(run, ()) for run in runs.values()]
    assert_allclose(table, pd.DataFrame(single), rtol=1e-6, atol=1e-12)
    assert set(study.MEASURES) | {"reversals"} == set(table.columns)
    with pytest.raises(ValueError, match="3 labels do not fit"):
        study.variants(batch, "abc")
    with pytest.raises(ValueError, match="nothing of a run of"):
        study.after(batch, 9)


def test_by_direction_sums_to_the_step():
    table = study.by_direction(*HUMAN, POSES[1], gait.walking(0.2))
    assert list(table.index) == list(range(1, 13))
    assert (table["share"].dropna() <= 1 + 1e-9).all()
    assert_allclose(table["share"], table["f"] * table["σ"])
