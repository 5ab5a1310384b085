"""The recipe by which Binder builds this repository, and a way to follow it without a container."""

import os
import re
import shlex
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[1]
UV = [sys.executable, "-m", "uv"]
PIP = "${KERNEL_PYTHON_PREFIX}/bin/pip install --no-cache-dir"
BY_UV = f"{shlex.join(UV)} pip install --quiet --python ${{KERNEL_PYTHON_PREFIX}}"
LAYER = re.compile(r"^(COPY|RUN|ENV) (?:--chown=\S+ )?(.+)$", re.M)


class Recipe(NamedTuple):
    """Python's version, such as 3.13, and the layers (kind, what) that the repository asks for."""

    python: str
    layers: list[tuple[str, str]]


def recipe(repository: Path) -> Recipe:
    """Ask repo2docker what it would build of a folder, without Docker."""
    command = [sys.executable, "-m", "repo2docker", "--no-build", "--debug", str(repository)]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    python = re.search(r"python=([\d.]+)", done.stderr)
    ours = done.stdout.partition("# Run pre-assemble scripts!")[2].partition("# Add entrypoint")[0]
    if not (python and ours):
        raise ValueError(f"repo2docker printed no recipe:\n{done.stdout}{done.stderr}")
    return Recipe(python[1], LAYER.findall(ours))


def clone(source: Path, folder: Path) -> None:
    """Clone what is committed, on a branch of its own."""
    for command in (
        ["git", "clone", "--quiet", str(source), str(folder)],
        ["git", "-C", str(folder), "switch", "--quiet", "--force-create", "main"],
    ):
        subprocess.run(command, check=True)


class Build:
    """What is committed, built in a folder as Binder builds it, less the container.

    source       the clean clone
    home         the folder that is the container's home
    prefix       the virtual environment
    environment  what the variables of the environment are
    """

    def __init__(self, folder: Path) -> None:
        self.source, self.home, self.prefix = (folder / n for n in ("clone", "home", "environment"))
        self.home.mkdir()
        foreign = ("JUPYTER", "IPYTHON", "MPL", "PYTHON", "VIRTUAL_ENV", "XDG_")
        own = {k: v for k, v in os.environ.items() if not k.startswith(foreign)}
        self.environment = own | {
            "HOME": str(self.home),
            "REPO_DIR": str(self.home),
            "KERNEL_PYTHON_PREFIX": str(self.prefix),
            "PATH": f"{self.prefix / 'bin'}{os.pathsep}{os.environ['PATH']}",
            "UV_CACHE_DIR": output([*UV, "cache", "dir"]),  # which is not in that home
        }

    def steps(self, pip: bool = False) -> Iterator[str]:
        """Build, and say of each step what it was.

        pip  install the packages as Binder does; else by uv, which needs seconds, not minutes
        """
        clone(ROOT, self.source)
        python, layers = recipe(self.source)
        yield f"the recipe: Python {python}, {len(layers)} layers"
        yield self._make_environment(python)
        for kind, what in layers:
            if kind == "COPY":
                self._copy(what)
            elif kind == "ENV":
                name, _, value = what.partition("=")
                self.environment[name] = value.strip('"').replace("${REPO_DIR}", str(self.home))
            else:
                self.run("bash", "-c", what if pip else what.replace(PIP, BY_UV))
            by = ", by uv" if PIP in what and not pip else ""
            yield f"{kind} {what}{by}"
        self.run("pip", "check")
        yield "pip check"

    def _make_environment(self, python: str) -> str:
        """With that version of Python if there is one, else with this Python; say which it is."""
        make = [*UV, "venv", "--quiet", "--seed", str(self.prefix), "--python"]
        # Where pyenv stands in for Python, it wants to be told the version.
        environment = os.environ | {"PYENV_VERSION": python}
        if subprocess.run([*make, python], env=environment, capture_output=True).returncode != 0:
            subprocess.run([*make, sys.executable], check=True)
        return output([str(self.prefix / "bin" / "python"), "-V"])

    def _copy(self, what: str) -> None:
        start, end = (Path(word) for word in what.replace("${REPO_DIR}", str(self.home)).split())
        start = self.source / start.relative_to("src")
        if start.is_dir():
            shutil.copytree(start, end, dirs_exist_ok=True)
        else:
            end.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(start, end)

    def run(self, *command: str) -> str:
        """Run a command in the home folder; it must succeed."""
        done = subprocess.run(
            command, cwd=self.home, env=self.environment, capture_output=True, text=True
        )
        if done.returncode != 0:
            raise RuntimeError(f"{' '.join(command)} failed:\n{done.stdout}{done.stderr}"[-4000:])
        return done.stdout


def output(command: list[str]) -> str:
    """Run a command, and give what it prints."""
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()
