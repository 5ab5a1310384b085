"""Makes `tests/` and `tests/bench/` places to import from, for every room."""

import sys
from pathlib import Path

import pytest
from hypothesis import settings

settings.register_profile("ikteach", deadline=None, derandomize=True, print_blob=True)
settings.load_profile("ikteach")

HERE = Path(__file__).parent
sys.path += [str(HERE), str(HERE / "bench")]


@pytest.fixture(autouse=True)
def _answers_of_this_folder(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each test begins as a kernel does, which keeps its answers where it was first asked."""
    from ikteach.course import record

    monkeypatch.setattr(record, "_folder", None)
