"""Run chapters as Python in a browser would, as far as that can be played here.

    python tests/tools/limits.py 09_workbench …

No thread, no process, no connection, no PyAV: what asks for one is refused and noted. The cells of
each notebook run in a loop that is running already, then every button is pressed, and what the live
figures have to say is printed as JSON.
"""

import ast
import asyncio
import contextlib
import json
import os
import socket
import subprocess
import sys
import tempfile
import threading
import time
import warnings
from pathlib import Path
from typing import Any

NOTEBOOKS = Path(__file__).parents[2] / "notebooks"
asked: list[str] = []


def refuse(what: str) -> Any:
    def refused(*_: Any, **__: Any) -> Any:
        asked.append(what)
        raise RuntimeError(f"can't start new {what}")

    return refused


def confine() -> None:
    """Take away what Pyodide does not have; libraries are loaded first, as they are built here."""
    import anywidget, matplotlib.pyplot, pandas, pythreejs, sysconfig  # noqa: E401, F401, I001

    sysconfig.get_config_vars()
    threading.Thread.start = refuse("thread")  # type: ignore[method-assign]
    subprocess.Popen.__init__ = refuse("process")  # type: ignore[method-assign]
    os.fork = refuse("process")
    os.system = refuse("process")
    # An event loop needs a pair of sockets here; what is taken away is to go anywhere with one.
    gone = {name: refuse("socket") for name in ("connect", "bind", "listen")}
    socket.socket = type("socket", (socket.socket,), gone)  # type: ignore[misc]
    time.sleep = refuse("sleep")  # it would hold up the page
    sys.modules["av"] = None  # type: ignore[assignment]
    sys.platform = "emscripten"


async def chapter(name: str) -> dict[str, Any]:
    """Run one notebook, let it live for a moment, press everything; what went wrong."""
    import ipywidgets
    from IPython.display import display

    names: dict[str, Any] = {"__name__": "__main__", "display": display}
    notebook = json.loads((NOTEBOOKS / f"{name}.ipynb").read_text(encoding="utf-8"))
    for cell in notebook["cells"]:
        if cell["cell_type"] == "code":
            code = compile("".join(cell["source"]), name, "exec", ast.PyCF_ALLOW_TOP_LEVEL_AWAIT)
            coming = eval(code, names)
            if coming is not None:
                await coming
            await asyncio.sleep(0)
    await asyncio.sleep(0.5)
    there = ipywidgets.widgets.widget._instances  # `Widget.widgets` is deprecated
    pressed = []
    for widget in list(there.values()):
        if isinstance(widget, ipywidgets.Button) and not widget.disabled and widget.comm:
            pressed.append(widget.description)
            widget.click()
            await asyncio.sleep(0.05)
    said = [str(getattr(w, "wrong", "")) for w in there.values()]
    ipywidgets.Widget.close_all()
    return {
        "chapter": name,
        "pressed": pressed,
        "wrong": [words for words in said if words],
        "asked": asked,
    }


def main(chapters: list[str]) -> None:
    confine()
    warnings.simplefilter("error")
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        for name in chapters:
            with contextlib.redirect_stdout(sys.stderr):
                facts = asyncio.run(chapter(name))
            print(json.dumps(facts), flush=True)
        os.chdir("/")


if __name__ == "__main__":
    main(sys.argv[1:])
