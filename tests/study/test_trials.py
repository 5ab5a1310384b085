"""The fair experiment."""

from functools import partial
from itertools import product

import numpy as np
import pandas as pd
import pytest
from numpy.testing import assert_allclose
from pandas.testing import assert_frame_equal

from ikteach import SOLVERS, dls, figures, gait, study, track
from ikteach.motion import BUSS_CAPS, clip, hold
from ikteach.study import trials
from ikteach.study.experiment import reversals, starts
from ikteach.study.measures import measures

HUMAN = figures.human()
CAPS = {"equal": dict.fromkeys(SOLVERS, np.radians(30)), "own": BUSS_CAPS}
LIMITS = {"hold": hold, "clip": clip}
POSES = starts(HUMAN.tree, 2)
REACH = np.array([[True, True, False, False], [False] * 4])
OPTIONS = {
    "caps": CAPS, "limits": LIMITS, "dampings": (0.1, 0.4), "starts": POSES, "rate": 20,
    "seconds": 1.5, "settle": 0.5, "can_reach": REACH,
}  # fmt: skip


@pytest.fixture(scope="module")
def found():
    return trials.trials(*HUMAN, gait.MOTIONS, **OPTIONS)


def test_a_row_for_each_cell_of_the_factors(found):
    table = found.table
    assert list(table.columns[:6]) == trials.FACTORS
    assert len(table) == 4 * 2 * 2 * 2 * 2 * 2
    assert not table.duplicated(trials.FACTORS).any()
    assert_frame_equal(table, trials.trials(*HUMAN, gait.MOTIONS, **OPTIONS).table)


def test_a_row_is_the_run_that_it_stands_for(found):
    times = np.arange(1, 31) / 20
    for method, damping in product(SOLVERS, (0.1, 0.4)):
        solver = partial(dls, damping=damping) if method == "dls" else method
        run = track(
            *HUMAN, gait.walking(times), solver, theta=POSES[1], times=times,
            max_step=BUSS_CAPS[method], limits=clip,
        )  # fmt: skip
        late = study.after(run, 0.5)
        [row] = found.table.query(
            f"motion == 'walking' and caps == 'own' and limits == 'clip' and start == 1"
            f" and damping == {damping} and method == '{method}'"
        ).itertuples()
        assert row.mean == pytest.approx(late.error.mean(), rel=1e-6)
        assert row.reach == pytest.approx(late.error[:, :2].mean(), rel=1e-6)
        assert row.out_of_reach == pytest.approx(late.error[:, 2:].mean(), rel=1e-6)
        assert row.capped == pytest.approx(late.capped.mean())
        assert row.held == pytest.approx(late.held.sum(axis=-1).mean())
        assert row.reversals == pytest.approx(reversals(late))
        assert row.jitter == pytest.approx(late.jitter.mean(), rel=1e-6)
        assert row.acceleration == pytest.approx(20**2 * row.jitter)
        again = found.run(row.Index)
        assert again.method == method
        assert_allclose(again.theta, run.theta, atol=1e-9)
        assert_allclose(again.targets, run.targets)
        assert_allclose(again.start, run.start)
        mine = found.distances.iloc[4 * row.Index : 4 * row.Index + 4]
        assert list(mine["effector"]) == list(HUMAN.effectors.names)
        assert (mine["start"] == 1).all()
        assert (mine["run"] == row.Index).all()
        assert_allclose(mine["mean"], late.error.mean(axis=0), rtol=1e-6)
        assert_allclose(mine["p95"], np.quantile(late.error, 0.95, axis=0), rtol=1e-6)
        assert_allclose(mine["max"], late.error.max(axis=0), rtol=1e-6)


def test_a_method_without_damping_runs_once_for_all(found):
    once = [found.at_every_damping(row) for row in found.table.index]
    assert list(np.array(once)) == list(found.table["method"] != "dls")
    bound = trials.trials(
        *HUMAN, gait.MOTIONS, methods={"mine": partial(dls, damping=1)}, **OPTIONS
    )
    assert all(bound.at_every_damping(row) for row in bound.table.index)
    with pytest.raises(IndexError, match="rows 0 to 127, not 128"):
        found.run(128)


def test_what_cannot_be_reached_has_no_mean_of_what_can(found):
    table = found.table
    assert table.loc[table["motion"] == "running", "reach"].isna().all()
    assert table.loc[table["motion"] == "walking", "reach"].notna().all()


def test_reach_is_the_thesiss():
    assert (trials.reachable_throughout(*HUMAN, gait.MOTIONS, phases=4) == REACH).all()


def made_up(order, wins=3):
    """Trials in which the methods have 1, 2, 30, 40 but the first two change places at times."""
    rows = []
    for start in range(4):
        values = dict(zip(order, (1.0, 2.0, 30.0, 40.0), strict=True))
        if start >= wins:
            values[order[0]] = 2.5
        cell = {"motion": "walking", "caps": "equal", "limits": "hold", "damping": 0.1}
        rows += [
            {**cell, "start": start, "method": m, "mean": v, "acceleration": v, "reversals": v}
            for m, v in values.items()
        ]
    return pd.DataFrame(rows)


CELL = ("hold", "walking", "equal", 0.1)


def test_the_ranking_follows_the_numbers():
    for order in (["sdls", "dls", "transpose", "pseudoinverse"], list(SOLVERS)):
        ranked = trials.ranking(made_up(order), "mean").loc[CELL]
        assert ranked["order"] == " < ".join(order)
        assert ranked["first"] == order[0]
        assert ranked["wins"] == 3 / 4


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
    single = [measures(run) for run in runs.values()]
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
