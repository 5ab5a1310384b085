"""Makes `tests/tools/` and `tests/bench/` places to import from, for every room."""

import sys
from pathlib import Path

import numpy as np
import pytest
from hypothesis import settings

settings.register_profile("ikteach", deadline=None, derandomize=True, print_blob=True)
settings.load_profile("ikteach")

HERE = Path(__file__).parent
sys.path += [str(HERE / "tools"), str(HERE / "bench")]


@pytest.fixture(autouse=True)
def _answers_of_this_folder(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each test begins as a kernel does, which keeps its answers where it was first asked."""
    from ikteach.course import record

    monkeypatch.setattr(record, "_folder", None)


@pytest.fixture(params=["as rounded here", "rounded otherwise"])
def rounding(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """For what is said of runs: once with this processor's last bits, once with others."""
    from rounding import move_all

    if request.param == "rounded otherwise":
        for name, other in move_all().items():
            monkeypatch.setattr(np.linalg, name, other)
