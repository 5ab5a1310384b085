"""Firefox and WebKit by the drivers that their distributions bring, behind one small interface."""

import base64
import os
import shutil
import subprocess
import time
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Protocol

from selenium.webdriver import ActionChains, WebKitGTK
from selenium.webdriver.webkitgtk.options import Options
from selenium.webdriver.webkitgtk.service import Service

with warnings.catch_warnings():  # its packages have strings with stray backslashes
    warnings.simplefilter("ignore")
    from marionette_driver.marionette import ActionSequence, Marionette

WIDTH, HEIGHT = 1366, 900
WEBKIT = (  # Debian and Ubuntu, Fedora
    "/usr/lib/*/webkit2gtk-4.1/MiniBrowser",
    "/usr/libexec/webkit2gtk-4.1/MiniBrowser",
)
Point = tuple[float, float]


class Engine(Protocol):
    """A browser with one page; places are in CSS pixels of the view."""

    def go(self, address: str) -> None:
        """Open an address."""

    def run(self, script: str) -> Any:
        """Run the body of a JavaScript function, and return what it returns."""

    def drag(self, path: Sequence[Point]) -> None:
        """Press the mouse at the first place, go through the others, let go at the last."""

    def press(self, key: str) -> None:
        """Press and let go a key, at what has the focus."""

    def shot(self, path: Path) -> None:
        """Keep a screenshot."""

    def close(self) -> None:
        """End the browser."""


class Firefox:
    """Firefox, by its own Marionette."""

    def __init__(self, folder: Path) -> None:
        os.environ["LIBGL_ALWAYS_SOFTWARE"] = "1"
        name = next(filter(None, map(shutil.which, ("firefox-esr", "firefox"))))
        self.page = Marionette(
            port=0,
            app="fxdesktop",
            bin=name,
            gecko_log=str(folder / "gecko.log"),
            prefs={"webgl.force-enabled": True},
            startup_timeout=60,
        )
        self.page.start_session()
        self.page.set_window_rect(x=0, y=0, width=WIDTH, height=HEIGHT)

    def go(self, address: str) -> None:
        self.page.navigate(address)

    def run(self, script: str) -> Any:
        return self.page.execute_script(script, sandbox=None)

    def drag(self, path: Sequence[Point]) -> None:
        actions = ActionSequence(self.page, "pointer", "mouse", {"pointerType": "mouse"})
        for place, (x, y) in enumerate(path):
            actions.pointer_move(round(x), round(y), duration=50)
            if place == 0:
                actions.pointer_down()
        actions.pointer_up()
        actions.perform()

    def press(self, key: str) -> None:
        actions = ActionSequence(self.page, "key", "keyboard")
        actions.key_down(key).key_up(key)
        actions.perform()

    def shot(self, path: Path) -> None:
        path.write_bytes(base64.b64decode(self.page.screenshot(full=False)))

    def close(self) -> None:
        profile = self.page.instance.profile
        self.page.cleanup()
        profile.cleanup()  # its folder goes while Python is still there


class WebKit:
    """WebKitGTK's MiniBrowser, by WebKitWebDriver."""

    def __init__(self, folder: Path) -> None:
        options = Options()
        options.binary_location = str(
            next(found for pattern in WEBKIT for found in Path("/").glob(pattern[1:]))
        )
        options.add_argument("--automation")
        service = Service(executable_path=shutil.which("WebKitWebDriver"), log_output=os.devnull)
        self.page = WebKitGTK(options=options, service=service)
        self.page.set_window_size(WIDTH, HEIGHT)

    def go(self, address: str) -> None:
        self.page.get(address)

    def run(self, script: str) -> Any:
        return self.page.execute_script(script)

    def drag(self, path: Sequence[Point]) -> None:
        actions = ActionChains(self.page, duration=50)
        for place, (x, y) in enumerate(path):
            actions.w3c_actions.pointer_action.move_to_location(round(x), round(y))
            if place == 0:
                actions.w3c_actions.pointer_action.pointer_down()
        actions.w3c_actions.pointer_action.pointer_up()
        actions.perform()

    def press(self, key: str) -> None:
        ActionChains(self.page).send_keys(key).perform()

    def shot(self, path: Path) -> None:
        self.page.save_screenshot(str(path))

    def close(self) -> None:
        self.page.quit()


class Screen:
    """A screen that nobody sees (Xvfb), for browsers that want one."""

    def __init__(self) -> None:
        read, write = os.pipe()
        self.process = subprocess.Popen(
            ["Xvfb", "-displayfd", str(write), "-screen", "0", "1600x1200x24", "-nolisten", "tcp"],
            pass_fds=[write],
            stderr=subprocess.DEVNULL,
        )
        os.close(write)
        with os.fdopen(read) as answer:
            self.before, self.number = os.environ.get("DISPLAY"), answer.readline().strip()
        os.environ["DISPLAY"] = f":{self.number}"
        os.environ.pop("WAYLAND_DISPLAY", None)

    def close(self) -> None:
        """End it, and have what was there before."""
        self.process.terminate()
        self.process.wait(30)
        os.environ.pop("DISPLAY")
        if self.before is not None:
            os.environ["DISPLAY"] = self.before


def wait(engine: Engine, script: str, seconds: float = 60) -> Any:
    """Run a script until what it returns is true, and return that."""
    end = time.monotonic() + seconds
    while not (found := engine.run(script)):
        if time.monotonic() > end:
            raise AssertionError(f"after {seconds:.0f} s still not: {script}")
        time.sleep(0.2)
    return found
