"""Names of a classmate's file in the page: seen as they are, run by nobody, set as no formula."""

from typing import Any

import nbformat

from tests.browser.conftest import READY, Lab

SCRIPT = '<img src=x onerror="window.pwned=1">'
CELL = f"""from dataclasses import replace
from functools import partial
from IPython.display import display
from ikteach import dls, figures
from ikteach.course import predict
from ikteach.course.notice import Notice
from ikteach.motion.live.session import Session
from ikteach.view import ColumnPoser, GaitPlayer, Poser
from ikteach.view.tools.inspector import Glass
from ikteach.view.tools.replay import Replay
bad = {SCRIPT!r}
formula = r"$\\frac{{1}}{{2}}$"
tree, effectors = figures.human()
names = tuple((bad if i % 2 else formula) + name for i, name in enumerate(tree.names))
ends = tuple((bad if i % 2 else formula) + name for i, name in enumerate(effectors.names))
figure = figures.Figure(replace(tree, names=names), replace(effectors, names=ends))
methods = {{bad: dls, formula: partial(dls, damping=0.3)}}
session = Session(figure, methods=methods, method=bad)
for _ in range(3):
    session.tick()
glass = Glass(session)
glass.look()
player = GaitPlayer(methods, method=bad)
shown = [Poser(figure), ColumnPoser(figure), player, glass, Replay(session.log())]
asked = predict("99.bad", bad, [bad, formula], explain=formula)
display(*shown, asked, Notice(bad + formula))"""


def test_names_are_shown_and_not_run(open_notebook: Any, lab: Lab) -> None:
    kernel = {"kernelspec": {"name": "python3", "display_name": "Python 3 (ipykernel)"}}
    book = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(CELL)], metadata=kernel)
    nbformat.write(book, lab.folder / "names.ipynb")
    notebook = open_notebook("names.ipynb")
    notebook.run_all()
    page = notebook.page
    for selector in (".widget-html", ".widget-label", ".ikteach-status", ".ikteach-strips, legend",
                     "[role=status]", "td, th"):  # fmt: skip
        page.locator(".jp-OutputArea").locator(selector, has_text=SCRIPT).first.wait_for(
            state="attached", timeout=READY
        )
    notebook.shot("names")
    outputs = page.locator(".jp-OutputArea")
    assert outputs.locator("img[onerror], script").count() == 0
    assert outputs.locator("mjx-container, .MathJax").count() == 0
    assert page.evaluate("window.pwned") is None
    assert notebook.errors == []
