"""Runs, sessions and experiments as tables; below `view` pandas is imported here alone.

runs        runs of many methods, and their tidy log
measures    summaries of logs and runs
sessions    ticks, poses and events of a live figure
directions  one step by singular directions (chapter 6)
reach       the simulator of chapter 10
gaits       how natural a run is (chapter 11)
walks       three walks of one body, to be compared (chapter 11)
poses       frames that turn and feet that give way (chapter 12)
experiment  runs made to be compared, starts, counts and times
trials      the fair experiment of chapter 8
verdicts    rules by which its table says whether a sentence holds
evidence    what else the sentences of the thesis are held against
thesis      these sentences, as data
"""

from ikteach.study.directions import by_direction
from ikteach.study.gaits import gait_report
from ikteach.study.measures import (
    MEASURES,
    by_phase,
    distances,
    many,
    ranges,
    summary,
    variants,
)
from ikteach.study.reach import follow, reaches, standings
from ikteach.study.runs import after, compare, log, runs, timing, together
from ikteach.study.sessions import angles, events, ticks

__all__ = [
    "MEASURES",
    "after",
    "angles",
    "by_direction",
    "by_phase",
    "compare",
    "distances",
    "events",
    "follow",
    "gait_report",
    "log",
    "many",
    "ranges",
    "reaches",
    "runs",
    "standings",
    "summary",
    "ticks",
    "timing",
    "together",
    "variants",
]
