"""The workbench without a page: its panels act on the session, and only when a person asks."""

import pytest

from ikteach.body import locate
from ikteach.motion.rules import BUSS_CAPS
from ikteach.view.chapters.workbench import Workbench
from ikteach.view.stage.lengths import Lengths

PLACE = [0.6, 0.25, 0.1]


@pytest.fixture
def bench():
    bench = Workbench(slot=None)
    yield bench
    assert bench.status.wrong == ""
    bench.close()


def control(bench, name):
    return next(p.controls[name] for p in bench.panels.values() if name in p.controls)


def drag(bench, count):
    for i in range(count):
        at = [PLACE[0], PLACE[1] + 0.001 * i, PLACE[2]]
        message = {"target": 3, "at": at, "fresh": i == 0, "number": i}
        bench.targets.handles._hear(None, message, [])
        if bench.playing:
            bench.session.tick()


def said(bench):
    return [str(event) for event in bench.session.events]


def test_to_open_it_changes_nothing_and_logs_nothing(bench):
    before = bench.session.settings()
    for panel in bench.panels.values():  # as a page does with what is between two steps
        for slider in panel.controls.values():
            if hasattr(slider, "step") and not hasattr(slider, "base"):
                steps = round((slider.value - slider.min) / slider.step)
                slider.set_state({"value": slider.min + steps * slider.step})
    assert bench.session.settings() == before
    assert said(bench) == []


@pytest.mark.parametrize("playing", [False, True])
def test_each_drag_is_one_event_and_one_undo(bench, playing):
    bench.playing = playing
    walking = bench.session.targets.copy()
    drag(bench, 60)
    drag(bench, 60)
    assert [event.kind for event in bench.session.events] == ["target", "target"]
    bench.targets._hear(None, {"undo": True}, [])  # the button of the panel
    assert bench.session.targets[3] == pytest.approx([0.6, 0.309, 0.1])
    bench.undo()
    assert not bench.session.by_hand
    assert bench.panels["Motion"].values["motion"] == "walking"
    if not playing:
        assert bench.session.targets == pytest.approx(walking)


def test_a_control_changes_what_it_names(bench):
    session = bench.session
    control(bench, "sdls.clamp").value = "soft"  # and not γ_max, which is between two steps
    control(bench, "mix.hand.l").value = "sdls"
    control(bench, "caps").value = "each author's own"
    control(bench, "limits").value = "clip"
    control(bench, "clamp_error").value = True
    control(bench, "motion").value = "running"
    assert session.methods["sdls"].keywords.keys() == {"clamp"}
    assert {name: session.caps[name] for name in BUSS_CAPS} == BUSS_CAPS
    assert control(bench, "speed").value == session.gait.speed == 9.0
    assert said(bench) == [
        "solver: method sdls, solver (function sdls, clamp soft)",
        "solver: method mix, solver (function mix, foot.l dls, foot.r dls, hand.r dls,"
        " hand.l sdls)",
        "caps: transpose 0.5236, pseudoinverse 0.08727, dls 0.7854, sdls None, mix None",
        "options: limits clip",
        "options: max_error 0.4",
        "gait: motion running",
    ]


def test_the_picture_keeps_its_settings_when_the_figures_change(bench):
    control(bench, "dark").value = True
    control(bench, "layer.ellipsoid").value = True
    control(bench, "figures").value = "all, overlaid"
    assert bench.scene.dark
    assert bench.scene.layers["ellipsoid"]
    bench.draw()
    control(bench, "zoom").value = 2.0
    bench.object.ball.azimuth = 10.0
    assert control(bench, "azimuth").value == 10.0
    control(bench, "straight").click()
    assert control(bench, "zoom").value == 1.0


def test_views_are_shown_by_control_or_key_and_stay_when_the_figures_change(bench):
    control(bench, "views").value = "4"
    assert bench.scene.views == 4
    bench.scene.driver.on_act("v")
    bench.report()
    assert control(bench, "views").value == "1"
    bench.scene.driver.on_act("v")
    bench.report()
    control(bench, "figures").value = "all, side by side"
    assert bench.scene.views == 2
    bench.begin_again()
    assert bench.scene.views == 1


def test_the_recorded_skeleton_is_there_while_a_recording_is_followed(bench):
    control(bench, "layer.recorded skeleton").value = True
    assert "do not follow a recording" in bench.status.said
    bench.draw()
    assert [len(one) for one in bench.scene.now.skeletons] == [0]
    control(bench, "motion").value = "recorded"
    bench.session.tick()
    bench.draw()
    (bones,) = bench.scene.now.skeletons
    assert len(bones) > 20
    assert abs(bones).max() < 1.2  # it hangs at the pelvis, which is the human's origin
    control(bench, "figures").value = "all, overlaid"
    bench.draw()
    assert len(bench.scene.now.skeletons) == len(bench.scene.stage)


