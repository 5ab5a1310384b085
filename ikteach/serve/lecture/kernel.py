"""Start a kernel of the lecture, which takes so much of this machine and no more."""

import os
from contextlib import suppress

from ipykernel.kernelapp import launch_new_instance

MEMORY = 2**30  # bytes that it may write to; the workbench takes a third of it
LOWER = 10  # about a tenth of the share of a process that does not give way: the server delivers

if __name__ == "__main__":
    with suppress(ImportError, OSError, ValueError):  # Windows has no limits, macOS not this one
        import resource

        resource.setrlimit(resource.RLIMIT_DATA, (MEMORY, MEMORY))
    with suppress(AttributeError, OSError):
        os.nice(LOWER)
    launch_new_instance()
