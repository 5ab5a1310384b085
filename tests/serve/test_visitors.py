"""A lecture with visitors who mean it no good: it goes on, for others and for them."""

import asyncio
import json
import os
import re
import signal
import socket
import subprocess
import sys
import uuid
from collections.abc import Awaitable, Callable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

import nbformat
import psutil
import pytest
from jupyter_server.services.kernels.connection.base import (
    deserialize_msg_from_ws_v1,
    serialize_msg_to_ws_v1,
)
from tornado.httpclient import AsyncHTTPClient, HTTPClientError, HTTPRequest, HTTPResponse
from tornado.websocket import WebSocketClientConnection, WebSocketClosedError, websocket_connect

from ikteach.serve.lecture import gate
from ikteach.serve.lecture import kernel as limits
from tests.serve.test_gate import HOSTILE

OPEN_EACH = 3
START = f"""
import sys
from ikteach import __main__
from ikteach.serve.lecture import server
server.OPEN_EACH = {OPEN_EACH}
sys.exit(__main__.main(["lecture", *sys.argv[1:]]))
"""
FIGURE = "import ipywidgets; large = ipywidgets.HTML('x' * 10**6); ipywidgets.IntSlider(5)"
PIXEL = bytes.fromhex(
    "47494638396101000100800000ffffff00000021f90400000000002c00000000010001000002024401003b"
)


