"""Voilà as a lecture needs it: pages only, a token always, nothing fetched from elsewhere."""

import logging
import secrets
import shutil
import signal
import threading
import webbrowser
from pathlib import Path
from typing import Any

from jupyter_client.kernelspec import KernelSpec, KernelSpecManager
from jupyter_core.utils import run_sync
from tornado.ioloop import IOLoop
from tornado.web import RedirectHandler
from tornado.websocket import WebSocketClosedError
from traitlets.config import Config
from voila.app import Voila
from voila.tornado.contentshandler import VoilaContentsHandler
from voila.tornado.handler import TornadoVoilaHandler
from voila.tornado.treehandler import TornadoVoilaTreeHandler

from ikteach import server
from ikteach.course.lecture import own_address

LOOK = Path(__file__).parent / "look"
PORT = 8866
ASK_EVERY, ALONE = 30, 120  # [s] how often kernels are looked at; how long one lives without a page
NEEDED = [  # of all that is installed for JupyterLab
    "@jupyter-widgets/jupyterlab-manager",
    "@voila-dashboards/widgets-manager8",
    "anywidget",
    "jupyter-threejs",
    "jupyterlab-datawidgets",
]
TO_ALL = """\
Others in this network can open it too, with this address, token and all. Each page they open is a
kernel on this machine (about 150 MB); they can move the figures and run no code of their own. What
goes over the network is not encrypted."""


class Quiet(KernelSpecManager):
    """Kernels that tell of errors only: that one listens on this machine is no news."""

    def get_kernel_spec(self, kernel_name: str) -> KernelSpec:
        """What starts the kernel of that name."""
        spec = super().get_kernel_spec(kernel_name)
        spec.argv = [*spec.argv, "--log-level=ERROR"]
        return spec


class Page(TornadoVoilaHandler):  # type: ignore[misc]
    """A page, with the cookie that it shows when it is closed, so that its kernel may end."""

    async def get(self, path: str = "") -> None:
        """Send the page, figure by figure."""
        self.xsrf_token  # noqa: B018 - to ask for it is to have the cookie set
        await super().get(path)


SETTINGS = {
    "VoilaConfiguration": {
        "template": "lab",
        "theme": "light",
        "allow_template_override": "NO",
        "allow_theme_override": "NO",
        "extension_allowlist": NEEDED,
        "kernel_spec_manager_class": Quiet,
    },
    "MappingKernelManager": {"cull_interval": ASK_EVERY, "cull_idle_timeout": ALONE},
}


class Lecture(Voila):  # type: ignore[misc]
    """Voilà on a folder of pages. Only who has the token gets in; nobody sees code or files."""

    first: str
    room: bool
    browse: bool

    @classmethod
    def of(
        cls, folder: Path, first: str, port: int | None, *, room: bool = False, browse: bool = True
    ) -> "Lecture":
        """Serve the notebooks of `folder`, `first` at once; to this machine, or to a room."""
        made = cls(config=Config(SETTINGS), root_dir=str(folder))
        made.first, made.room, made.browse = first, room, browse
        made.token = secrets.token_urlsafe(16)
        made.ip = "" if room else "127.0.0.1"
        made.port, made.port_retries = port or PORT, 0 if port else 50
        made.log_level = "ERROR"
        return made

    @property
    def address(self) -> str:
        """Where the first page is, with the token."""
        host = own_address() if self.room else "127.0.0.1"
        return f"http://{host}:{self.port}{self.base_url}?token={self.token}"

    def setup_template_dirs(self) -> None:
        """Our look goes before that of Voilà, which it extends."""
        super().setup_template_dirs()
        self.template_paths.insert(0, str(LOOK))

    def init_settings(self) -> dict[str, Any]:
        """The settings of the server; frames go out in time."""
        settings = dict(super().init_settings())
        server._load_jupyter_server_extension(self)
        return settings

    def init_handlers(self) -> list[Any]:
        """Pages, but no list of files; the root is the first page."""
        pages = []
        for path, handler, *options in super().init_handlers():
            if handler not in (TornadoVoilaTreeHandler, VoilaContentsHandler):
                pages.append((path, Page if handler is TornadoVoilaHandler else handler, *options))
        first = {"url": f"{self.base_url}voila/render/{self.first}", "permanent": False}
        return [(self.server_url, RedirectHandler, first), *pages]

    def start(self) -> None:
        """Serve; that a page was closed while a frame was under way to it is no news."""
        logging.getLogger("asyncio").addFilter(
            lambda record: not (record.exc_info and record.exc_info[0] is WebSocketClosedError)
        )
        logging.getLogger("tornado").setLevel(logging.ERROR)
        # As an exception, Ctrl-C may land in some callback that survives it; this is only noted.
        self.ioloop = IOLoop.current()
        signal.signal(signal.SIGINT, self._handle_signal_stop)
        super().start()

    def stop(self) -> None:
        """End all kernels at once: there is nothing of the visitors' to be kept."""
        shutil.rmtree(self.connection_dir, ignore_errors=True)
        run_sync(self.kernel_manager.shutdown_all)(now=True)

    def launch_browser(self) -> None:
        """Say where the first page is, now that the port is known, and open it."""
        print(f"the lecture is at {self.address}; Ctrl-C here ends it", flush=True)
        if self.room:
            print(TO_ALL, flush=True)
        if self.browse:
            threading.Thread(target=webbrowser.open, args=[self.address], daemon=True).start()
