"""Say whether OpenBLAS takes the kernel that it is asked for: python tests/tools/kernel.py Haswell

A kernel is for a kind of processor, and rounds in its own way. One that this processor cannot run,
that numpy's OpenBLAS does not have, or that it takes anyhow, is told by name and left out.
"""

import os
import subprocess
import sys

NAME = """
import numpy, threadpoolctl
numpy.linalg.svd(numpy.ones((20, 20)))
libraries = threadpoolctl.threadpool_info()
print(*{one["architecture"] for one in libraries if one["internal_api"] == "openblas"})
"""


def taken(asked: str | None) -> str:
    """The kernel that is in use where this one is asked for, "" where there is no OpenBLAS."""
    environment = {k: v for k, v in os.environ.items() if k != "OPENBLAS_CORETYPE"}
    if asked is not None:
        environment["OPENBLAS_CORETYPE"] = asked
    run = subprocess.run(
        [sys.executable, "-c", NAME], env=environment, capture_output=True, text=True
    )
    if run.returncode < 0:  # it was ended by an instruction that is not there
        raise OSError(f"this processor cannot run OpenBLAS's kernel {asked}")
    run.check_returncode()
    return run.stdout.strip()


def left_out(asked: str) -> str | None:
    """Why there is nothing to be tried with this kernel; None if there is."""
    try:
        native, other = taken(None), taken(asked)
    except OSError as error:
        return str(error)
    if not native:
        return "numpy has no OpenBLAS here"
    if other.lower() != asked.lower():
        return f"asked for {asked}, OpenBLAS takes {other}"
    return f"OpenBLAS takes {asked} anyhow" if other == native else None


if __name__ == "__main__":
    sys.exit(left_out(sys.argv[1]))
