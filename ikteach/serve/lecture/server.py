"""Voilà as a lecture needs it: pages only, a token always, nothing fetched from elsewhere.

One visitor must not stop the lecture for all, so everything that a visitor can have is counted, and
of what Voilà serves there is only what a page needs.
"""

import logging
import re
import secrets
import shutil
import signal
import threading
import webbrowser
from collections import Counter, deque
from contextlib import suppress
from pathlib import Path
from typing import Any, ClassVar

from jupyter_client.kernelspec import KernelSpec, KernelSpecManager
from jupyter_core.utils import run_sync
from jupyter_server.base.call_context import CallContext
from jupyter_server.base.handlers import FileFindHandler
from jupyter_server.services.kernels.handlers import KernelHandler
from jupyter_server.services.kernels.kernelmanager import AsyncMappingKernelManager
from jupyterlab_server.themes_handler import ThemesHandler
from tornado.httpserver import HTTPServer
from tornado.ioloop import IOLoop
from tornado.iostream import IOStream, StreamBufferFullError
from tornado.web import HTTPError, RedirectHandler
from tornado.websocket import WebSocketClosedError
from traitlets import Dict
from traitlets.config import Config
from voila.app import Voila
from voila.shutdown_kernel_handler import VoilaShutdownKernelHandler
from voila.static_file_handler import MultiStaticFileHandler, TemplateStaticFileHandler
from voila.tornado.handler import TornadoVoilaHandler
from voila.tornado.kernel_websocket_handler import VoilaKernelWebsocketHandler

from ikteach.serve import extension as server
from ikteach.serve.lecture import PAGES, gate, own_address

logger = logging.getLogger(__name__)
TEMPLATES = Path(__file__).parent / "look"
KERNEL_SCRIPT, LAUNCHER = Path(__file__).with_name("kernel.py"), "ipykernel_launcher"
PORT = 8866
ASK_EVERY, ALONE = 30, 120  # [s] how often kernels are looked at; how long one lives without a page
OPEN_EACH, OPEN_ALL = 6, 30  # pages, each a kernel: of one visitor, of all; a visitor is an address
SOCKETS = 4  # to one kernel; a page needs one, and a second while it comes back
CONNECTIONS = 64  # of one visitor, websockets not counted
MESSAGES, BYTES, SAVED = 500, 2**20, 4  # per second that a socket may send; seconds saved up
UNREAD = 2**24  # bytes that wait for a page before it is given up
BUFFERED = 100  # messages of a kernel that wait for a page that has lost its socket
OUTPUT = 60  # [s] that a figure may take to come; where many pages open at once, it takes long
SLOW = 30  # [s] within which a request must have come
FORM = 2**16  # bytes, the largest body of a request
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


class BoundedKernels(KernelSpecManager):
    """Kernels that are bounded, and tell of errors only."""

    def get_kernel_spec(self, kernel_name: str) -> KernelSpec:
        """Start the kernel of that name by `kernel.py`."""
        spec = super().get_kernel_spec(kernel_name)
        if LAUNCHER in spec.argv:  # after `-m`, for which -P stands: import nothing from FOLDER
            at = spec.argv.index(LAUNCHER)
            spec.argv[at - 1 : at + 1] = ["-P", str(KERNEL_SCRIPT)]
        spec.argv = [*spec.argv, "--log-level=ERROR"]
        # Matrices of a figure are small: more threads would only be in one another's way.
        spec.env = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"} | spec.env
        return spec


class Kernels(AsyncMappingKernelManager):
    """The kernels of all pages, counted per visitor and together.

    visitors  kernel -> address of the visitor whose page it is
    """

    visitors: Any = Dict()

    async def start_kernel(self, **options: Any) -> str:  # type: ignore[override]
        """Start a kernel for a visitor's page, or refuse."""
        visitor = CallContext.get(CallContext.JUPYTER_HANDLER).request.remote_ip
        if list(self.visitors.values()).count(visitor) >= OPEN_EACH:
            raise HTTPError(429, f"You have {OPEN_EACH} pages open. Close one, wait, and reload.")
        if len(self.visitors) >= OPEN_ALL:
            raise HTTPError(503, f"{OPEN_ALL} pages are open, and no more. Come back later.")
        kernel_id = self.new_kernel_id()
        self.visitors[kernel_id] = visitor
        try:
            return str(await super().start_kernel(kernel_id=kernel_id, **options))
        except BaseException:
            self.visitors.pop(kernel_id, None)
            raise

    def remove_kernel(self, kernel_id: str) -> Any:
        """Forget a kernel that has ended."""
        self.visitors.pop(kernel_id, None)
        return super().remove_kernel(kernel_id)

    def start_buffering(self, kernel_id: str, *where: Any) -> None:
        """Keep the newest messages for a page without a socket."""
        super().start_buffering(kernel_id, *where)  # type: ignore[no-untyped-call]
        self._kernel_buffers[kernel_id]["buffer"] = deque(maxlen=BUFFERED)