class Lecture:
    """The lecture's command, with small pages of the lecturer's own, and a way to visit it."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        words = nbformat.v4.new_markdown_cell("![a picture](walk.gif)")
        page = nbformat.v4.new_notebook(cells=[words, nbformat.v4.new_code_cell(FIGURE)])
        page.metadata.kernelspec = {"name": "python3", "language": "python", "display_name": "3"}
        for name in ("gait", "mine", "sub/gait", ".hidden", ".ipynb_checkpoints/gait-checkpoint"):
            (folder / name).parent.mkdir(exist_ok=True)
            nbformat.write(page, folder / f"{name}.ipynb")
        (folder / "walk.gif").write_bytes(PIXEL)
        with socket.create_server(("127.0.0.1", 0)) as free:
            self.port = free.getsockname()[1]
        command = [sys.executable, "-u", "-c", START, str(folder), "--no-browser"]
        self.errors = folder.with_name("errors")  # what it says on stderr
        with self.errors.open("w") as errors:
            self.server = subprocess.Popen(
                [*command, f"--port={self.port}"], stdout=subprocess.PIPE, stderr=errors,
                text=True, cwd=folder, env=os.environ | {"JUPYTER_CONFIG_DIR": str(folder)},
            )  # fmt: skip
        assert self.server.stdout is not None
        said = "".join(iter(self.server.stdout.readline, "Ctrl-C here ends it\n"))
        found = re.search(r"^the lecture is at (http://\S+/)\?token=([\w-]+)$", said, re.M)
        assert found, said
        self.site, self.token = found.groups()
        self.headers = {"Authorization": f"token {self.token}"}

    async def get(self, path: str, token: bool = True, **options: Any) -> HTTPResponse:
        request = HTTPRequest(
            self.site + path, headers=self.headers if token else None, request_timeout=90,
            follow_redirects=False, **options,
        )  # fmt: skip
        return await AsyncHTTPClient().fetch(request, raise_error=False)

    async def page(self) -> str:
        """Open a page; its kernel."""
        answer = await self.get("voila/render/gait.ipynb")
        found = re.search(rb'"kernelId":\s*"([0-9a-f-]+)"', answer.body)
        assert found, answer.body
        return found[1].decode()

    async def socket(
        self, kernel: str, *, protocol: str | None = gate.PROTOCOL, query: str = ""
    ) -> WebSocketClientConnection:
        address = f"{self.site.replace('http', 'ws')}api/kernels/{kernel}/channels?{query}"
        subprotocols = [protocol] if protocol else None
        return await websocket_connect(
            HTTPRequest(address, headers=self.headers), subprotocols=subprotocols
        )

    def kernels(self) -> list[psutil.Process]:
        return psutil.Process(self.server.pid).children()

    def visited(self, visit: Callable[[str], Awaitable[None]]) -> None:
        """Have a visitor come who has a page of their own; the page is closed afterwards."""

        async def whole() -> None:
            kernel = await self.page()
            try:
                async with asyncio.timeout(120):
                    await visit(kernel)
            finally:
                await self.get(f"voila/api/shutdown/{kernel}", method="POST", body="")

        asyncio.run(whole())


@pytest.fixture(scope="module")
def lecture(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Lecture]:
    folder = tmp_path_factory.mktemp("visited") / "pages"
    folder.mkdir()
    lecture = Lecture(folder)
    yield lecture
    lecture.server.send_signal(signal.SIGINT)
    assert lecture.server.wait(30) == 0
    assert "Traceback" not in lecture.errors.read_text()


def message(kind: str, channel: str = "shell", **content: object) -> bytes:
    header = {"msg_id": uuid.uuid4().hex, "msg_type": kind, "username": "", "session": "v",
              "date": "", "version": "5.3"}  # fmt: skip
    parts = [json.dumps(part).encode() for part in (header, {}, {"version": "1.0.0"}, content)]
    return serialize_msg_to_ws_v1(parts, channel)


async def answers(page: WebSocketClientConnection) -> list[str]:
    """The kinds of what comes back, up to the answer to a question that is allowed."""
    await page.write_message(message("kernel_info_request"), binary=True)
    kinds: list[str] = []
    while "kernel_info_reply" not in kinds:
        frame = await page.read_message()
        assert frame is not None, "the socket was closed"
        _, (header, *_) = deserialize_msg_from_ws_v1(frame)
        kinds.append(json.loads(header)["msg_type"])
    return kinds


async def closed(page: WebSocketClientConnection) -> int | None:
    """Wait until the server closes a socket; the code that it gives."""
    while await page.read_message() is not None:
        pass
    return page.close_code


def test_hostile_frames_close_their_socket_and_nothing_else(lecture: Lecture) -> None:
    async def visit(kernel: str) -> None:
        other = await lecture.socket(kernel)
        for frame in HOSTILE.values():
            page = await lecture.socket(kernel)
            await page.write_message(frame, binary=isinstance(frame, bytes))
            assert await closed(page) in (1008, 1009)  # a breach of the rules, or too big
            assert "kernel_info_reply" in await answers(other)
        page = await lecture.socket(kernel)
        with suppress(WebSocketClosedError):
            await page.write_message("x" * 50_000_000)
        assert await closed(page) in (1009, None)  # it may hear of the end before it has sent all
        assert (await lecture.get("login", token=False)).code == 200
        assert "kernel_info_reply" in await answers(other)

    lecture.visited(visit)
    assert "127.0.0.1 is closed: it sent a frame that is none: it claims" in (
        lecture.errors.read_text()
    )
    assert psutil.Process(lecture.server.pid).memory_info().rss < 400e6


def test_no_code_runs_by_any_channel(lecture: Lecture) -> None:
    trace = lecture.folder / "trace"
    code = f"open({str(trace)!r}, 'w').close()"

    async def visit(kernel: str) -> None:
        page = await lecture.socket(kernel)
        for channel in ("shell", "control", "stdin", "iopub", "no such", ""):
            for kind in ("execute_request", "inspect_request", "complete_request"):
                said = {"code": code, "silent": False, "store_history": False,
                        "user_expressions": {"x": code}, "allow_stdin": True}  # fmt: skip
                await page.write_message(message(kind, channel, **said), binary=True)
            for kind in ("shutdown_request", "interrupt_request", "create_subshell_request"):
                await page.write_message(message(kind, channel, restart=True), binary=True)
            await page.write_message(message("input_reply", channel, value=code), binary=True)
            debug = {"type": "request", "seq": 1, "command": "evaluate",
                     "arguments": {"expression": code}}  # fmt: skip
            await page.write_message(message("debug_request", channel, **debug), binary=True)
        state = {"_model_module": "@jupyter-widgets/controls", "_model_name": "TextModel"}
        opens = {"comm_id": "mine", "target_name": "jupyter.widget", "data": {"state": state}}
        await page.write_message(message("comm_open", **opens), binary=True)
        kinds = set(await answers(page))
        assert kinds <= {"status", "kernel_info_reply", "iopub_welcome"}
        assert (await lecture.get(f"api/kernels/{kernel}")).code == 200

    before = lecture.kernels()
    lecture.visited(visit)
    assert not trace.exists()
    assert set(lecture.kernels()) <= set(before)


def test_a_page_may_ask_for_its_widgets_and_move_them(lecture: Lecture) -> None:
    async def states(page: WebSocketClientConnection) -> dict[str, Any]:
        ask = {"comm_id": uuid.uuid4().hex}
        await page.write_message(
            message("comm_open", **ask, target_name=gate.STATES, data={}), binary=True
        )
        asked = message("comm_msg", **ask, data={"method": "request_states"})
        await page.write_message(asked, binary=True)
        while True:
            frame = await page.read_message()
            assert isinstance(frame, bytes)
            content = json.loads(deserialize_msg_from_ws_v1(frame)[1][3])
            if "states" in content.get("data", {}):
                return content["data"]["states"]

    async def visit(kernel: str) -> None:
        page = await lecture.socket(kernel)
        found = (i for i, one in (await states(page)).items() if one["state"].get("value") == 5)
        slider = next(found)
        move = {"method": "update", "state": {"value": 7}, "buffer_paths": []}
        await page.write_message(message("comm_msg", comm_id=slider, data=move), binary=True)
        assert (await states(page))[slider]["state"]["value"] == 7

    lecture.visited(visit)


def test_sockets_speak_one_protocol_and_are_counted(lecture: Lecture) -> None:
    async def refused(code: int, kernel: str, **options: Any) -> None:
        with pytest.raises(HTTPClientError, match=str(code)):
            await lecture.socket(kernel, **options)

    async def visit(kernel: str) -> None:
        await refused(400, kernel, protocol=None)
        await refused(400, kernel, protocol="v0.kernel.websocket.jupyter.org")
        await refused(400, kernel, query="session_id=" + "x" * 300)
        await refused(400, kernel, query="session_id=a/b")
        await refused(404, str(uuid.uuid4()))
        sockets = [await lecture.socket(kernel) for _ in range(4)]
        many = await asyncio.gather(
            *(lecture.socket(kernel) for _ in range(50)), return_exceptions=True
        )
        assert {getattr(one, "code", None) for one in many} == {429}
        sockets.pop().close()
        while True:  # the server has yet to hear of it
            try:
                sockets.append(await lecture.socket(kernel))
                break
            except HTTPClientError:
                await asyncio.sleep(0.05)
        for one in sockets:
            assert "kernel_info_reply" in await answers(one)

    lecture.visited(visit)


@pytest.mark.parametrize("flood", ["messages", "bytes", "pings"])
def test_who_sends_too_much_is_turned_out(lecture: Lecture, flood: str) -> None:
    async def visit(kernel: str) -> None:
        page, other = await lecture.socket(kernel), await lecture.socket(kernel)
        data = {"x": "x" * 2**19 * (flood == "bytes")}
        for _ in range(10_000):
            try:
                if flood == "pings":
                    page.ping(b"x" * 100)
                    await asyncio.sleep(0)
                else:
                    await page.write_message(
                        message("comm_msg", comm_id="none", data=data), binary=True
                    )
            except Exception:  # as the socket is closed
                break
        await closed(page)
        assert (await lecture.get("login", token=False)).code == 200
        assert "kernel_info_reply" in await answers(other)

    lecture.visited(visit)
    assert "it sends more than" in lecture.errors.read_text()


def test_who_does_not_read_is_given_up(lecture: Lecture) -> None:
    async def visit(kernel: str) -> None:
        page, other = await lecture.socket(kernel), await lecture.socket(kernel)
        opening = message("comm_open", comm_id="c", target_name=gate.STATES, data={})
        await page.write_message(opening, binary=True)
        for _ in range(50):  # each is answered by a megabyte, to both
            asking = message("comm_msg", comm_id="c", data={"method": "request_states"})
            await page.write_message(asking, binary=True)
        while b"does not read" not in lecture.errors.read_bytes():
            assert await other.read_message() is not None
        assert (await lecture.get("login", token=False)).code == 200

    lecture.visited(visit)


def test_a_thousand_connections_leave_room_for_one_more(lecture: Lecture) -> None:
    async def visit(kernel: str) -> None:
        page = await lecture.socket(kernel)
        idle = []
        for _ in range(1000):
            idle.append(await asyncio.open_connection("127.0.0.1", lecture.port))
            idle[-1][1].write(b"GET / HTTP/1.1\r\n")  # and never the rest
        assert (await lecture.get("login", token=False)).code == 200
        assert "kernel_info_reply" in await answers(page)  # which is older than all of them
        assert psutil.Process(lecture.server.pid).num_fds() < 200
        for _, writer in idle:
            writer.close()

    lecture.visited(visit)


def test_a_visitor_has_so_many_pages_and_their_kernels_are_bounded(lecture: Lecture) -> None:
    async def visit(kernel: str) -> None:
        first = await asyncio.gather(*(lecture.page() for _ in range(OPEN_EACH - 1)))
        assert len(lecture.kernels()) == OPEN_EACH
        many = [lecture.get("voila/render/gait.ipynb") for _ in range(20)]
        for answer in await asyncio.gather(*many):
            assert answer.code == 429
            assert answer.body.startswith(b"You have 3 pages open.")
        assert len(lecture.kernels()) == OPEN_EACH
        for one in lecture.kernels():
            assert one.nice() > psutil.Process(lecture.server.pid).nice()
            if sys.platform == "linux":
                assert one.rlimit(psutil.RLIMIT_DATA) == (limits.MEMORY, limits.MEMORY)
        for other in first:
            await lecture.get(f"voila/api/shutdown/{other}", method="POST", body="")
        await lecture.get(f"voila/api/shutdown/{await lecture.page()}", method="POST", body="")

    lecture.visited(visit)


UNSERVED = [
    "voila/render/mine.ipynb", "voila/render/sub/gait.ipynb", "voila/render/.hidden.ipynb",
    "voila/render/.ipynb_checkpoints/gait-checkpoint.ipynb", "voila/render/Gait.ipynb",
    "voila/render/sub/../gait.ipynb", "voila/render/sub%2F..%2Fgait.ipynb", "voila/render/",
    "voila/render/./gait.ipynb", "voila/render//gait.ipynb", "voila/render/gait.ipynb/",
    "voila/render/gait.ipynb%00", "voila/render/%6dine.ipynb", "voila/render/walk.gif",
    "voila/files/walk.gif", "voila/files/gait.ipynb", "files/walk.gif", "walk.gif", "mine.ipynb",
    "voila/tree", "voila/api/contents", "api/contents", "api/kernels", "api/sessions",
    "api/terminals", "api/kernelspecs", "api/status", "nbconvert/html/gait.ipynb", "tree", "lab",
    "voila/static/../../../../etc/passwd", "voila/static/..%2f..%2f..%2f..%2fetc%2fpasswd",
    "voila/labextensions/..%2f..%2f..%2f..%2f..%2f..%2fetc%2fpasswd",
    "voila/templates/lab/static/..%2f..%2f..%2f..%2f..%2f..%2f..%2fetc%2fpasswd",
    "voila/templates/../static/x", "voila/templates/lab", "voila/templates/", "voila/static/",
    "voila/templates/..%2f..%2fstatic%2fx",
    "voila/api/themes/..%2f..%2f..%2fetc%2fpasswd",
]  # fmt: skip


def test_the_lecture_s_own_pages_are_served_and_nothing_else(lecture: Lecture) -> None:
    async def visit() -> None:
        for path in UNSERVED:
            assert (await lecture.get(path)).code in (400, 403, 404), path
        for method in ("POST", "PUT", "DELETE", "PATCH"):
            body = None if method == "DELETE" else "{}"
            for path in ("api/kernels", "api/sessions", "api/contents", "api/terminals"):
                code = (await lecture.get(path, method=method, body=body)).code
                assert code in (403, 404, 405), (method, path)
        assert not lecture.kernels()

    asyncio.run(visit())


def test_pages_and_their_pictures_need_the_token(lecture: Lecture) -> None:
    async def visit() -> None:
        for path in ("", "voila/render/gait.ipynb", f"api/kernels/{uuid.uuid4()}"):
            answer = await lecture.get(path, token=False)
            assert answer.code in (302, 403)
            assert "login" in answer.headers.get("Location", "login") or path == ""
        assert (await lecture.get("voila/files/walk.gif", token=False)).code == 404
        answer = await lecture.get("voila/render/gait.ipynb")
        assert b'src="data:image/gif;base64,R0lGODlhAQAB' in answer.body
        kernel = re.search(rb'"kernelId":\s*"([0-9a-f-]+)"', answer.body)
        assert kernel
        await lecture.get(f"voila/api/shutdown/{kernel[1].decode()}", method="POST", body="")

    asyncio.run(visit())


def test_who_has_the_token_sets_no_password(lecture: Lecture) -> None:
    async def visit() -> None:
        before = sorted(lecture.folder.rglob("*"))
        form = f"password={lecture.token}&new_password=mine"
        assert (await lecture.get("login", method="POST", body=form)).code == 302
        assert sorted(lecture.folder.rglob("*")) == before

    asyncio.run(visit())


def test_a_large_body_is_refused_before_it_comes(lecture: Lecture) -> None:
    async def visit() -> None:
        reader, writer = await asyncio.open_connection("127.0.0.1", lecture.port)
        writer.write(b"POST /login HTTP/1.1\r\nHost: a\r\nContent-Length: 100000000\r\n\r\n")
        async with asyncio.timeout(10):
            assert b" 200 " not in await reader.read()
        writer.close()

    asyncio.run(visit())
