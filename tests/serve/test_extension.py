"""The extension of Jupyter Server, with a kernel manager of Jupyter Server and a real kernel."""

import asyncio
import sys
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import nbformat
import pytest
from jupyter_server.services.contents.largefilemanager import AsyncLargeFileManager
from jupyter_server.services.kernels import websocket
from jupyter_server.services.kernels.kernelmanager import AsyncMappingKernelManager
from jupyter_server.services.kernels.websocket import KernelWebsocketHandler

from ikteach.body.figures import human
from ikteach.serve.extension import _load_jupyter_server_extension, show_stills
from ikteach.serve.fallback import STATE, VIEW
from ikteach.view.chapters.figure import Poser
from ikteach.view.widgets.lacking import WIDGETS

CELL = """
from comm import create_comm
comm = create_comm(target_name="nobody")
for frame in range(20):
    comm.send({"frame": frame})
print("done")
"""


class Sessions:
    """The sessions of a server, by the paths of their notebooks."""

    def __init__(self, *paths: str) -> None:
        self.paths = paths

    async def list_sessions(self) -> list[dict[str, Any]]:
        return [{"path": path, "kernel": {"id": "a kernel"}} for path in self.paths]


def server(*, folder: Path = Path(), sessions: Sessions | None = None, **parts: Any) -> Any:
    """As much of a server as the extension changes."""
    contents = AsyncLargeFileManager(root_dir=str(folder))
    return SimpleNamespace(
        contents_manager=contents, session_manager=sessions or Sessions(), **parts
    )


class Kernels:
    """One kernel with a client, and with these widgets; None: it is too busy to answer."""

    def __init__(self, widgets: list[str] | None) -> None:
        self.widgets, self.open = widgets, 0

    def get_kernel(self, _: str) -> Any:
        return self

    def client(self) -> Any:
        return self

    def start_channels(self, **_: bool) -> None:
        self.open += 1

    def stop_channels(self) -> None:
        self.open -= 1

    async def comm_info(self, target: str, *, reply: bool, timeout: float) -> Any:
        if self.widgets is None:
            raise TimeoutError(f"{timeout} s")
        return {"content": {"comms": {name: {"target_name": target} for name in self.widgets}}}


async def activity() -> tuple[list[bytes], list[str]]:
    """What a server hears of a cell that sends frames: topics, and how the kernel stands by it."""
    manager = AsyncMappingKernelManager()
    _load_jupyter_server_extension(server(kernel_manager=manager))
    heard: list[bytes] = []
    stood: list[str] = []
    kernel_id = await manager.start_kernel(kernel_name="python3")
    try:
        kernel = manager.get_kernel(kernel_id)
        stream = kernel._activity_stream
        record = stream._recv_callback

        def hear(parts: list[bytes]) -> None:
            heard.append(parts[0])
            record(parts)
            stood.append(kernel.execution_state)

        stream._recv_callback = hear
        client = kernel.client()
        client.start_channels()
        await client.wait_for_ready(timeout=60)
        await client._async_execute_interactive(CELL, timeout=60, output_hook=lambda message: None)
        async with asyncio.timeout(60):
            while stood[-2:] != ["busy", "idle"] or not any(b"stdout" in one for one in heard):
                await asyncio.sleep(0.1)
        client.stop_channels()
    finally:
        await manager.shutdown_kernel(kernel_id, now=True)
    return heard, stood