class PlainErrors:
    """Tells of an error in a sentence, without Jupyter's page."""

    def write_error(self: Any, status_code: int, exc_info: Any = (None, None), **_: Any) -> None:
        """Send the sentence of the error, or of its number."""
        self.set_header("Content-Type", "text/plain; charset=utf-8")
        self.finish(getattr(exc_info[1], "log_message", None) or self._reason)


class Files(PlainErrors):
    """Files of installed packages, by paths that lead down."""

    def parse_url_path(self, url_path: str) -> str:
        """Give the path of a file, or 404."""
        with suppress(AssertionError, ValueError):  # Voilà's, where a template is not named
            if ".." not in url_path.split("/"):
                return str(super().parse_url_path(url_path))  # type: ignore[misc]
        raise HTTPError(404)


class LecturePage(PlainErrors, TornadoVoilaHandler):  # type: ignore[misc]
    """A page, whose cookie lets its kernel end when closed."""

    async def get(self, path: str = "") -> None:
        """Send one of the lecture's own pages, figure by figure."""
        if path not in {page.name for page in PAGES.glob("*.ipynb")}:
            raise HTTPError(404)
        self.xsrf_token  # noqa: B018 - to ask for it is to have the cookie set
        await super().get(path)


class Channels(PlainErrors, VoilaKernelWebsocketHandler):  # type: ignore[misc]
    """The socket between a page and its kernel, guarded."""

    sockets: ClassVar[Counter[str]] = Counter()  # kernel -> how many are open, or opening
    turned_out = False

    async def get(self, kernel_id: str) -> None:
        """Open the socket, and serve it until it is closed."""
        offered = self.request.headers.get("Sec-WebSocket-Protocol", "").split(",")
        if gate.PROTOCOL not in map(str.strip, offered):
            raise HTTPError(400, f"a socket must speak {gate.PROTOCOL}")
        if not re.fullmatch(r"[\w-]{0,64}", self.get_argument("session_id", "")):
            raise HTTPError(400, "that is no name of a session")
        if self.sockets[kernel_id] >= SOCKETS:
            raise HTTPError(429, f"{SOCKETS} sockets are open to this kernel, and no more")
        self.sockets[kernel_id] += 1
        try:
            await super().get(kernel_id)
        finally:
            self.sockets[kernel_id] -= 1
            if not self.sockets[kernel_id]:
                del self.sockets[kernel_id]

    def select_subprotocol(self, subprotocols: list[str]) -> str:
        """Speak the one protocol that can be guarded."""
        return gate.PROTOCOL

    async def open(self, kernel_id: str) -> None:
        """Connect to the kernel."""
        self.wire = self.ws_connection.stream
        self.wire.max_write_buffer_size = UNREAD
        clock = IOLoop.current().time
        self.messages = gate.Allowance(MESSAGES, SAVED, clock)
        self.bytes = gate.Allowance(BYTES, SAVED, clock)
        await super().open(kernel_id)

    def on_message(self, frame: bytes | str) -> None:
        """Pass on a frame that is a permitted message."""
        if not self._paid(len(frame)):
            return
        try:
            message = gate.read_frame(frame)
        except ValueError as reason:
            self._turn_out(f"it sent a frame that is none: {reason}")
            return
        if gate.permitted(message):
            super().on_message(frame)

    def on_ping(self, data: bytes) -> None:
        """Count a ping, which is answered, as a message."""
        self._paid(len(data))

    def write_message(self, message: Any, binary: bool = False) -> Any:
        """Send a message, unless earlier ones are unread."""
        try:
            return super().write_message(message, binary)
        except StreamBufferFullError:
            self._turn_out("it does not read what it is sent")

    def _paid(self, size: int) -> bool:
        """Whether so large a message may come now; who is turned out and goes on is cut off."""
        if self.turned_out:
            self.wire.close()
        elif not (self.messages.spend(1) and self.bytes.spend(size)):
            self._turn_out(f"it sends more than {MESSAGES} messages or {BYTES} bytes per second")
        return not self.turned_out

    def _turn_out(self, reason: str) -> None:
        if self.turned_out:
            return
        self.turned_out = True
        logger.error("A socket of %s is closed: %s.", self.request.remote_ip, reason)
        try:
            self.close(1008)  # which stands for a breach of the rules
        except StreamBufferFullError:
            self.wire.close()


