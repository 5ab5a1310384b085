"""Runs as tables."""

from dataclasses import replace
from functools import partial

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from metamorphic import BODY, Case
from numpy.testing import assert_allclose, assert_array_equal
from pandas.testing import assert_frame_equal
from strategies import KNOWN, SEEDS

from ikteach import SOLVERS, Effectors, dls, figures, forward, gait, jacobian, locate, study, track
from ikteach.motion import BUSS_CAPS, clip

TREE, EFFECTORS = figures.human()
FRAMES, K = 20, 4
WALK = gait.walking(gait.walking.clock(FRAMES))
COLUMNS = [
    "frame", "time", "method", "effector", "error", "reachable", "capped", "held", "jitter",
    "smallest_sigma",
]  # fmt: skip


@pytest.fixture(scope="module")
def run():
    return track(TREE, EFFECTORS, WALK, "dls", max_step=0.05)


@pytest.fixture(scope="module")
def table():
    return study.compare(TREE, EFFECTORS, WALK)


def test_a_row_is_a_frame_and_an_effector(run):
    log = study.log(run)
    assert list(log.columns) == COLUMNS
    assert len(log) == FRAMES * K
    assert_array_equal(log["frame"], np.repeat(np.arange(FRAMES), K))
    assert_array_equal(log["time"], np.repeat(run.times, K))
    assert_array_equal(log["effector"].iloc[:5], [*EFFECTORS.names, EFFECTORS.names[0]])
    assert (log["method"] == "dls").all()
    assert_array_equal(log["error"], run.error.ravel())
    assert_array_equal(log["capped"], np.repeat(run.capped, K))
    assert_array_equal(log["jitter"], np.repeat(run.jitter, K))
    assert_array_equal(log["smallest_sigma"], np.repeat(run.smallest_sigma, K))
    chains = [[run.held[t][EFFECTORS.carried[i]].sum() for i in range(K)] for t in range(FRAMES)]
    assert_array_equal(log["held"], np.ravel(chains))
    assert log["held"].max() > 0
    assert_array_equal(log["reachable"], ~log["effector"].str.startswith("hand"))


def test_reach_may_be_handed_in(run):
    log = study.log(run, can_reach=np.zeros((FRAMES, K), dtype=bool))
    assert not log["reachable"].any()


def test_a_log_is_of_one_run():
    batch = track(TREE, EFFECTORS, np.stack([WALK, WALK], axis=1), "dls")
    with pytest.raises(ValueError, match=r"a log is of one run, not of a batch of shape \(2,\)"):
        study.log(batch)
    with pytest.raises(ValueError, match="there is no run"):
        study.together({})


def test_equal_inputs_give_equal_tables(table):
    assert_frame_equal(table, study.compare(TREE, EFFECTORS, WALK))
    assert_frame_equal(study.summary(table), study.summary(table.copy()))


def test_methods_by_name_by_mapping_and_all(table):
    assert list(table["method"].cat.categories) == list(SOLVERS)
    assert len(table) == len(SOLVERS) * FRAMES * K
    assert list(table.columns) == COLUMNS
    some = study.compare(TREE, EFFECTORS, WALK, ["sdls", "dls"])
    assert list(some["method"].cat.categories) == ["sdls", "dls"]
    for name in ("sdls", "dls"):
        ours, all_ = (t[t["method"] == name].drop(columns="method") for t in (some, table))
        assert_frame_equal(ours.reset_index(drop=True), all_.reset_index(drop=True))
    named = {"λ = 0.1": partial(dls, damping=0.1), "λ = 1": partial(dls, damping=1)}
    mapped = study.compare(TREE, EFFECTORS, WALK, named)
    assert list(mapped["method"].unique()) == list(named)
    with pytest.raises(LookupError, match="no method 'dsl'"):
        study.compare(TREE, EFFECTORS, WALK, ["dsl"])


def test_a_cap_for_all_or_for_each():
    runs = study.runs(TREE, EFFECTORS, WALK, max_step=BUSS_CAPS, limits=clip)
    for name, run in runs.items():
        alone = track(TREE, EFFECTORS, WALK, name, max_step=BUSS_CAPS[name], limits=clip)
        assert_array_equal(run.theta, alone.theta)
    assert runs["pseudoinverse"].capped.any()
    assert not runs["sdls"].capped.any()
    for name, run in study.runs(TREE, EFFECTORS, WALK, max_step=0.01).items():
        moved = np.diff(run.theta, axis=0)
        assert abs(moved).max() <= 0.01 + 1e-12, name


