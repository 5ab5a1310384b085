"""The targets: whatever moves one, everything agrees; what does not fit is refused in words."""

import numpy as np
import pytest
from ipywidgets.widgets.widget import _instances

from ikteach.body import Effectors, figures, forward, locate
from ikteach.motion.live.session import Session
from ikteach.view import Scene, StillScene
from ikteach.view.webgl.positions import Moves
from ikteach.view.webgl.targets import Targets

TREE, EFFECTORS = figures.human()
START = np.array([[0.35, -0.9, 0.0], [-0.35, -0.9, 0.0], [-0.8, 0.0, 0.0], [0.8, 0.0, 0.0]])
PLACE = np.array([0.6, 0.25, 0.1])


@pytest.fixture
def targets():
    scene = Scene(TREE, EFFECTORS)
    panel = Targets(scene, START)
    yield panel
    panel.close()
    scene.close()


def grip(targets, index, at, fresh=True):
    """What the page sends when a target is dragged."""
    targets.handles._hear(None, {"target": index, "at": list(at), "fresh": fresh}, [])


def slide(targets, index, axis, value, **more):
    """What the page sends when a slider moves, or with typed=True when a number is entered."""
    message = {"target": index, "axis": axis, "value": value, "fresh": True, **more}
    targets._hear(None, message, [])


def agrees(targets, positions):
    assert targets.positions == pytest.approx(np.array(positions))
    assert np.array(targets.values) == pytest.approx(np.array(positions))
    assert targets.handles.positions.now == pytest.approx(np.array(positions))


def test_all_ways_of_moving_agree(targets):
    wanted = START.copy()
    agrees(targets, wanted)
    grip(targets, 3, PLACE)
    wanted[3] = PLACE
    agrees(targets, wanted)
    slide(targets, 2, 1, 0.4)
    wanted[2, 1] = 0.4
    agrees(targets, wanted)
    slide(targets, 2, 0, -0.55, typed=True)
    wanted[2, 0] = -0.55
    agrees(targets, wanted)
    targets.move(0, [0.3, -0.8, 0.2])
    wanted[0] = [0.3, -0.8, 0.2]
    agrees(targets, wanted)


def test_whoever_asks_is_told_of_each_move(targets):
    told = []

    @targets.on_change
    def follow(index, position):
        told.append((index, position.tolist()))

    grip(targets, 3, PLACE)
    slide(targets, 3, 0, 0.5)
    targets.undo()
    assert told == [(3, PLACE.tolist()), (3, [0.5, 0.25, 0.1]), (3, PLACE.tolist())]


def test_a_drag_is_one_move_and_undo_takes_it_back(targets):
    grip(targets, 1, [-0.3, -0.9, 0.0])
    grip(targets, 3, [0.7, 0.1, 0.0])
    grip(targets, 3, [0.6, 0.2, 0.0], fresh=False)
    grip(targets, 3, PLACE, fresh=False)
    targets.handles._hear(None, {"undo": True}, [])
    assert targets.positions[3] == pytest.approx(START[3])
    assert targets.positions[1] == pytest.approx([-0.3, -0.9, 0.0])
    targets._hear(None, {"undo": True}, [])
    agrees(targets, START)
    targets.undo()
    agrees(targets, START)


def test_a_drag_stops_at_the_edge_of_the_range(targets):
    grip(targets, 3, [9, -9, 0.2])
    assert targets.positions[3] == pytest.approx([2.3, -1.5, 0.2])


@pytest.mark.parametrize("value", [9, -9, None])
def test_a_typed_number_outside_is_refused_with_the_range(targets, value):
    sent = []
    targets.send = sent.append
    slide(targets, 3, 0, value, typed=True)
    assert "X of hand.l goes from -0.70 to 2.30 m" in targets.alert
    assert "Nothing was changed." in targets.alert
    assert {"again": True} in sent
    agrees(targets, START)
    slide(targets, 3, 0, 0.5, typed=True)
    assert targets.alert == ""


def test_moving_outside_from_a_cell_is_a_valueerror(targets):
    with pytest.raises(ValueError, match=r"y of foot.l goes from -2.40 to 0.60 m; 3 is"):
        targets.move(0, [0.3, 3, 0])
    with pytest.raises(ValueError, match=r"foot.l needs three numbers"):
        targets.move(0, [0.3, 3])
    agrees(targets, START)


def test_an_error_of_a_follower_is_told_and_the_session_goes_on(targets):
    @targets.on_change
    def follow(index, position):
        if position[0] < 0:
            raise RuntimeError("no way there")

    grip(targets, 3, [-0.1, 0, 0])
    assert targets.handles.alert == "That did not work: no way there"
    slide(targets, 3, 0, -0.2)
    assert targets.alert == "That did not work: no way there"
    grip(targets, 3, PLACE)
    assert targets.handles.alert == ""
    assert targets.positions[3] == pytest.approx(PLACE)


