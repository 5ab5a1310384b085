"""What a wrong argument of study, trials, experiment, gait and the simulator is told."""

import re
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from ikteach import SOLVERS, figures, gait, study, track
from ikteach.motion.anatomy import anatomy
from ikteach.motion.reach.planar import PlanarReach
from ikteach.motion.reach.reaching import Reach, reachable_cursors, trial
from ikteach.motion.reach.ways import WAYS, Way, advance
from ikteach.motion.reachable import nearest
from ikteach.solvers import cramer, dls
from ikteach.study import experiment, trials, verdicts

ARM = figures.planar_arm(3)
HUMAN = figures.human()
GOALS = np.tile([[[1.0, 1.0, 0.0]]], (5, 1, 1))
RUN = track(*ARM, GOALS, "dls")
OTHER = track(*ARM, 0.5 * GOALS, "sdls")
TABLE = study.log(RUN)
BROKEN = replace(RUN, theta=np.full_like(RUN.theta, np.nan))
EMPTY = replace(RUN, times=RUN.times[:0], theta=RUN.theta[:0], error=RUN.error[:0])
REACHING = Reach()
BODY, WAY = REACHING.body, WAYS["dls"]
CAPS = {"none": {}}
LONG = "x" * 10**6


def fair(**others):
    return trials.trials(*ARM, {"round": experiment.Round()}, **{
        "caps": CAPS, "starts": np.zeros((1, 3)), "rate": 5, "can_reach": [[True]],
    } | others).table  # fmt: skip


