"""What the chapters say to try: each sentence has a button, and the button does it."""

import ast
import re
from pathlib import Path
from typing import Any

import nbformat
import numpy as np
import pytest

from ikteach import figures
from ikteach.course import plainly, show_me, source
from ikteach.course.plain import PLAIN, largest_difference
from ikteach.view import BendBench, Poser, Simulator, Workbench
from ikteach.view.chapters.transpose import slope_bench
from ikteach.view.live.controls import controls
from ikteach.view.widgets.closing import close_all

ROOT = Path(__file__).parents[2]
ROUNDED = re.compile(r"\S+e-1[3-9]|\S+e-[2-9]\d|-0\.0+(?!\d)")  # numbers that stand for 0


def cells() -> list[Any]:
    """The cells that show what to try.

    The first of a notebook as it is, for whoever runs nothing before it; others after the imports.
    """
    found = []
    for path in sorted((ROOT / "notebooks").glob("*.ipynb")):
        code = [c for c in nbformat.read(path, as_version=4).cells if c.cell_type == "code"]
        nodes = [node for cell in code for node in ast.parse(cell.source).body]
        imports = [ast.unparse(n) for n in nodes if isinstance(n, ast.Import | ast.ImportFrom)]
        shown = [cell for cell in code if "show_me(" in cell.source]
        for i, cell in enumerate(shown):
            source = "\n".join([*(imports if i else []), cell.source])
            found.append(pytest.param(source, id=f"{path.stem}:{cell.id}"))
    return found


def state(figure: Any) -> str:
    values = {n: c.value for n, c in controls(figure).items() if hasattr(c, "value")}
    targets = figure.targets.positions.tolist() if hasattr(figure, "targets") else None
    return f"{values} {targets} {getattr(figure, 'words', '')}"


def off_the_grid(figure: Any, code: str) -> dict[str, float]:
    """The sliders that a cell sets to what no page can show: there they take the nearest value."""
    found = {}
    for name, control in controls(figure).items():
        if f'"{name}"' in code and getattr(control, "step", None):
            value = control.value
            value = np.log(value) / np.log(control.base) if hasattr(control, "base") else value
            steps = (value - control.min) / control.step
            if abs(steps - round(steps)) > 1e-6:
                found[name] = control.value
    return found


@pytest.mark.parametrize("code", cells())
def test_every_button_of_a_chapter_moves_its_figure(code: str) -> None:
    names: dict[str, Any] = {"display": lambda *shown: None}
    body = ast.parse(code).body
    exec(compile(ast.Module(body[:-1], []), "cell", "exec"), names)
    last = body[-1]
    assert isinstance(last, ast.Expr)
    made = eval(compile(ast.Expression(last.value), "cell", "eval"), names)
    call = last.value
    assert isinstance(call, ast.Call)
    figure = names[ast.unparse(call.args[0])]
    seen = [state(figure)]
    buttons = [row.children[0] for row in made.children[:-1]]
    for button in buttons:
        button.click()
        assert made.status.wrong == ""
        assert made.status.said
        assert figure.status.wrong == ""
        assert off_the_grid(figure, code) == {}
        assert ROUNDED.findall(getattr(figure, "words", "")) == []
        seen.append(state(figure))
    assert len(set(seen)) >= len(seen) - 1  # the first may be how the figure starts
    assert len(seen) > 1
    for button, first in zip(buttons[::-1], seen[:0:-1], strict=True):
        button.click()
        assert state(figure) == first, f"{button.description} shows something else after others"
    close_all(made, figure)


def test_the_first_chapters_all_have_buttons() -> None:
    assert len(cells()) >= 10


def test_a_control_that_is_not_there_is_named() -> None:
    bench = BendBench()
    with pytest.raises(LookupError, match="bent"):
        show_me(bench, {"bend it": {"bent": 0}})
    with pytest.raises(TypeError, match="control: value"):
        show_me(bench, {"bend it": 5})  # type: ignore[dict-item]
    bench.close()


def test_a_value_that_does_not_fit_is_told_and_the_figure_goes_on() -> None:
    bench = BendBench()
    made = show_me(bench, {"<b>bend</b>": {"bend": "much"}, "way": {"way": 0}})
    made.children[0].children[0].click()
    assert "much" in made.status.wrong
    assert "<b>" not in made._repr_mimebundle_()[0]["text/html"]
    made.children[1].children[0].click()
    assert (made.status.wrong, bench.values["way"]) == ("", 0)
    close_all(made, bench)


def test_buttons_targets_and_panels_are_set_too() -> None:
    slope = slope_bench()
    made = show_me(slope, {"step": {"gain": 1.0, "Take the step": 3}})
    made.children[0].children[0].click()
    assert "after 3 steps" in slope.words
    simulator = Simulator()
    low = show_me(simulator, {"low": {"cursor": [0.4, -0.2, 0.3], "method": "dls"}})
    low.children[0].children[0].click()
    assert simulator.session.cursor.tolist() == [0.4, -0.2, 0.3]
    assert simulator.session.method == "dls"
    bench = Workbench()
    run = show_me(bench, {"run": {"motion": "running", "speed": 8.0}})
    run.children[0].children[0].click()
    assert (bench.session.gait.name, bench.session.gait.speed) == ("running", 8.0)
    poser = Poser(figures.human())
    spine = show_me(poser, {"bend": {"elbow.l": 90}})
    spine.children[0].children[0].click()
    assert poser.values["elbow.l"] == 90
    close_all(made, low, run, spine, slope, simulator, bench, poser)


@pytest.mark.parametrize("thing", PLAIN, ids=lambda thing: thing.__name__)
def test_plain_versions_are_equal_and_short(thing: Any) -> None:
    assert largest_difference(thing) < 1e-12
    shown = plainly(thing)
    assert f"{largest_difference(thing):.0e}" in shown._repr_markdown_()
    lines = PLAIN[thing][0][0].__code__.co_lines()
    assert len({line for *_, line in lines}) <= 8


def test_what_has_no_plain_version_says_which_have() -> None:
    with pytest.raises(LookupError, match="forward"):
        plainly(source)
