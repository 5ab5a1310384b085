"""The core in WebAssembly: the same numbers as here, and its own tests.

They want the extra `wasm` (a CPython for WASI, 98 MB), so they run in the full mode of `tests/run`.
"""

import json
from pathlib import Path

import numpy as np
import pytest

from tests.wasm.results import results
from tests.wasm.sandbox import fetch, wasm

CORE = ["body", "solvers", "motion", "study"]
# What rounding may move, after a run of 90 frames, where a number is about 1: rad, m, m/rad.
CLOSE = 1e-9
OPTIONS = [
    "--override-ini=addopts=-q",
    "--capture=sys",
    "--log-file=/tmp/log",  # there is no /dev/null
    "-p",
    "no:cacheprovider",
    "-p",
    "no:faulthandler",
]


@pytest.fixture(scope="module")
def there() -> dict[str, list[float]]:
    """The numbers that come of it there."""
    code = "import runpy; runpy.run_path('/course/tests/wasm/results.py', run_name='__main__')"
    return dict(json.loads(wasm(code)))


@pytest.fixture(scope="module")
def here() -> dict[str, np.ndarray]:
    return {name: np.asarray(found, float) for name, found in results()}


def test_it_is_wasm32() -> None:
    said = wasm("import sys, numpy; print(sys.platform, sys.maxsize, numpy.intp(0).nbytes)")
    assert said.split() == ["wasi", str(2**31 - 1), "4"]


def test_numbers_are_the_same_there(
    here: dict[str, np.ndarray], there: dict[str, list[float]]
) -> None:
    assert list(here) == list(there)
    for name, ours in here.items():
        np.testing.assert_allclose(there[name], ours, rtol=CLOSE, atol=CLOSE, err_msg=name)
        assert np.abs(ours).max() > 1e-3, name  # or every number would be close to every other


@pytest.mark.parametrize("room", CORE)
def test_the_tests_of_a_room_pass_there(
    room: str, tmp_path_factory: pytest.TempPathFactory
) -> None:
    packages = fetch(tmp_path_factory.getbasetemp() / "packages")
    code = f"import pytest; sys.exit(int(pytest.main({[*OPTIONS, f'tests/{room}']})))"
    assert " passed" in wasm(code, Path(packages))
