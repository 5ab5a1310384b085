"""The extension of Jupyter Server, with a kernel manager of Jupyter Server and a real kernel."""

import asyncio
from types import SimpleNamespace

import pytest
from jupyter_server.services.kernels.kernelmanager import AsyncMappingKernelManager
from jupyter_server.services.kernels.websocket import KernelWebsocketHandler

from ikteach.server import _load_jupyter_server_extension

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