FAIR = fair()
CALLS = {
    "no run": (lambda: study.log("walk"), "a run is a Track, as `track` makes, not 'walk'"),
    "NaN in a run": (lambda: study.log(BROKEN), "the run of 'dls' has theta that are not finite"),
    "no frame": (lambda: study.log(EMPTY), "the run of 'dls' has no frame"),
    "reach of another": (
        lambda: study.log(RUN, can_reach=[True]),
        r"the shape \(5, 1\), not \(1,\)",
    ),
    "runs in a list": (lambda: study.together([RUN]), "runs are {name: Track}"),
    "no runs": (lambda: study.together({}), "there is no run"),
    "other targets": (
        lambda: study.together({"a": RUN, "b": OTHER}),
        "'b' does not follow those of 'a'",
    ),
    "no method": (lambda: study.compare(*ARM, GOALS, []), "at least one method is needed"),
    "a number for a method": (
        lambda: study.compare(*ARM, GOALS, 3),
        "methods are solvers or their names",
    ),
    "a name that is none": (lambda: study.compare(*ARM, GOALS, "dsl"), "no method 'dsl'"),
    "a long name": (lambda: study.compare(*ARM, GOALS, LONG), "no method"),
    "a cap for none": (
        lambda: study.compare(*ARM, GOALS, "dls", max_step={"dsl": 1}), "no method 'dsl'; did"
    ),
    "a table of another kind": (lambda: study.summary([1]), "a table is a DataFrame"),
    "no rows": (lambda: study.summary(TABLE[:0]), "the table has no rows"),
    "no such column": (
        lambda: study.summary(TABLE, by="metod"),
        "no column 'metod'; did you mean 'method'",
    ),
    "no column": (lambda: study.summary(TABLE, by=[]), "at least one column"),
    "a column missing": (lambda: study.summary(TABLE.drop(columns="error")), "no column 'error'"),
    "words for numbers": (
        lambda: study.summary(TABLE.assign(error="far")),
        "'error' is not made of numbers",
    ),
    "a cycle of no time": (lambda: study.by_phase(TABLE, 0), "a cycle lasts longer than 0 s"),
    "a cycle without end": (
        lambda: study.by_phase(TABLE, np.inf),
        "period must be 0 or more, and finite",
    ),
    "half a part": (lambda: study.by_phase(TABLE, 1, 0.5), "parts must be 1 or more, and whole"),
    "distances of none": (lambda: study.distances({}), "there is no run"),
    "timing of none": (lambda: study.timing({"a": 1}), "a run is a Track"),
    "ticks of a run": (lambda: study.ticks(RUN), "what happened is in a Log"),
    "angles of a run": (lambda: study.angles(RUN), "what happened is in a Log"),
    "events of a run": (lambda: study.events(RUN), "what happened is in a Log"),
    "after words": (lambda: study.after(RUN, "long"), "seconds must be 0 or more"),
    "after all": (lambda: study.after(RUN, 9), "nothing of a run"),
    "labels": (lambda: study.variants(RUN, 3), "1 labels do not fit a batch"),
    "directions of many": (
        lambda: study.by_direction(*ARM, np.zeros((2, 3)), GOALS[0]), "taken apart at a time"
    ),
    "directions, targets": (
        lambda: study.by_direction(*ARM, np.zeros(3), [1, 2]),
        "targets of shape",
    ),
    "ways in a list": (lambda: study.reaches([0, 0, 0], ["dls"]), "ways are {name: Way}"),
    "a solver for a way": (lambda: study.reaches([0, 0, 0], {"a": dls}), "'a' must be a Way"),
    "follow what": (lambda: study.follow([1, 2], WAY), r"cursors have the shape \(T, 3\)"),
    "follow how long": (lambda: study.follow([0, 0, 0], WAY, -1), "ticks must be 1 or more"),
    "follow whom": (lambda: study.follow([0, 0, 0], "dls", 3), "must be a Way"),
    "no motions": (lambda: trials.reachable_throughout(*ARM, {}), "motions are {name: gait}"),
    "no gait": (
        lambda: trials.reachable_throughout(*ARM, {"a": 3}),
        "the motion 'a' is no gait but 3",
    ),
    "a human's gait": (
        lambda: trials.reachable_throughout(*ARM, gait.MOTIONS),
        r"'walking' gives targets \(8, 4, 3\), and this body needs \(8, 1, 3\)",
    ),
    "phases": (lambda: trials.reachable_throughout(*HUMAN, gait.MOTIONS, 0), "phases must be 1"),
    "no caps": (lambda: fair(caps={}), "caps are {name"),
    "caps of words": (lambda: fair(caps={"a": "b"}), "a set of caps is {method: cap}"),
    "caps of none": (lambda: fair(caps={"a": {"dsl": 1}}), "no method 'dsl'"),
    "starts": (lambda: fair(starts=np.zeros(3)), r"starts need the shape \(s, 3\), not \(3,\)"),
    "too short": (lambda: fair(seconds=1), "none is left of 1 s after 1 s"),
    "a rate of words": (lambda: fair(rate="fast"), "rate must be 0 or more"),
    "no limits": (lambda: fair(limits={}), "limits are {name: limit rule}"),
    "limits of words": (lambda: fair(limits={"a": "hold"}), "'a' must be a function, not 'hold'"),
    "λ twice": (lambda: fair(dampings=[0.1, 0.1]), "dampings are one λ or more, each once"),
    "λ below 0": (lambda: fair(dampings=[-1.0]), "λ must be 0 or more"),
    "no λ": (lambda: fair(dampings=[]), "dampings are one λ or more"),
    "λ of words": (lambda: fair(dampings="big"), "dampings must be made of numbers"),
    "trials, reach": (lambda: fair(can_reach=[True]), r"can_reach needs the shape \(1, 1\)"),
    "rank what": (lambda: trials.ranking(FAIR, "method"), "'method' is not made of numbers"),
    "rank one": (lambda: trials.ranking(fair(methods="dls"), "mean"), "two methods or more"),
    "against whom": (
        lambda: verdicts.against(FAIR, ["dls"], ["sldls"], ["mean"]),
        "no method 'sldls'; did you mean 'sdls'",
    ),
    "against by what": (
        lambda: verdicts.against(FAIR, ["dls"], ["sdls"], ["meen"]),
        "no column 'meen'; did you mean 'mean'",
    ),
    "within nothing": (lambda: verdicts.against_bound(FAIR, "mean", 0), "by a bound of 0"),
    "weigh what": (lambda: verdicts.weigh(FAIR), "no column 'ratio'"),
    "weigh how": (
        lambda: verdicts.weigh(verdicts.against_bound(FAIR, "mean", 1), "fewer"),
        "no relation 'fewer'; there are 'less', 'more', 'at most'",
    ),
    "weigh nothing": (
        lambda: verdicts.weigh(verdicts.against_bound(FAIR, "mean", 1)[:0]),
        "no rows",
    ),
    "gait of words": (lambda: replace(gait.walking, speed="fast"), "speed of 'walking' is 'fast'"),
    "gait of NaN": (lambda: replace(gait.walking, hand_z=np.nan), "must be a finite number"),
    "gait without a name": (lambda: replace(gait.walking, name=3), "the name of a gait is a text"),
    "half a tick": (lambda: replace(gait.walking, slowdown=0.5), "slowdown counts ticks"),
    "wounds of words": (
        lambda: replace(gait.walking, wound={"knee.l": "bad"}),
        "must be from 0 to 1",
    ),
    "a list of wounds": (
        lambda: replace(gait.walking, wound=["knee.l"]),
        "a wound is {joint: mobility}",
    ),
    "time in words": (lambda: gait.walking("soon"), "T must be made of numbers"),
    "time without end": (lambda: gait.walking(np.inf), "the phase of a gait must be finite"),
    "clock of words": (lambda: gait.walking.clock("many"), "frames must be 0 or more"),
    "clock of NaN": (lambda: gait.walking.clock(3, np.nan), "dt must be 0 or more, and finite"),
    "drawn of words": (lambda: gait.displayed("a"), "theta must be made of numbers"),
    "drawn of others": (lambda: gait.displayed([1, 2], times=[1, 2, 3]), "do not fit together"),
    "starts of words": (lambda: experiment.starts(ARM.tree, "a"), "count must be 0 or more"),
    "starts beyond": (lambda: experiment.starts(ARM.tree, 3, spread=2), "spread is a share"),
    "starts of NaN": (lambda: experiment.starts(ARM.tree, 3, spread=np.nan), "spread must be"),
    "reversals": (lambda: experiment.reversals(3), "a run is a Track"),
    "circle": (lambda: experiment.circle([0], turn=0), "a turn longer than 0 s"),
    "downhill": (
        lambda: experiment.downhill(*ARM, [0, 0, 0], GOALS[0], 1.0),
        r"gains \(g,\) are wanted",
    ),
    "iterations": (lambda: experiment.iterations(*ARM, [1, 1], "dls"), "targets of shape"),
    "iterations, NaN": (
        lambda: experiment.iterations(*ARM, GOALS[0], "dls", within=np.nan),
        "within must be",
    ),
    "times of a step": (
        lambda: experiment.step_times(*ARM, GOALS[0]),
        "targets over time have shape",
    ),
    "no rounds": (lambda: experiment.step_times(*ARM, GOALS, rounds=0), "rounds must be 1 or more"),
    "anatomy of nothing": (
        lambda: anatomy(*ARM[:1], [0, 0, 0], ARM[1], GOALS[0], "dls", methods=[]),
                           "at least one method"),
    "nearest to NaN": (lambda: nearest(*ARM, [[np.nan, 0, 0]]), "target of 'hand' is not finite"),
    "nearest to words": (lambda: nearest(*ARM, "there"), "targets must be made of numbers"),
    "parts of words": (lambda: Reach(parts="six"), "number of parts must be"),
    "no parts": (lambda: Reach(parts=0), "divided into 1 part or more"),
    "ways of solvers": (lambda: Reach({"dls": dls}), "'dls' must be a Way, as Way.dls. is"),
    "a way of words": (lambda: Way("dls"), "the solver of a way must be a function"),
    "cursor of words": (lambda: REACHING.put("there"), "the cursor must be made of numbers"),
    "cursor of NaN": (lambda: REACHING.put([0, 0, np.nan]), "a cursor is three finite numbers"),
    "a move of two": (lambda: REACHING.move([0, 0]), "a cursor is three finite numbers"),
    "cramer for two": (
        lambda: PlanarReach(2, {"cramer": cramer}),
        "Cramer's rule is for an arm of three",
    ),
    "four links": (lambda: PlanarReach(4), "has 1, 2 or 3 links"),
    "cursors of two": (lambda: trial(BODY, [0, 0], WAY), r"cursors \(..., 3\) are x, y and z"),
    "trial of whom": (lambda: trial(BODY, [0, 0, 0], dls), "must be a Way"),
    "how many cursors": (lambda: reachable_cursors(BODY, -1), "number of cursors must be 0"),
    "batches": (
        lambda: advance(BODY, np.zeros((2, 17)), np.zeros((3, 3)), WAY), "do not fit together"
    ),
}  # fmt: skip


