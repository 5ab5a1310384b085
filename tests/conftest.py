"""Makes `tests/` and `tests/bench/` places to import from, for every room."""

import sys
from pathlib import Path

import pytest
from hypothesis import settings

settings.register_profile("ikteach", deadline=None, derandomize=True, print_blob=True)
settings.load_profile("ikteach")

HERE = Path(__file__).parent
sys.path += [str(HERE), str(HERE / "bench")]

# What shares a server, a browser or a build stays in one process when the tests are run in several.
TOGETHER = ("browser", "test_notebooks", "test_opening", "test_builds", "test_tracking")


@pytest.hookimpl(tryfirst=True)  # pytest-xdist reads the marks in the same hook
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Tell pytest-xdist which tests belong together."""
    for item in items:
        names = {*item.path.relative_to(HERE).parts[:-1], item.path.stem}
        for group in names.intersection(TOGETHER):
            item.add_marker(pytest.mark.xdist_group(group))
