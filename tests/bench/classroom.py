"""A JupyterHub on loopback and the students who use it, simulated; `hub.py` measures them.

A student does over the network what the page of chapter 7 does: logs in, starts a server and a
kernel, runs the player's cell, and tells the driver what has been drawn. Nothing is drawn.
"""

import asyncio
import contextlib
import json
import os
import re
import secrets
import shutil
import socket
import subprocess
import sys
import time
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, NamedTuple, Self
from uuid import uuid4

import aiohttp
import psutil
from jupyter_server.services.kernels.connection import base as protocol

ROOT = Path(__file__).parents[2]
CONFIG = ROOT / "binder" / "jupyterhub" / "jupyterhub_config.py"
PATIENCE = 300  # [s] for a server or a cell, when a whole class starts at once
PROTOCOL = "v1.kernel.websocket.jupyter.org"
SEARCH = os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])

DRIVER_JS = (ROOT / "ikteach" / "view" / "webgl" / "driver.js").read_text()
(REPORT_EVERY,) = map(int, re.findall(r"REPORT_EVERY = (\d+)", DRIVER_JS))
CELLS = json.loads((ROOT / "notebooks" / "07_gait.ipynb").read_text())["cells"]
(PLAYER,) = ("".join(cell["source"]) for cell in CELLS if cell["id"] == "player")
ONE_METHOD = "from ikteach import dls, view; view.GaitPlayer({'dls': dls})"


class Hub:
    """JupyterHub with the configuration for a class, in a folder of its own; see `loopback.py`.

    Use it as `async with Hub(folder, students) as hub`: it answers then, and ends afterwards.
    """

    def __init__(self, folder: Path, students: int) -> None:
        if not shutil.which("configurable-http-proxy", path=SEARCH):
            need = "npm install --global configurable-http-proxy@5"
            raise FileNotFoundError(f"JupyterHub needs its proxy: {need}")
        with contextlib.ExitStack() as sockets:
            free = [sockets.enter_context(socket.create_server(("127.0.0.1", 0))) for _ in "123"]
            ports = [one.getsockname()[1] for one in free]
        self.url = f"http://127.0.0.1:{ports[0]}"
        self.homes = folder / "homes"
        self.homes.mkdir()
        self.passwords = {f"student{i + 1:02}": secrets.token_hex(16) for i in range(students)}
        facts = {"ports": ports, "passwords": self.passwords, "homes": str(self.homes)}
        (folder / "bench.json").write_text(json.dumps(facts))
        environment = os.environ | {
            "PATH": SEARCH,
            "PYTHONPATH": os.pathsep.join([str(ROOT), os.environ.get("PYTHONPATH", "")]),
            "IKTEACH_CLASS": str(Path(__file__).with_name("loopback.py")),
            "IKTEACH_BENCH": str(folder / "bench.json"),
        }
        command = [sys.executable, "-m", "jupyterhub", f"--config={CONFIG}"]
        self._log = folder / "hub.log"
        with self._log.open("w") as log:
            self.process = psutil.Popen(
                command, cwd=folder, env=environment, stdout=log, stderr=subprocess.STDOUT
            )

    def log(self) -> str:
        """The end of what it says."""
        return self._log.read_text()[-3000:]

    async def ask(self, path: str, token: str = "", post: Any = None) -> str:
        """GET, or POST something; ClientResponseError for what is refused."""
        method = "GET" if post is None else "POST"
        headers = {"Authorization": f"token {token}"} if token else {}
        url = self.url + path
        async with self.web.request(method, url, headers=headers, json=post) as answer:
            answer.raise_for_status()
            return await answer.text()

    def servers(self) -> dict[str, psutil.Process]:
        """The process of each student's server."""
        owners = {
            child.environ().get("JUPYTERHUB_USER"): child for child in self.process.children()
        }
        return {name: child for name, child in owners.items() if name}

    async def __aenter__(self) -> Self:
        nobody_queues = aiohttp.TCPConnector(limit=0)
        self.web = aiohttp.ClientSession(
            connector=nobody_queues, timeout=aiohttp.ClientTimeout(PATIENCE)
        )
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end and self.process.poll() is None:
            with contextlib.suppress(aiohttp.ClientError):  # at first the proxy knows no hub
                await self.ask("/hub/health")
                return self
            await asyncio.sleep(0.2)
        await self.__aexit__()
        raise RuntimeError(f"The hub does not answer.\n{self.log()}")

    async def __aexit__(self, *_: object) -> None:
        await self.web.close()
        self.stop()

    def stop(self) -> None:
        """End it, and all that it has started."""
        if self.process.poll() is not None:
            return
        started = [self.process, *self.process.children(recursive=True)]
        for how in (psutil.Process.terminate, psutil.Process.kill):
            for process in started:
                with contextlib.suppress(psutil.NoSuchProcess):
                    how(process)
            _, started = psutil.wait_procs(started, timeout=20)