def test_the_summary_is_what_numpy_says(table):
    summary = study.summary(table)
    assert list(summary.columns) == study.MEASURES
    assert len(summary) == len(SOLVERS) * K
    runs = study.runs(TREE, EFFECTORS, WALK)
    for method, run in runs.items():
        for i, effector in enumerate(EFFECTORS.names):
            row, error = summary.loc[method, effector], run.error[:, i]
            held = run.held[:, EFFECTORS.carried[i]].sum(axis=1).mean()
            wanted = [
                error.mean(), np.median(error), np.quantile(error, 0.95), error.max(),
                run.jitter.mean(), run.capped.mean(), held, run.smallest_sigma.min(),
            ]  # fmt: skip
            assert_allclose(row, wanted)
    by_method = study.summary(table, by=["method"])
    assert_allclose(by_method["mean"], [run.error.mean() for run in runs.values()])


def test_of_many_runs_the_middle_and_the_ends(table):
    one = study.runs(TREE, EFFECTORS, WALK[:, None], ["dls"], theta=TREE.rest[None])
    summary = study.summary(table).loc[["dls"]]
    for word in ("least", "median", "most"):
        of_one = study.many(one).xs(word, axis=1, level=1)
        assert list(of_one.columns) == study.MEASURES
        assert_allclose(of_one, summary, rtol=1e-6, atol=1e-12)

    poses = TREE.rest + np.linspace(0, 0.2, 5)[:, None]
    runs = study.runs(TREE, EFFECTORS, WALK[:, None], ["sdls", "dls"], theta=poses)
    many = study.many(runs)
    assert many.index.tolist() == [(m, e) for m in ("sdls", "dls") for e in EFFECTORS.names]
    assert list(many["mean", "median"].unstack("effector").columns) == list(EFFECTORS.names)
    error, jitter = runs["dls"].error[:, :, 0].mean(axis=0), runs["dls"].jitter.mean(axis=0)
    row = many.loc["dls", EFFECTORS.names[0]]
    assert_allclose(row["mean"], [error.min(), np.median(error), error.max()])
    assert_allclose(row["jitter"], [jitter.min(), np.median(jitter), jitter.max()])
    with pytest.raises(ValueError, match="many runs are a batch"):
        study.many(study.runs(TREE, EFFECTORS, WALK, ["dls"]))
    with pytest.raises(ValueError, match="no runs"):
        study.many({})


def test_ranges_stand_where_runs_differ():
    words = pd.MultiIndex.from_product([["mean", "jitter"], ["least", "median", "most"]])
    rows = [[0.1201, 0.1202, 0.1203, 1.3, 4.94, 5.2], [0, 1e-17, 3e-9, 0.5, 0.5, 1]]
    told = study.ranges(pd.DataFrame(rows, columns=words))
    assert told.to_dict("list") == {
        "mean": ["0.12", "0"],
        "jitter": ["4.9 (1.3 to 5.2)", "0.5 (0.5 to 1)"],
    }


def test_by_phase_is_a_mean_in_each_part_of_the_cycle(table):
    period = gait.walking.period
    parts = study.by_phase(table, period, parts=4)
    part = (table["time"] % period / period * 4).astype(int)
    wanted = table[(part == 0) & (table["method"] == "dls") & (table["effector"] == "foot.l")]
    assert parts.index[0] == 1 / 8
    assert_allclose(parts.loc[1 / 8, ("dls", "foot.l")], wanted["error"].mean())
    assert parts.shape == (3, len(SOLVERS) * K)  # the run is shorter than a cycle


def test_distances_at_a_glance():
    runs = study.runs(TREE, EFFECTORS, WALK, ["dls", "sdls"])
    table = study.distances(runs)
    assert list(table.index) == ["dls", "sdls"]
    run = runs["sdls"]
    assert_allclose(table.loc["sdls", list(EFFECTORS.names)], 100 * run.error.mean(axis=0))
    assert table.loc["sdls", "worst"] == 100 * run.error.max()
    assert table.loc["sdls", "jitter"] == pytest.approx(np.degrees(run.jitter.mean()))
    assert table.loc["sdls", "held"] == run.held.sum(axis=1).mean()


