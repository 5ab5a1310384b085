"""The simulator of CS 490 against the general methods: python tests/bench/reach.py [cursors]

Cursors are where a hand is in random poses within the limits, so that arm and back of that side can
reach every one. Each way starts from rest, with limits on, for at most 300 ticks: first without a
cap, to see the largest step of a joint in one tick, then with the simulator's cap of 10°.
"""

import sys

from ikteach import study
from ikteach.motion.reach.packages import ReachingFigure
from ikteach.motion.reach.reaching import reachable_cursors
from ikteach.motion.reach.ways import MAX_STEP, PARTS


def main(cursors=2000, ticks=300):
    """Print a table for each cap."""
    places = reachable_cursors(ReachingFigure(), cursors)
    for cap, words in ((None, "no cap"), (MAX_STEP, "no joint turns more than 10° a tick")):
        print(f"{cursors} cursors, n = {PARTS} parts, {words}")
        table = study.reaches(places, ticks=ticks, max_step=cap)
        print(table.to_string(float_format="{:.3f}".format))


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