def test_every_message_of_a_drag_is_answered(targets):
    sent = []
    targets.handles.send = sent.append
    for number in (1, 2):
        message = {"target": 3, "at": PLACE.tolist(), "fresh": number == 1, "number": number}
        targets.handles._hear(None, message, [])
    assert sent == [{"heard": 1}, {"heard": 2}]


def test_a_planar_figure_keeps_its_targets_in_the_plane():
    scene = Scene(*figures.planar_arm(3))
    panel = Targets(scene, [[1.0, 1.0, 0.0]])
    grip(panel, 0, [0.5, 0.5, 0.8])
    assert panel.positions.tolist() == [[0.5, 0.5, 0.0]]
    panel.close()
    scene.close()


def test_the_still_renderer_has_sliders_and_no_handles():
    still = StillScene(TREE, EFFECTORS)
    panel = Targets(still, START)
    assert panel.handles is None
    slide(panel, 3, 0, 0.5)
    panel.undo()
    assert panel.positions == pytest.approx(START)
    panel.close()
    still.close()


def test_closing_frees_every_widget():
    before = set(_instances)
    scene = Scene(TREE, EFFECTORS)
    panel = Targets(scene, START)
    panel.close()
    scene.close()
    assert set(_instances) - before == set()


def test_a_start_outside_the_range_is_refused():
    scene = StillScene(*figures.planar_arm(2))
    with pytest.raises(ValueError, match="1 targets need positions"):
        Targets(scene, [[0, 0, 0], [0, 0, 0]])
    with pytest.raises(ValueError, match=r"x of hand goes from -1.00 to 1.00 m; 2 is not"):
        Targets(scene, [[2, 0, 0]], low=-1, high=1)
    scene.close()


def test_only_so_many_moves_are_kept():
    moves = Moves(np.zeros((1, 3)))
    for i in range(500):
        moves.aim(0, [i / 1000, 0, 0])
    for _ in range(200):
        moves.undo()
    with pytest.raises(LookupError, match="no move to undo"):
        moves.undo()
    assert moves.targets[0, 0] == pytest.approx(0.299)


@pytest.fixture
def walker():
    session, scene = Session(), Scene(TREE, EFFECTORS, slot=None)
    panel = Targets(scene, session=session)
    yield session, panel
    panel.close()
    scene.close()


def drag(panel, index, count):
    """What the page sends from pointer down to pointer up."""
    for i in range(count):
        grip(panel, index, PLACE + [0.001 * i, 0, 0], fresh=i == 0)


def kinds(session):
    return [event.kind for event in session.events]


def test_a_session_keeps_the_targets_and_nobody_else(walker):
    session, panel = walker
    agrees(panel, session.targets)
    session.aim("hand.l", PLACE)
    assert panel.positions[3] == pytest.approx(PLACE)
    session.tick()
    session.by_hand = False
    for _ in range(5):
        session.tick()
        assert panel.positions == pytest.approx(session.targets)
    panel.agree()
    agrees(panel, session.targets)


def test_a_long_drag_is_one_event_and_one_undo_of_the_session(walker):
    session, panel = walker
    before = session.targets.copy()
    drag(panel, 3, 60)
    assert kinds(session) == ["target"]
    assert session.targets[3] == pytest.approx(PLACE + [0.059, 0, 0])
    panel._hear(None, {"undo": True}, [])
    assert not session.by_hand
    agrees(panel, before)
    with pytest.raises(LookupError, match="nothing to undo"):
        session.undo()


def test_two_drags_while_it_plays_are_two_events(walker):
    session, panel = walker
    for high in (0, 0.1):
        for i in range(30):
            grip(panel, 3, PLACE + [0.001 * i, high, 0], fresh=i == 0)
            session.tick()
    assert kinds(session) == ["target", "target"]
    panel.undo()
    assert session.targets[3] == pytest.approx(PLACE + [0.029, 0, 0])


def test_undo_move_takes_back_whatever_was_changed_last(walker):
    session, panel = walker
    sent = []
    panel.handles.send = sent.append
    session.show("sdls")
    panel.undo()
    panel.undo()
    assert session.method == "dls"
    said = [message["say"] for message in sent if "say" in message]
    assert said == ["Taken back.", "There is nothing to take back."]
    assert panel.alert == ""


FREE = figures.walker()
WAYS = {name: i for i, name in enumerate(FREE.effectors.names) if not FREE.effectors.w[i]}
UP = WAYS["pelvis.up"]
LONG = np.linalg.norm(FREE.effectors.offsets[UP])  # ℓ


