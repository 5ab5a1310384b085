"""The parts of `tests/run`: each runs, whatever became of the others; then it is told what failed.

What a part says is shown if it fails. Two lanes go side by side: browsers one at a time, since two
are too slow for one another, and with the time that they leave what only computes.

IKTEACH_FULL=1 adds what is not needed on every change: more kernels of OpenBLAS, and every version
of Python that can be had, with the newest packages and with the lowest.
"""

import os
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).parents[2]
PYTHONS = ("3.11", "3.12", "3.13", "3.14")
COMPUTING = [
    *(f"tests/{room}" for room in ("bench", "body", "motion", "solvers", "study")),
]
BROWSERS = ["tests/browser", "tests/engines"]
WASM = "tests/wasm"  # in the full mode alone
KERNELS, RARER_KERNELS = ["Haswell", "Sandybridge"], ["SkylakeX", "Zen"]
ROUNDED = [  # what solves, and what is said of runs
    *(f"tests/motion/test_{name}.py" for name in ("gait", "rank", "solve", "step", "tracking")),
    *("tests/solvers", "tests/course/test_prose.py"),
]
LOWEST = ["tests/body", *ROUNDED, "tests/study", "tests/view"]
STYLE = "tests/test_types.py"  # with the newest numpy, pandas, mypy and ruff alone
NPM = ["npm", "--prefix", "tests/page"]
RARER = [
    *("tests/body", "tests/motion", "tests/solvers"),
    *("tests/course/test_prose.py", "tests/course/test_teaching.py", "tests/test_notebooks.py"),
]
Command = Sequence[str]


@dataclass(frozen=True)
class Part:
    """Commands that run one after the other until one fails.

    needs  commands before those: if one fails, the part is left out, and its last line says why
    """

    name: str
    commands: Sequence[Command]
    environment: Mapping[str, str] = field(default_factory=dict)
    needs: Sequence[Command] = ()


@dataclass(frozen=True)
class Done:
    """What became of a part: "passed", "FAILED" or "left out"; and what it said."""

    name: str
    result: str
    seconds: float
    said: str

    def __str__(self) -> str:
        line = f"{self.result:8} {self.seconds:5.0f} s  {self.name}"
        return (
            line if self.result != "left out" else f"{line}: {self.said.splitlines()[-1].strip()}"
        )


class Runner:
    """Runs parts, and with `end` ends what it has started and starts nothing more."""

    def __init__(self) -> None:
        self._under_way: set[subprocess.Popen[bytes]] = set()
        self._ended = False

    def lane(self, parts: Iterable[Part]) -> list[Done]:
        """One part after the other, each with a line when it is over."""
        return [self.run(part) for part in parts]

    def run(self, part: Part) -> Done:
        """The part, whose output is kept."""
        began = time.monotonic()
        with tempfile.TemporaryFile() as log:

            def fails(commands: Sequence[Command]) -> bool:
                return any(self._status(one, part.environment, log) for one in commands)

            left_out = fails(part.needs)
            result = "left out" if left_out else "FAILED" if fails(part.commands) else "passed"
            log.seek(0)
            said = log.read().decode(errors="replace").strip() or "it said nothing"
        done = Done(part.name, result, time.monotonic() - began, said)
        print(done, flush=True)
        return done

    def end(self) -> None:
        """End what is under way, and all that it has started."""
        self._ended = True
        for process in self._under_way.copy():
            os.killpg(process.pid, signal.SIGTERM)

    def _status(self, command: Command, environment: Mapping[str, str], log: object) -> int:
        if self._ended:
            return 1
        process = subprocess.Popen(
            command, cwd=ROOT, env={**os.environ, **environment}, stdin=subprocess.DEVNULL,
            stdout=log, stderr=subprocess.STDOUT, start_new_session=True,
        )  # fmt: skip
        self._under_way.add(process)
        try:
            return process.wait()
        finally:
            self._under_way.discard(process)


