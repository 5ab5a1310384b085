"""An extension of Jupyter Server that lets frames through in time; it needs no other setting.

Jupyter Server leaves Nagle's algorithm on: a frame of 2 kB then waits until the page's machine has
acknowledged the one before, which takes it up to 40 ms, and 30 poses a second come as 25 pairs.

It also reads every message of a kernel twice, once to pass it on and once to know whether somebody
uses the kernel, which is half of what a frame costs it. Of the second kind it is told here to take
only what tells of cells: that they run, are done, print or show something.

`python -m ikteach` turns the extension on. Without it everything works, less smoothly.
"""

from typing import Any

CELLS = b"kernel.", b"stream.", b"display_data"  # how topics begin; those of widgets with "comm-"


def _jupyter_server_extension_points() -> list[dict[str, str]]:
    return [{"module": "ikteach.server"}]


def _load_jupyter_server_extension(server: Any) -> None:
    from jupyter_server.services.kernels import websocket

    handler: Any = websocket.KernelWebsocketHandler
    opened = handler.open

    async def open_with_nodelay(self: Any, kernel_id: str) -> None:
        self.set_nodelay(True)
        await opened(self, kernel_id)

    handler.open = open_with_nodelay

    manager: Any = server.kernel_manager
    watch = manager.start_watching_activity

    def watch_cells(kernel_id: str) -> None:
        watch(kernel_id)
        kernel = manager.get_kernel(kernel_id)
        if kernel.kernel_name == "python3":  # other kernels may have other topics
            socket = kernel._activity_stream.socket
            socket.unsubscribe(b"")
            for topic in CELLS:
                socket.subscribe(topic)

    manager.start_watching_activity = watch_cells
