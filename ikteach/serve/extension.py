"""An extension of Jupyter Server that lets frames through in time; it needs no other setting.

Jupyter Server leaves Nagle's algorithm on: a frame of 2 kB then waits until the page's machine has
acknowledged the one before, which takes it up to 40 ms, and 30 poses a second come as 25 pairs.

It also reads every message of a kernel twice, once to pass it on and once to know whether somebody
uses the kernel, which is half of what a frame costs it. Of the second kind it is told here to take
only what tells of cells: that they run, are done, print or show something.

And a notebook whose kernel has ended, or was started anew, is handed out with still pictures in
place of the figures that lived in it, as `fallback` says.

`python -m ikteach` turns the extension on. Without it everything works, less smoothly.
"""

import inspect
from typing import Any

from ikteach.serve.fallback import without_dead_views

ANSWER = 2.0  # [s] how long a kernel may take to say what lives in it: opening waits for it
CELLS = b"kernel.", b"stream.", b"display_data"  # how topics begin; those of widgets with "comm-"


def _jupyter_server_extension_points() -> list[dict[str, str]]:
    return [{"module": "ikteach.serve.extension"}]


def _load_jupyter_server_extension(server: Any) -> None:
    for step in (send_at_once, watch_cells, show_stills):
        try:
            step(server)
        except (ImportError, AttributeError) as missing:
            server.log.warning(
                f"{__name__} steps aside in {step.__name__}: it does not know this Jupyter Server "
                f"({missing}). Everything works, less smoothly."
            )


def send_at_once(server: Any) -> None:
    """Have the sockets of pages send without waiting."""
    from jupyter_server.services.kernels.websocket import KernelWebsocketHandler

    handler: Any = KernelWebsocketHandler
    opened, set_nodelay = handler.open, handler.set_nodelay

    async def open_with_nodelay(self: Any, *args: Any, **kwargs: Any) -> None:
        set_nodelay(self, True)
        await opened(self, *args, **kwargs)

    handler.open = open_with_nodelay


def watch_cells(server: Any) -> None:
    """Have the server listen to kernels about cells only."""
    manager: Any = server.kernel_manager
    watch = manager.start_watching_activity

    def watch_cells_of(kernel_id: str) -> None:
        watch(kernel_id)
        kernel = manager.get_kernel(kernel_id)
        socket = getattr(getattr(kernel, "_activity_stream", None), "socket", None)
        if socket and kernel.kernel_name == "python3":  # other kernels may have other topics
            socket.unsubscribe(b"")
            for topic in CELLS:
                socket.subscribe(topic)

    manager.start_watching_activity = watch_cells_of


def show_stills(server: Any) -> None:
    """Have notebooks show stills of figures that no kernel holds."""
    contents, sessions = server.contents_manager, server.session_manager
    get = contents.get
    if not inspect.iscoroutinefunction(get):
        raise AttributeError(f"{type(contents).__name__}.get does not wait")

    async def get_without_dead_views(path: str, *args: Any, **kwargs: Any) -> Any:
        model = await get(path, *args, **kwargs)
        if model["type"] == "notebook" and model["content"]:
            running = [
                server.kernel_manager.get_kernel(one["kernel"]["id"])
                for one in await sessions.list_sessions()
                if one["path"].strip("/") == path.strip("/")
            ]
            living = await widgets_in(running[0]) if running else set()
            if living is not None:
                without_dead_views(model["content"], living)
        return model

    contents.get = get_without_dead_views


async def widgets_in(kernel: Any) -> set[str] | None:
    """Ask a kernel which widgets live in it.

    None if it is too busy to say.
    """
    client = kernel.client()
    client.start_channels(iopub=False, stdin=False, hb=False, control=False)
    try:
        said = await client.comm_info("jupyter.widget", reply=True, timeout=ANSWER)
    except TimeoutError:
        return None
    finally:
        client.stop_channels()
    return set(said["content"].get("comms", ()))