class Frame(NamedTuple):
    """One pose: when the kernel made its message and when the student had it [s]."""

    number: int
    sent: float
    received: float


class Student:
    """One student and their page. `frames` are the poses that came, `moving` is set by the first.

    cell      what the student runs
    scene     messages that concern the picture: poses, and whatever else its objects are told
    messages  messages of any kind from the kernel
    """

    def __init__(self, hub: Hub, name: str, cell: str = PLAYER) -> None:
        self.hub, self.name, self.cell = hub, name, cell
        self.frames: list[Frame] = []
        self.scene = self.messages = 0
        self.moving = asyncio.Event()
        self._done = asyncio.Event()
        self._driver, self._objects = "", set[str]()
        self._session, self._reported, self._failed = uuid4().hex, -1, ""

    async def come(self) -> None:
        """Log in, start a server and a kernel, and have the figure move."""
        hub, user = self.hub, f"/hub/api/users/{self.name}"
        token = await self.log_in(hub.passwords[self.name])
        await hub.ask(f"{user}/server", token, post={})
        told = await hub.ask(f"{user}/server/progress", token)
        if '"ready": true' not in told:
            raise RuntimeError(f"{self.name} gets no server: {told[-500:]}\n{hub.log()}")
        kernels = f"/user/{self.name}/api/kernels"
        kernel = json.loads(await hub.ask(kernels, token, post={"name": "python3"}))["id"]
        self._page = await hub.web.ws_connect(
            f"{hub.url}{kernels}/{kernel}/channels",
            headers={"Authorization": f"token {token}"},
            protocols=[PROTOCOL],
            max_msg_size=2**27,
        )
        self._listening = asyncio.create_task(self._listen())
        code = {"code": self.cell, "silent": False, "allow_stdin": False, "stop_on_error": True}
        await self._say("execute_request", **code)
        await asyncio.wait_for(self._done.wait(), PATIENCE)
        if self._failed or not self._driver:
            raise RuntimeError(f"{self.name} has no figure: {self._failed}")
        await self._tell(hello=True)
        await asyncio.wait_for(self.moving.wait(), PATIENCE)

    async def log_in(self, password: str) -> str:
        """A token of one's own, for a password."""
        proof = {"auth": {"username": self.name, "password": password}}
        answer = await self.hub.ask(f"/hub/api/users/{self.name}/tokens", post=proof)
        return str(json.loads(answer)["token"])

    async def _tell(self, **content: Any) -> None:
        """Send the driver in the kernel a message, as driver.js does."""
        await self._say(
            "comm_msg", comm_id=self._driver, data={"method": "custom", "content": content}
        )

    async def _say(self, kind: str, **content: Any) -> None:
        header = {
            "msg_id": uuid4().hex, "msg_type": kind, "session": self._session,
            "username": self.name, "version": "5.4", "date": datetime.now(UTC).isoformat(),
        }  # fmt: skip
        message = {"header": header, "parent_header": {}, "metadata": {}, "content": content}
        pack = lambda part: json.dumps(part).encode()  # noqa: E731
        data = protocol.serialize_msg_to_ws_v1(message, "shell", pack)
        await self._page.send_bytes(data)

    async def _listen(self) -> None:
        """Hear what comes, until the server hangs up."""
        async for message in self._page:
            await self._hear(message.data)

    async def _hear(self, data: bytes) -> None:
        """What the page does when a message comes; it is cheap, as all students share a process."""
        received = time.time()
        channel, parts = protocol.deserialize_msg_from_ws_v1(data)
        header, content = json.loads(parts[0]), json.loads(parts[3])
        self.messages += channel == "iopub"
        kind = header["msg_type"]
        if kind == "comm_msg":
            await self._obey(header, content, received)
        elif kind == "comm_open":
            state = content["data"].get("state", {})
            if state.get("_model_module") == "jupyter-threejs":
                self._objects.add(content["comm_id"])
            elif {"renderer", "nodes"} <= state.keys():
                self._driver = content["comm_id"]
        elif kind == "execute_reply":
            self._failed = content.get("evalue", "")
            self._done.set()

    async def _obey(self, header: Any, content: Any, received: float) -> None:
        pose = content["data"].get("content", {}).get("frame")
        own = content["comm_id"] == self._driver and pose is not None
        self.scene += own or content["comm_id"] in self._objects
        if not own:
            return
        self.frames.append(
            Frame(pose, datetime.fromisoformat(header["date"]).timestamp(), received)
        )
        self.moving.set()
        if pose - self._reported >= REPORT_EVERY:
            self._reported = pose
            await self._tell(drawn=pose)
