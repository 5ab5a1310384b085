"""How many machines a class needs, from what was measured of the hub on one machine.

    python binder/jupyterhub/kubernetes/machines.py [--write]

prints the reckoning in Markdown; with --write it puts it into README.md beside this file, between
two marks. Needs PyYAML, which Jupyter brings.
"""

import argparse
import re
from math import ceil, floor
from pathlib import Path
from typing import NamedTuple

import yaml

HERE = Path(__file__).parent
TEACHING, README, VALUES = HERE.parents[2] / "TEACHING.md", HERE / "README.md", HERE / "values.yaml"
HEAD = "| students | frames/s, least |"  # of the table of capacity
FIRST, LAST = "<!-- by machines.py -->\n", "<!-- end -->\n"

RATE, LATE = 25.0, 100.0  # the bar: frames a second for each, and the 95th percentile [ms]
CHAPTERS = 3  # that a student has open; one was measured, which is half of the memory
CLASSES = (50, 200, 1000)
SIZES = ((4, 16), (8, 32), (16, 64))  # cores and memory [GB] of machines that are let everywhere
OWN_CORES, OWN_MEMORY = 0.5, 3.0  # [cores], [GB] of a machine for its system and the pods of it
PODS = 110 - 10  # what Kubernetes puts on a machine, less those of its own


class Capacity(NamedTuple):
    """What one machine carried, at most, of a class that plays all at once."""

    cores: int
    students: int
    memory: float  # a student, the most of all rows [MB]

    @property
    def cpu(self) -> float:
        """Of a student [cores]."""
        return self.cores / self.students

    @property
    def held(self) -> float:
        """Memory of a student with some chapters open [MB]."""
        return self.memory / 2 * (1 + CHAPTERS)


def measured(teaching: str) -> Capacity:
    """Read the table: the largest class of which each had what is asked for."""
    before, _, after = teaching.partition(HEAD)
    rows = after.partition("\n\n")[0].splitlines()[2:]
    table = [[float(cell) for cell in re.findall(r"[\d.]+", row)] for row in rows]
    cores = re.findall(r"on (\d+) cores", before)
    if not (table and cores):
        raise ValueError(f"there is no table, of so many cores, that begins with {HEAD!r}")
    good = [students for students, rate, _, late, *_ in table if rate >= RATE and late < LATE]
    return Capacity(int(cores[-1]), int(max(good)), max(memory for *_, memory, _ in table))


class Pod(NamedTuple):
    """What the values promise to a student's pod, and what it may take at most."""

    cpu: float  # [cores]
    most_cpu: float
    memory: float  # [MB]
    most_memory: float
    home: float  # [GB]


def promised(values: str) -> Pod:
    """Read the values of the chart."""
    user = yaml.safe_load(values)["singleuser"]
    memory = [megabytes(user["memory"][name]) for name in ("guarantee", "limit")]
    home = megabytes(user["storage"]["capacity"].removesuffix("i")) / 1024
    return Pod(user["cpu"]["guarantee"], user["cpu"]["limit"], *memory, home)


def megabytes(text: str) -> float:
    """[MB] of such as 512M or 1G, by which JupyterHub means powers of 1024."""
    return float(text[:-1]) * 1024 ** "MG".index(text[-1])


def on_one(pod: Pod, cores: float, memory: float) -> int:
    """How many students a machine of so many cores and GB takes."""
    by_cpu = (cores - OWN_CORES) / pod.cpu
    by_memory = (memory - OWN_MEMORY) * 1024 / pod.memory
    return min(floor(by_cpu + 1e-9), floor(by_memory), PODS)


def reckoning(pod: Pod) -> str:
    """Tabulate the machines of each size for each class, in Markdown."""
    cells = [["students", *(f"{cores} cores, {memory} GB" for cores, memory in SIZES), "homes"]]
    for students in CLASSES:
        machines = [ceil(students / on_one(pod, *size)) for size in SIZES]
        cells.append([f"{students:,}", *map(str, machines), f"{pod.home * students:,.0f} GB"])
    each = [f"{on_one(pod, *size)}" for size in SIZES]
    cells.append(["*on one machine*", *each, ""])
    cells.insert(1, ["---"] * len(cells[0]))
    return "".join(f"| {' | '.join(row)} |\n" for row in cells)


def main() -> None:
    """Print the reckoning, or write it into the README."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--write", action="store_true", help="into README.md")
    table = reckoning(promised(VALUES.read_text()))
    if parser.parse_args().write:
        before, _, rest = README.read_text().partition(FIRST)
        after = rest.partition(LAST)[2]
        README.write_text(before + FIRST + table + LAST + after)
    else:
        print(table, end="")


if __name__ == "__main__":
    main()
