"""What TEACHING.md promises of each chapter's demo, done with the controls that it names."""

import math
import re
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from ikteach import figures, gait, study, track
from ikteach.course.record import store
from ikteach.motion import BUSS_CAPS
from ikteach.publish.collect import collect
from ikteach.study import distances
from ikteach.study.experiment import nearby
from ikteach.view import (
    BendBench,
    ColumnPoser,
    GaitPlayer,
    Poser,
    Simulator,
    WalksPlayer,
    Workbench,
)
from ikteach.view.chapters.comparison import EQUAL, OWN, Race
from ikteach.view.chapters.dls import tradeoff_bench
from ikteach.view.chapters.pseudoinverse import CapPlayer
from ikteach.view.chapters.robots import robot_player, standing_player
from ikteach.view.chapters.sdls import spectrum_bench
from ikteach.view.chapters.transpose import slope_bench

pytestmark = pytest.mark.usefixtures("rounding")
TEXT = (Path(__file__).parents[2] / "TEACHING.md").read_text(encoding="utf-8")


def put(bench: Any, **values: Any) -> str:
    """Move controls; what the figure says then."""
    for name, value in values.items():
        bench.controls[name].value = value
    return str(bench.words)


def number(pattern: str, words: str) -> float:
    found = re.search(pattern + r" ?(-?[\d.e-]+\d)", words)
    assert found, f"no {pattern} in {words}"
    return float(found[1])