class Door(HTTPServer):
    """Lets each visitor have a number of connections.

    For a newer one the oldest is closed.

    waiting  address -> its connections, of which none has become a websocket
    """

    def initialize(self, *arguments: Any, **options: Any) -> None:
        """Start with nobody there."""
        self.waiting: dict[str, list[IOStream]] = {}
        super().initialize(*arguments, **options)

    def handle_stream(self, stream: IOStream, address: tuple[Any, ...]) -> None:
        """Serve a connection that has just been made."""
        theirs = self.waiting.setdefault(address[0], [])
        if len(theirs) >= CONNECTIONS:
            theirs.pop(0).close()
        theirs.append(stream)
        super().handle_stream(stream, address)

    def on_close(self, server_conn: Any) -> None:
        """Forget a connection that has ended or is a websocket."""
        super().on_close(server_conn)
        for address, theirs in list(self.waiting.items()):
            if server_conn.stream in theirs:
                theirs.remove(server_conn.stream)
            if not theirs:
                del self.waiting[address]


# What there is of Voilà's handlers, and by what of ours it is done. What a newer Voilà adds is not
# served before somebody has looked at it. Pictures need none: a page holds those of its words.
FILES = (TemplateStaticFileHandler, MultiStaticFileHandler, FileFindHandler, ThemesHandler)
SERVED = {
    TornadoVoilaHandler: LecturePage,
    VoilaKernelWebsocketHandler: Channels,
    KernelHandler: KernelHandler,
    VoilaShutdownKernelHandler: VoilaShutdownKernelHandler,
} | {kind: type(kind.__name__, (Files, kind), {}) for kind in FILES}
SETTINGS = {
    "VoilaConfiguration": {
        "template": "lab",
        "theme": "light",
        "allow_template_override": "NO",
        "allow_theme_override": "NO",
        "extension_allowlist": NEEDED,
        "kernel_spec_manager_class": BoundedKernels,
        "multi_kernel_manager_class": Kernels,
    },
    "VoilaExecutor": {"iopub_timeout": OUTPUT},
    "MappingKernelManager": {"cull_interval": ASK_EVERY, "cull_idle_timeout": ALONE},
    # Else who has the token may have a password written into a file of Jupyter's settings.
    "PasswordIdentityProvider": {"allow_password_change": False},
}


class Lecture(Voila):  # type: ignore[misc]
    """Voilà on a folder of pages, for holders of the token."""

    first: str
    room: bool
    browse: bool

    @classmethod
    def of(
        cls, folder: Path, first: str, port: int | None, *, room: bool = False, browse: bool = True
    ) -> "Lecture":
        """Serve the notebooks of `folder`, here or to a room."""
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
        """Put our look before that of Voilà, which it extends."""
        super().setup_template_dirs()
        self.template_paths.insert(0, str(TEMPLATES))

    def init_settings(self) -> dict[str, Any]:
        """Make the settings; frames go out in time."""
        settings = dict(super().init_settings())
        self.kernel_manager.allowed_message_types = gate.PERMITTED
        server._load_jupyter_server_extension(self)
        return settings | {"websocket_max_message_size": gate.FRAME}

    def init_handlers(self) -> list[Any]:
        """List the handlers that are served; the root is `first`."""
        login = {handler: handler for _, handler, *_ in self.identity_provider.get_handlers()}
        served = SERVED | login
        pages = [
            (path, served[handler], *options)
            for path, handler, *options in super().init_handlers()
            if handler in served
        ]
        first = {"url": f"{self.base_url}voila/render/{self.first}", "permanent": False}
        return [(self.server_url, RedirectHandler, first), *pages]

    def listen(self) -> None:
        """Listen at a door where requests are small and quick."""
        door = Door(self.app, max_body_size=FORM, idle_connection_timeout=SLOW, body_timeout=SLOW)
        self.app.listen = door.listen
        super().listen()

    def start(self) -> None:
        """Serve until Ctrl-C, without news of pages closed early."""
        logging.getLogger("asyncio").addFilter(
            lambda record: not (record.exc_info and record.exc_info[0] is WebSocketClosedError)
        )
        logging.getLogger("tornado").setLevel(logging.ERROR)
        # As an exception, Ctrl-C may land in some callback that survives it; this is only noted.
        self.ioloop = IOLoop.current()
        signal.signal(signal.SIGINT, self._handle_signal_stop)
        super().start()

    def stop(self) -> None:
        """End all kernels at once; nothing is to be kept."""
        shutil.rmtree(self.connection_dir, ignore_errors=True)
        run_sync(self.kernel_manager.shutdown_all)(now=True)

    def launch_browser(self) -> None:
        """Say where the first page is, and open it."""
        print(f"the lecture is at {self.address}", "Ctrl-C here ends it", sep="\n", flush=True)
        if self.room:
            print(TO_ALL, flush=True)
        if self.browse:
            threading.Thread(target=webbrowser.open, args=[self.address], daemon=True).start()
