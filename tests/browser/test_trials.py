"""Chapter 8: the runs of an experiment, chosen and watched with the keyboard."""

from typing import Any

from tests.browser.conftest import READY

SMALL = """from ikteach import figures, gait
from ikteach.study.experiment import starts
from ikteach.study.trials import trials
from ikteach.view.widgets.closing import occupant

human = figures.human()
found = trials(*human, gait.MOTIONS, starts=starts(human.tree, 3), seconds=1.5, settle=0.5,
               can_reach=[[True, True, False, False], [False] * 4])
"""
ROWS = 'table[aria-label="methods in the chosen condition"] tr'
PLAYER = "occupant('trials')"


def test_a_row_is_chosen_by_keys_and_its_runs_move(open_notebook: Any) -> None:
    notebook = open_notebook("08_comparison.ipynb")
    page = notebook.page
    notebook.kernel("None", SMALL)
    notebook.run_figure("TrialsPlayer(found)")
    page.locator(f"{ROWS}[tabindex='0']").focus(timeout=READY)
    for method in "pseudoinverse", "dls":
        page.keyboard.press("ArrowDown")
        notebook.settle(f"{PLAYER}.words.split(',')[0]", method)
        assert page.locator(f"{ROWS}[aria-selected='true']").inner_text().startswith(method)
    notebook.frames(3)
    notebook.shot("08_trials")
    notebook.press("Pause")
    page.locator(".noUi-handle:visible").last.focus()
    page.keyboard.press("End")
    notebook.settle(f"{PLAYER}.session.frame", 44)
    notebook.press("running")
    notebook.settle(f"'running' in {PLAYER}.words", True)
    page.locator(ROWS, has_text="sdls").click()
    notebook.settle(f"{PLAYER}.words.split(',')[0]", "sdls")
    assert notebook.kernel(f"{PLAYER}.status.wrong") == ""
    assert notebook.errors == []
