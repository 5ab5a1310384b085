"""The runs of an experiment as a figure, their order as a chart, and the sentences as a page."""

from functools import partial

import numpy as np
import pandas as pd
import pytest

from ikteach import dls, figures, gait
from ikteach.motion import clip, hold
from ikteach.study.experiment import Round, starts
from ikteach.study.trials import trials
from ikteach.view.chapters.comparison import Ledger, Race, TrialsPlayer, order_chart
from ikteach.view.chapters.gait import GaitPlayer, session_table
from ikteach.view.stage.lengths import misses

HUMAN = figures.human()


@pytest.fixture(scope="module")
def found():
    return trials(
        *HUMAN, gait.MOTIONS, starts=starts(HUMAN.tree, 3), limits={"hold": hold, "clip": clip},
        dampings=(0.1, 0.4), seconds=1.0, settle=0.5, rate=20,
        can_reach=[[True, True, False, False], [False] * 4],
    )  # fmt: skip


@pytest.fixture
def player(found):
    made = TrialsPlayer(found)
    yield made
    made.close()


def cells(player):
    return [row[:2] for row in player.rows.rows]


def test_a_row_for_each_method_and_its_λ(player):
    assert cells(player) == [
        ["transpose", "any"],
        ["pseudoinverse", "any"],
        ["dls", "0.1"],
        ["dls", "0.4"],
        ["sdls", "any"],
    ]
    assert len(player.rows.header) == len(player.rows.rows[0])
    assert player.rows.label == "methods in the chosen condition"


@pytest.mark.parametrize("row", range(5))
def test_the_chosen_row_is_what_moves(found, player, row):
    player.controls["motion"].value = "running"
    player.controls["limits"].value = "clip"
    player.rows.chosen = row
    player.controls["frame"].value = 7
    player.draw()
    method, damping = cells(player)[row]
    wanted = found.table.query("motion == 'running' and limits == 'clip'")
    wanted = wanted[wanted["method"] == method]
    wanted = wanted[wanted["damping"] == (0.1 if damping == "any" else float(damping))]
    runs = [found.run(i) for i in wanted.index]
    assert len(runs) == 3
    now = player.scene.now
    np.testing.assert_allclose(now.effectors, [run.positions[7] for run in runs], atol=1e-12)
    np.testing.assert_allclose(now.targets, [runs[0].targets[7]] * 3)
    assert f"{method}, λ {damping}; running, clip, none. At 0.40 s" in player.words
    far = [f"start {i} {100 * run.error[7].mean():.1f} cm" for i, run in enumerate(runs)]
    assert all(words in player.words for words in far)
    low, middle, high = 100 * wanted["mean"].quantile([0, 0.5, 1])
    assert player.rows.rows[row][2].startswith(f"{middle:.3g} ({low:.3g} to {high:.3g}")
    assert player.status.wrong == ""


def test_it_plays_steps_and_begins_again(player):
    assert player.session.dt == pytest.approx(1 / 20)
    player.step()
    assert (player.session.frame, player.playing) == (1, False)
    for _ in range(19):
        player.step()
    assert player.session.frame == 0
    player.step()
    player.report()
    assert player.controls["frame"].value == 1
    assert player.still().alt == player.words
    assert len(player.still().png) > 1000


def test_any_body_and_any_methods():
    arm = figures.planar_arm(3)
    made = trials(
        *arm, {"<b>round": Round()}, starts=np.zeros((1, 3)), seconds=1.0, settle=0.5,
        methods={"<i>mine": partial(dls, damping=0.3)},
    )  # fmt: skip
    player = TrialsPlayer(made, slot=None)
    assert cells(player) == [["<i>mine", "0.1"]]  # one λ: it does not matter that it is bound
    player.draw()
    assert "<b>round, hold, none" in player.words
    player.close()
    with pytest.raises(TypeError, match="found must be Trials, not 3"):
        TrialsPlayer(3)


def test_the_chart_says_its_orders(found):
    chart = order_chart(
        found.table, "acceleration", title="Jitter", ylabel="rad/s²", motion="walking"
    )
    table = found.table.query("motion == 'walking' and limits == 'clip' and damping == 0.4")
    middle = table.groupby("method", observed=True)["acceleration"].median().sort_values()
    assert f"clip, λ 0.4: {' < '.join(middle.index)}" in chart.alt
    assert chart.alt.count("λ") == 4
    assert chart.png.startswith(b"\x89PNG")


def test_a_ledger_is_a_table_whose_words_are_words():
    row = {
        "section": "5.3", "says": "<script>a</script>", "measured by": "a < b", "in": "50% of 4",
        "verdict": "depends on λ", "number": "× 2", "turned by": "0.1 100%, 0.2 0%",
        "own settings": "holds",
    }  # fmt: skip
    frame = pd.DataFrame([row, row | {"verdict": "does not hold", "turned by": ""}])
    page = Ledger(frame.set_index(["section", "says"]))._repr_html_()
    assert "<script>" not in page
    assert "&lt;script&gt;" in page
    assert "≈ <b>depends on λ</b>, in 50% of 4 cells: 0.1 100%, 0.2 0%" in page
    assert "✗ <b>does not hold</b>, in 50% of 4 cells<" in page
    assert page.count("<tr>") == 3


def test_a_direction_is_off_by_degrees_and_makes_metres_by_its_length():
    walker = figures.walker()
    player = GaitPlayer(figure=walker, slot=None)
    race = Race(figure=walker, slot=None)
    for one in (player, race):
        for _ in range(5):
            one.step()
        one.report()
    session = player.session
    up = walker.effectors.names.index("pelvis.up")
    phi = 2 * np.arcsin(session.error[up] / (2 * np.linalg.norm(walker.effectors.offsets[up])))
    assert f"pelvis.up {np.degrees(phi):.1f}° ({100 * session.error[up]:.1f} cm)" in player.words
    assert "<th>pelvis.up [°]</th>" in player._table.value
    assert "<th>pelvis [°]</th>" not in player._table.value
    rows = session_table(session)
    mean = np.mean(
        next(misses(walker.effectors, r.error)[:, up] for r in session.tracks().values())
    )
    assert f"{np.degrees(mean):.2f}" in rows
    for text in (player._table.value, race._table.value, race.words):
        assert "A direction that is off by φ counts as 2ℓ sin(φ/2)." in text
    for one in (player, race):
        one.close()
