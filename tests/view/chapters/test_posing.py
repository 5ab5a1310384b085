"""The live figures of chapters 0 to 2, without a page: sliders, words, stills."""

import io
import re

import numpy as np
import pandas as pd
import pytest
from PIL import Image

from ikteach import figures, forward, jacobian
from ikteach.body.partials import by_differences
from ikteach.view import BendBench, ColumnPoser, Poser
from ikteach.view.charts import heat

MAKERS = {
    "human": lambda: Poser(figures.human()),
    "simulator": lambda: Poser(figures.simulator()),
    "columns": lambda: ColumnPoser(figures.human()),
    "plane": lambda: ColumnPoser(figures.planar_model()),
    "bend": BendBench,
}


def ends(control):
    return [getattr(control, "base", 0) ** x if hasattr(control, "base") else x
            for x in (control.min, control.max)]  # fmt: skip


@pytest.mark.parametrize("name", MAKERS)
def test_every_slider_goes_to_both_ends(name):
    bench = MAKERS[name]()
    for control in bench.controls.values():
        if not hasattr(control, "min"):
            for option in control.options:
                control.value = option
                assert bench.status.wrong == ""
            continue
        was = control.value
        for end in ends(control):
            control.value = end
            assert bench.status.wrong == ""
            assert len(bench.words) > 40
        control.value = was
    bundle = bench._repr_mimebundle_()
    picture = np.asarray(Image.open(io.BytesIO(bundle["image/png"])).convert("RGB"))
    assert picture.std() > 5
    assert bundle["text/plain"] == bench.words == bench.scene.driver.description
    bench.close()
    assert bench.comm is None
    assert bench.scene.renderer.comm is None


def test_the_pose_is_what_the_sliders_say_within_the_limits():
    figure = figures.human()
    bench = Poser(figure)
    bench.controls["elbow.l"].value = 90
    theta = bench.theta()
    assert theta[figure.tree.index("elbow.l")] == pytest.approx(np.pi / 2)
    for control in bench.controls.values():
        control.value = control.max
    assert (bench.theta() <= figure.tree.upper).all()
    bench.close()


def test_one_angle_turns_both_segments_of_the_back():
    figure = figures.simulator()
    bench = Poser(figure)
    assert len(bench.controls) == 16
    bench.controls["back.lower"].value = 20
    lower, upper = (bench.theta()[figure.tree.index(f"back.{x}")] for x in ("lower", "upper"))
    assert lower == upper == pytest.approx(np.radians(20))
    bench.close()


def test_columns_are_of_the_effector_and_by_the_way_that_are_chosen():
    figure = figures.human()
    bench = ColumnPoser(figure)
    bench.controls["effector"].value = "foot.r"
    J = jacobian(figure.tree, forward(figure.tree, bench.theta()), figure.effectors)[3:6]
    assert np.allclose(bench.scene.now.columns, J)
    bench.controls["way"].value = "finite differences"
    bench.controls["h"].value = 0.3
    wide = by_differences(figure.tree, bench.theta(), figure.effectors, h=0.3)[3:6]
    assert np.allclose(bench.scene.now.columns, wide)
    assert abs(wide - J).max() > 1e-3
    bench.close()


def test_an_error_inward_moves_a_straight_arm_by_no_method_and_a_bent_one_by_all():
    bench = BendBench()
    bench.controls["way"].value = 180
    for bend, moves in ((0, 0), (5, 4)):
        bench.controls["bend"].value = bend
        said = bench.words.partition("Steps: ")[2]
        steps = [float(length) for length in re.findall(r"(\S+) rad", said)]
        assert len(steps) == 4
        assert sum(step > 0 for step in steps) == moves
    bench.close()


def test_running_a_cell_again_closes_the_figure_before():
    first, second = Poser(figures.human()), Poser(figures.human())
    assert first.comm is None
    assert first.scene.renderer.comm is None
    assert second.comm is not None
    second.close()


def test_heat_says_in_words_what_it_shows():
    table = pd.DataFrame([[0.0, -2.5], [1.0, 0.0]], ["a", "b"], ["p", "q"])
    shown = heat(table, title="J", unit="m/rad")
    words = "J: 2 rows by 2 columns, 2 of 4 entries are 0. The largest is -2.50 m/rad, in row a"
    assert shown.alt.startswith(words)
    assert np.asarray(Image.open(io.BytesIO(shown.png)).convert("RGB")).std() > 5
    heat(0 * table, title="nothing", unit="m")