def test_wall_time_stands_apart():
    runs = study.runs(TREE, EFFECTORS, WALK, ["dls", "sdls"])
    timing = study.timing(runs)
    assert isinstance(timing, pd.Series)
    assert timing.to_dict() == {name: run.seconds for name, run in runs.items()}
    assert "seconds" not in study.together(runs).columns


def test_an_arm_in_the_plane_is_singular_where_it_is_stretched():
    tree, hand = figures.planar_arm(3)
    theta = np.array([[0.3, 0.5, 0.7], [0.0, 1.2, 1.2], [0.0, 0.0, 0.0]])
    s = locate(forward(tree, theta), hand)
    run = track(tree, hand, s, "dls", theta=theta[0])
    log = study.log(replace(run, theta=theta))
    J = jacobian(tree, forward(tree, theta), hand)
    assert_allclose(log["smallest_sigma"], np.linalg.svdvals(J[:, :2])[:, 1], atol=1e-12)
    assert (log["smallest_sigma"][:2] > 0.3).all()
    assert log["smallest_sigma"][2] < 1e-12
    goal = np.tile([[[1.0, 1.0, 0.0]]], (60, 1, 1))
    table = study.compare(tree, hand, goal, theta=[0.3, 0.5, 0.7])
    assert (study.summary(table)["smallest_sigma"] > 0.1).all()


@settings(max_examples=25)
@given(st.one_of(KNOWN, st.just(figures.planar_arm(3))), SEEDS, st.sampled_from(list(BODY)))
def test_the_table_moves_along_with_the_body(figure, seed, change):
    rng = np.random.default_rng(seed)
    tree, effectors = figure
    theta = rng.uniform(
        np.maximum(tree.lower, -np.pi), np.minimum(tree.upper, np.pi), (3, len(tree))
    )
    away = rng.choice([0.0, 2.0], (3, len(effectors), 1)) * rng.normal(size=(3, len(effectors), 3))
    targets = locate(forward(tree, theta), effectors) + away
    one, two, along = BODY[change](Case(tree, effectors, theta, targets), rng)
    run = track(*one[:2], one.targets, "dls", theta=one.theta[0])
    other = replace(
        run, tree=two.tree, effectors=two.effectors, targets=two.targets,
        theta=along.pose(run.theta), start=along.pose(run.start), error=along.distances(run.error),
        held=along.marks(run.held),
    )  # fmt: skip
    before, after = study.log(run), study.log(other)
    order = np.arange(before.shape[0]).reshape(3, -1)[:, along.effectors].ravel()
    before = before.iloc[order].reset_index(drop=True)
    assert_allclose(after["error"], along.length * before["error"], rtol=1e-9)
    assert_array_equal(after["reachable"], before["reachable"])
    assert_array_equal(after["held"], before["held"])
    assert_allclose(after["jitter"], before["jitter"], atol=1e-9)
    assert_allclose(
        after["smallest_sigma"] / along.length, before["smallest_sigma"], rtol=1e-6, atol=1e-9
    )


def test_no_column_is_lost_to_an_effector_of_its_name():
    tree, _ = figures.planar_arm(2)
    both = Effectors.of(tree, {"worst": ("joint1", (1, 0, 0)), "held": ("joint2", (1, 0, 0))})
    run = track(tree, both, np.ones((4, 2, 3)), "dls")
    row = study.distances({"dls": run}).loc["dls"]
    assert_allclose(row[["effector worst", "effector held"]], 100 * run.error.mean(axis=0))
    assert row["worst"] == 100 * run.error.max()


def test_reach_is_each_bodys_own():
    """Two bodies after the same targets: the short one's reach is not taken for the long one's."""
    goal = np.tile([[[0.0, 2.5, 0.0]]], (3, 1, 1))
    tracks = {str(links): track(*figures.planar_arm(links), goal, "dls") for links in (2, 3)}
    table = study.together(tracks)
    assert table.groupby("method", observed=True)["reachable"].all().to_dict() == {
        "2": False, "3": True,
    }  # fmt: skip