def standing(session: Any, ticks: int = 150) -> pd.DataFrame:
    """The table under a figure that has run for so many ticks, of the last two thirds."""
    for _ in range(ticks):
        session.tick()
    return distances(session.tracks(last=2 * ticks // 3))


def shaken(*caps: float | None) -> list[np.ndarray]:
    """Jitter [°] of the pseudoinverse from forty poses that hardly differ, (40,) for each cap [°].

    150 ticks with each cap, one after the other; of the last two thirds. For what is seen in a
    figure whose run is chaotic: it must be seen from most of them.
    """
    (tree, effectors), jitter = figures.human(), []
    walk = gait.walking(gait.walking.clock(150 * len(caps))).reshape(-1, 150, 1, 4, 3)
    theta = nearby(tree.rest)
    for targets, cap in zip(walk, caps, strict=True):
        bound = None if cap is None else math.radians(cap)
        run = track(tree, effectors, targets, "pseudoinverse", theta=theta, max_step=bound)
        jitter.append(np.degrees(run.jitter[50:].mean(axis=0)))
        theta = run.theta[-1]
    return jitter


def test_there_is_a_row_for_each_chapter() -> None:
    _, _, chapters = TEXT.partition("## Chapter by chapter")
    assert re.findall(r"^\| (\d+) \|", chapters, re.MULTILINE) == [str(n) for n in range(13)]


def test_what_students_are_told_to_write_is_collected(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    store("quiz", "03.stuck", answer="It stands still", right=True, tries=1)
    walk = gait.walking(gait.walking.clock(3))
    names = {"study": study, "table": study.compare(*figures.human(), walk)}
    told = re.findall(r"```python\n(.*?)```", TEXT, re.DOTALL)
    exec(next(code for code in told if "export" in code), names)
    table, logs, skipped = collect(tmp_path)
    assert skipped == {}
    assert {"ada", "predictions"} == set(table["student"])
    assert {"method", "effector", "jitter"} <= set(logs.columns)


def test_0_a_turn_of_a_straight_arm_moves_nothing() -> None:
    poser = Poser(figures.human())

    def hand() -> np.ndarray:
        said = re.sub("<[^>]+>", " ", poser._below.value).replace("−", "-").split("hand.l")[1]
        return np.array(said.split()[:3], dtype=float)

    rest = hand()
    put(poser, **{"shoulder.turn.l": 60})
    assert np.linalg.norm(hand() - rest) == 0
    put(poser, **{"shoulder.turn.l": 0, "elbow.l": 90})
    bent = hand()
    put(poser, **{"shoulder.turn.l": 60})
    assert np.linalg.norm(hand() - bent) == pytest.approx(0.36, abs=0.005)


def test_1_an_arrow_appears() -> None:
    poser = ColumnPoser(figures.human())
    words = put(poser, effector="hand.l")
    assert words.startswith("5 of 20")
    assert "shoulder.turn.l" not in words
    words = put(poser, **{"elbow.l": 90})
    assert words.startswith("6 of 20")
    assert "shoulder.turn.l" in words
    assert "spine" not in put(poser, effector="foot.l")


def test_2_none_moves_and_then_one_moves_too_much() -> None:
    bench = BendBench()

    def steps(bend: int) -> dict[str, float]:
        told = put(bench, bend=bend, way=180).partition("Steps:")[2]
        found = re.findall(r"(\w+) ([\d.e-]+) rad", told)
        return {name: math.degrees(float(length)) for name, length in found}

    assert max(steps(0).values()) < 1e-9
    near = steps(5)
    assert near.pop("pseudoinverse") == pytest.approx(147, abs=1)
    assert max(near.values()) < 20
    assert steps(1)["pseudoinverse"] < 0.1


def test_3_on_this_arm_the_half_step_is_slower() -> None:
    bench, left = slope_bench(), {}
    for gain in (1.0, 0.5):
        bench.buttons["Start again"].click()
        put(bench, gain=gain)
        for _ in range(12):
            bench.buttons["Take the step"].click()
        left[gain] = number("Distance now", bench.words)
    assert left[1.0] < 0.001
    assert left[0.5] == pytest.approx(0.10, abs=0.01)


def test_4_one_cap_for_all_costs_the_feet() -> None:
    table = standing(CapPlayer().player.session)
    feet = table[["foot.l", "foot.r"]].max(axis=1)
    assert feet["whole step"] == pytest.approx(13, abs=1.5)
    assert feet[["each chain", "no cap"]].max() < 1
    (free,) = shaken(None)
    assert np.median(free) > 10 * table["jitter"]["each chain"]


def test_5_lambda_trades_and_has_a_unit() -> None:
    bench = tradeoff_bench()
    said = [put(bench, damping=d, unit="metres") for d in (0.001, 0.01, 0.1, 1, 10)]
    near, calm = ([number(w, s) for s in said] for w in ("distance to target", "m, jitter"))
    assert calm == sorted(calm, reverse=True)
    assert near[0] > near[1] > near[2] < near[3] < near[4]
    words = put(bench, damping=0.1, unit="centimetres")
    assert number("m, jitter", words) == pytest.approx(calm[0], abs=1e-3)


def test_6_the_weakest_direction_is_cut() -> None:
    bench = spectrum_bench()
    words = put(bench, steps=5, direction=12)
    assert number("1/σ is", words) == pytest.approx(45, abs=1)
    assert number("damped", words) == pytest.approx(2.1, abs=0.1)
    assert number("SDLS takes", words) < 0.1
    words = put(bench, direction=1)
    three = [number(name, words) for name in ("1/σ is", "damped", "SDLS takes")]
    assert max(three) - min(three) < 0.01


def test_7_hands_never_arrive_and_one_method_shakes() -> None:
    table = standing(GaitPlayer().session)
    assert table.loc["dls", ["hand.l", "hand.r"]].to_list() == pytest.approx([22, 22], abs=1)
    (free,) = shaken(None)
    assert np.median(free) > 10 * table["jitter"]["dls"]


def test_8_the_cap_makes_the_verdict() -> None:
    race = Race()
    assert race.values["caps"] == EQUAL
    own = BUSS_CAPS["pseudoinverse"]
    assert own is not None
    at_30, at_2, at_own = shaken(race.values["degrees"], 2, math.degrees(own))
    assert at_30.min() > 60
    assert np.median(at_30) == pytest.approx(75, abs=8)
    assert at_2 == pytest.approx(4, abs=0.5)
    assert at_own == pytest.approx(15, abs=2)
    put(race, degrees=2)
    race.session.tick()
    race.report()
    assert standing(race.session).loc["dls", "foot.l"] == pytest.approx(4.4, abs=0.5)
    put(race, caps=OWN)
    race.session.tick()
    race.report()
    assert standing(race.session)["jitter"]["pseudoinverse"] == pytest.approx(15, abs=2)


def test_9_the_feet_follow_later_and_the_hands_as_before() -> None:
    bench = Workbench()
    slow = standing(bench.session).loc["dls"]
    bench.panels["Speed"].controls["speed"].value = 8.4
    fast = standing(bench.session).loc["dls"]
    assert (slow["foot.l"], fast["foot.l"]) == pytest.approx((0.22, 0.33), abs=0.06)
    assert fast["hand.l"] == pytest.approx(slow["hand.l"], abs=1)
    bench.close()


def test_10_the_hand_never_comes_to_rest_unless_mended() -> None:
    simulator = Simulator()
    session = simulator.session

    def after(*place: float) -> pd.Series:
        session.put(np.array(place))
        for _ in range(120):
            session.tick()
        return pd.Series({name: one.words for name, one in session.standing.items()})

    low = after(0.4, -0.2, 0.3)
    assert "oscillates" in low["cramer"]
    assert "repeat every 9 ticks" in low["cramer"]
    assert low["cramer, mended"].startswith("arrived")
    middle = after(0.0, 0.25, 0.35)
    assert "does not answer" in middle["cramer"]
    assert middle["dls"].startswith("arrived")


def test_11_targets_are_met_and_the_knees_are_wrong() -> None:
    player = WalksPlayer()
    recorded = player.session.sessions["recorded"]

    def far(ticks: int = 90) -> dict[str, float]:
        """Mean distance of each effector of the recorded walk, once it has settled [m]."""
        errors = []
        for tick in range(2 * ticks):
            player.session.tick()
            errors += [recorded.error] if tick >= ticks else []
        return dict(zip(recorded.effectors.names, np.mean(errors, axis=0), strict=True))

    asked = {"pelvis": False, "knees": False, "elbows": False}
    limbs = ("ball.l", "ball.r", "hand.l", "hand.r")
    put(player, method="dls", **asked)
    few = far()
    assert max(few[name] for name in limbs) < 0.01
    assert min(few["knee.l"], few["knee.r"]) > 0.05
    put(player, **dict.fromkeys(asked, True))
    assert max(far().values()) < 0.02

    def measured() -> pd.Series:
        said = player._table.value.replace("−", "-")
        heads = re.findall(r"<th>([^<]+)</th>", said.partition("<tbody>")[0])
        row = said.partition("natural</th>")[2].partition("</tr>")[0]
        return pd.Series(map(float, re.findall(r"<td>([^<]+)</td>", row)), heads)

    player.report()
    assert measured()["clearance"] > 1.5
    put(player, lift=0)
    far()
    player.report()
    assert measured()["clearance"] < 0.5
    assert measured()["score"] < 8
    player.close()


def test_12_the_feet_give_way_less_and_a_frame_turns() -> None:
    player = standing_player()
    session = player.session

    def errors(ticks: int = 300) -> dict[str, float]:
        for _ in range(ticks):
            session.tick()
        return dict(zip(session.effectors.names, session.error, strict=True))

    put(player, method="dls", z=1.4, y=1.2, feet=1)
    even = errors()
    assert min(even["ball.l"], even["ball.r"]) == pytest.approx(0.01, abs=0.005)
    put(player, feet=10)
    firm = errors()
    assert max(firm["ball.l"], firm["ball.r"]) < 1e-3
    assert firm["hand.r"] > even["hand.r"]
    player.close()
    arm = robot_player()
    session = arm.session
    put(arm, **{"method": "dls", "turn y": 60})
    assert max(errors(60).values()) < 0.01
    put(arm, **{"length": 0.01, "turn y": 0})
    slow = errors(10)
    assert slow["tool"] < 0.01
    assert slow["tool.ahead"] > 0.3
    arm.close()
