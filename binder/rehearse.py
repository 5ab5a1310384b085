"""What Binder does with this repository, repeated here: build it, start it, open its links.

    python -m binder.rehearse [--pip] [--all]

The steps are those of the recipe that repo2docker prints for a clean clone of what is committed;
they run in a new virtual environment instead of a container. Then a Chromium opens the launch
links. Needs the extra `test`.
"""

import argparse
import os
import re
import secrets
import shlex
import socket
import subprocess
import sys
import tempfile
import time
import urllib.error
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NamedTuple

from playwright.sync_api import Browser, Page, sync_playwright

from binder.links import LECTURE, ROOT, chapters

PATIENCE = 120_000  # [ms] how long a page may take on a slow machine
MEMORY = 1024  # [MB] what mybinder.org promises


class Recipe(NamedTuple):
    """What repo2docker would build: the Python, the commands before and after the clone, start."""

    python: str
    packages: list[str]
    clone: list[str]
    start: str


def recipe(repository: Path) -> Recipe:
    """The recipe for a repository, without building it."""
    command = [sys.executable, "-m", "repo2docker", "--no-build", "--debug", str(repository)]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    return read(done.stdout, done.stderr)


def read(dockerfile: str, told: str) -> Recipe:
    """Take from a Dockerfile of repo2docker what depends on the repository."""
    ours = dockerfile.partition("# Run pre-assemble scripts!")[2]
    before, copied, after = ours.partition("\nCOPY --chown=0:0 src/ ")
    start = re.search(r'^ENV R2D_ENTRYPOINT="(.+)"$', after, re.M)
    python = re.search(r"python=([\d.]+)", told)
    if not (copied and start and python):
        raise ValueError(f"not a recipe that this script can follow:\n{dockerfile}")
    runs = [re.findall(r"^RUN (.+)$", part, re.M) for part in (before, after)]
    return Recipe(python[1], *runs, start[1])
