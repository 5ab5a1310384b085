"""The extension of Jupyter Server, with a kernel manager of Jupyter Server and a real kernel."""

import asyncio
import sys
from types import SimpleNamespace
from typing import Any

import pytest
from jupyter_server.services.kernels import websocket
from jupyter_server.services.kernels.kernelmanager import AsyncMappingKernelManager
from jupyter_server.services.kernels.websocket import KernelWebsocketHandler

from ikteach.serve.extension import _load_jupyter_server_extension

CELL = """
from comm import create_comm
comm = create_comm(target_name="nobody")
for frame in range(20):
    comm.send({"frame": frame})
print("done")
"""


async def activity() -> tuple[list[bytes], list[str]]:
    """What a server hears of a cell that sends frames: topics, and how the kernel stands by it."""
    manager = AsyncMappingKernelManager()
    _load_jupyter_server_extension(SimpleNamespace(kernel_manager=manager))
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
    _load_jupyter_server_extension(SimpleNamespace(log=log, **parts))
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
    _load_jupyter_server_extension(SimpleNamespace(kernel_manager=manager))
    manager.start_watching_activity("k")
    assert watched == ["k"]
