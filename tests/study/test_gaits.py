"""The table of gaits against the measures that it is made of."""

import pytest

from ikteach import figures
from ikteach.motion import gait
from ikteach.motion.paths import quality
from ikteach.motion.paths.perform import perform
from ikteach.motion.paths.walk import Walk
from ikteach.study import gait_report


def test_the_natural_walk_beside_that_of_the_thesis():
    walk = Walk()
    tracks = {
        "natural": perform(walk, figures.walker(), "dls"),
        "thesis": perform(gait.walking, figures.human(), "dls"),
    }
    table = gait_report(tracks, {"natural": walk, "thesis": gait.walking})
    assert table.index.tolist() == ["natural", "thesis"]
    assert table.loc["natural", "score"] < table.loc["thesis", "score"]
    for name, path in ("natural", walk), ("thesis", gait.walking):
        run, row = tracks[name], table.loc[name]
        assert row["score"] == pytest.approx(quality.gait_score(run, path))
        parts = row[list(quality.CURVES)]
        assert row["score"] == pytest.approx(((parts**2).mean()) ** 0.5)
        assert row["slip"] == quality.slip(run, path).max()
    alone = gait_report({"natural": tracks["natural"]}, walk, speed="Fast")
    assert alone.loc["natural", "score"] != table.loc["natural", "score"]


def test_no_runs_are_refused():
    with pytest.raises(ValueError, match="at least one"):
        gait_report({}, Walk())