def test_hip_knee_and_ankle_run_on_the_norms_band_while_unfolded(bench):
    folded = bench.norm.bands.png
    for _ in range(80):
        bench.session.tick()
    bench.draw()
    assert bench.norm.bands.png == folded
    bench.norm.selected_index = 0
    assert "shown hip" in bench.norm.bands.alt
    was = bench.norm.bands.png
    for _ in range(10):
        bench.session.tick()
    bench.draw()
    assert bench.norm.bands.png != was
    bench.session.by_hand = True
    bench.norm.follow()
    for _ in range(10):
        bench.session.tick()
    bench.draw()
    assert "no stride yet" in bench.norm.bands.alt


def test_to_begin_again_puts_controls_and_picture_back(bench):
    first = {title: panel.values for title, panel in bench.panels.items()}
    control(bench, "method").value = "sdls"
    control(bench, "sdls.clamp").value = "soft"
    control(bench, "speed").value = 9.0
    control(bench, "layer.world axes").value = True
    control(bench, "dark").value = True
    control(bench, "ghost").value = "pseudoinverse"
    assert len(bench.scene.stage) == 2
    bench.slow_down()
    bench.begin_again()
    assert {title: panel.values for title, panel in bench.panels.items()} == first
    assert (len(bench.scene.stage), bench.scene.driver.pace) == (1, "1×")
    assert not any(bench.scene.layers.values())
    assert bench.playing


def test_a_ghost_stands_in_the_place_of_the_shown_figure(bench):
    control(bench, "ghost").value = "pseudoinverse"
    assert control(bench, "figures").value == "one and a ghost"
    for _ in range(30):
        bench.session.tick()
    bench.draw()
    shown, ghost = bench.scene.now.effectors
    names = [bench.session.method, "pseudoinverse"]
    for seen, name in zip((shown, ghost), names, strict=True):
        frames = bench.session.frames_of(name)
        assert seen == pytest.approx(locate(frames, bench.session.effectors))


def test_keys_at_the_picture_press_what_they_name(bench):
    press = bench.scene._perform
    press(" ")
    assert not bench.playing
    ticks = bench.session.ticks
    press(".")
    assert bench.session.ticks == ticks + 1
    for key, (words, _) in bench.acts().items():
        if key.isdigit():
            press(key)
            assert words == f"shows {bench.session.method}"
    press("s")
    assert bench.scene.driver.pace == "½×"
    press("no key")  # of a page that is older than the figure


def test_the_picture_tells_distances_while_it_is_asked(bench):
    sent = []
    bench.scene.driver.send = lambda content, buffers=None: sent.append(content)
    bench.draw()
    assert "far" not in sent[-1]
    bench.scene.driver.measuring = True
    length = Lengths.of(bench.session.tree, bench.session.effectors)
    assert sent[-1]["far"] == [length(float(far)) for far in bench.session.error]


@pytest.mark.parametrize("name", ["natural", "recorded"])
def test_a_walk_with_stance_is_followed_undone_and_replayed(bench, name):
    control(bench, "motion").value = name
    for _ in range(60):
        bench.session.tick()
    assert bench.session.gait.name == name
    assert bench.session.error.mean() < 0.02
    assert not bench.session.gait.stands(0.0).all()
    assert control(bench, "speed").disabled
    assert control(bench, "back_z_leg").disabled
    control(bench, "step_frequency").value = 2.0
    assert bench.session.gait.step_frequency == 2
    bench.scrub()
    assert len(bench.replay.run) == 60
    bench.step()
    bench.undo()
    assert (bench.session.gait.name, bench.session.gait.step_frequency) == (name, 1)
    bench.undo()
    assert control(bench, "motion").value == "walking"
    assert not control(bench, "speed").disabled


def test_a_curve_is_drawn_point_by_point(bench):
    control(bench, "drawn").value = "hand.l"
    corners = [[0.3, 0, 0.3], [0.5, 0, 0.3], [0.5, 0.3, 0.3]]
    for corner in corners:
        bench.session.aim("hand.l", corner)
        control(bench, "point").click()
    control(bench, "seconds").value = 3.0
    control(bench, "along").click()
    gait = bench.session.gait
    assert (gait.name, gait.period) == ("drawn", pytest.approx(3))
    assert control(bench, "motion").value == "drawn"
    assert not bench.session.by_hand
    hand = bench.session.effectors.names.index("hand.l")
    assert bench.session.targets[hand] == pytest.approx(corners[0])
    for _ in range(90):
        bench.session.tick()
    assert bench.session.error[hand] < 0.01
    control(bench, "motion").value = "walking"
    control(bench, "motion").value = "drawn"
    assert bench.session.gait.name == "drawn"


def test_a_curve_of_one_point_is_refused_and_the_bench_goes_on(bench):
    control(bench, "along").click()
    assert "needs two points" in bench.motion.pad.status.wrong
    control(bench, "motion").value = "running"
    assert bench.session.gait.name == "running"


def test_a_motion_that_is_given_is_among_the_motions(bench):
    walk = bench.session.gait.change(name="limping")
    bench.session.gait = walk
    bench._agree()
    assert control(bench, "motion").value == "limping"
    with pytest.raises(ValueError, match="a motion already"):
        bench.motion.add(walk.change(name="running"))
