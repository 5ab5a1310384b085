"""The time trial: who arrives, after how many steps, and what a broken solver costs the others."""

from functools import partial

import numpy as np
import pytest

from ikteach import SOLVERS, dls, dls_following, figures
from ikteach.study.timetrial import arrival, time_trial

HUMAN = figures.human()
FEW = {"courses": 6, "most": 30}


def test_arrival_is_the_first_frame_with_all_effectors_near():
    error = np.array([[0.5, 0.1], [0.001, 0.2], [0.004, 0.009], [0.3, 0.3]])
    assert arrival(error, np.array([1.0, 2, 3, 9]), 0.01) == (True, 3, 2.0)
    assert arrival(error, np.array([1.0, 2, 3, 2]), 0.001) == (False, 4, 2.0)


@pytest.mark.usefixtures("rounding")
def test_the_best_rank_first_and_scores_are_shares_of_the_steps_saved():
    methods = {
        "good": dls_following,
        "bad": partial(dls, damping=30.0),
        "still": lambda J, e: 0 * J[0],
    }
    table = time_trial(*HUMAN, methods, **FEW)
    assert list(table.index) == ["good", "bad", "still"]
    assert table.loc["good", "reached"] > 0.8
    assert 70 < table.loc["good", "score"] < 100
    assert table.loc["still", ["reached", "score", "jitter"]].to_list() == [0, 0, 0]
    assert (table["time"] > 0).all()
    assert (table["fell"] == "").all()


def test_equal_but_for_time():
    one, two = (time_trial(*HUMAN, SOLVERS, **FEW).drop(columns="time") for _ in "ab")
    assert one.equals(two)
    other = time_trial(*HUMAN, SOLVERS, seed=1, **FEW)
    assert not other["score"].sort_index().equals(one["score"].sort_index())


def test_a_solver_that_fails_falls_and_the_others_ride_on():
    def broken(J, e):
        raise RuntimeError("no brakes")

    table = time_trial(*HUMAN, {"stub": lambda J, e: None, "broken": broken, "dls": dls}, **FEW)
    assert table.index[0] == "dls"
    assert "gave back nothing" in table.loc["stub", "fell"]
    assert table.loc["broken", "fell"] == "no brakes"
    assert table.loc[["stub", "broken"], "score"].to_list() == [0, 0]


@pytest.mark.parametrize("wrong", [{"courses": 0}, {"most": 0}, {"within": -1.0}])
def test_what_is_no_trial_is_refused(wrong):
    with pytest.raises(ValueError, match=next(iter(wrong))):
        time_trial(*HUMAN, "dls", **wrong)
