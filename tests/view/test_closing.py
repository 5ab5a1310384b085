"""Whatever lives in a cell: made twice, in part, closed; every widget that lives can be sent."""

import ast
import importlib
import json
import pkgutil
import sys
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import ipywidgets as widgets
import numpy as np
import pytest

import ikteach.course
import ikteach.view
from ikteach import figures
from ikteach.body.figures import Figure
from ikteach.course import predict, quiz, show_me
from ikteach.motion.live.session import Session
from ikteach.motion.reach.planar import PlanarReach
from ikteach.study.experiment import Round
from ikteach.study.trials import trials
from ikteach.view.chapters.comparison import Race, TrialsPlayer
from ikteach.view.chapters.dls import tradeoff_bench
from ikteach.view.chapters.pseudoinverse import CapPlayer
from ikteach.view.chapters.robots import robot_player, standing_player
from ikteach.view.chapters.sdls import spectrum_bench
from ikteach.view.chapters.transpose import slope_bench
from ikteach.view.live.bands import Bands
from ikteach.view.live.bench import Bench, Shown
from ikteach.view.live.link import StateLink
from ikteach.view.live.panel import slider
from ikteach.view.live.strips import Strips
from ikteach.view.tools.files import Keeper
from ikteach.view.tools.inspector import Glass
from ikteach.view.tools.motion_files import MotionFiles
from ikteach.view.tools.recorder import Recorder
from ikteach.view.tools.replay import Replay
from ikteach.view.webgl.driver import Driver
from ikteach.view.webgl.handles import Handles
from ikteach.view.webgl.targets import Targets
from ikteach.view.widgets.ball import RotationBall
from ikteach.view.widgets.closing import Living, living, occupant
from ikteach.view.widgets.curve import Curve
from ikteach.view.widgets.picture import Picture
from ikteach.view.widgets.plane import Plane
from ikteach.view.widgets.prose import Prose
from ikteach.view.widgets.status import Status
from ikteach.view.widgets.table import Rows

NOTEBOOKS = Path(__file__).parents[2] / "notebooks"


def arm() -> Figure:
    return figures.planar_arm(2)


def still() -> Any:
    one = ikteach.view.StillScene(*arm())
    one.show(np.zeros(2), np.ones((1, 3)))
    assert one.widget.png
    return one


@cache
def log() -> Any:
    session = Session()
    for _ in range(3):
        session.tick()
    return session.log()


@cache
def some_trials() -> Any:
    poses = np.zeros((2, 2))
    return trials(*arm(), {"round": Round()}, starts=poses, seconds=0.5, settle=0.2)


# What is imported by a notebook, exported by `view`, or lives, and how a cell makes one.
FIGURES: dict[Any, Callable[[], Any]] = {
    ikteach.view.BendBench: ikteach.view.BendBench,
    ikteach.view.ColumnPoser: lambda: ikteach.view.ColumnPoser(arm()),
    ikteach.view.DrawingPad: ikteach.view.DrawingPad,
    ikteach.view.GaitPlayer: lambda: ikteach.view.GaitPlayer(pad=True),
    ikteach.view.Poser: lambda: ikteach.view.Poser(figures.human()),
    ikteach.view.Scene: lambda: ikteach.view.Scene(*arm()),
    ikteach.view.Simulator: lambda: ikteach.view.Simulator(PlanarReach()),
    ikteach.view.StillScene: still,
    ikteach.view.SvdBench: ikteach.view.SvdBench,
    ikteach.view.WalksPlayer: ikteach.view.WalksPlayer,
    ikteach.view.Workbench: ikteach.view.Workbench,
    CapPlayer: CapPlayer,
    Race: Race,
    TrialsPlayer: lambda: TrialsPlayer(some_trials()),
    Bench: lambda: Bench(lambda x: Shown(b"", ""), {"x": slider("x", 0, 0, 1, 1)}, slot="own"),
    slope_bench: slope_bench,
    robot_player: robot_player,
    spectrum_bench: spectrum_bench,
    standing_player: standing_player,
    tradeoff_bench: tradeoff_bench,
    Glass: lambda: Glass(Session()),
    Keeper: lambda: Keeper(Session()),
    MotionFiles: lambda: MotionFiles(Session(), print),
    Recorder: lambda: Recorder(Session()),
    Replay: lambda: Replay(log()),
    Targets: lambda: Targets(ikteach.view.Scene(*arm()), [[1.0, 1.0, 0.0]]),
    show_me: lambda: show_me(SimpleNamespace(slot="own"), {"Look.": {}}),
    predict: lambda: predict("00.test", "Which?", ["one", "other"]),
    quiz: lambda: quiz("00.test", "Which?", ["one", "other"], "one", "It is so."),
}

# Parts of figures: they live as long as what they are in, and have no slot of their own.
PARTS: dict[Any, Callable[[], Any]] = {
    RotationBall: RotationBall,
    Bands: lambda: Bands(["one", "other"]),
    Curve: Curve,
    Driver: lambda: ikteach.view.Scene(*arm(), slot=None).driver,
    Handles: lambda: Targets(ikteach.view.Scene(*arm(), slot=None), [[1, 1, 0]], slot=None).handles,
    Picture: Picture,
    Plane: lambda: Plane(title="plane"),
    Prose: Prose,
    Rows: Rows,
    Status: Status,
    StateLink: lambda: StateLink(str, lambda act: act),
    Strips: lambda: Strips(Session()),
}
# In notebooks too, but what they give back is no widget.
NO_WIDGETS = {
    "Ledger", "bars", "check", "export", "film", "heat", "lines", "order_chart", "phase_plot",
    "plainly", "preset", "reveal", "source",
}  # fmt: skip


