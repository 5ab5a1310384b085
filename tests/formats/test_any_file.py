"""Files of anybody: whatever is in them, they are read or refused in one sentence."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from test_bvh import LEG

from ikteach import figures, forward, locate
from ikteach.formats.bvh import read_bvh
from ikteach.formats.gltf import write_glb
from ikteach.formats.urdf import ARM, read_urdf
from ikteach.motion.live.session import Session
from ikteach.motion.track import track

URDF = ARM.read_text(encoding="utf-8")
SIGNS = [*"{}<>/&;#\"'=-.0 \n\r\t", "\x00", "\u2028", "\ud800", "\ufeff", "é", "²", "_"]
KEYS = [
    "OFFSET",
    "JOINT x",
    "End Site",
    "MOTION",
    "CHANNELS 6",
    "Frames: 5",
    "0 0 0",
    "1e999",
    "nan",
]
TAGS = ["<joint", "</link>", "<!--", "-->", "]]>", 'type="fixed"', "&lt;", "99999999999999999999"]
SPLINTERS = st.sampled_from(SIGNS + KEYS + TAGS)


def broken(draw, text, most=6):
    """A text with some of it left out, doubled or put in its place."""
    for _ in range(draw(st.integers(1, most))):
        a = draw(st.integers(0, len(text)))
        b = min(len(text), a + draw(st.sampled_from([0, 0, 1, 2, 10, 60])))
        put = draw(st.one_of(SPLINTERS, st.just(""), st.just(2 * text[a:b])))
        text = text[:a] + put + text[b:]
    return text


@pytest.mark.parametrize(("read", "text"), [(read_bvh, LEG), (read_urdf, URDF)])
def test_what_is_damaged_is_refused_in_a_sentence(read, text):
    @settings(max_examples=300)
    @given(st.data())
    def tried(data):
        wrong = broken(data.draw, text) + "\n"
        try:
            found = read(wrong)
        except ValueError as error:
            said = str(error)
            assert said.startswith(("BVH", "URDF", "'", '"')) or "joint" in said, said
            assert len(said) < 500
            assert "\n" not in said
        else:
            assert np.isfinite(forward(found.tree, found.tree.rest).positions).all()

    tried()


def test_a_robot_of_a_file_is_a_figure_like_others():
    robot = read_urdf(URDF)
    figure = figures.Figure(robot.tree, robot.effectors)
    session = Session(figure)
    for _ in range(3):
        session.tick()
    assert session.error.max() < 0.5
    targets = np.tile(session.targets, (3, 1, 1))
    assert write_glb(track(*figure, targets, "dls"))[:4] == b"glTF"


def test_a_recorded_body_is_a_figure_like_others():
    leg = read_bvh(LEG, scale=0.01)
    targets = locate(forward(leg.tree, leg.theta), leg.effectors)
    run = track(leg.tree, leg.effectors, targets, "dls", iterations=50)
    assert_allclose(run.positions[-1], targets[-1], atol=1e-3)
