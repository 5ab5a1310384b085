"""What a widget refuses: a sentence of its own, before anything is made."""

import re
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import ipywidgets as widgets
import numpy as np
import pandas as pd
import pytest

from ikteach import figures
from ikteach.course import predict, quiz
from ikteach.motion.live.session import Session
from ikteach.motion.reach.planar import PlanarReach
from ikteach.view import BendBench, ColumnPoser, Poser, Scene, Simulator, StillScene, Workbench
from ikteach.view.chapters.comparison import Race
from ikteach.view.chapters.pseudoinverse import CapPlayer
from ikteach.view.charts import bars, heat, lines, phase_plot
from ikteach.view.live.bench import Bench, Shown
from ikteach.view.live.panel import slider
from ikteach.view.tools.files import Keeper
from ikteach.view.tools.inspector import Glass
from ikteach.view.tools.recorder import Recorder
from ikteach.view.tools.replay import Replay
from ikteach.view.webgl.targets import Targets
from ikteach.view.widgets.closing import living

ARM, HUMAN = figures.planar_arm(3), figures.human()
NAN = float("nan")


def targets(*arguments: Any, **options: Any) -> Any:
    return Targets(StillScene(*ARM), *arguments, **options)


def bench(show: Any = lambda: Shown(b"", ""), controls: Any = None, **options: Any) -> Any:
    return Bench(show, {} if controls is None else controls, slot="x", **options)


def ask(**options: Any) -> Any:
    return predict("00.x", **({"question": "Which?", "options": ["a", "b"]} | options))


def exit_question(options: Any = ("a", "b"), right: Any = "a", why: Any = "So.") -> Any:
    return quiz("00.x", "Which?", options, right, why)