def test_the_server_watches_cells_and_not_frames(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(KernelWebsocketHandler, "open", KernelWebsocketHandler.open)  # afterwards
    heard, stood = asyncio.run(activity())
    assert {"busy", "idle"} <= set(stood)
    assert any(one.startswith(b"stream.stdout") for one in heard)
    assert not any(one.startswith(b"comm") for one in heard)


class Told(list[str]):
    """A log that keeps what it is told."""

    warning = list.append


def sentence(monkeypatch: pytest.MonkeyPatch, **parts: Any) -> str:
    """What is said where a server has only these parts."""
    monkeypatch.setattr(KernelWebsocketHandler, "open", KernelWebsocketHandler.open)  # afterwards
    log = Told()
    _load_jupyter_server_extension(server(log=log, **parts))
    (said,) = log
    assert said.startswith("ikteach.serve.extension steps aside in ")
    return said


def test_without_what_it_changes_it_says_so_and_steps_aside(monkeypatch: Any) -> None:
    manager = SimpleNamespace(start_watching_activity=print)
    assert "kernel_manager" in sentence(monkeypatch)
    assert "start_watching_activity" in sentence(monkeypatch, kernel_manager=object())
    monkeypatch.setattr(websocket, "KernelWebsocketHandler", object)
    assert "open" in sentence(monkeypatch, kernel_manager=manager)
    monkeypatch.setitem(sys.modules, websocket.__name__, None)
    assert "send_at_once" in sentence(monkeypatch, kernel_manager=manager)
    assert manager.start_watching_activity is not print


def test_a_kernel_that_is_not_watched_is_left_alone(monkeypatch: Any) -> None:
    monkeypatch.setattr(KernelWebsocketHandler, "open", KernelWebsocketHandler.open)  # afterwards
    watched: list[str] = []
    manager = SimpleNamespace(
        start_watching_activity=watched.append, get_kernel=lambda kernel_id: object()
    )
    _load_jupyter_server_extension(server(kernel_manager=manager))
    manager.start_watching_activity("k")
    assert watched == ["k"]


def saved(*shown: Any) -> nbformat.NotebookNode:
    """A notebook whose cells have shown these."""
    cell, out = nbformat.v4.new_code_cell, nbformat.v4.new_output
    outputs = [out("display_data", data=bundle(one)) for one in shown]
    return nbformat.v4.new_notebook(cells=[cell("figure", outputs=[one]) for one in outputs])


def bundle(one: Any) -> dict[str, Any]:
    """What a cell keeps of what it shows, but for bytes, which a file has not."""
    answer = one if isinstance(one, dict) else one._repr_mimebundle_()
    data = answer[0] if isinstance(answer, tuple) else answer
    return {mime: text for mime, text in data.items() if mime != "image/png"}


def opened(
    folder: Path, notebook: Any, *living: str, widgets: list[str] | None = None
) -> list[dict[str, Any]]:
    """What a page is given of its outputs, while the notebooks of these paths have kernels."""
    nbformat.write(notebook, folder / "a.ipynb")
    kernels = Kernels(widgets)
    one = server(folder=folder, sessions=Sessions(*living), kernel_manager=kernels)
    show_stills(one)
    content = asyncio.run(one.contents_manager.get("a.ipynb"))["content"]
    assert kernels.open == 0
    return [output["data"] for cell in content["cells"] for output in cell["outputs"]]


def test_without_a_kernel_a_notebook_shows_stills_and_says_what_to_run(tmp_path: Path) -> None:
    figure = Poser(human(), slot=None)
    other = {VIEW: {"model_id": "1"}, "text/plain": "IntSlider()"}
    plain = {"text/plain": "3"}
    first, second, third = opened(tmp_path, saved(figure, other, plain), "b.ipynb")
    figure.close()
    for data in first, second:
        assert VIEW not in data
        assert data["text/html"].count("Run All Cells") == 1
    assert "<img" in first["text/html"]
    assert str(WIDGETS) not in first["text/html"]  # nothing lacks, but the kernel
    assert third == plain


def test_with_a_kernel_or_with_its_state_a_notebook_keeps_its_views(tmp_path: Path) -> None:
    notebook = saved({VIEW: {"model_id": "1"}, "text/html": "a still"})
    for widgets in ["1", "2"], None:
        (data,) = opened(tmp_path, notebook, "a.ipynb", widgets=widgets)
        assert VIEW in data
    notebook.metadata.widgets = {STATE: {"state": {}}}
    (data,) = opened(tmp_path, notebook)
    assert data == {VIEW: {"model_id": "1"}, "text/html": "a still"}


def test_a_kernel_that_was_started_anew_has_lost_its_views(tmp_path: Path) -> None:
    first, second = {VIEW: {"model_id": "1"}}, {VIEW: {"model_id": "2"}}
    old, new = opened(tmp_path, saved(first, second), "a.ipynb", widgets=["2"])
    assert "Run All Cells" in old["text/html"]
    assert VIEW not in old
    assert VIEW in new
