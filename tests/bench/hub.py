"""How many students one machine carries: a JupyterHub and a class that plays chapter 7, simulated.

    python tests/bench/hub.py [--students 20] [--seconds 60] [--one] [--table]

The hub is that of binder/jupyterhub, on loopback, and the figure is the player's own. Each student
answers as a page does whose every frame is drawn at once; they take a share of the machine, which
is said. A delay is the time from the kernel's making a message to the student's having it, by one
clock. The player compares four methods, with `--one` it has one. `--table` plays with 1, 5, 10 and
20 students and prints a table for a document.

Trust it on a machine that does nothing else.
"""

import argparse
import asyncio
import signal
import statistics
import sys
import tempfile
import time
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import NamedTuple

import psutil

sys.path.insert(0, str(Path(__file__).parent))
from classroom import ONE_METHOD, PLAYER, Hub, Student

COUNTS = (1, 5, 10, 20)
RATE, LATE = 25.0, 100.0  # the bar: frames a second for each, and the 95th percentile [ms]


class Seen(NamedTuple):
    """What one student has of the hub, and what the student costs it."""

    rate: float  # [frames/s]
    p50: float  # [ms]
    p95: float  # [ms]
    scene: float  # messages for the picture, a frame
    messages: float  # messages of any kind, a frame
    server_cpu: float  # [s/s]
    kernel_cpu: float  # [s/s]
    server_memory: float  # [MB]
    kernel_memory: float  # [MB]

    @property
    def good(self) -> bool:
        """Whether it meets the bar."""
        return self.rate >= RATE and self.p95 < LATE and self.scene == 1


LABELS = (
    "frames a second", "delay, median [ms]", "delay, 95 % [ms]", "picture's messages a frame",
    "all messages a frame", "CPU of the server [s/s]", "CPU of the kernel [s/s]",
    "memory of the server [MB]", "memory of the kernel [MB]",
)  # fmt: skip


class Class(NamedTuple):
    """A whole class: what each student has, and what the rest of the machine does [s/s]."""

    seen: list[Seen]
    hub: float
    students: float
    busy: float  # of all cores

    @property
    def verdict(self) -> str:
        """Whether each student has what is asked for."""
        missed = sum(not one.good for one in self.seen)
        bar = f"{RATE:.0f} frames a second, 95 % under {LATE:.0f} ms, one message a frame"
        return f"{bar}: " + (f"missed by {missed} of {len(self.seen)}" if missed else "met by each")


async def gather(students: Iterable[Student]) -> float:
    """Have students come, all at once; how long it takes until their figures move [s]."""
    began = time.monotonic()
    await asyncio.gather(*(student.come() for student in students))
    return time.monotonic() - began


async def watch(
    hub: Hub, students: Sequence[Student], seconds: float, settling: float = 3.0
) -> Class:
    """Let them play for some seconds, after some that do not count."""
    await asyncio.sleep(settling)
    servers = hub.servers()
    trees = [[servers[one.name], *servers[one.name].children()] for one in students]
    known = [one for tree in trees for one in tree]
    rest = [one for one in hub.process.children(recursive=True) if one not in known]
    groups = [[tree[0]] for tree in trees] + [tree[1:] for tree in trees]
    groups += [[hub.process, *rest], [psutil.Process()]]
    psutil.cpu_percent()
    for one in students:
        one.frames.clear()
        one.scene = one.messages = 0
    began, before = time.monotonic(), [used(group) for group in groups]
    await asyncio.sleep(seconds)
    lasted = time.monotonic() - began
    counts = [(list(one.frames), one.scene, one.messages) for one in students]
    cpu = [(used(group) - b) / lasted for group, b in zip(groups, before, strict=True)]
    busy = psutil.cpu_percent() / 100 * (psutil.cpu_count() or 1)
    seen, n = [], len(students)
    for i, (frames, scene, messages) in enumerate(counts):
        count = max(len(frames), 1)
        late = sorted(1000 * (frame.received - frame.sent) for frame in frames) or [float("nan")]
        p50, p95 = statistics.median(late), late[int(0.95 * len(late))]
        memory = [held(groups[i]), held(groups[n + i])]
        share = (scene / count, messages / count)
        seen.append(Seen(len(frames) / lasted, p50, p95, *share, cpu[i], cpu[n + i], *memory))
    return Class(seen, cpu[-2], cpu[-1], busy)


def used(processes: Iterable[psutil.Process]) -> float:
    """CPU time so far [s]."""
    return sum(sum(process.cpu_times()[:2]) for process in processes)


def held(processes: Iterable[psutil.Process]) -> float:
    """Memory that would be free without them [MB]."""
    return sum(process.memory_full_info().uss for process in processes) / 1e6


def told(one: Class) -> str:
    """What each has, over the class, and the verdict."""
    lines = [f"{f'{len(one.seen)} students':28}{'min':>8}{'median':>8}{'max':>8}"]
    for label, *values in zip(LABELS, *one.seen, strict=True):
        spread = min(values), statistics.median(values), max(values)
        lines.append(f"{label:28}" + "".join(f"{value:8.3g}" for value in spread))
    lines.append(
        f"CPU: hub and proxy {one.hub:.2f} s/s, simulated students {one.students:.2f} s/s, "
        f"all of the machine {one.busy:.2f} of {psutil.cpu_count()} cores"
    )
    return "\n".join([*lines, one.verdict])


def row(one: Class) -> str:
    """A line of the table: the worst of the class where it matters, else the median."""
    column = dict(zip(Seen._fields, zip(*one.seen, strict=True), strict=True))
    middle = {name: statistics.median(values) for name, values in column.items()}
    cells = [
        len(one.seen), f"{min(column['rate']):.1f}", f"{middle['p50']:.0f}",
        f"{max(column['p95']):.0f}", f"{max(column['scene']):.2f}",
        f"{1000 * (middle['server_cpu'] + middle['kernel_cpu']):.0f}",
        f"{middle['server_memory']:.0f} + {middle['kernel_memory']:.0f}", f"{one.busy:.2f}",
    ]  # fmt: skip
    return f"| {' | '.join(map(str, cells))} |"


HEAD = """\
| students | frames/s, least | delay, median [ms] | delay, worst 95 % [ms] | messages a frame \
| CPU a student [ms/s] | memory a student, server + kernel [MB] | cores busy |
|---|---|---|---|---|---|---|---|"""


async def main(counts: Sequence[int], seconds: float, cell: str, table: bool) -> None:
    """Play with ever more students, and print what came of it."""
    students: list[Student] = []
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        async with Hub(Path(folder), max(counts)) as hub:
            if table:
                print(HEAD, flush=True)
            for count in counts:
                names = list(hub.passwords)[len(students) : count]
                new = [Student(hub, name, cell) for name in names]
                took = await gather(new)
                students += new
                seen = await watch(hub, students, seconds)
                print(row(seen) if table else told(seen), flush=True)
            print(f"\n{seen.verdict}" if table else f"From login to the last figure {took:.0f} s")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--students", type=int, default=20)
    parser.add_argument("--seconds", type=float, default=60)
    parser.add_argument("--table", action="store_true", help=f"for {COUNTS} students, in markdown")
    parser.add_argument("--one", action="store_true", help="one method, not four")
    given = parser.parse_args()
    signal.signal(signal.SIGTERM, lambda *_: sys.exit("ended"))  # and the hub with it
    counts = COUNTS if given.table else (given.students,)
    asyncio.run(main(counts, given.seconds, ONE_METHOD if given.one else PLAYER, given.table))