@pytest.fixture
def ways():
    scene = Scene(*FREE)
    panel = Targets(scene, locate(forward(FREE.tree, FREE.tree.rest), FREE.effectors))
    yield panel
    panel.close()
    scene.close()


def test_the_target_of_a_direction_turns_whatever_moves_it(ways):
    grip(ways, UP, [3.0, 4.0, 0.0])
    assert ways.positions[UP] == pytest.approx(LONG * np.array([0.6, 0.8, 0]))
    grip(ways, UP, [0, 0, 0])  # nowhere: it stays
    assert ways.positions[UP] == pytest.approx(LONG * np.array([0.6, 0.8, 0]))
    slide(ways, UP, 0, -0.6 * LONG)
    assert ways.positions[UP] == pytest.approx(LONG * np.array([-0.6, 0.8, 0]))
    slide(ways, UP, 2, 0.6 * LONG, typed=True)
    assert ways.positions[UP] == pytest.approx(LONG * np.array([-0.48, 0.64, 0.6]))
    ways.move(UP, [0, 0, -7])
    assert ways.positions[UP] == pytest.approx([0, 0, -LONG])
    slide(ways, UP, 2, 0.0)  # from a pole, any way
    assert np.linalg.norm(ways.positions[UP]) == pytest.approx(LONG)
    assert ways.positions[UP, 2] == 0
    assert np.array(ways.values) == pytest.approx(ways.positions)
    ways.undo()
    assert ways.positions[UP] == pytest.approx([0, 0, -LONG])


@pytest.mark.parametrize("axis", range(3))
def test_any_series_of_slides_keeps_the_length(ways, axis):
    for value in np.random.default_rng(axis).uniform(-1.2, 1.2, 60) * LONG:
        slide(ways, UP, axis, value)
        at = ways.positions[UP]
        assert at[axis] == pytest.approx(np.clip(value, -LONG, LONG))
        assert np.linalg.norm(at) == pytest.approx(LONG)
        axis = (axis + 1) % 3


@pytest.mark.parametrize("value", [1.01 * LONG, -9, None])
def test_a_typed_number_longer_than_the_direction_is_refused(ways, value):
    before = ways.positions
    slide(ways, UP, 1, value, typed=True)
    assert f"Y of pelvis.up goes from -{LONG:.2f} to {LONG:.2f} m" in ways.alert
    assert np.array_equal(ways.positions, before)


def test_a_direction_needs_a_way_to_point(ways):
    with pytest.raises(ValueError, match=r"pelvis.up is a direction, and \(0, 0, 0\) is none"):
        ways.move(UP, [0, 0, 0])


def test_the_words_say_that_a_direction_points(ways):
    grip(ways, UP, [0, 0, 1])
    ways.handles._hear(None, {"undo": True}, [])
    grip(ways, UP, [0, 0, 1])
    assert ways._model.words(UP) == f"pelvis.up: points to x 0.00, y 0.00, z {LONG:.2f} m"
    assert ways._model.words(0).startswith("pelvis: x ")
    assert [ways.marks[i] for i in WAYS.values()] == ["➤", "➤"]


def test_a_direction_of_a_planar_figure_turns_in_its_plane():
    tree = figures.planar_arm(2).tree
    ends = Effectors.of(tree, {}, directions={"gaze": ("joint2", (0, 0.5, 0))})
    scene = Scene(tree, ends)
    panel = Targets(scene, [[0, 0.5, 0]])
    grip(panel, 0, [3, 4, 12])
    assert panel.positions[0] == pytest.approx([0.3, 0.4, 0])
    slide(panel, 0, 0, 0.4)
    assert panel.positions[0] == pytest.approx([0.4, 0.3, 0])
    panel.close()
    scene.close()


def test_a_session_hears_of_a_direction_as_a_vector():
    session = Session(figure=FREE)
    scene = Scene(*FREE)
    panel = Targets(scene, session=session, low=-1.5, high=1.5)
    grip(panel, UP, [0, 3, 4])
    assert session.targets[UP] == pytest.approx(LONG * np.array([0, 0.6, 0.8]))
    panel.close()
    scene.close()


def test_the_page_has_targets_in_the_order_of_the_effectors():
    tree, ends = FREE
    scene = Scene(tree, ends, names=("a", "b"))
    here = locate(forward(tree, tree.rest), ends)
    scene.show(tree.rest, here)
    (plan,) = (one for one in scene._basics if one.layer.name == "targets")
    rows = plan.layer.place(scene.now)
    moved = {id(thing): row for thing, row in plan.moves}
    assert [moved[id(thing)] for thing in scene.targets] == list(range(2 * len(ends)))
    assert len(rows) == 2 * len(ends)
    panel = Targets(scene, here)
    assert panel.handles.lengths == pytest.approx(np.where(ends.w, 0, LONG))
    panel.close()
    scene.close()