REFUSED: list[tuple[Callable[[], Any], type[Exception], str]] = [
    *(
        (lambda make=make, one=one: make(one), error, said)
        for make in (Poser, ColumnPoser)
        for one, error, said in (
            (ARM.tree, TypeError, "a figure is its tree and its effectors, .* not a Tree alone"),
            (None, TypeError, "not None"),
            ("human", TypeError, "not 'human'"),
            (figures.human, TypeError, "not <function human"),
            (ARM[::-1], TypeError, "the tree must be a Tree, not Effectors"),
            ((ARM.tree, HUMAN.effectors), ValueError, "of a tree of 20 joints, not of 3"),
        )
    ),
    *(
        (lambda make=make, options=options: make(*ARM, **options), error, said)
        for make in (Scene, StillScene)
        for options, error, said in (
            ({"width": "3"}, ValueError, "width must be from 1 to 8192, and whole, not '3'"),
            ({"height": 0}, ValueError, "height must be from 1 to 8192, and whole, not 0"),
            ({"width": NAN}, ValueError, "width must be .*, not nan"),
            ({"width": 10**9}, ValueError, "width must be .*, not 1000000000"),
            ({"names": []}, ValueError, "at least one figure"),
            ({"names": "ab"}, TypeError, "must be a list of texts, not 'ab'"),
            ({"names": [1]}, TypeError, "must be text, not 1"),
            ({"names": ["ab"], "apart": NAN}, ValueError, "apart must be a number, 0 or"),
            ({"apart": "x"}, ValueError, "apart must be a number, 0 or more, not 'x'"),
            ({"drak": True}, TypeError, "no option of .*Scene 'drak'; did you mean 'dark'"),
            ({"slot": 3}, TypeError, "a slot is a name, or None for none, not 3"),
        )
    ),
    *(
        (lambda make=make, session=session: make(session), TypeError, "session must be a Session")
        for make in (Glass, Keeper, Recorder)
        for session in (3, None, Session)
    ),
    (lambda: Scene(ARM.tree, None), TypeError, "the effectors must be Effectors, not None"),
    (lambda: StillScene(*ARM[::-1]), TypeError, "the tree must be a Tree, not Effectors"),
    (lambda: Scene(ARM.tree, HUMAN.effectors), ValueError, "of a tree of 20 joints, not of 3"),
    (lambda: Poser(ARM, slott="a"), TypeError, "no option of Poser 'slott'; did you mean 'slot'"),
    (lambda: BendBench(slot=[]), TypeError, "a slot is a name, or None for none"),
    (lambda: Glass(Session(), stop=3), TypeError, "stop must be a function, not 3"),
    (lambda: Keeper(Session(), 3), TypeError, "open_run must be a function, not 3"),
    (lambda: Keeper(Session(), folder=3), TypeError, "folder must be a path, not 3"),
    (lambda: Recorder(Session(), folder=3), TypeError, "folder must be a path, not 3"),
    (lambda: Workbench(folder=3), TypeError, "folder must be a path, not 3"),
    (lambda: Workbench(method="dsl"), LookupError, "no method 'dsl'; did you mean 'dls'"),
    (lambda: Replay(3), TypeError, "run must be a Log, not 3"),
    (lambda: Replay(Session()), TypeError, "run must be a Log, not <ikteach"),
    (lambda: Replay(Session().log()), ValueError, "nothing to replay"),
    (lambda: Simulator(3), TypeError, "session must be a Reach or a PlanarReach, not 3"),
    (lambda: Simulator(Session()), TypeError, "session must be a Reach or a PlanarReach"),
    (lambda: Simulator(PlanarReach(), parts=2), TypeError, "parts: options are for a session that"),
    (
        lambda: Simulator(parts="x"),
        ValueError,
        "the number of parts must be 0 or more, and finite, not 'x'",
    ),
    (
        lambda: Simulator(max_step=NAN),
        ValueError,
        "max_step must be 0 or more, and finite, not nan",
    ),
    (lambda: CapPlayer("x"), ValueError, "degrees must be a number, from 0.5 to 45, not 'x'"),
    (lambda: CapPlayer(NAN), ValueError, "degrees must be a number, from 0.5 to 45, not nan"),
    *(
        (
            lambda degrees=degrees: Race(degrees=degrees),
            ValueError,
            f"from 0.5 to 180, not {degrees}",
        )
        for degrees in (-3, 1000, NAN, None)
    ),
    (lambda: Race(degrees="x"), ValueError, "degrees must be a number, from 0.5 to 180, not 'x'"),
    (lambda: slider("x", NAN, 0, 1, 1), ValueError, "the value of 'x' must be a finite number"),
    (lambda: slider("x", None, 0, 1, 0.1), ValueError, "'x' must be a finite number, not None"),
    *(
        (lambda draw=draw, table=table: draw(table), error, said)
        for draw in (
            partial(heat, title="", unit=""),
            partial(bars, title="", ylabel=""),
            partial(lines, title="", xlabel="", ylabel=""),
            phase_plot,
        )
        for table, error, said in (
            (None, TypeError, "a chart needs a pandas DataFrame, not None"),
            ("abc", TypeError, "a chart needs a pandas DataFrame, not 'abc'"),
            (np.eye(2), TypeError, "a chart needs a pandas DataFrame, not array"),
            (pd.DataFrame(), ValueError, "a chart needs rows and columns, not 0 by 0"),
            (pd.DataFrame({"a": []}), ValueError, "a chart needs rows and columns, not 0 by 1"),
            (pd.DataFrame({"a": ["x"]}), ValueError, "column 'a' of a chart's table must be made"),
            (pd.DataFrame({"a": [NAN]}), ValueError, "all of this table are missing"),
        )
    ),
    (lambda: CapPlayer(x_hand=99), ValueError, "x_hand must be a number, from 0.3 to 2, not 99"),
    (lambda: CapPlayer(xhand=1), TypeError, "no option of CapPlayer 'xhand'; did you mean 'x_hand"),
    (lambda: Targets(3, [[0, 0, 0]]), TypeError, "scene must be a Scene or a StillScene, not 3"),
    (lambda: targets([0, 0, 0]), ValueError, r"1 targets need positions \(1, 3\), not \(3,\)"),
    (lambda: targets([[0, 0, NAN]]), ValueError, "start is not finite"),
    (lambda: targets("abc"), ValueError, "start must be made of numbers, not 'abc'"),
    (lambda: targets([[0, 0, 0]], low=NAN), ValueError, "low has no number where it should"),
    (lambda: targets([[0, 0, 0]], low=[1, 2]), ValueError, r"low must be one number or \(1, 3\)"),
    (lambda: targets([[0, 0, 0]], high="x"), ValueError, "high must be made of numbers"),
    (lambda: bench(3), TypeError, "show must be a function, not 3"),
    (lambda: bench(controls=[1]), TypeError, r"controls must be a \{name: …\}, not \[1\]"),
    (lambda: bench(controls={"x": 3}), TypeError, "'x' of controls must be a widget with a value"),
    (lambda: bench(buttons={"a": 3}), TypeError, "'a' of buttons must be a function, not 3"),
    (lambda: ask(options=["a"]), ValueError, "'00.x' needs options to choose from"),
    (lambda: ask(options=["a", "a"]), ValueError, "'00.x' needs options to choose from"),
    (lambda: ask(options="ab"), TypeError, "the options of '00.x' must be a list of texts"),
    (lambda: ask(options=[1, 2]), TypeError, "each of the options of '00.x' must be text, not 1"),
    (
        lambda: ask(options=(), numbers=(1, 2)),
        TypeError,
        r"must be \(low, high, unit\), not \(1, 2",
    ),
    (lambda: ask(options=(), numbers=(3, 2, "m")), ValueError, "the high end of '00.x' must be"),
    (lambda: ask(options=(), numbers=(NAN, 2, "m")), ValueError, "the low end of '00.x' must be"),
    (lambda: ask(question=None), TypeError, "the question of '00.x' must be text, not None"),
    (lambda: predict(3, "Which?", ["a", "b"]), TypeError, "the key of a question must be text"),
    (lambda: exit_question(right="c"), LookupError, "no option of '00.x' 'c'"),
    (lambda: exit_question(why={"c": ""}), LookupError, "no option of '00.x' 'c'"),
    (lambda: exit_question(why=None), TypeError, "why of '00.x' must be a sentence or"),
    (lambda: exit_question([1, 2], 1), TypeError, "each of the options of '00.x' must be text"),
]
FOREIGN = "trait|dictionary|broadcast|operand|NoneType|attribute|subscript|iterable|unpack|zip"


@pytest.mark.parametrize(("make", "error", "said"), REFUSED, ids=range(len(REFUSED)))
@pytest.mark.filterwarnings("error::pytest.PytestUnraisableExceptionWarning")
def test_what_cannot_be_is_refused_in_a_sentence(
    make: Callable[[], Any], error: type[Exception], said: str, tmp_path: Path, monkeypatch: Any
) -> None:
    monkeypatch.chdir(tmp_path)
    widgets.Widget.close_all()
    with pytest.raises(error, match=said) as caught:
        make()
    sentence = str(caught.value)
    assert not re.search(FOREIGN, sentence)
    assert len(sentence) < 300
    assert not living


def test_numbers_of_numpy_are_numbers() -> None:
    CapPlayer(np.float32(5), x_hand=np.int64(1)).close()
    Scene(*ARM, width=np.int64(300), height=200.0).close()
    bench(lambda x: Shown(b"", ""), {"x": slider("x", 0, 0, 1, 1)}).close()
    assert not living