def pytest(*arguments: str, python: str = sys.executable, nice: bool = True) -> Command:
    """A run of pytest, which gives way to others if it is `nice`."""
    return [*(["nice", "-n", "19"] if nice else []), python, "-m", "pytest", *arguments]


def kernel(name: str, tests: Sequence[str]) -> Part:
    """What hangs on rounding, with another kernel of OpenBLAS."""
    return Part(
        f"rounded by {name}",
        [pytest(*tests)],
        {"OPENBLAS_CORETYPE": name, "IKTEACH_FULL": ""},
        needs=[[sys.executable, "tests/tools/kernel.py", name]],
    )


def packages(folder: Path, resolution: str, tests: Sequence[str], python: str = "") -> Part:
    """In an environment of its own, with the lowest-direct or the highest versions of packages.

    `python` is a version of Python; without one it is that which runs.
    """
    uv, place = [sys.executable, "-m", "uv"], folder / f"{resolution}-{python or 'this'}"
    create = [*uv, "venv", "--quiet", "--python", python or sys.executable, str(place)]
    inside = str(place / "bin" / "python")
    install = [*uv, "pip", "install", "--quiet", "--python", inside, "--resolution", resolution]
    return Part(
        f"Python {python or '.'.join(map(str, sys.version_info[:2]))}, {resolution} versions",
        [[*install, "--editable", ".[test]"], pytest(*tests, python=inside)],
        {"PATH": f"{place / 'bin'}{os.pathsep}{path_to_pythons()}", "IKTEACH_FULL": ""},
        needs=[create],
    )


def path_to_pythons() -> str:
    """PATH, and behind it the versions of Python that pyenv has."""
    pyenv = Path(os.environ.get("PYENV_ROOT") or Path.home() / ".pyenv")
    return os.pathsep.join([os.environ["PATH"], *map(str, pyenv.glob("versions/*/bin"))])


def lanes(folder: Path, full: bool) -> list[list[list[Part]]]:
    """The lanes, those of one list side by side, one list after the other."""
    apart = [f"--ignore={one}" for one in [*BROWSERS, *COMPUTING, STYLE, WASM]]
    no_browser = ["tests", *(f"--ignore={one}" for one in [*BROWSERS, STYLE])]
    servers = Part(
        "servers, notebooks, widgets",
        [pytest("--numprocesses", "2", "--dist", "loadfile", *apart, nice=False)],
    )
    page = Part("JavaScript", [[*NPM, "test"]], {"PYTHON": sys.executable})
    browsers = [Part("browser", [pytest("tests/browser", nice=False)])]
    engines = Part(
        "Firefox and WebKit",
        [pytest("tests/engines", nice=False)],
        needs=[["sh", "tests/engines/install", sys.executable]],
    )
    install = [sys.executable, "-m", "uv", "pip", "install", "--quiet", "--python", sys.executable]
    wasm = Part("WebAssembly", [pytest(WASM)], needs=[[*install, "--editable", ".[wasm]"]])
    beside = [
        Part("computing", [pytest(*COMPUTING, STYLE)]),
        page,
        *(kernel(name, RARER if full else ROUNDED) for name in KERNELS),
        packages(folder, "lowest-direct", no_browser if full else LOWEST),
    ]
    if full:
        browsers.append(engines)
        beside.append(wasm)
        beside += [kernel(name, RARER) for name in RARER_KERNELS]
        beside += [packages(folder, "highest", no_browser, python) for python in PYTHONS]
    return [[[servers]], [browsers, beside]]


def main() -> int:
    """Run all parts, show what those said that failed, and return how many there are."""
    runner, done = Runner(), []
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor() as pool:
        try:
            for side_by_side in lanes(Path(folder), bool(os.environ.get("IKTEACH_FULL"))):
                done += [one for lane in pool.map(runner.lane, side_by_side) for one in lane]
        finally:
            runner.end()
    failed = [one for one in done if one.result == "FAILED"]
    for one in failed:
        print(f"\n{'=' * 20} {one.name} {'=' * 20}\n{one.said}")
    print("", *done, sep="\n")
    return len(failed)


if __name__ == "__main__":
    sys.exit(main())