@pytest.mark.parametrize("what", CALLS)
def test_one_sentence_names_the_culprit(what):
    call, words = CALLS[what]
    with pytest.raises((ValueError, TypeError, LookupError)) as caught:
        call()
    said = str(caught.value)
    assert re.search(words, said)
    assert len(said) < 400
    assert "\n" not in said


def one(J, e):
    return 0.1 * np.vecmat(e, J)


@pytest.mark.parametrize(
    ("methods", "names"),
    [
        (SOLVERS, list(SOLVERS)),
        ("dls", ["dls"]),
        (["sdls", "dls"], ["sdls", "dls"]),
        (one, ["one"]),
        ([one, one, "dls", dls], ["one", "one 2", "dls", "dls 2"]),
        ({"mine": one, "theirs": "dls"}, ["mine", "theirs"]),
        (lambda J, e: one(J, e), ["<lambda>"]),
    ],
)
def test_methods_however_they_are_given(methods, names):
    """None is lost, not even of two with one name."""
    table = study.compare(*ARM, GOALS, methods)
    assert list(table["method"].unique()) == names
    assert list(experiment.step_times(*ARM, GOALS, methods, rounds=1)) == names
    assert set(fair(methods=methods)["method"]) == set(names)
    assert list(anatomy(*ARM[:1], [0, 0.1, 0.1], ARM[1], GOALS[0], "dls", methods=methods)
                .responses)[: len(names)] == names  # fmt: skip


def test_what_cannot_be_measured_has_no_first():
    table = fair(can_reach=[[False]])
    ranked = trials.ranking(table, "reach")
    assert ranked["wins"].isna().all()
    assert pd.api.types.is_numeric_dtype(ranked["wins"])
