"""A small class in a real hub; `tests/bench/hub.py` plays with a large one."""

import asyncio

import hub as bench
import pytest
from aiohttp import ClientResponseError
from classroom import Hub, Student


async def lesson(folder):
    """Two students play for a while; what they saw, and what each found in their folder."""
    async with Hub(folder, 2) as hub:
        one, other = students = [Student(hub, name) for name in hub.passwords]
        mine = hub.homes / one.name / "ikteach-course" / "07_gait.ipynb"
        mine.parent.mkdir(parents=True)
        mine.write_text("mine")
        with pytest.raises(ClientResponseError, match="403"):
            await one.log_in(hub.passwords[other.name])
        await bench.gather(students)
        with pytest.raises(ClientResponseError, match="403"):
            await hub.ask(
                f"/user/{other.name}/api/kernels", await one.log_in(hub.passwords[one.name])
            )
        seen = await bench.watch(hub, students, seconds=2, settling=0.2)
        for server in hub.servers().values():
            (kernel,) = server.children()
            assert kernel.nice() > server.nice()
            sockets = {one.laddr[-6:] for one in kernel.net_connections("unix")}
            assert {f"-ipc-{i}" for i in range(1, 6)} <= sockets  # no ports, which others may take
        assert mine.read_text() == "mine"
        folders = [hub.homes / one.name / "ikteach-course" for one in students]
        return seen, [{file.name for file in folder.iterdir()} for folder in folders]


def test_each_has_a_course_and_a_moving_figure_of_their_own(tmp_path):
    seen, courses = asyncio.run(lesson(tmp_path))
    assert "07_gait.new.ipynb" in courses[0]  # beside the student's own
    assert "07_gait.new.ipynb" not in courses[1]
    for one, course in zip(seen.seen, courses, strict=True):
        assert {"00_figure.ipynb", "07_gait.ipynb", "pictures"} < course
        assert one.rate > 0
        assert one.scene == 1  # message a frame
        assert one.server_cpu > 0
        assert one.kernel_cpu > 0
    assert bench.told(seen).count("\n") == len(bench.LABELS) + 2
    assert bench.row(seen).count("|") == bench.HEAD.splitlines()[0].count("|")