def by_name(makers: dict[Any, Callable[[], Any]]) -> Any:
    return pytest.mark.parametrize(
        "make", [pytest.param(m, id=k.__name__) for k, m in makers.items()]
    )


@pytest.fixture(autouse=True)
def alone(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Nothing lives before and after, and files go elsewhere."""
    monkeypatch.chdir(tmp_path)
    widgets.Widget.close_all()
    yield
    widgets.Widget.close_all()


def all_can_be_sent() -> None:
    """What the kernel does when a page is loaded anew."""
    for widget in list(living.values()):
        widget.get_state()


def of_notebooks() -> dict[str, set[str]]:
    """The names that the chapters import of `view` and `course`, by module."""
    found: dict[str, set[str]] = {}
    for path in NOTEBOOKS.glob("*.ipynb"):
        cells = json.loads(path.read_text("utf-8"))["cells"]
        lines = [line for cell in cells if cell["cell_type"] == "code" for line in cell["source"]]
        for line in lines:
            if line.startswith(("from ikteach.view", "from ikteach.course")):
                (node,) = ast.parse(line.strip()).body
                assert isinstance(node, ast.ImportFrom)
                found.setdefault(str(node.module), set()).update(a.name for a in node.names)
    return found


def full(thing: Any) -> str:
    return f"{thing.__module__}.{thing.__qualname__}"


def all_that_live() -> set[str]:
    """Every class of `view` and `course` that lives in a cell, and that no other is made of."""
    for room in (ikteach.view, ikteach.course):
        for module in pkgutil.walk_packages(room.__path__, f"{room.__name__}."):
            if not module.name.startswith(("ikteach.serve.lecture", "ikteach.course.solutions")):
                importlib.import_module(module.name)
    found, waiting = set[str](), Living.__subclasses__()
    while waiting:
        one = waiting.pop()
        below = [each for each in one.__subclasses__() if each.__module__.startswith("ikteach.")]
        waiting += below
        # A module whose first import failed halfway leaves classes that nobody can find.
        there = getattr(sys.modules.get(one.__module__), one.__qualname__, None) is one
        if one.__module__.startswith("ikteach.") and there and not below:
            found.add(full(one))
    return found


def test_none_is_forgotten() -> None:
    known = set(map(full, FIGURES.keys() | PARTS.keys()))
    shown = set(ikteach.view.__all__) - NO_WIDGETS
    assert {full(getattr(ikteach.view, name)) for name in shown} <= known
    imported = {
        full(getattr(importlib.import_module(module), name))
        for module, names in of_notebooks().items()
        for name in names - NO_WIDGETS
    }
    assert len(imported) > 10
    assert imported <= known
    # Of Simulator; of predict and quiz; of show_me; of robot_player and standing_player.
    within = {"ikteach.view.chapters.reach.CursorScene", "ikteach.course.widget.Question"}
    within |= {"ikteach.course.buttons.Tries", "ikteach.view.chapters.robots.AskedPlayer"}
    assert all_that_live() - within <= known


@by_name(FIGURES)
def test_a_cell_run_again_adds_nothing_and_all_can_be_sent(make: Callable[[], Any]) -> None:
    first = make()
    count = len(living)
    all_can_be_sent()
    for _ in range(2):
        newest = make()
        assert len(living) == count
        all_can_be_sent()
    assert occupant(first.slot) is newest
    first.close()  # once more
    assert len(living) == count
    newest.close()
    if not isinstance(newest, Targets):
        assert not living
    all_can_be_sent()


@by_name(FIGURES | PARTS)
def test_what_is_closed_leaves_nothing_in_boxes_and_links_of_others(
    make: Callable[[], Any],
) -> None:
    one = make()
    shown = one if isinstance(one, widgets.Widget) else one.widget
    box = widgets.HBox([widgets.Accordion([shown]), widgets.Label("mine")])
    sliders = [w for w in living.values() if isinstance(w, widgets.FloatSlider)]
    mine = widgets.FloatSlider()
    links = [widgets.jslink((mine, "value"), (other, "value")) for other in sliders[:1]]
    one.close()
    all_can_be_sent()
    assert box.comm is not None
    assert mine.comm is not None
    assert box.children[0].children == ()
    assert all(link.comm is None for link in links)


@by_name(FIGURES)
def test_every_part_may_close_before_the_whole(make: Callable[[], Any]) -> None:
    make()
    parts = [one for one in living.values() if isinstance(one, Living) and one.slot is None]
    for part in parts:
        part.close()
        all_can_be_sent()
    make().close()
    all_can_be_sent()


class HalfwayError(Exception):
    pass


@by_name(FIGURES)
@pytest.mark.parametrize("share", [0.0, 0.5, 0.999])
@pytest.mark.filterwarnings("error::pytest.PytestUnraisableExceptionWarning")
def test_a_constructor_that_fails_leaves_what_was_before(
    make: Callable[[], Any], share: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = make()
    known = set(living)
    opened, open_one = 0, widgets.Widget.open

    def fails(self: widgets.Widget) -> None:
        nonlocal opened
        if opened == int(share * len(known)):
            raise HalfwayError
        opened += 1
        open_one(self)

    monkeypatch.setattr(widgets.Widget, "open", fails)
    with pytest.raises(HalfwayError):
        make()
    monkeypatch.undo()
    if before.slot not in ("own", "still", "targets"):  # their cells make more than one thing
        assert set(living) == known
    all_can_be_sent()
