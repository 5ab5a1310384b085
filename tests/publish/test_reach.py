"""The first cell for Colab: there it installs and asks for widgets, elsewhere it does nothing."""

import re
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest
from IPython.core.inputtransformer2 import TransformerManager

from ikteach import publish

PAGE = Path(publish.__file__).parent / "docs" / "pages" / "reach.md"
CELL = re.search(r"```python\n(import sys\n.*?)```", PAGE.read_text("utf-8"), re.DOTALL)


def run(cell: str) -> list[str]:
    """What a notebook does with the cell, in order; names that it leaves behind are few."""
    asked: list[str] = []

    class Shell:
        def run_line_magic(self, name: str, line: str, *_: Any) -> None:
            asked.append(f"%{name} {line}")

    left: dict[str, Any] = {"get_ipython": Shell, "asked": asked}
    exec(TransformerManager().transform_cell(cell), left)
    assert set(left) <= {"__builtins__", "get_ipython", "asked", "sys", "output"}
    return asked


def test_elsewhere_it_does_nothing() -> None:
    assert "google.colab" not in sys.modules
    assert CELL is not None
    assert run(CELL[1]) == []


def test_in_colab_it_installs_then_asks_for_the_widgets(monkeypatch: pytest.MonkeyPatch) -> None:
    assert CELL is not None
    google, colab = ModuleType("google"), ModuleType("google.colab")
    asked: list[str] = []

    class Output:
        @staticmethod
        def enable_custom_widget_manager() -> None:
            asked.append("widgets")

    colab.output = Output  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "google", google)
    monkeypatch.setitem(sys.modules, "google.colab", colab)
    (install,) = run(CELL[1])
    assert re.fullmatch(r'%pip install -q "ikteach @ git\+https://\S+"', install)
    assert asked == ["widgets"]
