"""The bench of circle and ellipse, without a page: sliders, the dragged point, words, still."""

import re

import numpy as np
import pytest
from matplotlib.figure import Figure

from ikteach.view.chapters.svd import SvdBench


def pairs(words: str) -> list[np.ndarray]:
    found = re.findall(r"\((-?[\d.]+), (-?[\d.]+)\)", words.replace("−", "-"))
    return [np.array(pair, dtype=float) for pair in found]


@pytest.fixture(params=[None, ["transpose", "pseudoinverse", "dls", "sdls"]], ids=["J", "methods"])
def bench(request):
    bench = SvdBench(request.param)
    yield bench
    bench.close()


def test_every_control_to_both_ends(bench):
    drawn = set()
    for control in bench.controls.values():
        before = control.value
        for end in (control.min, control.max):
            control.value = end
            assert bench.status.wrong == ""
            assert "nan" not in bench.words
            assert bench.words in (bench.steps.alt, bench.places.alt)
            drawn.add(str(bench.steps.lines) + str(bench.places.lines))
        control.value = before
    assert len(drawn) == 6
    assert bench.still().alt == bench.words
    assert bench._picture not in bench.children  # an image without a picture shows its words
    assert len(bench.still().png) > 5000


def test_the_dragged_point_and_the_sliders_agree(bench):
    bench.held.at = [0.25, -0.5]  # as the page does
    assert (bench.controls["x"].value, bench.controls["y"].value) == (0.25, -0.5)
    assert bench.held.said == "(0.25, −0.50)"
    bench.controls["x"].value = -0.1
    assert bench.held.at == [-0.1, -0.5]
    assert bench.status.wrong == ""


def test_words_hold_what_is_drawn():
    bench = SvdBench()
    bench.controls["bend"].value = -90  # J of the chapter's 2 × 2, turned
    assert "σ₁ = 1.618, σ₂ = 0.618" in bench.words
    *_, dtheta, moved = pairs(bench.words)
    np.testing.assert_allclose(bench.places.lines[-1]["points"][-1], moved, atol=0.006)
    np.testing.assert_allclose(bench.steps.lines[-1]["points"][-1], dtheta, atol=0.006)
    bench.close()


def test_where_a_direction_is_lost_the_methods_say_so():
    bench = SvdBench(["pseudoinverse", "dls"])
    bench.controls["bend"].value = 0
    e = 0.2 * np.array([np.cos(np.radians(20)), np.sin(np.radians(20))])
    bench.held.at = (-e).tolist()  # straight inward
    assert bench.words.count("long 0;") + bench.words.count("e-1") == 2
    bench.close()


def test_a_long_answer_is_told_to_leave_the_picture():
    bench = SvdBench(["pseudoinverse"])
    bench.controls["bend"].value = 3
    assert "beyond the picture" in bench.words
    bench.close()


def test_no_name_of_a_still_lies_on_another():
    bench = SvdBench()
    for bend in range(-180, 181, 30):
        bench.controls["bend"].value = bend
        for plane in (bench.steps, bench.places):
            axes = Figure().subplots()
            plane.draw(axes)
            places = [np.array(text.xy) / plane.half for text in axes.texts if text.get_text()]
            assert len(places) == 3
            for i, place in enumerate(places):
                apart = abs(np.reshape(places[i + 1 :], (-1, 2)) - place)
                assert ((apart[:, 0] >= 0.2) | (apart[:, 1] >= 0.09)).all()
    bench.close()
